// Powers, exp, log and the hyperbolic functions on intervals. No function of the C library is called but sqrt, frexp
// and ldexp, which IEEE 754 and the C standard make exact or correctly rounded: each kernel below evaluates a Taylor
// series of the function at one double in interval arithmetic and adds its remainder, so its enclosure is proved by
// construction. The functions are monotone (or even): the values at the ends of an interval enclose all in between.
//
// Plan: series with their rests; exp; log; hyperbolic functions; powers.
#include <array>
#include <cmath>

#include "interval/interval.h"
#include "interval/series.h"

namespace certa::interval {
namespace {

// ln 2 = high + low: `high` has 32 bits, so its product with any |k| < 2^21 is exact; digits
// 0.b17217f7d1cf79abc9e3b398...
constexpr double ln2_high = 0x1.62e42feep-1;
constexpr Interval ln2_low{0x1.a39ef35793c76p-33, 0x1.a39ef35793c77p-33};

/// value * 2^k, bounds outward where that is not exact.
Interval scale(const Interval& value, int k) {
    const double low = std::ldexp(value.lo, k), high = std::ldexp(value.hi, k);
    const bool exact = std::ldexp(low, -k) == value.lo && std::ldexp(high, -k) == value.hi;
    return exact ? Interval{low, high} : detail::outward(low, high);
}

}  // namespace

/// Cut after r^13, the rest is at most |r|^14 / 14! * (1 + |r|/15 + ...) <= |r|^14 / 14! * 1.25.
Interval exp_series(const Interval& r) {
    return horner(r, exponential_coefficients(), 13) + remainder_of_series(r, 14, 1.25);
}

/// Terms 2 s^(2i+1) / (2i+1), i <= 10; the rest is at most |s|^23 * 2/23 / (1 - s^2).
Interval twice_atanh_series(const Interval& s) {
    const Interval t = sqr(s);
    Interval sum = Interval(2.0) / Interval(21.0);
    for (int i = 9; i >= 0; --i) sum = sum * t + Interval(2.0) / Interval(2.0 * i + 1.0);
    // The rest, divided by s: 2/23 t^11 / (1 - t), below 0.116 t^11.
    const double rest = above(0.116 * power(t, 11).hi);
    return s * (sum + Interval(0.0, rest));
}

/// Cut after x^15, the rest is at most |x|^17 / 17! * (1 + x^2 / (18 19) + ...) <= |x|^17 / 17! * 1.25.
Interval sinh_series(double x) {
    const Interval t = sqr(Interval(x));
    Interval sum = inverse_factorial(15);
    for (int i = 13; i >= 1; i -= 2) sum = sum * t + inverse_factorial(i);
    const Interval rest = remainder_of_series(Interval(x), 16, 1.25 / 17);  // divided by x
    return Interval(x) * (sum + rest);
}

namespace {

/// exp at a finite double. x = k ln 2 + r with |r| <= 0.35.
Interval exp_at(double x) {
    if (x > 709.8) return {largest, infinity};  // exp(709.8) > 2^1024
    if (x < -745.2) return {0.0, 0x1p-1074};    // exp(-745.2) < 2^-1075
    const double k = std::nearbyint(x * 0x1.71547652b82fep0);
    const Interval r = k == 0 ? Interval(x) : (Interval(x) - Interval(k * ln2_high)) - Interval(k) * ln2_low;
    return scale(exp_series(r), static_cast<int>(k));
}

/// log at a positive finite double: x = m 2^k with m in [sqrt(1/2), sqrt 2], log m = 2 atanh((m - 1) / (m + 1)), at
/// most at 0.172.
Interval log_at(double x) {
    int k = 0;
    double m = std::frexp(x, &k);
    if (m < 0x1.6a09e667f3bcdp-1) {
        m *= 2;
        --k;
    }
    const Interval s = Interval(m - 1.0) / (Interval(m) + Interval(1.0));  // m - 1 is exact (Sterbenz)
    const Interval log_m = twice_atanh_series(s);
    if (k == 0) return log_m;
    return Interval(k * ln2_high) + (Interval(k) * ln2_low + log_m);
}

Interval sinh_at(double x) {
    if (std::fabs(x) <= 0.5) return sinh_series(x);
    const Interval e = exp_at(std::fabs(x));
    const Interval value = Interval(0.5) * (e - Interval(1.0) / e);
    return x < 0 ? -value : value;
}

Interval cosh_at(double x) {
    const Interval e = exp_at(std::fabs(x));
    const Interval value = Interval(0.5) * (e + Interval(1.0) / e);
    return {detail::greatest(value.lo, 1.0), value.hi};
}

Interval tanh_at(double x) {
    Interval value;
    if (std::fabs(x) <= 0.5) {
        value = sinh_series(x) / cosh_at(x);
    } else if (std::fabs(x) > 40) {
        value = {1 - 0x1p-53, 1.0};  // 1 - tanh 40 < 4e-35
    } else {
        value = Interval(1.0) - Interval(2.0) / (sqr(exp_at(std::fabs(x))) + Interval(1.0));
    }
    if (std::fabs(x) > 0.5 && x < 0) value = -value;
    return {detail::greatest(value.lo, -1.0), detail::least(value.hi, 1.0)};
}

/// The function at the ends of a defined interval, for a function that increases; infinite ends have given values.
template <class Function>
Interval increasing(const Interval& a, Function at, double at_minus_infinity, double at_infinity) {
    if (!is_defined(a)) return undefined();
    const double low = a.lo == -infinity ? at_minus_infinity : a.lo == infinity ? at(largest).lo : at(a.lo).lo;
    const double high = a.hi == infinity ? at_infinity : a.hi == -infinity ? at(-largest).hi : at(a.hi).hi;
    return {low, high};
}

Interval power_of_point(double x, unsigned n) {
    Interval result(1.0), square(x);
    for (; n != 0; n >>= 1) {
        if (n & 1u) result = result * square;
        if (n > 1) square = sqr(square);
    }
    return result;
}

}  // namespace

Interval exp(const Interval& a) {
    const Interval value = increasing(a, exp_at, 0.0, infinity);
    return is_defined(value) ? Interval{detail::greatest(value.lo, 0.0), value.hi} : undefined();
}

Interval log(const Interval& a) {
    if (!(a.lo > 0)) return undefined();
    return increasing(a, log_at, -infinity, infinity);
}

Interval sinh(const Interval& a) { return increasing(a, sinh_at, -infinity, infinity); }
Interval tanh(const Interval& a) { return increasing(a, tanh_at, -1.0, 1.0); }

Interval cosh(const Interval& a) {
    if (!is_defined(a)) return undefined();
    const double far = detail::greatest(std::fabs(a.lo), std::fabs(a.hi));
    const double near = a.lo > 0 ? a.lo : a.hi < 0 ? -a.hi : 0.0;
    return {near == infinity ? largest : cosh_at(near).lo, far == infinity ? infinity : cosh_at(far).hi};
}

Interval power(const Interval& a, int n) {
    if (!is_defined(a)) return undefined();
    if (n == 0) return 1.0;
    if (n == 1) return a;
    if (n == 2) return sqr(a);
    if (n < 0) return n == std::numeric_limits<int>::min() ? undefined() : Interval(1.0) / power(a, -n);
    const auto exponent = static_cast<unsigned>(n);
    if (n % 2 != 0) return {power_of_point(a.lo, exponent).lo, power_of_point(a.hi, exponent).hi};
    const double far = detail::greatest(detail::absolute(a.lo), detail::absolute(a.hi));
    const double near = a.lo > 0 ? a.lo : a.hi < 0 ? -a.hi : 0.0;
    return {detail::greatest(power_of_point(near, exponent).lo, 0.0), power_of_point(far, exponent).hi};
}

Interval power(const Interval& a, const Interval& e) { return exp(e * log(a)); }

}  // namespace certa::interval
