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

/// A ball: everything is relative to its centre and in units of its radius.
class WeightedBall {
public:
    WeightedBall(const Point3& center, double radius, Weight weight)
        : center_(center), radius_(radius), per_radius_(1.0 / radius), profile_{weight} {}

    Point3 local(const Point3& p) const { return per_radius_ * (p - center_); }
    double radius() const { return radius_; }
    /// The weight at a point; 0 outside. `square` is its squared distance in units of the radius.
    double at(double square) const { return square <= 1.0 ? profile_.at(1.0 - square) : 0.0; }
    /// Integral over the segment from a to b (local points with their squares), in units of its length.
    double over_segment(const Point3& a, double a2, const Point3& b, double b2) const;
    /// Integral over the triangle (local points), in units of the squared radius; `normal` is its unit normal, `area`
    /// its area in units of the squared radius.
    double over_triangle(const std::array<Point3, 3>& p, const std::array<double, 3>& squares, const Point3& normal,
                         double area) const;

private:
    double over_inner_triangle(const std::array<double, 3>& squares, const std::array<double, 3>& sides,
                               double area) const;
    double over_polygon_edge(const Point3& a, const Point3& b, const Point3& normal, double height2,
                             AngleSum& outside) const;
    double primitive(double full, double s) const;

    Point3 center_;
    double radius_, per_radius_;
    Profile profile_;
};

/// Where the segment from a to b runs inside the unit ball: parameters in [0, 1]; empty (first > second) if nowhere.
std::array<double, 2> inside_unit_ball(const Point3& a, double a2, const Point3& b, double b2);

}  // namespace certa::curvature
