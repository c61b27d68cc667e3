#pragma once
// Integrals of radial weights over edges and triangles cut by a sphere, in closed form.
#include "curvature/surface.h"

namespace certa::curvature {

/// The weight as a polynomial of s = 1 - t^2, t = distance / radius, for s in [0, 1]: w = c0 + c2 s^2 + c3 s^3.
struct Profile {
    Weight weight = Weight::indicator;
    double at(double s) const {
        switch (weight) {
            case Weight::indicator:
                return 1.0;
            case Weight::kernel2:
                return s * s;
            case Weight::kernel4:
                return s * s * (2.5 * s - 1.5);
        }
        return 0.0;
    }
};

/// A sum of angles, each between -pi and pi, for the price of one arc tangent: the angles' complex numbers are
/// multiplied, and passing the negative axis is noticed.
class AngleSum {
public:
    /// The angle of (cosine, sine), of any length.
    void add(double cosine, double sine) {
        const double re = re_ * cosine - im_ * sine, im = re_ * sine + im_ * cosine;
        if (im_ >= 0.0 && sine > 0.0 && im < 0.0) turns_ += 1.0;
        if (im_ < 0.0 && sine < 0.0 && im >= 0.0) turns_ -= 1.0;
        re_ = re, im_ = im;
    }
    double value() const;

private:
    double re_ = 1.0, im_ = 0.0, turns_ = 0.0;
};

/// A segment from a to b against the unit ball.
struct SideCut {
    double along = 0.0;           ///< a . (b - a)
    double square = 0.0;          ///< |b - a|^2
    double from = 1.0, to = 0.0;  ///< where it runs inside: parameters in [0, 1]; nowhere if from > to
    bool meets() const { return from <= to; }
};
/// `a2`, `b2`: squares of a and b.
SideCut cut_side(const Point3& a, double a2, const Point3& b, double b2);

/// A ball: everything is relative to its centre and in units of its radius.
class WeightedBall {
public:
    WeightedBall(const Point3& center, double radius, Weight weight)
        : center_(center),
          per_radius_(1.0 / radius),
          square_(radius * radius),
          per_square_(1.0 / square_),
          profile_{weight} {}

    Point3 local(const Point3& p) const { return per_radius_ * (p - center_); }
    double square() const { return square_; }  ///< of the radius
    double per_square() const { return per_square_; }
    Weight weight() const { return profile_.weight; }
    /// The weight at a point; 0 outside. `square` is its squared distance in units of the radius.
    double at(double square) const { return square <= 1.0 ? profile_.at(1.0 - square) : 0.0; }
    /// Integral over a side, in units of its length; `a2`, `b2`: squares of its ends.
    double over_segment(const SideCut& side, double a2, double b2) const;
    /// Integral over the triangle (local points), in units of the squared radius; side i is opposite corner i; `normal`
    /// is its unit normal, `area` its area in units of the squared radius.
    double over_triangle(const std::array<Point3, 3>& p, const std::array<double, 3>& squares,
                         const std::array<SideCut, 3>& sides, const Point3& normal, double area) const;

private:
    double over_inner_triangle(const std::array<double, 3>& squares, const std::array<SideCut, 3>& sides,
                               double area) const;
    double primitive(double full, double s) const;

    Point3 center_;
    double per_radius_, square_, per_square_;
    Profile profile_;
};

}  // namespace certa::curvature
