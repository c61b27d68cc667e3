// Marching tetrahedra with exact vertices (docs/implicit-theorem.md, "output"). No tolerance anywhere: which edges
// carry vertices and how triangles join depends on signs only, and a vertex is moved along its edge to a dyadic
// fraction that a double can hold.
#include "implicit/surface.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/assert.h"
#include "core/index_map.h"
#include "core/vector3.h"

namespace certa::implicit {
namespace {

constexpr int finest_bits = 12;

// Orders that bring one point, or a pair (the first number tells which, a bit each), to the front and keep the
// orientation.
constexpr unsigned one_first[4][4] = {{0, 1, 2, 3}, {1, 0, 3, 2}, {2, 3, 0, 1}, {3, 2, 1, 0}};
constexpr unsigned pair_first[6][5] = {{3, 0, 1, 2, 3}, {5, 0, 2, 3, 1},  {9, 0, 3, 1, 2},
                                       {6, 1, 2, 0, 3}, {10, 1, 3, 2, 0}, {12, 2, 3, 0, 1}};

}  // namespace

void SurfaceBuilder::add(const std::array<std::uint32_t, 4>& tetrahedron, const std::array<int, 4>& signs,
                         std::uint32_t component) {
    unsigned positive = 0;
    for (unsigned i = 0; i < 4; ++i) positive |= signs[i] > 0 ? 1u << i : 0u;
    const int count = std::popcount(positive);
    if (count == 0 || count == 4) return;
    if (count != 2) {
        const unsigned* o = one_first[std::countr_zero(count == 1 ? positive : ~positive & 15u)];
        std::array<std::uint32_t, 3> ends{};
        for (std::size_t i = 0; i < 3; ++i)
            ends[i] = count == 1 ? vertex(tetrahedron[o[i + 1]], tetrahedron[o[0]])
                                 : vertex(tetrahedron[o[0]], tetrahedron[o[i + 1]]);
        // In this order they face away from the lonely point.
        if (count == 1) std::swap(ends[1], ends[2]);
        return emit(ends[0], ends[1], ends[2], component);
    }
    const auto* row = std::find_if(std::begin(pair_first), std::end(pair_first),
                                   [&](const unsigned(&r)[5]) { return r[0] == positive; });
    CERTA_ASSERT(row != std::end(pair_first));
    const std::uint32_t a = tetrahedron[(*row)[1]], b = tetrahedron[(*row)[2]], c = tetrahedron[(*row)[3]],
                        d = tetrahedron[(*row)[4]];
    // Around the quadrilateral so that it faces the positive pair (a, b).
    add_quadrilateral({vertex(c, a), vertex(c, b), vertex(d, b), vertex(d, a)}, component);
}

void SurfaceBuilder::add_quadrilateral(const std::array<std::uint32_t, 4>& corners, std::uint32_t component) {
    const auto& p = surface_.mesh.positions;
    const auto [a, b, c, d] = corners;
    if (distance(p[a], p[c]) <= distance(p[b], p[d])) {
        emit(a, b, c, component);
        emit(a, c, d, component);
    } else {
        emit(b, c, d, component);
        emit(b, d, a, component);
    }
}

void SurfaceBuilder::emit(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t component) {
    surface_.mesh.triangles.push_back({VertexId{a}, VertexId{b}, VertexId{c}});
    surface_.component_of_triangle.push_back(component);
}

std::uint32_t SurfaceBuilder::vertex(std::uint32_t negative, std::uint32_t positive) {
    std::uint32_t id = vertices_.find(negative, positive);
    if (id != no_index) return id;
    const auto [a, b] = std::minmax(negative, positive);
    id = static_cast<std::uint32_t>(surface_.mesh.positions.size());
    vertices_.set(a, b, id);
    surface_.vertex_edges.push_back({a, b});
    surface_.mesh.positions.push_back(place(tree_.points()[a], tree_.points()[b], a == negative ? -1 : 1));
    return id;
}

/// The point a + (b - a) k / 2^bits of the edge nearest to a sign change of f in doubles.
Point3 SurfaceBuilder::place(const GridPoint& a, const GridPoint& b, int sign_at_a) {
    const Grid& grid = tree_.grid();
    Coordinate all = 0;
    for (std::size_t i = 0; i < 3; ++i) all |= a[i] | b[i];
    const int zeros = std::countr_zero(all);
    int bits = finest_bits;
    while (bits > 1 && !grid.is_exact(bits, zeros)) --bits;
    CERTA_ASSERT(grid.is_exact(bits, zeros));
    const auto at = [&](unsigned k) {
        return Point3{grid.between(0, a[0], b[0], k, bits), grid.between(1, a[1], b[1], k, bits),
                      grid.between(2, a[2], b[2], k, bits)};
    };
    // Bisection keeps a sign change between low and high; away from the ends, where triangles would get needles.
    const unsigned whole = 1u << bits, margin = std::max(1u, whole / 32);
    unsigned low = margin, high = whole - margin;
    while (high - low > 1) {
        const unsigned k = low + (high - low) / 2;
        if ((field_.value(at(k)) < 0 ? -1 : 1) == sign_at_a)
            low = k;
        else
            high = k;
    }
    return at(low);
}

Surface build_surface(const Octree& tree, const Triangulation& triangulation, const Findings& findings, Field& field) {
    SurfaceBuilder builder(tree, field);
    for (const auto& t : triangulation.tetrahedra()) {
        const std::array<int, 4> signs{triangulation.sign(t[0]), triangulation.sign(t[1]), triangulation.sign(t[2]),
                                       triangulation.sign(t[3])};
        builder.add(t, signs, findings.component_of_point[t[0]]);
    }
    return builder.take();
}

}  // namespace certa::implicit
