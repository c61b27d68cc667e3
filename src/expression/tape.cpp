// From the tree to the tape. Nodes are visited operands first; each becomes an instruction by way of rules that keep
// its value and its domain, and instructions that exist already are found by a hash table (hash-consing), so that
// common parts of the function are computed once even where the tree repeats them. Instructions that simplification
// left unused are dropped at the end.
//
// Why x x becomes x^2: the enclosure of a square knows that both factors are equal. Why x 0 stays unless x is a total
// function: log(x) 0 is undefined for x <= 0.
#include "expression/tape.h"

#include <array>
#include <cstdlib>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "expression/scalar.h"

namespace certa::expression {
namespace {

std::size_t mix(std::size_t seed, std::uint64_t value) {
    seed ^= value + 0x9e3779b97f4a7c15ull + (seed << 6) + (seed >> 2);
    return seed * 0xff51afd7ed558ccdull;
}

}  // namespace

class TapeBuilder {
public:
    explicit TapeBuilder(const Expression& function) {
        std::unordered_map<const Node*, std::uint32_t> places;
        for (const Node* node : in_order(function.node())) {
            const std::uint32_t a = node->first ? places.at(node->first.get()) : 0;
            const std::uint32_t b = node->second ? places.at(node->second.get()) : 0;
            places.emplace(node, translate(*node, a, b));
        }
        root_ = places.at(function.node().get());
    }

    /// The instructions that the root needs, in order.
    std::vector<Instruction> finish() const {
        std::vector<char> needed(steps_.size(), 0);
        needed[root_] = 1;
        for (std::size_t i = steps_.size(); i-- > 0;) {
            if (!needed[i]) continue;
            const int operands = operand_count(steps_[i].instruction.op);
            if (operands >= 1) needed[steps_[i].instruction.first] = 1;
            if (operands == 2) needed[steps_[i].instruction.second] = 1;
        }
        std::vector<std::uint32_t> places(steps_.size());
        std::vector<Instruction> result;
        for (std::size_t i = 0; i < steps_.size(); ++i) {
            if (!needed[i]) continue;
            Instruction instruction = steps_[i].instruction;
            const int operands = operand_count(instruction.op);
            if (operands >= 1) instruction.first = places[instruction.first];
            if (operands == 2) instruction.second = places[instruction.second];
            places[i] = static_cast<std::uint32_t>(result.size());
            result.push_back(instruction);
        }
        return result;
    }

private:
    struct Step {
        Instruction instruction;
        Constant constant;
        bool exact = false;  ///< `constant` is the value
        bool total = false;  ///< defined for all x, y, z
    };

    bool is_constant(std::uint32_t i, std::int64_t value) const {
        return steps_[i].exact && steps_[i].constant.is(value);
    }
    Op op(std::uint32_t i) const { return steps_[i].instruction.op; }

    std::uint32_t exact_constant(const Constant& value) {
        Step step;
        step.instruction.enclosure = enclosure(value);
        step.instruction.nearest = nearest(value);
        step.constant = value;
        step.exact = step.total = true;
        return intern(step);
    }

    std::uint32_t translate(const Node& node, std::uint32_t a, std::uint32_t b) {
        switch (node.op) {
            case Op::constant:
                return exact_constant(node.constant);
            case Op::pi: {
                Step step;
                step.instruction.enclosure = interval::pi;
                step.instruction.nearest = interval::pi.lo;  // the nearest double to pi
                step.total = true;
                return intern(step);
            }
            case Op::x:
            case Op::y:
            case Op::z: {
                Step step;
                step.instruction.op = node.op;
                step.instruction.gradient =
                    static_cast<std::uint8_t>(1u << (static_cast<int>(node.op) - static_cast<int>(Op::x)));
                step.total = true;
                return intern(step);
            }
            case Op::negate:
                return negate(a);
            case Op::add:
                return add(a, b);
            case Op::subtract:
                return subtract(a, b);
            case Op::multiply:
                return multiply(a, b);
            case Op::divide:
                return divide(a, b);
            case Op::power:
                return raise(a, node.exponent);
            default:
                return emit(node.op, a, b, 0);
        }
    }

    std::uint32_t negate(std::uint32_t a) {
        if (op(a) == Op::negate) return steps_[a].instruction.first;
        if (op(a) == Op::subtract) return subtract(steps_[a].instruction.second, steps_[a].instruction.first);
        if (steps_[a].exact) return exact_constant(negated(steps_[a].constant));
        return emit(Op::negate, a, 0, 0);
    }

    std::uint32_t add(std::uint32_t a, std::uint32_t b) {
        if (is_constant(a, 0)) return b;
        if (is_constant(b, 0)) return a;
        if (steps_[a].exact && steps_[b].exact) {
            if (const auto value = sum(steps_[a].constant, steps_[b].constant)) return exact_constant(*value);
        }
        if (op(b) == Op::negate) return subtract(a, steps_[b].instruction.first);
        if (op(a) == Op::negate) return subtract(b, steps_[a].instruction.first);
        if (a == b) return multiply(exact_constant({2, 1, {}}), a);
        return emit(Op::add, std::min(a, b), std::max(a, b), 0);
    }

    std::uint32_t subtract(std::uint32_t a, std::uint32_t b) {
        if (is_constant(b, 0)) return a;
        if (is_constant(a, 0)) return negate(b);
        if (a == b && steps_[a].total) return exact_constant({});
        if (steps_[b].exact) return add(a, exact_constant(negated(steps_[b].constant)));
        if (op(b) == Op::negate) return add(a, steps_[b].instruction.first);
        return emit(Op::subtract, a, b, 0);
    }

    /// Base and exponent of a power, where every operation is its own first power.
    std::pair<std::uint32_t, int> as_power(std::uint32_t a) const {
        if (op(a) == Op::power) return {steps_[a].instruction.first, steps_[a].instruction.exponent};
        return {a, 1};
    }

    std::uint32_t multiply(std::uint32_t a, std::uint32_t b) {
        if (is_constant(a, 1)) return b;
        if (is_constant(b, 1)) return a;
        if (is_constant(a, -1)) return negate(b);
        if (is_constant(b, -1)) return negate(a);
        if ((is_constant(a, 0) && steps_[b].total) || (is_constant(b, 0) && steps_[a].total)) return exact_constant({});
        if (steps_[a].exact && steps_[b].exact) {
            if (const auto value = product(steps_[a].constant, steps_[b].constant)) return exact_constant(*value);
        }
        const auto [base_a, n] = as_power(a);
        const auto [base_b, m] = as_power(b);
        if (base_a == base_b && n > 0 && m > 0 && n + m <= 1'000'000) return raise(base_a, n + m);
        return emit(Op::multiply, std::min(a, b), std::max(a, b), 0);
    }

    std::uint32_t divide(std::uint32_t a, std::uint32_t b) {
        if (is_constant(b, 1)) return a;
        if (steps_[b].exact && !is_constant(b, 0)) {
            if (const auto inverse = quotient({1, 1, {}}, steps_[b].constant))
                return multiply(a, exact_constant(*inverse));
        }
        return emit(Op::divide, a, b, 0);
    }

    std::uint32_t raise(std::uint32_t a, int n) {
        if (n == 1) return a;
        if (n == 0 && steps_[a].total) return exact_constant({1, 1, {}});
        if (steps_[a].exact) {
            if (const auto value = power(steps_[a].constant, n)) return exact_constant(*value);
        }
        if (op(a) == Op::power && n > 0 && steps_[a].instruction.exponent > 0 &&
            static_cast<std::int64_t>(n) * steps_[a].instruction.exponent <= 1'000'000)
            return raise(steps_[a].instruction.first, n * steps_[a].instruction.exponent);
        if (op(a) == Op::negate && n % 2 == 0) return raise(steps_[a].instruction.first, n);
        return emit(Op::power, a, 0, n);
    }

    static std::uint8_t outer_product(std::uint8_t a, std::uint8_t b) {
        unsigned mask = 0;
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 3; ++j) {
                if (((a >> i) & 1) && ((b >> j) & 1)) mask |= 1u << hessian_index[i][j];
            }
        }
        return static_cast<std::uint8_t>(mask);
    }

    bool is_total(Op operation, const Step& a, const Step& b, int exponent) const {
        if (!a.total || (operand_count(operation) == 2 && !b.total)) return false;
        switch (operation) {
            case Op::divide:
            case Op::real_power:
            case Op::square_root:
            case Op::log:
            case Op::tan:
                return false;
            case Op::power:
                return exponent >= 0;
            default:
                return true;
        }
    }

    std::uint32_t emit(Op operation, std::uint32_t a, std::uint32_t b, int exponent) {
        const Step& left = steps_[a];
        const Step& right = operand_count(operation) == 2 ? steps_[b] : left;
        Step step;
        Instruction& i = step.instruction;
        i.op = operation;
        i.first = a;
        i.second = b;
        i.exponent = exponent;
        i.gradient = left.instruction.gradient | right.instruction.gradient;
        i.hessian = left.instruction.hessian | right.instruction.hessian;
        if (operation == Op::multiply) {
            i.hessian |= outer_product(left.instruction.gradient, right.instruction.gradient);
        } else if (operation == Op::divide) {
            i.hessian |= outer_product(i.gradient, right.instruction.gradient);
        } else if (operation > Op::divide) {
            i.hessian |= outer_product(left.instruction.gradient, left.instruction.gradient);
        }
        step.total = is_total(operation, left, right, exponent);
        if (left.instruction.op == Op::constant && right.instruction.op == Op::constant) {
            // A number such as exp(2): computed now, in an enclosure.
            Step value;
            value.instruction.enclosure =
                apply(operation, left.instruction.enclosure, right.instruction.enclosure, exponent);
            value.instruction.nearest = apply(operation, left.instruction.nearest, right.instruction.nearest, exponent);
            value.total = interval::is_defined(value.instruction.enclosure);
            return intern(value);
        }
        return intern(step);
    }

    static bool equal(const Step& a, const Step& b) {
        const Instruction &i = a.instruction, &j = b.instruction;
        if (i.op != j.op) return false;
        if (i.op != Op::constant) return i.first == j.first && i.second == j.second && i.exponent == j.exponent;
        if (a.exact || b.exact) return a.exact == b.exact && a.constant == b.constant;
        return i.enclosure.lo == j.enclosure.lo && i.enclosure.hi == j.enclosure.hi && i.nearest == j.nearest;
    }

    static std::size_t hash(const Step& step) {
        const Instruction& i = step.instruction;
        std::size_t seed = mix(0, static_cast<std::uint64_t>(i.op));
        if (i.op != Op::constant) {
            seed = mix(seed, i.first);
            seed = mix(seed, i.second);
            return mix(seed, static_cast<std::uint64_t>(i.exponent));
        }
        seed = mix(seed, std::hash<double>()(i.nearest));
        return mix(seed, static_cast<std::uint64_t>(step.constant.numerator));
    }

    std::uint32_t intern(const Step& step) {
        auto [first, last] = index_.equal_range(hash(step));
        for (; first != last; ++first) {
            if (equal(steps_[first->second], step)) return first->second;
        }
        const auto place = static_cast<std::uint32_t>(steps_.size());
        steps_.push_back(step);
        index_.emplace(hash(step), place);
        return place;
    }

    std::vector<Step> steps_;
    std::unordered_multimap<std::size_t, std::uint32_t> index_;
    std::uint32_t root_ = 0;
};

Tape::Tape(const Expression& function) : instructions_(TapeBuilder(function).finish()) {}

}  // namespace certa::expression
