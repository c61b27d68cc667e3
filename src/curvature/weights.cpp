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

SideCut cut_side(const Point3& a, double a2, const Point3& b, double b2) {
    const Point3 d = b - a;
    SideCut side{dot(a, d), dot(d, d)};
    const bool starts = a2 <= 1.0, ends = b2 <= 1.0;
    if (starts && ends) {
        side.from = 0.0, side.to = 1.0;
        return side;
    }
    // square t^2 + 2 along t + rest <= 0
    const double along = side.along, rest = a2 - 1.0;
    if (!starts && !ends && (along >= 0.0 || along + side.square <= 0.0)) return side;  // nearest at an end
    const double discriminant = along * along - side.square * rest;
    if (!(discriminant >= 0.0) || !(side.square > 0.0)) return side;
    // big / square and rest / big are the two roots, neither by a difference of near numbers.
    const double root = std::sqrt(discriminant), big = along > 0.0 ? -(along + root) : root - along;
    if (along > 0.0) {  // starts inside
        side.from = 0.0, side.to = std::clamp(rest / big, 0.0, 1.0);
    } else {
        side.from = starts ? 0.0 : std::clamp(rest / big, 0.0, 1.0);
        side.to = ends ? 1.0 : std::clamp(big / side.square, 0.0, 1.0);
    }
    return side;
}

double AngleSum::value() const { return std::atan2(im_, re_) + 2.0 * std::numbers::pi * turns_; }

double WeightedBall::over_segment(const SideCut& side, double a2, double b2) const {
    const double width = side.to - side.from;
    if (!(width > 0.0)) return 0.0;
    if (profile_.weight == Weight::indicator) return width;
    // s between two parameters from their values: quadratic with second derivative -2 |b - a|^2.
    const auto s_at = [&](double t) { return 1.0 - ((1.0 - t) * a2 + t * b2 - t * (1.0 - t) * side.square); };
    const double center = 0.5 * (side.from + side.to);
    if (profile_.weight == Weight::kernel2)
        return width * square_integral(s_at(side.from), s_at(center), s_at(side.to));
    double sum = 0.0;
    for (std::size_t k = 0; k < 4; ++k)
        sum += gauss4_weights[k] * profile_.at(s_at(center + 0.5 * width * gauss4_points[k]));
    return 0.5 * width * sum;
}

double WeightedBall::over_inner_triangle(const std::array<double, 3>& squares, const std::array<SideCut, 3>& sides,
                                         double area) const {
    // Squared distance at barycentric l: sum l_i squares_i - sum over pairs l_i l_j sides_k.
    const auto s_at = [&](double u, double v, double w) {
        return 1.0 - (u * squares[0] + v * squares[1] + w * squares[2] - v * w * sides[0].square -
                      w * u * sides[1].square - u * v * sides[2].square);
    };
    if (profile_.weight == Weight::kernel2) {
        const double a = 1.0 - squares[0], b = 1.0 - squares[1], c = 1.0 - squares[2];
        const double ma = 0.5 * (b + c) + 0.25 * sides[0].square, mb = 0.5 * (c + a) + 0.25 * sides[1].square;
        const double mc = 0.5 * (a + b) + 0.25 * sides[2].square;
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

double WeightedBall::over_triangle(const std::array<Point3, 3>& p, const std::array<double, 3>& squares,
                                   const std::array<SideCut, 3>& sides, const Point3& normal, double area) const {
    if (squares[0] <= 1.0 && squares[1] <= 1.0 && squares[2] <= 1.0)
        return profile_.weight == Weight::indicator ? area : over_inner_triangle(squares, sides, area);
    if (area == 0.0) return 0.0;
    // The ball meets the plane in a disc around the foot of its centre, of squared radius `full`. Points stay where
    // they are: products of points less height^2 are those of their shadows around the foot, and so is the turn.
    const double height = dot(normal, p[0]), height2 = height * height, full = 1.0 - height2;
    if (full <= 0.0) return 0.0;
    constexpr std::array<std::size_t, 3> next{1, 2, 0}, previous{2, 0, 1};
    AngleSum outside;
    double sum = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = next[i], k = previous[i];
        const SideCut& side = sides[i];
        const double turn = dot(normal, cross(p[j], p[k]));
        if (turn == 0.0) continue;
        // Outside F is constant: all that counts is the angle under which a part is seen.
        if (!(side.to > side.from)) {
            outside.add(squares[j] + side.along - height2, turn);
            continue;
        }
        if (side.from > 0.0) outside.add(squares[j] + side.from * side.along - height2, side.from * turn);
        const double rest = 1.0 - side.to;
        if (rest > 0.0) outside.add(squares[k] - rest * (side.along + side.square) - height2, rest * turn);
        const double half = 0.5 * (side.to - side.from);
        if (profile_.weight == Weight::indicator) {
            sum += turn * half;
            continue;
        }
        double inner = 0.0;
        for (std::size_t q = 0; q < 4; ++q) {
            const double t = 0.5 * (side.from + side.to) + half * gauss4_points[q];
            inner += gauss4_weights[q] * primitive(full, 1.0 - (squares[j] + t * (2.0 * side.along + t * side.square)));
        }
        sum += turn * half * inner;
    }
    sum += full * primitive(full, 0.0) * outside.value();
    // A sliver's normal is noise: the weight's range bounds the integral all the same (the order 4 kernel dips to
    // -0.08).
    return std::clamp(sum, profile_.weight == Weight::kernel4 ? -0.08 * area : 0.0, area);
}

}  // namespace certa::curvature
