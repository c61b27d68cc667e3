// The exact ends of the orientation predicates, by CGAL's kernel with exact predicates (interval arithmetic, then
// multiprecision), and predicates composed of them. The filters stand in the header, where they can be inlined.
//
// Underflow: a product of differences that vanishes makes the filters' sums small, which sends the call here.
#include "exact/orientation.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace certa::exact {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

int sign_of(CGAL::Orientation orientation) {
    return orientation == CGAL::POSITIVE ? 1 : orientation == CGAL::NEGATIVE ? -1 : 0;
}

bool is_within(double a, double b, double c) { return (a <= c && c <= b) || (b <= c && c <= a); }

}  // namespace

namespace detail {

int orient2d_exact(const Point2& a, const Point2& b, const Point2& c) {
    if ((a.x == b.x && b.x == c.x) || (a.y == b.y && b.y == c.y)) return 0;
    return sign_of(CGAL::orientation(Kernel::Point_2(a.x, a.y), Kernel::Point_2(b.x, b.y), Kernel::Point_2(c.x, c.y)));
}

int orient3d_exact(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
    return sign_of(CGAL::orientation(Kernel::Point_3(a.x, a.y, a.z), Kernel::Point_3(b.x, b.y, b.z),
                                     Kernel::Point_3(c.x, c.y, c.z), Kernel::Point_3(d.x, d.y, d.z)));
}

}  // namespace detail

bool are_collinear(const Point3& a, const Point3& b, const Point3& c) {
    for (int axis = 0; axis < 3; ++axis) {
        if (orient2d(drop_axis(a, axis), drop_axis(b, axis), drop_axis(c, axis)) != 0) return false;
    }
    return true;
}

bool is_between(const Point3& a, const Point3& b, const Point3& c) {
    if (c == a || c == b) return false;
    return is_within(a.x, b.x, c.x) && is_within(a.y, b.y, c.y) && is_within(a.z, b.z, c.z) && are_collinear(a, b, c);
}

}  // namespace certa::exact
