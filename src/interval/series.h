#pragma once
// Power series in interval arithmetic: coefficients, Horner's rule, remainders. Private to the room.
#include <array>

#include "interval/interval.h"

namespace certa::interval {

inline constexpr int last_factorial = 22;  // 22! < 2^53 * 2^19: exact in a double, its odd part has 51 bits

namespace detail {
constexpr std::array<Interval, last_factorial + 1> make_inverse_factorials() {
    std::array<Interval, last_factorial + 1> table{};
    double factorial = 1.0;
    for (int n = 0; n <= last_factorial; ++n) {
        if (n > 1) factorial *= n;
        table[n] = n < 2 ? Interval(1.0) : Interval(1.0) / Interval(factorial);
    }
    return table;
}
inline constexpr auto inverse_factorials = make_inverse_factorials();
}  // namespace detail

/// 1 / n! for n <= 22.
constexpr const Interval& inverse_factorial(int n) { return detail::inverse_factorials[n]; }
constexpr const std::array<Interval, last_factorial + 1>& exponential_coefficients() {
    return detail::inverse_factorials;
}

/// c[0] + c[1] r + ... + c[degree] r^degree.
template <class Coefficients>
constexpr Interval horner(const Interval& r, const Coefficients& c, int degree) {
    Interval sum = c[degree];
    for (int i = degree - 1; i >= 0; --i) sum = sum * r + c[i];
    return sum;
}

/// [-b, b] with b >= factor * |r|^n / n!, the rest of a Taylor series after the terms below degree n.
inline Interval remainder_of_series(const Interval& r, int n, double factor) {
    const double size = detail::greatest(detail::absolute(r.lo), detail::absolute(r.hi));
    Interval bound = inverse_factorial(n) * Interval(factor);
    const Interval square = sqr(Interval(size));
    for (int i = 0; i < n / 2; ++i) bound = bound * square;
    if (n % 2 != 0) bound = bound * Interval(size);
    return {-bound.hi, bound.hi};
}

// The series that the functions are computed with, rests included. Each encloses its function as far as is said, which
// is further out than it is used: where they are used their rests are below the outward steps, and no test could tell
// whether they are there.

/// exp r for |r| <= 3.
Interval exp_series(const Interval& r);
/// sinh x at |x| <= 8.
Interval sinh_series(double x);
/// 2 atanh s for |s| <= 1/2.
Interval twice_atanh_series(const Interval& s);
/// sin r, cos r for any r.
Interval sin_series(const Interval& r);
Interval cos_series(const Interval& r);
/// atan u for |u| <= 1.
Interval atan_series(const Interval& u);

}  // namespace certa::interval
