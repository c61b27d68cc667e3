// sin, cos, tan and atan on intervals, by Taylor series at the ends (see elementary.cpp for the principle).
//
// Reduction: x = k pi/2 + r with pi/2 = first + second + third; `first` and `second` have 33 bits each, so their
// products with |k| < 2^20 are exact, and what is left of pi/2 is an interval (digits of
// pi: 3.243f6a8885a308d313198a2e03707344...). Beyond |x| = 2^20 nothing is claimed but the range of the functions.
// Between the ends: sin has its maxima 1 at pi/2 + 2 pi m and minima -1 at -pi/2 + 2 pi m, cos at 2 pi m and pi + 2 pi
// m, tan its poles at pi/2 + pi m. Whether an interval meets one of these is decided on an enclosure of (x - place) /
// period: it does unless no integer lies in it.
#include <cmath>

#include "interval/interval.h"
#include "interval/series.h"

namespace certa::interval {
namespace {

constexpr double half_pi_first = 0x1.921fb544p0;
constexpr double half_pi_second = 0x1.0b4611a6p-34;
constexpr Interval half_pi_third{0x1.3198a2e037073p-69, 0x1.3198a2e037074p-69};
constexpr Interval half_pi{0x1.921fb54442d18p0, 0x1.921fb54442d19p0};
constexpr double reducible = 0x1p20;

}  // namespace

/// Used for |r| <= 0.8: r^17 is the last term, the rest is at most |r|^19 / 19! (Lagrange).
Interval sin_series(const Interval& r) {
    const Interval t = -sqr(r);
    Interval sum = inverse_factorial(17);
    for (int i = 15; i >= 1; i -= 2) sum = sum * t + inverse_factorial(i);
    return r * sum + remainder_of_series(r, 19, 1.0);
}

/// Used for |r| <= 0.8: r^18 is the last term, the rest is at most |r|^20 / 20!.
Interval cos_series(const Interval& r) {
    const Interval t = -sqr(r);
    Interval sum = inverse_factorial(18);
    for (int i = 16; i >= 0; i -= 2) sum = sum * t + inverse_factorial(i);
    return sum + remainder_of_series(r, 20, 1.0);
}

/// Cut after u^23, the rest is at most |u|^25 / 25 (alternating).
Interval atan_series(const Interval& u) {
    const Interval t = -sqr(u);
    Interval sum = Interval(1.0) / Interval(23.0);
    for (int i = 21; i >= 1; i -= 2) sum = sum * t + Interval(1.0) / Interval(i);
    // Divided by u, the rest is at most u^24 / 25, of either sign.
    const double rest = above(0.04001 * power(t, 12).hi);
    return u * (sum + Interval(-rest, rest));
}

namespace {

struct SineCosine {
    Interval sine, cosine;
};

/// Both at a double of size at most 2^20.
SineCosine sine_cosine_at(double x) {
    const double k = std::nearbyint(x * 0x1.45f306dc9c883p-1);
    const Interval r =
        ((Interval(x) - Interval(k * half_pi_first)) - Interval(k * half_pi_second)) - Interval(k) * half_pi_third;
    const Interval exact_r = k == 0 ? Interval(x) : r;
    const Interval s = sin_series(exact_r), c = cos_series(exact_r);
    switch (static_cast<long>(k) & 3) {
        case 0:
            return {s, c};
        case 1:
            return {c, -s};
        case 2:
            return {-s, -c};
        default:
            return {-c, s};
    }
}

/// Whether a may contain place + m * period for some integer m.
bool may_meet(const Interval& a, const Interval& place, const Interval& period) {
    const Interval turns = (a - place) / period;
    return !(std::floor(turns.hi) < std::ceil(turns.lo));
}

bool is_reducible(const Interval& a) { return a.lo >= -reducible && a.hi <= reducible; }

Interval wave(const Interval& a, const Interval& first, const Interval& last, const Interval& top,
              const Interval& bottom) {
    const Interval ends = hull(first, last), turn = Interval(2.0) * pi;
    const double low = may_meet(a, bottom, turn) ? -1.0 : detail::greatest(ends.lo, -1.0);
    const double high = may_meet(a, top, turn) ? 1.0 : detail::least(ends.hi, 1.0);
    return {low, high};
}

/// atan at |x| <= 1: halved twice by atan x = 2 atan(x / (1 + sqrt(1 + x^2))), then |u| < 0.2.
Interval atan_at_most_1(const Interval& x) {
    Interval u = x;
    for (int i = 0; i < 2; ++i) u = u / (Interval(1.0) + sqrt(Interval(1.0) + sqr(u)));
    return Interval(4.0) * atan_series(u);
}

Interval atan_at(double x) {
    if (std::fabs(x) <= 1) return atan_at_most_1(Interval(x));
    const Interval rest = atan_at_most_1(Interval(1.0) / Interval(std::fabs(x)));
    const Interval value = half_pi - rest;
    return x < 0 ? -value : value;
}

}  // namespace

Interval sin(const Interval& a) {
    if (!is_defined(a)) return undefined();
    if (!is_reducible(a)) return {-1.0, 1.0};
    return wave(a, sine_cosine_at(a.lo).sine, sine_cosine_at(a.hi).sine, half_pi, -half_pi);
}

Interval cos(const Interval& a) {
    if (!is_defined(a)) return undefined();
    if (!is_reducible(a)) return {-1.0, 1.0};
    return wave(a, sine_cosine_at(a.lo).cosine, sine_cosine_at(a.hi).cosine, Interval(0.0), pi);
}

Interval tan(const Interval& a) {
    if (!is_defined(a) || !is_reducible(a) || may_meet(a, half_pi, pi)) return undefined();
    const SineCosine first = sine_cosine_at(a.lo), last = sine_cosine_at(a.hi);
    const Interval low = first.sine / first.cosine, high = last.sine / last.cosine;
    if (!is_defined(low) || !is_defined(high)) return undefined();
    return {low.lo, high.hi};
}

Interval atan(const Interval& a) {
    if (!is_defined(a)) return undefined();
    return {a.lo == -infinity ? -half_pi.hi : atan_at(a.lo).lo, a.hi == infinity ? half_pi.hi : atan_at(a.hi).hi};
}

}  // namespace certa::interval
