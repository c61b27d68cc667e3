// Intersection points in rational arithmetic, rounded to the nearest doubles (to within one unit in the last place).
// Slow, and meant to be: used for the places in error messages and for repairs, never in a loop over healthy input.
#include "exact/constructions.h"

#include <CGAL/Exact_rational.h>

namespace certa::exact {
namespace {

using Number = CGAL::Exact_rational;
using Vector = std::array<Number, 3>;

Vector vector_of(const Point3& a) { return {Number(a.x), Number(a.y), Number(a.z)}; }
Vector operator-(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Number dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Point3 point_on(const Vector& a, const Vector& direction, const Number& t) {
    return {CGAL::to_double(Number(a[0] + t * direction[0])), CGAL::to_double(Number(a[1] + t * direction[1])),
            CGAL::to_double(Number(a[2] + t * direction[2]))};
}

}  // namespace

std::optional<Point3> line_plane_point(const Point3& a, const Point3& b, const Point3& p, const Point3& q,
                                       const Point3& r) {
    const Vector from = vector_of(a), direction = vector_of(b) - from, base = vector_of(p);
    const Vector normal = cross(vector_of(q) - base, vector_of(r) - base);
    const Number speed = dot(normal, direction);
    if (speed == 0) return std::nullopt;
    return point_on(from, direction, Number(dot(normal, base - from) / speed));
}

std::optional<Point3> line_line_point(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
    const Vector from = vector_of(a), direction = vector_of(b) - from;
    const Vector other = vector_of(d) - vector_of(c), normal = cross(direction, other);
    const Number square = dot(normal, normal);
    if (square == 0) return std::nullopt;
    return point_on(from, direction, Number(dot(cross(vector_of(c) - from, other), normal) / square));
}

}  // namespace certa::exact
