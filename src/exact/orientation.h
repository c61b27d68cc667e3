#pragma once
// Exact signs of areas and volumes. A static filter answers almost always; CGAL's exact predicates answer the rest.
#include <certa/types.h>

#include <cmath>

namespace certa::exact {

/// A point of a plane.
struct Point2 {
    double x = 0.0, y = 0.0;
    friend bool operator==(const Point2&, const Point2&) = default;
};

namespace detail {
int orient2d_exact(const Point2& a, const Point2& b, const Point2& c);
int orient3d_exact(const Point3& a, const Point3& b, const Point3& c, const Point3& d);
}  // namespace detail

/// Sign of the area of (a, b, c): +1 counter-clockwise, 0 collinear, -1 clockwise. Finite coordinates.
inline int orient2d(const Point2& a, const Point2& b, const Point2& c) {
    const double left = (a.x - c.x) * (b.y - c.y), right = (a.y - c.y) * (b.x - c.x);
    const double det = left - right;
    // Shewchuk 1997, "Adaptive precision floating-point arithmetic", section 4.1: ccwerrboundA = (3 + 16 u) u with
    // u = 2^-53. It supposes that nothing underflows, hence the second condition.
    const double sum = std::abs(left) + std::abs(right);
    constexpr double bound = 3.3306690738754716e-16;
    if (std::abs(det) > bound * sum && sum > 1e-280) return det > 0.0 ? 1 : -1;
    return detail::orient2d_exact(a, b, c);
}

/// Sign of det(b - a, c - a, d - a): +1 when d is on the side to which the normal of (a, b, c) points, 0 when the four
/// points are coplanar. Finite coordinates.
inline int orient3d(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
    const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z;
    const double vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
    const double wx = d.x - a.x, wy = d.y - a.y, wz = d.z - a.z;
    // A plane at right angles to an axis: the rule on machine parts, and exact without further ado.
    if ((ux == 0.0 && vx == 0.0 && wx == 0.0) || (uy == 0.0 && vy == 0.0 && wy == 0.0) ||
        (uz == 0.0 && vz == 0.0 && wz == 0.0)) {
        return 0;
    }
    const double vywz = vy * wz, vzwy = vz * wy, vzwx = vz * wx, vxwz = vx * wz, vxwy = vx * wy, vywx = vy * wx;
    const double det = ux * (vywz - vzwy) + uy * (vzwx - vxwz) + uz * (vxwy - vywx);
    const double permanent = std::abs(ux) * (std::abs(vywz) + std::abs(vzwy)) +
                             std::abs(uy) * (std::abs(vzwx) + std::abs(vxwz)) +
                             std::abs(uz) * (std::abs(vxwy) + std::abs(vywx));
    // Shewchuk 1997, section 4.2: o3derrboundA = (7 + 56 u) u, under the same condition.
    constexpr double bound = 7.7715611723761027e-16;
    if (std::abs(det) > bound * permanent && permanent > 1e-250) return det > 0.0 ? 1 : -1;
    return detail::orient3d_exact(a, b, c, d);
}

/// The coordinates other than `axis` (0, 1, 2), in cyclic order: what is counter-clockwise seen from +axis stays so.
inline Point2 drop_axis(const Point3& p, int axis) {
    return axis == 0 ? Point2{p.y, p.z} : axis == 1 ? Point2{p.z, p.x} : Point2{p.x, p.y};
}

/// True when the three points lie on one line (or coincide).
bool are_collinear(const Point3& a, const Point3& b, const Point3& c);

/// True when c lies on the open segment (a, b).
bool is_between(const Point3& a, const Point3& b, const Point3& c);

}  // namespace certa::exact
