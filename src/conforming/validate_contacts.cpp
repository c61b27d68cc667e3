// Corners of the intersection of two simplices by exact predicates only.
//
// A corner of A n B is a point where an open face of A and an open face of B meet in that point alone: a vertex on
// anything, two edges that cross, or an edge that pierces a triangle. So it is enough to list those pairs of faces.
// The signs of each triangle's corners against the other's plane are computed once and rule out most pairs.
#include "conforming/validate_contacts.h"

#include <algorithm>
#include <cmath>

#include "exact/constructions.h"
#include "exact/orientation.h"

namespace certa::conforming {
namespace {

using exact::drop_axis;
using exact::orient2d;
using exact::orient3d;
using exact::Point2;

constexpr Feature nowhere = 255;

/// Both simplices, with the signs of the vertices of one against the plane of the other (0 without a plane).
struct Pair {
    std::span<const Point3> points;
    const Simplex& a;
    const Simplex& b;
    std::array<int, 3> a_signs{}, b_signs{};

    const Point3& at(const Simplex& s, int i) const { return points[s.vertices[i]]; }
};

bool has_vertex(const Simplex& s, std::uint32_t v) {
    for (int i = 0; i < s.size; ++i) {
        if (s.vertices[i] == v) return true;
    }
    return false;
}

/// Which open face of triangle abc carries p, a point of its plane that is none of its corners.
Feature locate_in_triangle(const Point3& a, const Point3& b, const Point3& c, const Point3& p) {
    const int axis = faithful_axis(a, b, c);
    if (axis < 0) return nowhere;
    const std::array<Point2, 3> t{drop_axis(a, axis), drop_axis(b, axis), drop_axis(c, axis)};
    const Point2 q = drop_axis(p, axis);
    const int turn = orient2d(t[0], t[1], t[2]);
    Feature place = inside;
    for (int i = 0; i < 3; ++i) {
        const int side = turn * orient2d(t[i], t[(i + 1) % 3], q);
        if (side < 0) return nowhere;
        if (side > 0) continue;
        if (place != inside) return nowhere;  // on two lines, but no corner of the triangle: never on it
        place = static_cast<Feature>(first_edge + i);
    }
    return place;
}

/// Which open face of s carries vertex v of the other simplex; `sign` is its side of the plane of s.
Feature locate(std::span<const Point3> points, const Simplex& s, std::uint32_t v, int sign) {
    const Point3& p = points[v];
    const auto at = [&](int i) -> const Point3& { return points[s.vertices[i]]; };
    if (s.size == 1) return nowhere;
    if (s.size == 2) return exact::is_between(at(0), at(1), p) ? first_edge : nowhere;
    return sign != 0 ? nowhere : locate_in_triangle(at(0), at(1), at(2), p);
}

/// True when open segments ab and cd, in one plane, cross in one point.
bool cross_in_plane(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
    for (int axis = 0; axis < 3; ++axis) {
        const Point2 p = drop_axis(a, axis), q = drop_axis(b, axis), r = drop_axis(c, axis), s = drop_axis(d, axis);
        const int c_side = orient2d(p, q, r), d_side = orient2d(p, q, s);
        const int a_side = orient2d(r, s, p), b_side = orient2d(r, s, q);
        // All on one line: the plane is seen edge-on (or everything is collinear, and then nothing crosses).
        if (c_side == 0 && d_side == 0 && a_side == 0 && b_side == 0) continue;
        return c_side * d_side < 0 && a_side * b_side < 0;
    }
    return false;
}

int edge_count(const Simplex& s) { return s.size == 3 ? 3 : s.size - 1; }

void add_shared(const Pair& pair, Contacts& contacts) {
    for (int i = 0; i < pair.a.size; ++i) {
        for (int j = 0; j < pair.b.size; ++j) {
            if (pair.a.vertices[i] == pair.b.vertices[j]) {
                contacts.add(static_cast<Feature>(i), static_cast<Feature>(j));
            }
        }
    }
}

void add_vertex_contacts(const Pair& pair, Contacts& contacts) {
    for (int i = 0; i < pair.a.size; ++i) {
        if (has_vertex(pair.b, pair.a.vertices[i])) continue;
        const Feature place = locate(pair.points, pair.b, pair.a.vertices[i], pair.a_signs[i]);
        if (place != nowhere) contacts.add(static_cast<Feature>(i), place);
    }
    for (int i = 0; i < pair.b.size; ++i) {
        if (has_vertex(pair.a, pair.b.vertices[i])) continue;
        const Feature place = locate(pair.points, pair.a, pair.b.vertices[i], pair.b_signs[i]);
        if (place != nowhere) contacts.add(place, static_cast<Feature>(i));
    }
}

/// Strictly on one side of the other's plane: the edge meets nothing there.
bool is_off_plane(const std::array<int, 3>& signs, int i, int j) { return signs[i] * signs[j] > 0; }

void add_edge_crossings(const Pair& pair, Contacts& contacts) {
    for (int i = 0; i < edge_count(pair.a); ++i) {
        const int i2 = i + 1 < pair.a.size ? i + 1 : 0;
        if (is_off_plane(pair.a_signs, i, i2)) continue;
        for (int j = 0; j < edge_count(pair.b); ++j) {
            const int j2 = j + 1 < pair.b.size ? j + 1 : 0;
            if (is_off_plane(pair.b_signs, j, j2)) continue;
            const std::uint32_t a = pair.a.vertices[i], b = pair.a.vertices[i2];
            const std::uint32_t c = pair.b.vertices[j], d = pair.b.vertices[j2];
            if (a == c || a == d || b == c || b == d) continue;
            const auto& p = pair.points;
            if (!contacts.coplanar && orient3d(p[a], p[b], p[c], p[d]) != 0) continue;
            if (cross_in_plane(p[a], p[b], p[c], p[d])) {
                contacts.add(static_cast<Feature>(first_edge + i), static_cast<Feature>(first_edge + j));
            }
        }
    }
}

/// True when segment pq, whose ends are strictly on either side of the plane of t, passes through its inside.
bool pierces(std::span<const Point3> points, const Point3& p, const Point3& q, const Simplex& t) {
    int turn = 0;
    for (int i = 0; i < 3; ++i) {
        const int side = orient3d(p, q, points[t.vertices[i]], points[t.vertices[(i + 1) % 3]]);
        if (side == 0 || side * turn < 0) return false;
        turn = side;
    }
    return true;
}

void add_piercings(const Pair& pair, Contacts& contacts) {
    if (pair.b.size == 3) {
        for (int i = 0; i < edge_count(pair.a); ++i) {
            const int j = i + 1 < pair.a.size ? i + 1 : 0;
            if (pair.a_signs[i] * pair.a_signs[j] >= 0) continue;
            if (pierces(pair.points, pair.at(pair.a, i), pair.at(pair.a, j), pair.b)) {
                contacts.add(static_cast<Feature>(first_edge + i), inside);
            }
        }
    }
    if (pair.a.size == 3) {
        for (int i = 0; i < edge_count(pair.b); ++i) {
            const int j = i + 1 < pair.b.size ? i + 1 : 0;
            if (pair.b_signs[i] * pair.b_signs[j] >= 0) continue;
            if (pierces(pair.points, pair.at(pair.b, i), pair.at(pair.b, j), pair.a)) {
                contacts.add(inside, static_cast<Feature>(first_edge + i));
            }
        }
    }
}

std::array<int, 3> signs_against(std::span<const Point3> points, const Simplex& t, const Simplex& s) {
    std::array<int, 3> signs{};
    if (t.size < 3) return signs;
    for (int i = 0; i < s.size; ++i) {
        if (has_vertex(t, s.vertices[i])) continue;
        signs[i] = orient3d(points[t.vertices[0]], points[t.vertices[1]], points[t.vertices[2]], points[s.vertices[i]]);
    }
    return signs;
}

/// True when all vertices are strictly on one side.
bool all_on_one_side(const std::array<int, 3>& signs, int size) {
    for (int i = 0; i < size; ++i) {
        if (signs[i] == 0 || signs[i] != signs[0]) return false;
    }
    return true;
}

}  // namespace

int faithful_axis(const Point3& a, const Point3& b, const Point3& c) {
    const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z;
    const double vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
    const std::array<double, 3> n{std::abs(uy * vz - uz * vy), std::abs(uz * vx - ux * vz),
                                  std::abs(ux * vy - uy * vx)};
    const int best = n[0] >= n[1] && n[0] >= n[2] ? 0 : n[1] >= n[2] ? 1 : 2;
    for (int i = 0; i < 3; ++i) {
        const int axis = (best + i) % 3;
        if (orient2d(drop_axis(a, axis), drop_axis(b, axis), drop_axis(c, axis)) != 0) return axis;
    }
    return -1;
}

Contacts find_contacts(std::span<const Point3> points, const Simplex& a, const Simplex& b) {
    Contacts contacts;
    Pair pair{points, a, b, signs_against(points, b, a), {}};
    if (b.size == 3 && all_on_one_side(pair.a_signs, a.size)) return contacts;
    pair.b_signs = signs_against(points, a, b);
    if (a.size == 3 && all_on_one_side(pair.b_signs, b.size)) return contacts;
    contacts.coplanar = a.size == 3 && b.size == 3 && pair.a_signs == std::array<int, 3>{};
    add_shared(pair, contacts);
    add_vertex_contacts(pair, contacts);
    add_edge_crossings(pair, contacts);
    add_piercings(pair, contacts);
    return contacts;
}

bool is_on_triangle(std::span<const Point3> points, const Simplex& t, const Point3& p) {
    const Point3 &a = points[t.vertices[0]], &b = points[t.vertices[1]], &c = points[t.vertices[2]];
    if (p == a || p == b || p == c) return true;
    return orient3d(a, b, c, p) == 0 && locate_in_triangle(a, b, c, p) != nowhere;
}

Point3 place_of(std::span<const Point3> points, const Simplex& a, const Simplex& b, const Contact& contact) {
    if (is_vertex(contact.first)) return points[a.vertices[contact.first]];
    if (is_vertex(contact.second)) return points[b.vertices[contact.second]];
    if (is_edge(contact.first) && is_edge(contact.second)) {
        const auto e = ends_of(a, contact.first), f = ends_of(b, contact.second);
        return exact::line_line_point(points[e[0]], points[e[1]], points[f[0]], points[f[1]]).value_or(points[e[0]]);
    }
    const bool edge_of_a = is_edge(contact.first);
    const auto e = edge_of_a ? ends_of(a, contact.first) : ends_of(b, contact.second);
    const auto& t = edge_of_a ? b.vertices : a.vertices;
    return exact::line_plane_point(points[e[0]], points[e[1]], points[t[0]], points[t[1]], points[t[2]])
        .value_or(points[e[0]]);
}

}  // namespace certa::conforming
