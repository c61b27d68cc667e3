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

class Builder {
public:
    Builder(const Octree& tree, const Triangulation& t, const Findings& findings, Field& field)
        : tree_(tree), t_(t), findings_(findings), field_(field) {}

    Surface build() {
        for (const auto& tetrahedron : t_.tetrahedra()) add(tetrahedron);
        return std::move(surface_);
    }

private:
    void add(const Triangulation::Tetrahedron& tetrahedron) {
        unsigned positive = 0;
        for (unsigned i = 0; i < 4; ++i) positive |= t_.sign(tetrahedron[i]) > 0 ? 1u << i : 0u;
        const int count = std::popcount(positive);
        if (count == 0 || count == 4) return;
        const std::uint32_t component = findings_.component_of_point[tetrahedron[0]];
        // Orders that bring one point, or a pair, to the front and keep the orientation.
        static constexpr unsigned one_first[4][4] = {{0, 1, 2, 3}, {1, 0, 3, 2}, {2, 3, 0, 1}, {3, 2, 1, 0}};
        if (count != 2) {
            const unsigned lonely = static_cast<unsigned>(std::countr_zero(count == 1 ? positive : ~positive & 15u));
            const unsigned* o = one_first[lonely];
            const std::uint32_t a = vertex(tetrahedron[o[0]], tetrahedron[o[1]]),
                                b = vertex(tetrahedron[o[0]], tetrahedron[o[2]]),
                                c = vertex(tetrahedron[o[0]], tetrahedron[o[3]]);
            // (a, b, c) faces away from the lonely point.
            if (count == 1)
                emit(a, c, b, component);
            else
                emit(a, b, c, component);
            return;
        }
        static constexpr unsigned pair_first[6][5] = {{3, 0, 1, 2, 3}, {5, 0, 2, 3, 1},  {9, 0, 3, 1, 2},
                                                      {6, 1, 2, 0, 3}, {10, 1, 3, 2, 0}, {12, 2, 3, 0, 1}};
        const auto* row = std::find_if(std::begin(pair_first), std::end(pair_first),
                                       [&](const unsigned(&r)[5]) { return r[0] == positive; });
        CERTA_ASSERT(row != std::end(pair_first));
        const std::uint32_t a = tetrahedron[(*row)[1]], b = tetrahedron[(*row)[2]], c = tetrahedron[(*row)[3]],
                            d = tetrahedron[(*row)[4]];
        // Around the quadrilateral so that it faces the positive pair (a, b).
        add_quadrilateral(vertex(a, c), vertex(b, c), vertex(b, d), vertex(a, d), component);
    }

    void add_quadrilateral(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d,
                           std::uint32_t component) {
        const auto& p = surface_.mesh.positions;
        if (distance(p[a], p[c]) <= distance(p[b], p[d])) {
            emit(a, b, c, component);
            emit(a, c, d, component);
        } else {
            emit(b, c, d, component);
            emit(b, d, a, component);
        }
    }

    void emit(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t component) {
        surface_.mesh.triangles.push_back({VertexId{a}, VertexId{b}, VertexId{c}});
        surface_.component_of_triangle.push_back(component);
    }

    std::uint32_t vertex(std::uint32_t a, std::uint32_t b) {
        if (a > b) std::swap(a, b);
        std::uint32_t id = vertices_.find(a, b);
        if (id != no_index) return id;
        id = static_cast<std::uint32_t>(surface_.mesh.positions.size());
        vertices_.set(a, b, id);
        surface_.vertex_edges.push_back({a, b});
        surface_.mesh.positions.push_back(place(tree_.points()[a], tree_.points()[b], t_.sign(a)));
        return id;
    }

    /// The point a + (b - a) k / 2^bits of the edge nearest to a sign change of f in doubles.
    Point3 place(const GridPoint& a, const GridPoint& b, int sign_at_a) {
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

    const Octree& tree_;
    const Triangulation& t_;
    const Findings& findings_;
    Field& field_;
    core::PairMap vertices_;
    Surface surface_;
};

}  // namespace

Surface build_surface(const Octree& tree, const Triangulation& triangulation, const Findings& findings, Field& field) {
    return Builder(tree, triangulation, findings, field).build();
}

}  // namespace certa::implicit
