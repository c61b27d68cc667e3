#pragma once
// Intervals of doubles whose operations enclose every real result, in round-to-nearest arithmetic.
//
// Laws (tests/interval restates them against 200-bit MPFR):
// 1. For real numbers x in a, y in b at which the operation is defined: x op y lies in `a op b`, also when bounds
//    overflow, underflow or are infinite.
// 2. Where an operation is not defined for some x in a (division by 0, log of 0, ...), or cannot be shown to be, the
//    result is undefined(): a NaN in a bound. Undefined operands give undefined results. Every question below answers
//    "not proved" for undefined intervals, so a NaN can never certify anything.
// 3. Inclusion: a within b implies `op a` within `op b` for + - * / sqr and sqrt (isotone); the other functions keep
// law 1.
//
// How: the rounding mode is never touched (compilers move code across mode changes, see ARCHITECTURE.md, Numerics).
// Each bound is computed to nearest and then moved outward by at least one unit in the last place with arithmetic only:
// step(x) = phi |x| + eta with phi = 2^-53 (1 + 2^-52), eta = 2^-1074 gives fl(x + step) >= successor of x for every
// finite x (Rump, Zimmermann, Boldo, Melquiond, "Computing predecessor and successor in rounding to nearest", 2009,
// Theorem 2.2), and a rounding to nearest is off by at most half a unit. This needs round to nearest and denormals:
// is_environment_sound() (environment.h) is asked before anything is promised.
#include <cmath>
#include <limits>

namespace certa::interval {

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double largest = std::numeric_limits<double>::max();

namespace detail {
constexpr double absolute(double x) { return x < 0 ? -x : x; }
constexpr double step(double x) { return 0x1.0000000000001p-53 * absolute(x) + 0x1p-1074; }
constexpr double least(double a, double b) { return a < b ? a : b; }
constexpr double greatest(double a, double b) { return a > b ? a : b; }
constexpr bool is_finite(double x) { return absolute(x) <= largest; }
}  // namespace detail

/// At least the next double above x (for finite x); at most two doubles above.
constexpr double above(double x) { return x + detail::step(x); }
/// At most the next double below x (for finite x); at least two doubles below.
constexpr double below(double x) { return x - detail::step(x); }

/// All reals from lo to hi, bounds included where finite.
struct Interval {
    double lo = 0.0;
    double hi = 0.0;
    constexpr Interval() = default;
    constexpr Interval(double point) : lo(point), hi(point) {}  // NOLINT: a double is an interval
    constexpr Interval(double low, double high) : lo(low), hi(high) {}
};

constexpr Interval undefined() {
    return {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
}
constexpr Interval entire() { return {-infinity, infinity}; }

/// Whether the operations that led here are proved to be defined.
constexpr bool is_defined(const Interval& a) { return a.lo <= a.hi; }
constexpr bool is_bounded(const Interval& a) { return detail::is_finite(a.lo) && detail::is_finite(a.hi); }
/// +1 or -1 when every member is proved to have that sign, else 0.
constexpr int sign_of(const Interval& a) { return is_defined(a) ? (a.lo > 0 ? 1 : a.hi < 0 ? -1 : 0) : 0; }
constexpr bool contains(const Interval& a, double x) { return a.lo <= x && x <= a.hi; }
constexpr bool contains(const Interval& outer, const Interval& inner) {
    return outer.lo <= inner.lo && inner.hi <= outer.hi;
}
/// A double inside, near the middle; 0 where nothing better is known.
constexpr double middle(const Interval& a) {
    if (!is_bounded(a)) return 0.0;
    const double m = 0.5 * a.lo + 0.5 * a.hi;
    return m < a.lo ? a.lo : m > a.hi ? a.hi : m;
}
/// An upper bound of the width.
constexpr double width(const Interval& a) { return above(a.hi - a.lo); }
/// The smallest interval around both.
constexpr Interval hull(const Interval& a, const Interval& b) {
    if (!is_defined(a) || !is_defined(b)) return undefined();
    return {detail::least(a.lo, b.lo), detail::greatest(a.hi, b.hi)};
}
/// What two enclosures of the same numbers have in common. An undefined operand is left aside: the other still
/// encloses. Operands that contradict each other give undefined(): nothing may be concluded from a contradiction.
constexpr Interval intersect(const Interval& a, const Interval& b) {
    if (!is_defined(a)) return b;
    if (!is_defined(b)) return a;
    const Interval both{detail::greatest(a.lo, b.lo), detail::least(a.hi, b.hi)};
    return is_defined(both) ? both : undefined();
}

constexpr Interval operator-(const Interval& a) { return {-a.hi, -a.lo}; }
namespace detail {
constexpr Interval outward(double low, double high) {
    // A bound that overflowed to the wrong side of infinity stands for a number beyond the largest double.
    if (low == infinity) low = largest;
    if (high == -infinity) high = -largest;
    return {low == -infinity ? low : below(low), high == infinity ? high : above(high)};
}
/// The sum of bounds, moved outward; infinite and undefined bounds are told by one test. A sum of doubles that is 0 is
/// exact, so that sums of squares stay at least 0.
constexpr Interval sum_outward(double low, double high) {
    if (!is_finite(low - high)) return outward(low, high);
    return {low == 0 ? low : below(low), high == 0 ? high : above(high)};
}
constexpr double product_bound(double a, double b) { return a == 0 || b == 0 ? 0.0 : a * b; }
/// Infinite bounds or undefined operands.
constexpr Interval product_at_infinity(const Interval& a, const Interval& b) {
    if (!is_defined(a) || !is_defined(b)) return undefined();
    const double p = product_bound(a.lo, b.lo), q = product_bound(a.lo, b.hi);
    const double r = product_bound(a.hi, b.lo), s = product_bound(a.hi, b.hi);
    return outward(least(least(p, q), least(r, s)), greatest(greatest(p, q), greatest(r, s)));
}
}  // namespace detail

constexpr Interval operator+(const Interval& a, const Interval& b) {
    return detail::sum_outward(a.lo + b.lo, a.hi + b.hi);
}
constexpr Interval operator-(const Interval& a, const Interval& b) {
    return detail::sum_outward(a.lo - b.hi, a.hi - b.lo);
}

constexpr Interval operator*(const Interval& a, const Interval& b) {
    const double p = a.lo * b.lo, q = a.lo * b.hi, r = a.hi * b.lo, s = a.hi * b.hi;
    // One test for four: a NaN or an infinity among them makes the sum NaN or infinite.
    if (!detail::is_finite((p + q) + (r + s))) return detail::product_at_infinity(a, b);
    const double low = below(detail::least(detail::least(p, q), detail::least(r, s)));
    return {low < 0 && a.lo >= 0 && b.lo >= 0 ? 0.0 : low,
            above(detail::greatest(detail::greatest(p, q), detail::greatest(r, s)))};
}

constexpr Interval operator/(const Interval& a, const Interval& b) {
    if (sign_of(b) == 0 || !is_defined(a)) return undefined();
    const double p = a.lo / b.lo, q = a.lo / b.hi, r = a.hi / b.lo, s = a.hi / b.hi;
    if (!detail::is_finite((p + q) + (r + s))) return entire();
    return {below(detail::least(detail::least(p, q), detail::least(r, s))),
            above(detail::greatest(detail::greatest(p, q), detail::greatest(r, s)))};
}

constexpr Interval& operator+=(Interval& a, const Interval& b) { return a = a + b; }

constexpr Interval sqr(const Interval& a) {
    if (!is_defined(a)) return undefined();
    const double p = a.lo * a.lo, q = a.hi * a.hi;
    const double low = a.lo > 0 ? p : a.hi < 0 ? q : 0.0;
    const Interval result = detail::outward(low, detail::greatest(p, q));
    return {detail::greatest(result.lo, 0.0), result.hi};
}

inline Interval sqrt(const Interval& a) {
    if (!(a.lo >= 0) || !is_defined(a)) return undefined();
    const Interval result = detail::outward(std::sqrt(a.lo), std::sqrt(a.hi));
    return {detail::greatest(result.lo, 0.0), result.hi};
}

/// a^n; n < 0 is undefined where a contains 0.
Interval power(const Interval& a, int n);
/// a^e for a > 0; undefined where a is not proved positive.
Interval power(const Interval& a, const Interval& e);

/// Not isotone, within a few units in the last place of the range on finite arguments; any argument up to 2^20 for sin,
/// cos and tan (beyond: [-1, 1], [-1, 1] and undefined).
Interval exp(const Interval& a);
Interval log(const Interval& a);
Interval sin(const Interval& a);
Interval cos(const Interval& a);
Interval tan(const Interval& a);
Interval atan(const Interval& a);
Interval sinh(const Interval& a);
Interval cosh(const Interval& a);
Interval tanh(const Interval& a);

/// Enclosures of constants, one unit wide.
inline constexpr Interval pi{0x1.921fb54442d18p1, 0x1.921fb54442d19p1};

}  // namespace certa::interval
