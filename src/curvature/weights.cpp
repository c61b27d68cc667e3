// Closed forms for radial weights (docs/curvature.md, "Weights instead of indicators").
//
// With s = 1 - t^2 every weight is a polynomial of s, and s is quadratic along a segment and over a triangle. A
// segment's integral over the part inside the ball is a Gauss rule that is exact for the degree at hand. A triangle's
// is one too when it lies inside; otherwise Green's theorem turns it into integrals along its sides: the field F(rho) /
// rho^2 x, F(rho) the integral of w(rho) rho, has divergence w. Beyond the circle in which the sphere meets the plane F
// is constant, and the side's integral is F times the angle under which it is seen.
#include "curvature/weights.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace certa::curvature {
namespace {

constexpr std::array<double, 4> gauss4_points{-0.861136311594052575, -0.339981043584856265, 0.339981043584856265,
                                              0.861136311594052575};
constexpr std::array<double, 4> gauss4_weights{0.347854845137453857, 0.652145154862546143, 0.652145154862546143,
                                               0.347854845137453857};

/// Integral over [0, 1] of the square of the quadratic with the values u, m, v at 0, 1/2, 1.
double square_integral(double u, double m, double v) {
    return (4.0 * (u * u + v * v + m * (u + v)) + 16.0 * m * m - 2.0 * u * v) / 30.0;
}

}  // namespace

std::array<double, 2> inside_unit_ball(const Point3& a, double a2, const Point3& b, double b2) {
    if (a2 <= 1.0 && b2 <= 1.0) return {0.0, 1.0};
    const Point3 d = b - a;
    const double dd = dot(d, d), ad = dot(a, d);
    // dd t^2 + 2 ad t + (a2 - 1) <= 0
    const double discriminant = ad * ad - dd * (a2 - 1.0);
    if (!(discriminant >= 0.0) || !(dd > 0.0)) return {1.0, 0.0};
    const double root = std::sqrt(discriminant), big = ad > 0.0 ? -(ad + root) : root - ad;
    // big / dd and (a2 - 1) / big are the two roots, neither by a difference of near numbers.
    const double first = big / dd, second = big != 0.0 ? (a2 - 1.0) / big : first;
    const double low = std::min(first, second), high = std::max(first, second);
    return {a2 <= 1.0 ? 0.0 : std::max(0.0, low), b2 <= 1.0 ? 1.0 : std::min(1.0, high)};
}

double AngleSum::value() const { return std::atan2(im_, re_) + 2.0 * std::numbers::pi * turns_; }

double WeightedBall::over_segment(const Point3& a, double a2, const Point3& b, double b2) const {
    const auto [from, to] = inside_unit_ball(a, a2, b, b2);
    if (!(to > from)) return 0.0;
    if (profile_.weight == Weight::indicator) return to - from;
    const Point3 d = b - a;
    const double dd = dot(d, d);
    // s between two parameters from their values: quadratic with second derivative -2 dd.
    const auto s_at = [&](double t) { return 1.0 - ((1.0 - t) * a2 + t * b2 - t * (1.0 - t) * dd); };
    const double middle = s_at(0.5 * (from + to)), width = to - from;
    if (profile_.weight == Weight::kernel2) return width * square_integral(s_at(from), middle, s_at(to));
    double sum = 0.0;
    for (std::size_t k = 0; k < 4; ++k)
        sum += gauss4_weights[k] * profile_.at(s_at(0.5 * (from + to) + 0.5 * width * gauss4_points[k]));
    return 0.5 * width * sum;
}

double WeightedBall::over_inner_triangle(const std::array<double, 3>& squares, const std::array<double, 3>& sides,
                                         double area) const {
    // Squared distance at barycentric l: sum l_i squares_i - sum over pairs l_i l_j sides_k.
    const auto s_at = [&](double u, double v, double w) {
        return 1.0 - (u * squares[0] + v * squares[1] + w * squares[2] - v * w * sides[0] - w * u * sides[1] -
                      u * v * sides[2]);
    };
    if (profile_.weight == Weight::kernel2) {
        const double a = 1.0 - squares[0], b = 1.0 - squares[1], c = 1.0 - squares[2];
        const double ma = 0.5 * (b + c) + 0.25 * sides[0], mb = 0.5 * (c + a) + 0.25 * sides[1];
        const double mc = 0.5 * (a + b) + 0.25 * sides[2];
        // The mass matrix of quadratic elements.
        const double corners = 6.0 * (a * a + b * b + c * c) - 2.0 * (a * b + b * c + c * a);
        const double middles = 32.0 * (ma * ma + mb * mb + mc * mc + ma * mb + mb * mc + mc * ma);
        return area / 180.0 * (corners + middles - 8.0 * (a * ma + b * mb + c * mc));
    }
    // Degree 6, 12 points (Dunavant 1985).
    constexpr double p = 0.249286745170910421, pw = 0.116786275726379366, q = 0.063089014491502228,
                     qw = 0.050844906370206817;
    constexpr double r = 0.053145049844816947, t = 0.310352451033784405, rw = 0.082851075618373575;
    const auto w = [&](double u, double v) { return profile_.at(s_at(u, v, 1.0 - u - v)); };
    double sum =
        pw * (w(p, p) + w(p, 1 - 2 * p) + w(1 - 2 * p, p)) + qw * (w(q, q) + w(q, 1 - 2 * q) + w(1 - 2 * q, q));
    sum += rw * (w(r, t) + w(t, r) + w(r, 1 - r - t) + w(1 - r - t, r) + w(t, 1 - r - t) + w(1 - r - t, t));
    return area * sum;
}

/// F / rho^2 where s = full - rho^2, as a polynomial of s.
double WeightedBall::primitive(double full, double s) const {
    switch (profile_.weight) {
        case Weight::indicator:
            return 0.5;
        case Weight::kernel2:
            return (full * full + full * s + s * s) / 6.0;
        case Weight::kernel4:
            return 0.3125 * (full * full * full + s * (full * full + s * (full + s))) -
                   0.25 * (full * full + full * s + s * s);
    }
    return 0.0;
}

double WeightedBall::over_polygon_edge(const Point3& a, const Point3& b, const Point3& normal, double height2,
                                       AngleSum& outside) const {
    const double turn = dot(normal, cross(a, b));
    if (turn == 0.0) return 0.0;
    const double a2 = dot(a, a) + height2, b2 = dot(b, b) + height2, full = 1.0 - height2;
    // The ball meets the plane in a disc around the foot of its centre: |x|^2 <= full for x in the plane, which is the
    // same inequality as for the ball, since x is at a right angle to the height.
    const auto [from, to] = inside_unit_ball(a, a2, b, b2);
    const Point3 d = b - a;
    // Outside F is constant: all that counts is the angle under which a part is seen.
    const auto seen = [&](const Point3& p, const Point3& q) { outside.add(dot(p, q), dot(normal, cross(p, q))); };
    if (!(to > from)) {
        seen(a, b);
        return 0.0;
    }
    if (from > 0.0) seen(a, a + from * d);
    if (to < 1.0) seen(a + to * d, b);
    if (profile_.weight == Weight::indicator) return turn * 0.5 * (to - from);
    double inner = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
        const double t = 0.5 * (from + to) + 0.5 * (to - from) * gauss4_points[k];
        const Point3 x = a + t * d;
        inner += gauss4_weights[k] * primitive(full, full - dot(x, x));
    }
    return turn * 0.5 * (to - from) * inner;
}

double WeightedBall::over_triangle(const std::array<Point3, 3>& p, const std::array<double, 3>& squares,
                                   const Point3& normal, double area) const {
    if (squares[0] <= 1.0 && squares[1] <= 1.0 && squares[2] <= 1.0) {
        if (profile_.weight == Weight::indicator) return area;
        const auto side = [&](std::size_t i, std::size_t j) {
            const Point3 d = p[j] - p[i];
            return dot(d, d);
        };
        return over_inner_triangle(squares, {side(1, 2), side(2, 0), side(0, 1)}, area);
    }
    if (area == 0.0) return 0.0;
    const double height = dot(normal, p[0]), height2 = height * height;
    if (height2 >= 1.0) return 0.0;
    const Point3 foot = height * normal;
    const std::array<Point3, 3> flat{p[0] - foot, p[1] - foot, p[2] - foot};
    AngleSum outside;
    double sum = over_polygon_edge(flat[0], flat[1], normal, height2, outside) +
                 over_polygon_edge(flat[1], flat[2], normal, height2, outside) +
                 over_polygon_edge(flat[2], flat[0], normal, height2, outside);
    const double full = 1.0 - height2;
    sum += full * primitive(full, 0.0) * outside.value();
    // A sliver's normal is noise: the weight's range bounds the integral all the same (the order 4 kernel dips to
    // -0.08).
    return std::clamp(sum, profile_.weight == Weight::kernel4 ? -0.08 * area : 0.0, area);
}

}  // namespace certa::curvature
