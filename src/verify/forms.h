#pragma once
// Polynomials whose sign answers a geometric question, and how their sign is decided without error.
//
// A form is written once, as a template over its number type, in terms of vectors that are differences of two points.
// decide() tries, in this order:
//   1. in doubles, next to the same expression over absolute values (Bounded), which gives a bound on the rounding;
//   2. in 128-bit integers, when all differences are exact doubles that fit a small common grid (grids, boxes, CAD);
//   3. in integers of a fixed size, after scaling all coordinates by one power of two, when they are large enough;
//   4. in GMP integers of any size. Always exact, for every finite double.
//
// The filter's bound. Let u = 2^-53. Barring overflow and underflow, a computed value is the sum of the monomials of
// the expression, each multiplied by at most k factors (1 + d), |d| <= u, where k counts the roundings that a monomial
// meets on its way to the root: 1 for a leaf (the subtraction), k(xy) = k(x) + k(y) + 1, k(x + y) = max(k(x), k(y))
// + 1. So |computed - exact| <= g M with g = k u / (1 - k u) and M the sum of the monomials' absolute values; the
// computed sum P of absolute values obeys M <= P / (1 - g). Hence |error| <= g / (1 - g) P < (k + 1) u P for k < 2^20,
// and (k + 2) u absorbs the rounding of the comparison itself. k is computed by the compiler, from the form itself.
// Underflow adds at most 2^-1075 per operation, amplified by later factors. With all differences below 2^100 and degree
// at most 6 that is far below 2^-540 in total, so 2^-540 is added. Overflow makes P infinite or NaN, and every
// comparison with it false: then the exact stages decide.
#include <certa/types.h>
#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "verify/limbs.h"

namespace certa::verify {

template <class T>
struct Vec {
    T x, y, z;
};

template <class T>
Vec<T> operator+(const Vec<T>& a, const Vec<T>& b) {
    return {T(a.x + b.x), T(a.y + b.y), T(a.z + b.z)};
}
template <class T>
Vec<T> operator*(const T& s, const Vec<T>& a) {
    return {T(s * a.x), T(s * a.y), T(s * a.z)};
}
template <class T>
constexpr T dot_of(const Vec<T>& a, const Vec<T>& b) {
    return T(a.x * b.x + a.y * b.y + a.z * b.z);
}
template <class T>
constexpr Vec<T> cross_of(const Vec<T>& a, const Vec<T>& b) {
    return {T(a.y * b.z - a.z * b.y), T(a.z * b.x - a.x * b.z), T(a.x * b.y - a.y * b.x)};
}

/// A computed value and the sum of the absolute values of its monomials.
struct Bounded {
    double value = 0.0, size = 0.0;
    friend Bounded operator+(const Bounded& a, const Bounded& b) { return {a.value + b.value, a.size + b.size}; }
    friend Bounded operator-(const Bounded& a, const Bounded& b) { return {a.value - b.value, a.size + b.size}; }
    friend Bounded operator*(const Bounded& a, const Bounded& b) { return {a.value * b.value, a.size * b.size}; }
};

/// Counts, for an expression: roundings on the longest way (k above) and monomials.
struct Census {
    int roundings = 0;
    double monomials = 0.0;
    friend constexpr Census operator+(const Census& a, const Census& b) {
        return {std::max(a.roundings, b.roundings) + 1, a.monomials + b.monomials};
    }
    friend constexpr Census operator-(const Census& a, const Census& b) { return a + b; }
    friend constexpr Census operator*(const Census& a, const Census& b) {
        return {a.roundings + b.roundings + 1, a.monomials * b.monomials};
    }
};

inline constexpr double unit_roundoff = 0x1p-53;
inline constexpr double largest_filtered = 0x1p100;
inline constexpr double underflow_slack = 0x1p-540;

inline Bounded bounded_difference(double from, double to) {
    const double d = to - from;
    return {d, std::abs(d)};
}
inline Vec<Bounded> bounded_difference(const Point3& from, const Point3& to) {
    return {bounded_difference(from.x, to.x), bounded_difference(from.y, to.y), bounded_difference(from.z, to.z)};
}
inline bool is_filtered(const Vec<Bounded>& v) {
    return v.x.size <= largest_filtered && v.y.size <= largest_filtered && v.z.size <= largest_filtered;
}

/// The sign of an expression with `roundings` = k, or 2 when doubles cannot tell.
inline int filtered_sign(const Bounded& b, int roundings) {
    const double bound = (roundings + 2) * unit_roundoff * b.size + underflow_slack;
    if (b.value > bound) return 1;
    if (b.value < -bound) return -1;
    return 2;
}

/// The vector from one point to another.
struct Arrow {
    const Point3* from;
    const Point3* to;
};

using Int128 = __int128;

/// Writes the arrows' coordinates over one power of two; false when a subtraction rounds or they need more than `bits`.
bool to_small_integers(const Arrow* arrows, std::size_t count, int bits, Vec<Int128>* result);
/// Writes the arrows' coordinates over 2^exponent; false when they need more than `bits`.
bool to_limbs(const Arrow* arrows, std::size_t count, int bits, Vec<Limbs>* result, int& exponent);
/// Writes one arrow's coordinates over the given power of two; false when they are no integers then, or too large.
bool to_limbs_over(const Arrow& arrow, int exponent, int bits, Vec<Limbs>& result);
/// Writes the arrows' coordinates, exactly, over one power of two; returns its exponent.
int to_integers(const Arrow* arrows, std::size_t count, Vec<mpz_class>* result);

/// A form: `arity` vectors in, a number out, homogeneous of degree `degree` in all coordinates together.
template <class Form>
constexpr Census census_of() {
    constexpr Census leaf{1, 1.0};
    std::array<Vec<Census>, Form::arity> v{};
    for (auto& w : v) w = {leaf, leaf, leaf};
    return Form::template value<Census>(v);
}

/// Bits that a coordinate may have so that no value of the form needs more than `total`.
template <class Form>
constexpr int coordinate_bits(int total) {
    for (double monomials = census_of<Form>().monomials; monomials > 1.0; monomials /= 2.0) --total;
    return total / Form::degree;
}

template <class Form>
int decide_exactly(const std::array<Arrow, Form::arity>& arrows) {
    {
        std::array<Vec<Int128>, Form::arity> v;
        if (to_small_integers(arrows.data(), arrows.size(), coordinate_bits<Form>(126), v.data())) {
            const Int128 value = Form::template value<Int128>(v);
            return value > 0 ? 1 : value < 0 ? -1 : 0;
        }
    }
    {
        std::array<Vec<Limbs>, Form::arity> v;
        int exponent = 0;
        if (to_limbs(arrows.data(), arrows.size(), coordinate_bits<Form>(Limbs::bits), v.data(), exponent)) {
            return Form::template value<Limbs>(v).sign();
        }
    }
    std::array<Vec<mpz_class>, Form::arity> v;
    to_integers(arrows.data(), arrows.size(), v.data());
    return sgn(Form::template value<mpz_class>(v));
}

template <class Form>
int decide(const std::array<Arrow, Form::arity>& arrows) {
    static_assert(Form::degree <= 6);
    std::array<Vec<Bounded>, Form::arity> v;
    bool filtered = true;
    for (std::size_t i = 0; i < arrows.size(); ++i) {
        v[i] = bounded_difference(*arrows[i].from, *arrows[i].to);
        filtered = filtered && is_filtered(v[i]);
    }
    if (filtered) {
        constexpr int roundings = census_of<Form>().roundings;
        const int sign = filtered_sign(Form::template value<Bounded>(v), roundings);
        if (sign != 2) return sign;
    }
    return decide_exactly<Form>(arrows);
}

/// det(v0, v1, v2).
struct DeterminantForm {
    static constexpr int arity = 3, degree = 3;
    template <class T>
    static constexpr T value(const std::array<Vec<T>, 3>& v) {
        return dot_of(cross_of(v[0], v[1]), v[2]);
    }
};

/// det(v0, v1, v2 + v3 + v4).
struct DeterminantSumForm {
    static constexpr int arity = 5, degree = 3;
    template <class T>
    static constexpr T value(const std::array<Vec<T>, 5>& v) {
        return dot_of(cross_of(v[0], v[1]),
                      Vec<T>{T(v[2].x + v[3].x + v[4].x), T(v[2].y + v[3].y + v[4].y), T(v[2].z + v[3].z + v[4].z)});
    }
};

struct DotForm {
    static constexpr int arity = 2, degree = 2;
    template <class T>
    static constexpr T value(const std::array<Vec<T>, 2>& v) {
        return dot_of(v[0], v[1]);
    }
};

/// A ball through the origin o is { w : a |w|^2 - b . w < 0 }, a > 0. These are a and b, so that the same expressions
/// serve single tests and the search of many points.
template <class T>
struct BallCoefficients {
    T a;
    Vec<T> b;
};

/// The circumball of (0, u, v, w), positive: its centre c solves 2 c . u = |u|^2 and so on, so by Cramer's rule
/// 2 det(u, v, w) c = |u|^2 v x w + |v|^2 w x u + |w|^2 u x v.
template <class T>
constexpr BallCoefficients<T> circumball_of(const Vec<T>& u, const Vec<T>& v, const Vec<T>& w) {
    const Vec<T> vw = cross_of(v, w), wu = cross_of(w, u), uv = cross_of(u, v);
    const T uu = dot_of(u, u), vv = dot_of(v, v), ww = dot_of(w, w);
    return {dot_of(uv, w),
            {T(uu * vw.x + vv * wu.x + ww * uv.x), T(uu * vw.y + vv * wu.y + ww * uv.y),
             T(uu * vw.z + vv * wu.z + ww * uv.z)}};
}

/// The ball that has the circumcircle of (0, u, v) as a great circle: the same with w = n = u x v, |w|^2 replaced by
/// what puts the centre into the plane, c . n = 0: 2 |n|^2 c = |u|^2 v x n + |v|^2 n x u.
template <class T>
constexpr BallCoefficients<T> diametral_ball_of(const Vec<T>& u, const Vec<T>& v) {
    const Vec<T> n = cross_of(u, v), vn = cross_of(v, n), nu = cross_of(n, u);
    const T uu = dot_of(u, u), vv = dot_of(v, v);
    return {dot_of(n, n), {T(uu * vn.x + vv * nu.x), T(uu * vn.y + vv * nu.y), T(uu * vn.z + vv * nu.z)}};
}

/// Positive strictly inside.
template <class T>
constexpr T inside_value(const BallCoefficients<T>& ball, const Vec<T>& p) {
    return T(dot_of(ball.b, p) - ball.a * dot_of(p, p));
}

/// Vectors u, v, w, p from a common origin: positive when p is strictly inside the circumball of (0, u, v, w).
struct CircumballForm {
    static constexpr int arity = 4, degree = 5;
    template <class T>
    static constexpr T value(const std::array<Vec<T>, 4>& v) {
        return inside_value(circumball_of(v[0], v[1], v[2]), v[3]);
    }
};

/// Vectors u, v, p from a common origin.
struct DiametralBallForm {
    static constexpr int arity = 3, degree = 6;
    template <class T>
    static constexpr T value(const std::array<Vec<T>, 3>& v) {
        return inside_value(diametral_ball_of(v[0], v[1]), v[2]);
    }
};

}  // namespace certa::verify
