// Clips triangle b by the plane of a (from both sides) and by the three planes through the sides of a at right angles
// to it. What is left is the intersection, as the list of its corners; corners are points with one common denominator.
#include "intersection_oracle.h"

#include <algorithm>
#include <numeric>
#include <set>

namespace certa::oracle {
namespace {

using Int = __int128;

/// (x, y, z) / w with w > 0 and no common factor.
struct Rational3 {
    Int x = 0, y = 0, z = 0, w = 1;
    friend auto operator<=>(const Rational3&, const Rational3&) = default;
};

Int magnitude(Int a) { return a < 0 ? -a : a; }
Int gcd(Int a, Int b) {
    a = magnitude(a);
    b = magnitude(b);
    while (b != 0) {
        const Int r = a % b;
        a = b;
        b = r;
    }
    return a;
}

Rational3 reduced(Rational3 p) {
    Int g = gcd(gcd(p.x, p.y), gcd(p.z, p.w));
    if (p.w < 0) g = -g;
    return {p.x / g, p.y / g, p.z / g, p.w / g};
}

/// n . p = d.
struct Plane {
    std::array<Int, 3> n{};
    Int d = 0;
    Int side(const Rational3& p) const { return n[0] * p.x + n[1] * p.y + n[2] * p.z - d * p.w; }
};

std::array<Int, 3> difference(const IntegerPoint& a, const IntegerPoint& b) {
    return {Int(b[0]) - a[0], Int(b[1]) - a[1], Int(b[2]) - a[2]};
}
std::array<Int, 3> cross(const std::array<Int, 3>& a, const std::array<Int, 3>& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Plane plane_through(const std::array<Int, 3>& normal, const IntegerPoint& p) {
    return {normal, normal[0] * p[0] + normal[1] * p[1] + normal[2] * p[2]};
}
Plane opposite(const Plane& p) { return {{-p.n[0], -p.n[1], -p.n[2]}, -p.d}; }

/// The part of a convex polygon (or segment, or point) on the non-negative side.
std::vector<Rational3> clipped(const std::vector<Rational3>& polygon, const Plane& plane) {
    std::vector<Rational3> result;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Rational3 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
        const Int s = plane.side(p), t = plane.side(q);
        if (s >= 0) result.push_back(p);
        if ((s > 0 && t < 0) || (s < 0 && t > 0)) {
            // p and q by their homogeneous coordinates, weighted so that the side of the sum is zero.
            const Int a = t < 0 ? -t : t, b = s < 0 ? -s : s;
            result.push_back(reduced({a * p.x + b * q.x, a * p.y + b * q.y, a * p.z + b * q.z, a * p.w + b * q.w}));
        }
    }
    return result;
}

std::set<Rational3> corners_of_intersection(const IntegerTriangle& a, const IntegerTriangle& b) {
    const auto normal = cross(difference(a[0], a[1]), difference(a[0], a[2]));
    std::vector<Rational3> polygon;
    for (const IntegerPoint& p : b) polygon.push_back({p[0], p[1], p[2], 1});
    const Plane base = plane_through(normal, a[0]);
    polygon = clipped(clipped(polygon, base), opposite(base));
    for (int i = 0; i < 3; ++i) {
        polygon = clipped(polygon, plane_through(cross(normal, difference(a[i], a[(i + 1) % 3])), a[i]));
    }
    return {polygon.begin(), polygon.end()};
}

Rational3 rational(const IntegerPoint& p) { return {p[0], p[1], p[2], 1}; }

bool is_vertex_of(const IntegerTriangle& t, const Rational3& p) {
    return std::any_of(t.begin(), t.end(), [&](const IntegerPoint& v) { return rational(v) == p; });
}

/// For p on the closed triangle: on none of its sides.
bool is_inside(const IntegerTriangle& t, const Rational3& p) {
    const auto normal = cross(difference(t[0], t[1]), difference(t[0], t[2]));
    for (int i = 0; i < 3; ++i) {
        if (plane_through(cross(normal, difference(t[i], t[(i + 1) % 3])), t[i]).side(p) == 0) return false;
    }
    return true;
}

/// The corners of the intersection lie along one line: its two ends.
std::vector<Rational3> ends_of(const std::set<Rational3>& corners) { return {*corners.begin(), *corners.rbegin()}; }

bool side_is_inside(const IntegerTriangle& t, const IntegerTriangle& other, const std::vector<Rational3>& ends) {
    if (!is_vertex_of(t, ends[0]) || !is_vertex_of(t, ends[1])) return false;
    for (const Rational3& p : ends) {
        if (!is_vertex_of(other, p) && !is_inside(other, p)) return false;
    }
    return !(is_vertex_of(other, ends[0]) && is_vertex_of(other, ends[1]));
}

}  // namespace

Meeting meet(const IntegerTriangle& a, const IntegerTriangle& b) {
    const std::set<Rational3> corners = corners_of_intersection(a, b);
    if (corners.empty()) return Meeting::nothing;
    if (corners.size() > 2) return Meeting::forbidden;
    const auto shared = [&](const Rational3& p) { return is_vertex_of(a, p) && is_vertex_of(b, p); };
    if (std::all_of(corners.begin(), corners.end(), shared)) return Meeting::nothing;
    if (corners.size() == 1) {
        const Rational3& p = *corners.begin();
        const bool inside = (is_vertex_of(a, p) && is_inside(b, p)) || (is_vertex_of(b, p) && is_inside(a, p));
        return inside ? Meeting::point_inside : Meeting::forbidden;
    }
    const auto ends = ends_of(corners);
    return side_is_inside(a, b, ends) || side_is_inside(b, a, ends) ? Meeting::side_inside : Meeting::forbidden;
}

int volume_sign(const IntegerPoint& a, const IntegerPoint& b, const IntegerPoint& c, const IntegerPoint& d) {
    const auto n = cross(difference(a, b), difference(a, c));
    const auto e = difference(a, d);
    const Int volume = n[0] * e[0] + n[1] * e[1] + n[2] * e[2];
    return volume > 0 ? 1 : volume < 0 ? -1 : 0;
}

}  // namespace certa::oracle
