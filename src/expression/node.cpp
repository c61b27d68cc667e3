// Making expressions: nodes, C++ operators and functions, smooth blends. Trees may be as deep as memory allows (a sum
// of a million terms is a chain), so nothing here recurses along them.
#include "expression/node.h"

#include <cmath>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "expression/scalar.h"

namespace certa::expression {

const char* symbol_of(Op op) {
    static constexpr const char* symbols[] = {"",    "pi",  "x",    "y",    "z",    "-",   "+",   "-",
                                              "*",   "/",   "^",    "^",    "sqrt", "exp", "log", "sin",
                                              "cos", "tan", "atan", "sinh", "cosh", "tanh"};
    return symbols[static_cast<int>(op)];
}

Node::~Node() {
    std::vector<NodePointer> last;
    const auto take = [&last](NodePointer& child) {
        if (child && child.use_count() == 1) last.push_back(std::move(child));
    };
    take(first);
    take(second);
    while (!last.empty()) {
        const NodePointer node = std::move(last.back());
        last.pop_back();
        // Ours is the only reference: the children may be taken out of the node before it goes.
        auto& dying = const_cast<Node&>(*node);
        take(dying.first);
        take(dying.second);
    }
}

NodePointer make_constant(Constant constant) {
    auto node = std::make_shared<Node>();
    node->constant = std::move(constant);
    return node;
}

NodePointer make_leaf(Op op) {
    auto node = std::make_shared<Node>();
    node->op = op;
    node->depends_on_place = op >= Op::x;
    return node;
}

NodePointer make_unary(Op op, NodePointer a) {
    if (op == Op::negate && a->op == Op::constant) return make_constant(negated(a->constant));
    auto node = std::make_shared<Node>();
    node->op = op;
    node->depends_on_place = a->depends_on_place;
    node->first = std::move(a);
    return node;
}

NodePointer make_binary(Op op, NodePointer a, NodePointer b) {
    if (a->op == Op::constant && b->op == Op::constant) {
        std::optional<Constant> value;
        if (op == Op::add) value = sum(a->constant, b->constant);
        if (op == Op::subtract) value = sum(a->constant, negated(b->constant));
        if (op == Op::multiply) value = product(a->constant, b->constant);
        if (op == Op::divide) value = quotient(a->constant, b->constant);
        if (value) return make_constant(*value);
    }
    auto node = std::make_shared<Node>();
    node->op = op;
    node->depends_on_place = a->depends_on_place || b->depends_on_place;
    node->first = std::move(a);
    node->second = std::move(b);
    return node;
}

NodePointer make_power(NodePointer a, int exponent) {
    if (a->op == Op::constant) {
        if (const auto value = power(a->constant, exponent)) return make_constant(*value);
    }
    auto node = std::make_shared<Node>();
    node->op = Op::power;
    node->exponent = exponent;
    node->depends_on_place = a->depends_on_place;
    node->first = std::move(a);
    return node;
}

NodePointer make_constant_power(const NodePointer& base, const NodePointer& exponent) {
    if (exponent->depends_on_place) return nullptr;
    if (exponent->op == Op::constant) {
        const Constant& e = exponent->constant;
        if (e.is_rational() && e.denominator == 1 && std::abs(e.numerator) <= 1'000'000)
            return make_power(base, static_cast<int>(e.numerator));
        if (e.is_rational() && e.numerator == 1 && e.denominator == 2) return make_unary(Op::square_root, base);
    }
    return make_binary(Op::real_power, base, exponent);
}

std::vector<const Node*> in_order(const NodePointer& root) {
    std::vector<const Node*> order;
    std::unordered_set<const Node*> done;
    std::vector<std::pair<const Node*, bool>> work{{root.get(), false}};
    while (!work.empty()) {
        const auto [node, children_done] = work.back();
        work.pop_back();
        if (done.count(node) != 0) continue;
        if (children_done) {
            done.insert(node);
            order.push_back(node);
            continue;
        }
        work.emplace_back(node, true);
        if (node->second) work.emplace_back(node->second.get(), false);
        if (node->first) work.emplace_back(node->first.get(), false);
    }
    return order;
}

interval::Interval enclosure_of_constant(const NodePointer& root) {
    std::unordered_map<const Node*, interval::Interval> values;
    for (const Node* node : in_order(root)) {
        interval::Interval value = interval::undefined();
        if (node->op == Op::constant) value = enclosure(node->constant);
        if (node->op == Op::pi) value = interval::pi;
        if (operand_count(node->op) > 0) {
            const interval::Interval a = values.at(node->first.get());
            value = apply(node->op, a, node->second ? values.at(node->second.get()) : a, node->exponent);
        }
        values.emplace(node, value);
    }
    return values.at(root.get());
}

}  // namespace certa::expression

namespace certa {

using expression::make_binary;
using expression::make_leaf;
using expression::make_unary;
using expression::Op;

namespace {

[[noreturn]] void refuse(DefectKind kind, const std::string& message) {
    throw InputError({Defect{kind, {}, {}, message}});
}

expression::NodePointer node_of(double value) {
    if (!std::isfinite(value))
        refuse(DefectKind::coordinate_out_of_range, "a constant of an expression is not a finite number");
    return expression::make_constant(expression::constant_of(value));
}

void require_positive(const Expression& k) {
    if (k.node()->depends_on_place || interval::sign_of(expression::enclosure_of_constant(k.node())) <= 0)
        refuse(DefectKind::option_out_of_range, "the width k of a smooth blend must be a positive constant");
}

}  // namespace

Expression::Expression(double constant) : node_(node_of(constant)) {}
Expression Expression::x() { return Expression(make_leaf(Op::x)); }
Expression Expression::y() { return Expression(make_leaf(Op::y)); }
Expression Expression::z() { return Expression(make_leaf(Op::z)); }
Expression Expression::pi() { return Expression(make_leaf(Op::pi)); }

Expression operator-(const Expression& a) { return Expression(make_unary(Op::negate, a.node())); }
Expression operator+(const Expression& a, const Expression& b) {
    return Expression(make_binary(Op::add, a.node(), b.node()));
}
Expression operator-(const Expression& a, const Expression& b) {
    return Expression(make_binary(Op::subtract, a.node(), b.node()));
}
Expression operator*(const Expression& a, const Expression& b) {
    return Expression(make_binary(Op::multiply, a.node(), b.node()));
}
Expression operator/(const Expression& a, const Expression& b) {
    return Expression(make_binary(Op::divide, a.node(), b.node()));
}

Expression pow(const Expression& a, const Expression& exponent) {
    expression::NodePointer node = make_constant_power(a.node(), exponent.node());
    if (!node)
        refuse(DefectKind::option_out_of_range,
               "an exponent depends on x, y or z; write exp(exponent * log(base)) where base > 0");
    return Expression(std::move(node));
}

Expression sqrt(const Expression& a) { return Expression(make_unary(Op::square_root, a.node())); }
Expression exp(const Expression& a) { return Expression(make_unary(Op::exp, a.node())); }
Expression log(const Expression& a) { return Expression(make_unary(Op::log, a.node())); }
Expression sin(const Expression& a) { return Expression(make_unary(Op::sin, a.node())); }
Expression cos(const Expression& a) { return Expression(make_unary(Op::cos, a.node())); }
Expression tan(const Expression& a) { return Expression(make_unary(Op::tan, a.node())); }
Expression atan(const Expression& a) { return Expression(make_unary(Op::atan, a.node())); }
Expression sinh(const Expression& a) { return Expression(make_unary(Op::sinh, a.node())); }
Expression cosh(const Expression& a) { return Expression(make_unary(Op::cosh, a.node())); }
Expression tanh(const Expression& a) { return Expression(make_unary(Op::tanh, a.node())); }

Expression smooth_union(const Expression& a, const Expression& b, const Expression& k) {
    require_positive(k);
    return (a + b - sqrt(pow(a - b, 2.0) + pow(k, 2.0))) / 2.0;
}
Expression smooth_intersection(const Expression& a, const Expression& b, const Expression& k) {
    require_positive(k);
    return (a + b + sqrt(pow(a - b, 2.0) + pow(k, 2.0))) / 2.0;
}
Expression smooth_difference(const Expression& a, const Expression& b, const Expression& k) {
    return smooth_intersection(a, -b, k);
}

}  // namespace certa
