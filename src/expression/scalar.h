#pragma once
// The functions of expressions for doubles and for intervals: one name for both kinds of number.
#include <cmath>
#include <limits>

#include "expression/node.h"
#include "interval/interval.h"

namespace certa::expression {

inline double sqr(double a) { return a * a; }
inline double power(double a, int n) {
    double result = 1.0;
    double square = a;
    for (unsigned k = n < 0 ? 0u - static_cast<unsigned>(n) : static_cast<unsigned>(n); k != 0; k >>= 1) {
        if (k & 1u) result *= square;
        square *= square;
    }
    return n < 0 ? 1.0 / result : result;
}
inline double power(double a, double e) { return a > 0 ? std::pow(a, e) : std::numeric_limits<double>::quiet_NaN(); }
using interval::power;
using interval::sqr;

/// `a op b` (unary operations ignore b), exponent for Op::power.
template <class Number>
Number apply(Op op, const Number& a, const Number& b, int exponent) {
    using interval::atan, interval::cos, interval::cosh, interval::exp, interval::log, interval::sin, interval::sinh,
        interval::sqrt, interval::tan, interval::tanh;
    using std::atan, std::cos, std::cosh, std::exp, std::log, std::sin, std::sinh, std::sqrt, std::tan, std::tanh;
    switch (op) {
        case Op::negate:
            return -a;
        case Op::add:
            return a + b;
        case Op::subtract:
            return a - b;
        case Op::multiply:
            return a * b;
        case Op::divide:
            return a / b;
        case Op::power:
            return power(a, exponent);
        case Op::real_power:
            return power(a, b);
        case Op::square_root:
            return sqrt(a);
        case Op::exp:
            return exp(a);
        case Op::log:
            return log(a);
        case Op::sin:
            return sin(a);
        case Op::cos:
            return cos(a);
        case Op::tan:
            return tan(a);
        case Op::atan:
            return atan(a);
        case Op::sinh:
            return sinh(a);
        case Op::cosh:
            return cosh(a);
        case Op::tanh:
            return tanh(a);
        default:
            return std::numeric_limits<double>::quiet_NaN();
    }
}

}  // namespace certa::expression
