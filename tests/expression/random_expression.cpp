// A pool of expressions grows by operations on members drawn from it; the last one drawn is returned.
#include "expression/random_expression.h"

#include <algorithm>
#include <vector>

#include "expression/node.h"

namespace certa::test {
namespace {

Expression random_constant(core::Random& random) {
    switch (random.below(4)) {
        case 0:
            return static_cast<double>(random.below(7)) - 3.0;
        case 1:
            return parse_expression(std::to_string(random.below(1000)) + "e-2");
        case 2:
            return random.uniform(-2, 2);
        default:
            return Expression::pi();
    }
}

Expression combine(core::Random& random, const Expression& a, const Expression& b) {
    switch (random.below(22)) {
        case 0:
        case 1:
            return a + b;
        case 2:
        case 3:
            return a - b;
        case 4:
        case 5:
            return a * b;
        case 6:
            return a / (1.5 + b * b);
        case 7:
            return -a;
        case 8:
            return pow(a, 2.0);
        case 9:
            return pow(a, 3.0);
        case 10:
            return sqrt(0.5 + a * a);
        case 11:
            return exp(sin(a));
        case 12:
            return log(1.25 + a * a);
        case 13:
            return sin(a);
        case 14:
            return cos(a);
        case 15:
            return atan(a);
        case 16:
            return tanh(a);
        case 17:
            return tan(0.5 * atan(a));
        case 18:
            return sinh(sin(a));
        case 19:
            return cosh(cos(a)) - b;
        case 20:
            return pow(0.25 + b * b, parse_expression("1.7")) * a;
        default:
            return smooth_union(a, b, 0.5);
    }
}

}  // namespace

Expression random_expression(core::Random& random, int size) {
    std::vector<Expression> pool{Expression::x(), Expression::y(), Expression::z(), random_constant(random)};
    for (int i = 0; i < size; ++i) {
        // Late members are drawn more often, so that the tree grows deep and shares.
        const auto draw = [&] { return pool[pool.size() - 1 - random.below(std::min<std::size_t>(pool.size(), 6))]; };
        pool.push_back(combine(random, draw(), draw()));
        if (random.coin(0.2)) pool.push_back(random_constant(random));
        if (random.coin(0.2)) pool.push_back(Expression::y() * Expression::z() - Expression::x());
    }
    return pool.back().node()->op == expression::Op::constant ? pool.back() + Expression::x() : pool.back();
}

}  // namespace certa::test
