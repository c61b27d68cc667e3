#pragma once
// Intervals of doubles for the checker, apart from src/interval: each bound is computed with rounding to nearest and
// moved outward.
#include <algorithm>
#include <cmath>

namespace certa::verify {

/// A closed interval of doubles. One with a bound that is infinite or NaN is of no use: no sign is ever read off it,
/// and what is computed from it is of no use either.
struct Span {
    double low = 0, high = 0;
};

inline bool is_usable(const Span& a) { return std::isfinite(a.low) && std::isfinite(a.high); }
inline int sign_of(const Span& a) { return !is_usable(a) ? 0 : a.low > 0 ? 1 : a.high < 0 ? -1 : 0; }

/// A result r that is finite differs from the exact one by at most |r| 2^-53 + 2^-1022, even where tiny numbers are
/// flushed to 0; |r| 2^-51 + 2^-1000, subtracted with one more rounding, is more.
inline Span widened(double low, double high) {
    return {low - (std::fabs(low) * 0x1p-51 + 0x1p-1000), high + (std::fabs(high) * 0x1p-51 + 0x1p-1000)};
}
/// Around the results at the ends of two operands. Not minmax of a list: what is not finite has to reach the result.
inline Span around(double p, double q, double r, double s) {
    if (!std::isfinite(p + q + r + s)) return {NAN, NAN};
    return widened(std::min(std::min(p, q), std::min(r, s)), std::max(std::max(p, q), std::max(r, s)));
}

inline Span operator+(const Span& a, const Span& b) { return widened(a.low + b.low, a.high + b.high); }
inline Span operator-(const Span& a, const Span& b) { return widened(a.low - b.high, a.high - b.low); }
inline Span operator-(const Span& a) { return {-a.high, -a.low}; }
inline Span operator*(const Span& a, const Span& b) {
    return around(a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high);
}
/// Of no use where b has a zero.
inline Span operator/(const Span& a, const Span& b) {
    if (sign_of(b) == 0) return {NAN, NAN};
    return around(a.low / b.low, a.low / b.high, a.high / b.low, a.high / b.high);
}
inline Span square(const Span& a) {
    const double p = a.low * a.low, q = a.high * a.high;
    const Span wide = around(p, p, q, q);
    return {a.low <= 0 && a.high >= 0 ? 0.0 : std::max(wide.low, 0.0), wide.high};
}
/// a^n for n >= 1, by squaring: powers of even exponents are squares.
inline Span raised(const Span& a, long n) {
    if (n == 1) return a;
    const Span half = raised(a, n / 2);
    return n % 2 == 0 ? square(half) : square(half) * a;
}
/// Of no use where a has a negative number.
inline Span root(const Span& a) {
    const Span wide = widened(std::sqrt(a.low), std::sqrt(a.high));
    return a.low >= 0 ? Span{std::max(0.0, wide.low), wide.high} : Span{NAN, NAN};
}

}  // namespace certa::verify
