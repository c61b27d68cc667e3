#pragma once
// Where two simplices (points, segments, triangles in space) touch, exactly.
#include <certa/types.h>

#include <array>
#include <cstdint>
#include <span>

namespace certa::conforming {

/// 1 to 3 point indices. The points of a triangle are not collinear, those of a segment differ.
struct Simplex {
    std::array<std::uint32_t, 3> vertices{};
    std::uint8_t size = 0;
};

/// An open face of a simplex: vertex 0..2, edge 3 + i from vertex i to the next, or the inside of a triangle. The only
/// edge of a segment is `first_edge`.
using Feature = std::uint8_t;
inline constexpr Feature first_edge = 3, inside = 6;
constexpr bool is_vertex(Feature f) { return f < first_edge; }
constexpr bool is_edge(Feature f) { return f >= first_edge && f < inside; }

/// A point that both simplices have, by the open faces that carry it.
struct Contact {
    Feature first = 0, second = 0;
};

/// The corners of the intersection of two simplices: a convex set, hence empty without corners, a point with one, a
/// segment with two, a polygon with more.
struct Contacts {
    std::array<Contact, 12> list{};
    std::uint8_t count = 0;
    bool coplanar = false;  ///< two triangles in one plane

    void add(Feature first, Feature second) {
        if (count < list.size()) list[count++] = {first, second};
    }
    const Contact* begin() const { return list.data(); }
    const Contact* end() const { return list.data() + count; }
};

/// Finds all corners of the intersection. Exact. Points with equal coordinates must have equal indices.
Contacts find_contacts(std::span<const Point3> points, const Simplex& a, const Simplex& b);

/// The ends of an edge of a simplex.
constexpr std::array<std::uint32_t, 2> ends_of(const Simplex& s, Feature edge) {
    const int i = edge - first_edge;
    return {s.vertices[i], s.vertices[i + 1 < s.size ? i + 1 : 0]};
}

/// The place of a contact, rounded.
Point3 place_of(std::span<const Point3> points, const Simplex& a, const Simplex& b, const Contact& contact);

/// True when p lies on the closed triangle t.
bool is_on_triangle(std::span<const Point3> points, const Simplex& t, const Point3& p);

/// A coordinate axis along which the triangle is seen with non-zero area; -1 when it has none.
int faithful_axis(const Point3& a, const Point3& b, const Point3& c);

}  // namespace certa::conforming
