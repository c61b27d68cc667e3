// Triangle against triangle by signs of determinants only: nothing is constructed.
//
// Plan: segment against triangle by five orientations, in the plane where they are coplanar; two triangles meet if and
// only if an edge of one meets the other. Triangles that share a corner meet elsewhere if and only if the edge opposite
// to it in one meets the other: what they share beyond the corner is a convex set that ends on one of those edges.
// Before that, doubles look for a plane between the two: most pairs whose boxes meet are far apart in one plane.
#include "verify/surface_contacts.h"

#include <cmath>
#include <limits>
#include <numeric>

#include "verify/predicates.h"

namespace certa::verify {
namespace {

Point3 turned(const Point3& p, int axis) {
    return axis == 0 ? Point3{p.y, p.z, p.x} : axis == 1 ? Point3{p.z, p.x, p.y} : p;
}

/// Sign of the area of (a, b, p) seen along an axis.
int area_sign(const Point3& a, const Point3& b, const Point3& p, int axis) {
    return orientation_xy(turned(a, axis), turned(b, axis), turned(p, axis));
}

/// An axis along which the triangle has an area; -1: none.
int axis_of(const Corners& t) {
    for (int axis = 2; axis >= 0; --axis) {
        if (area_sign(t[0], t[1], t[2], axis) != 0) return axis;
    }
    return -1;
}

/// p on the line ab within the segment, all three collinear in the plane.
bool within(const Point3& a, const Point3& b, const Point3& p, int axis) {
    const Point3 u = turned(a, axis), v = turned(b, axis), w = turned(p, axis);
    return std::min(u.x, v.x) <= w.x && w.x <= std::max(u.x, v.x) && std::min(u.y, v.y) <= w.y &&
           w.y <= std::max(u.y, v.y);
}

bool segments_meet(const Point3& a, const Point3& b, const Point3& p, const Point3& q, int axis) {
    const int sp = area_sign(a, b, p, axis), sq = area_sign(a, b, q, axis);
    const int sa = area_sign(p, q, a, axis), sb = area_sign(p, q, b, axis);
    if (sp * sq < 0 && sa * sb < 0) return true;
    return (sp == 0 && within(a, b, p, axis)) || (sq == 0 && within(a, b, q, axis)) ||
           (sa == 0 && within(p, q, a, axis)) || (sb == 0 && within(p, q, b, axis));
}

bool in_plane_meets(const Point3& p, const Point3& q, const Corners& t) {
    const int axis = axis_of(t);
    bool positive = false, negative = false;
    for (std::size_t i = 0; i < 3; ++i) {
        const Point3 &a = t[i], &b = t[(i + 1) % 3];
        if (segments_meet(a, b, p, q, axis)) return true;
        const int side = area_sign(a, b, p, axis);
        positive = positive || side > 0;
        negative = negative || side < 0;
    }
    return !(positive && negative);  // p inside
}

using Arrows = std::array<Point3, 3>;

Point3 minus(const Point3& a, const Point3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Point3 product(const Point3& a, const Point3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Point3 shortened(const Point3& a) {
    const double length = std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z);
    return {a.x / length, a.y / length, a.z / length};
}

/// The least (side -1) or largest (+1) that n . p can be over the corners from `first` on, for any n, exact or not:
/// each of p's differences and of the five operations is off by half a unit in the last place, products perhaps by
/// underflow.
double extreme(const Arrows& corners, std::size_t first, const Point3& n, double side) {
    double most = -std::numeric_limits<double>::infinity();
    for (std::size_t i = first; i < 3; ++i) {
        const double x = n.x * corners[i].x, y = n.y * corners[i].y, z = n.z * corners[i].z;
        const double error = 0x1p-49 * (std::abs(x) + std::abs(y) + std::abs(z)) + 0x1p-1000;
        const double value = side * (x + y + z) + error;
        if (!std::isfinite(value)) return side * std::numeric_limits<double>::infinity();
        most = std::max(most, value);
    }
    return side * most;
}

/// Whether doubles find a plane that separates the triangles strictly, but for a common corner s[0] = t[0]. False says
/// nothing, and so do overflow and underflow.
bool are_clearly_apart(const Corners& s, const Corners& t, bool share_corner) {
    Arrows a, b;
    for (std::size_t i = 0; i < 3; ++i) a[i] = minus(s[i], s[0]), b[i] = minus(t[i], s[0]);
    const Point3 normal_a = product(a[1], a[2]), normal_b = product(minus(b[1], b[0]), minus(b[2], b[0]));
    const auto separates = [&](const Point3& n) {
        const std::size_t first = share_corner ? 1 : 0;
        const auto below = [&](const Arrows& low, const Arrows& high) {
            const double top = extreme(low, first, n, 1.0), bottom = extreme(high, first, n, -1.0);
            return share_corner ? top < 0.0 && bottom > 0.0 : top < bottom;
        };
        return below(a, b) || below(b, a);
    };
    if (!share_corner) {
        if (separates(normal_a) || separates(normal_b)) return true;
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t k = (i + 1) % 3;
            if (separates(product(normal_a, minus(a[k], a[i]))) || separates(product(normal_b, minus(b[k], b[i]))))
                return true;
        }
        return false;
    }
    // Between the planes of both, or between a side of one and a side of the other.
    const Point3 m = shortened(normal_a), n = shortened(normal_b);
    if (separates(minus(m, n)) || separates({m.x + n.x, m.y + n.y, m.z + n.z})) return true;
    for (std::size_t i = 1; i < 3; ++i) {
        for (std::size_t k = 1; k < 3; ++k) {
            const Point3 u = shortened(a[i]), v = shortened(b[k]);
            if (separates(product(m, {u.x + v.x, u.y + v.y, u.z + v.z}))) return true;
        }
    }
    return false;
}

}  // namespace

bool is_degenerate(const Corners& t) { return axis_of(t) < 0; }

bool segment_meets(const Point3& p, const Point3& q, const Corners& t) {
    const int at_p = orientation(t[0], t[1], t[2], p), at_q = orientation(t[0], t[1], t[2], q);
    if (at_p * at_q > 0) return false;
    if (at_p == 0 && at_q == 0) return in_plane_meets(p, q, t);
    bool positive = false, negative = false;
    for (std::size_t i = 0; i < 3; ++i) {
        const int side = orientation(p, q, t[i], t[(i + 1) % 3]);
        positive = positive || side > 0;
        negative = negative || side < 0;
    }
    return !(positive && negative);
}

bool triangles_meet(const Corners& s, const Corners& t) {
    const auto apart = [](const Corners& of, const Corners& from) {
        const int a = orientation(of[0], of[1], of[2], from[0]);
        return a != 0 && a == orientation(of[0], of[1], of[2], from[1]) &&
               a == orientation(of[0], of[1], of[2], from[2]);
    };
    if (apart(s, t) || apart(t, s)) return false;
    for (std::size_t i = 0; i < 3; ++i) {
        if (segment_meets(s[i], s[(i + 1) % 3], t) || segment_meets(t[i], t[(i + 1) % 3], s)) return true;
    }
    return false;
}

bool meet_beyond_corner(const Corners& s, const Corners& t) {
    return segment_meets(s[1], s[2], t) || segment_meets(t[1], t[2], s);
}

bool meet_beyond_edge(const Corners& s, const Corners& t) {
    if (orientation(s[0], s[1], s[2], t[2]) != 0) return false;
    const int axis = axis_of(s);
    return area_sign(s[0], s[1], s[2], axis) == area_sign(s[0], s[1], t[2], axis);
}

bool meet_beyond_shared(const std::vector<Point3>& positions, std::array<std::uint32_t, 3> s,
                        std::array<std::uint32_t, 3> t) {
    std::size_t shared = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = shared; k < 3; ++k) {
            if (s[i] != t[k]) continue;
            std::swap(s[i], s[shared]);
            std::swap(t[k], t[shared]);
            ++shared;
            break;
        }
    }
    if (shared == 3) return true;
    const Corners a{positions[s[0]], positions[s[1]], positions[s[2]]},
        b{positions[t[0]], positions[t[1]], positions[t[2]]};
    if (shared == 2) return meet_beyond_edge(a, b);
    if (are_clearly_apart(a, b, shared == 1)) return false;
    return shared == 1 ? meet_beyond_corner(a, b) : triangles_meet(a, b);
}

int crossing(const Point3& from, const Point3& to, const Corners& t) {
    const int start = orientation(t[0], t[1], t[2], from), end = orientation(t[0], t[1], t[2], to);
    if (start * end > 0) return 0;
    bool zero = start == 0 || end == 0, positive = false, negative = false;
    for (std::size_t i = 0; i < 3; ++i) {
        const int side = orientation(from, to, t[i], t[(i + 1) % 3]);
        zero = zero || side == 0;
        positive = positive || side > 0;
        negative = negative || side < 0;
    }
    if (positive && negative) return 0;
    if (zero) return 2;
    return end;
}

BoxTree::BoxTree(std::vector<BoundingBox> boxes) : boxes_(std::move(boxes)), order_(boxes_.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    if (!boxes_.empty()) build(0, static_cast<std::uint32_t>(boxes_.size()));
}

std::uint32_t BoxTree::build(std::uint32_t begin, std::uint32_t end) {
    const auto id = static_cast<std::uint32_t>(nodes_.size());
    Node node{boxes_[order_[begin]], begin, end, 0};
    for (std::uint32_t i = begin + 1; i < end; ++i) node.box.add(boxes_[order_[i]]);
    nodes_.push_back(node);
    if (end - begin <= 4) return id;
    const double sides[3] = {node.box.high.x - node.box.low.x, node.box.high.y - node.box.low.y,
                             node.box.high.z - node.box.low.z};
    const auto axis = std::max_element(sides, sides + 3) - sides;
    const auto middle = [&](std::uint32_t i) {
        const BoundingBox& b = boxes_[i];
        return axis == 0   ? b.low.x / 2 + b.high.x / 2
               : axis == 1 ? b.low.y / 2 + b.high.y / 2
                           : b.low.z / 2 + b.high.z / 2;
    };
    const std::uint32_t half = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + half, order_.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b) {
                         const double x = middle(a), y = middle(b);
                         return x != y ? x < y : a < b;
                     });
    build(begin, half);
    const std::uint32_t second = build(half, end);
    nodes_[id].second = second;
    return id;
}

}  // namespace certa::verify
