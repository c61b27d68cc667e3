#pragma once
// The checker's own exact predicates on doubles. Signs are -1, 0, +1; see forms.h for how they are decided.
#include <memory>
#include <vector>

#include "verify/forms.h"

namespace certa::verify {

/// Sign of det(b - a, c - a, d - a).
int orientation(const Point3& a, const Point3& b, const Point3& c, const Point3& d);
/// +1: p strictly inside the circumsphere of the positively oriented (a, b, c, d); 0: on it.
int in_circumball(const Point3& a, const Point3& b, const Point3& c, const Point3& d, const Point3& p);
/// +1: p strictly inside the ball that has the circumcircle of abc as a great circle.
int in_diametral_ball(const Point3& a, const Point3& b, const Point3& c, const Point3& p);
/// Sign of (b - a) . (d - c).
int dot_sign(const Point3& a, const Point3& b, const Point3& c, const Point3& d);
/// Sign of det(b - a, d - c, f - e).
int determinant_sign(const Arrow& first, const Arrow& second, const Arrow& third);
/// Sign of det(p - o, q - o, (a - o) + (b - o) + (c - o)): on which side of the plane opq is the middle of abc?
int middle_side(const Point3& o, const Point3& p, const Point3& q, const Point3& a, const Point3& b, const Point3& c);
/// Sign of the z coordinate of (b - a) x (p - a).
int orientation_xy(const Point3& a, const Point3& b, const Point3& p);

/// A region { w : a |w|^2 - b . w < 0 }, w = p - origin: the circumball of a tetrahedron, the diametral ball of a
/// triangle, or (a = 0) the open half-space beyond the plane of a triangle. Made for asking about many points and
/// boxes: a and b are kept in doubles with error bounds, and exactly once they are needed so. Where doubles say little
/// about them (slivers), they are computed exactly and rounded. Not to be used from two threads at once.
class QuadricRegion {
public:
    static QuadricRegion circumball(const Point3& a, const Point3& b, const Point3& c, const Point3& d);
    static QuadricRegion diametral_ball(const Point3& a, const Point3& b, const Point3& c);
    /// The side that the normal (b - a) x (c - a) points to.
    static QuadricRegion beyond(const Point3& a, const Point3& b, const Point3& c);

    /// +1 strictly inside, 0 on the boundary, -1 outside.
    int side(const Point3& p) const;
    /// True only if no point of the box is inside (nor, with `closed`, on the boundary).
    bool misses_box(const Point3& low, const Point3& high, bool closed) const;

private:
    enum class Kind : unsigned char { circumball, diametral_ball, beyond };
    QuadricRegion(Kind kind, const Point3& a, const Point3& b, const Point3& c, const Point3* d);
    int decide(const Point3& p) const;
    bool compute_exactly() const;
    void refine();

    Kind kind_;
    bool filtered_ = true;
    int roundings_ = 0;  // of inside_value, see forms.h
    Point3 corners_[4];
    Bounded a_;
    Vec<Bounded> b_;
    enum class Exact : unsigned char { unknown, known, too_large };
    mutable Exact state_ = Exact::unknown;
    mutable int exponent_ = 0;  // of the coordinates that exact_ is made from
    mutable BallCoefficients<Limbs> exact_;
};

/// Newell's normal of a closed polygon, twice its vector area: sum of (v_i - v_0) x (v_{i+1} - v_0). Exact on demand.
class NewellNormal {
public:
    explicit NewellNormal(std::vector<Point3> ring);

    /// Sign of normal . ((q - p) x (v - p)): +1 when v is to the left of the line from p to q, seen from the normal's
    /// tip. Not to be called from two threads at once.
    int side(const Point3& p, const Point3& q, const Point3& v) const { return side({&p, &q}, {&p, &v}); }
    /// Sign of normal . (first x second).
    int side(const Arrow& first, const Arrow& second) const;
    /// Sign of normal . (sum of the vector areas of a closed polygon): is it counter-clockwise?
    int turn(const std::vector<Point3>& polygon) const;
    /// Compares the areas of two closed polygons seen along the normal: sign of first - second.
    int compare_areas(const std::vector<Point3>& first, const std::vector<Point3>& second) const;
    /// Unit length, good to the last bits of extended precision however thin the polygon; zero when it has no area.
    Vec<long double> direction() const;

private:
    mpz_class area_along(const std::vector<Point3>& polygon, int& exponent) const;
    const Vec<mpz_class>& exact() const;

    std::vector<Point3> ring_;
    bool filtered_ = true;
    int roundings_ = 0;
    Vec<Bounded> bounded_{};
    mutable std::unique_ptr<Vec<mpz_class>> exact_;
};

}  // namespace certa::verify
