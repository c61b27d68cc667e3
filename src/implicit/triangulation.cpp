// Building T around the open leaves (docs/implicit-theorem.md, "triangulation").
//
// Plan: mark as active every leaf that shares a point with an open one; cone their squares and cells; settle the signs
// of their points; say which points may join W; index the tetrahedra around those.
#include "implicit/triangulation.h"

#include <algorithm>

#include "core/assert.h"

namespace certa::implicit {

Triangulation::Triangulation(Octree& tree, Field& field, std::vector<PointSign>& signs) {
    choose_active(tree);
    offsets_.push_back(0);
    for (std::uint32_t i = 0; i < active_.size(); ++i) {
        build_leaf(tree, active_[i]);
        offsets_.push_back(static_cast<std::uint32_t>(tetrahedra_.size()));
        leaf_of_.resize(tetrahedra_.size(), i);
    }
    settle_signs(tree, field, signs);
    choose_candidates(tree);
    index_stars();
}

/// Two leaves share a point exactly when the smaller one's closure has a corner on the larger one's: so the leaves
/// around an open leaf are those that hold a unit cube next to one of its corners, and those one of whose corners is on
/// its surface. Both are found by collecting, for every leaf, the leaves around each of its corners.
void Triangulation::choose_active(Octree& tree) {
    is_active_.assign(tree.cells().size(), 0);
    const std::vector<std::uint32_t> leaves = tree.leaves();
    const Coordinate side = tree.grid().side();
    for (const std::uint32_t leaf : leaves) {
        const Cell& cell = tree.cell(leaf);
        const bool open = cell.known.sign == 0;
        if (open) is_active_[leaf] = 1;
        const GridPoint high = tree.high_of(cell);
        for (unsigned c = 0; c < 8; ++c) {
            const GridPoint corner{(c & 1u) ? high[0] : cell.low[0], (c & 2u) ? high[1] : cell.low[1],
                                   (c & 4u) ? high[2] : cell.low[2]};
            for (unsigned octant = 0; octant < 8; ++octant) {
                if (octant == 7 - c) continue;  // the leaf itself
                GridPoint p = corner;
                bool inside = true;
                for (unsigned a = 0; a < 3; ++a) {
                    const bool below = ((octant >> a) & 1u) == 0;
                    if (below ? p[a] == 0 : p[a] == side) inside = false;
                    if (below) --p[a];
                }
                if (!inside) continue;
                const std::uint32_t other = tree.leaf_at(p);
                if (open) is_active_[other] = 1;
                if (tree.cell(other).known.sign == 0) is_active_[leaf] = 1;
            }
        }
    }
    for (const std::uint32_t leaf : leaves) {
        if (is_active_[leaf]) active_.push_back(leaf);
    }
}

void Triangulation::build_leaf(Octree& tree, std::uint32_t leaf) {
    const Cell cell = tree.cell(leaf);
    const std::uint32_t apex = tree.points().insert(tree.center_of(cell));
    const Coordinate size = tree.size_of(cell);
    for (int face = 0; face < 6; ++face) {
        GridPoint low = cell.low;
        if (face % 2 == 1) low[static_cast<std::size_t>(face / 2)] += size;
        build_square(tree, low, face / 2, face % 2, size, apex);
    }
}

void Triangulation::build_square(Octree& tree, const GridPoint& low, int axis, int side, Coordinate size,
                                 std::uint32_t apex) {
    const auto u = static_cast<std::size_t>((axis + 1) % 3), v = static_cast<std::size_t>((axis + 2) % 3);
    GridPoint center = low;
    center[u] += size / 2;
    center[v] += size / 2;
    if (tree.is_corner(center)) {
        for (unsigned q = 0; q < 4; ++q) {
            GridPoint corner = low;
            corner[u] += (q & 1u) * (size / 2);
            corner[v] += (q >> 1) * (size / 2);
            build_square(tree, corner, axis, side, size / 2, apex);
        }
        return;
    }
    const std::uint32_t middle = tree.points().insert(center);
    std::array<GridPoint, 4> corners{low, low, low, low};  // counter-clockwise around +axis
    corners[1][u] += size;
    corners[2][u] += size;
    corners[2][v] += size;
    corners[3][v] += size;
    if (side == 0) std::reverse(corners.begin(), corners.end());
    std::vector<std::uint32_t> ring;
    for (std::size_t i = 0; i < 4; ++i)
        append_edge(tree, tree.points().find(corners[i]), tree.points().find(corners[(i + 1) % 4]), ring);
    for (std::size_t i = 0; i < ring.size(); ++i)
        tetrahedra_.push_back({apex, middle, ring[i], ring[(i + 1) % ring.size()]});
}

/// The points of the edge from a to b, without b.
void Triangulation::append_edge(const Octree& tree, std::uint32_t a, std::uint32_t b,
                                std::vector<std::uint32_t>& ring) const {
    CERTA_ASSERT(a != none && b != none);
    const GridPoint &p = tree.points()[a], &q = tree.points()[b];
    GridPoint middle;
    Coordinate length = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const Coordinate low = std::min(p[i], q[i]), high = std::max(p[i], q[i]);
        middle[i] = low + (high - low) / 2;
        length = std::max(length, high - low);
    }
    const std::uint32_t m = length < 2 ? none : tree.points().find(middle);
    if (m == none || !tree.is_corner(m)) {
        ring.push_back(a);
        return;
    }
    append_edge(tree, a, m, ring);
    append_edge(tree, m, b, ring);
}

void Triangulation::settle_signs(const Octree& tree, Field& field, std::vector<PointSign>& signs) {
    signs.resize(tree.points().size());
    sign_.assign(tree.points().size(), 0);
    for (std::size_t i = 0; i < active_.size(); ++i) {
        const int proved = tree.cell(active_[i]).known.sign;
        for (const Tetrahedron& t : tetrahedra_of(i)) {
            for (const std::uint32_t point : t) {
                if (proved != 0) {
                    CERTA_ASSERT(!signs[point].proved || signs[point].sign == proved);
                    signs[point] = {static_cast<std::int8_t>(proved), true};
                } else if (signs[point].sign == 0) {
                    const GridPoint& p = tree.points()[point];
                    const int certain = field.sign_on(tree.grid().region(p, p));
                    const double value = certain == 0 ? field.value(tree.grid().place(p)) : certain;
                    signs[point] = {static_cast<std::int8_t>(value < 0 ? -1 : 1), certain != 0};
                }
            }
        }
    }
    for (const Tetrahedron& t : tetrahedra_) {
        for (const std::uint32_t point : t) sign_[point] = signs[point].sign;
    }
}

void Triangulation::choose_candidates(const Octree& tree) {
    may_join_.assign(point_count(), 0);
    for (std::size_t i = 0; i < active_.size(); ++i) {
        if (tree.cell(active_[i]).known.sign != 0) continue;
        for (const Tetrahedron& t : tetrahedra_of(i)) {
            for (const std::uint32_t point : t)
                may_join_[point] = tree.is_clipped() || !tree.on_boundary(tree.points()[point]) ? 1 : 0;
        }
    }
    for (std::size_t i = 0; i < active_.size(); ++i) {
        if (!tree.cell(active_[i]).is_critical()) continue;
        for (const Tetrahedron& t : tetrahedra_of(i)) {
            for (const std::uint32_t point : t) may_join_[point] = 0;
        }
    }
    if (!tree.is_clipped()) return;
    box_faces_.resize(point_count());
    for (std::uint32_t point = 0; point < point_count(); ++point)
        box_faces_[point] = static_cast<std::uint8_t>(tree.box_faces(tree.points()[point]));
}

void Triangulation::index_stars() {
    around_offsets_.assign(point_count() + 1, 0);
    for (const Tetrahedron& t : tetrahedra_) {
        for (const std::uint32_t point : t) around_offsets_[point + 1] += may_join_[point] ? 1 : 0;
    }
    for (std::size_t i = 0; i < point_count(); ++i) around_offsets_[i + 1] += around_offsets_[i];
    around_.resize(around_offsets_.back());
    std::vector<std::uint32_t> next(around_offsets_.begin(), around_offsets_.end() - 1);
    for (std::uint32_t k = 0; k < tetrahedra_.size(); ++k) {
        for (const std::uint32_t point : tetrahedra_[k]) {
            if (may_join_[point]) around_[next[point]++] = k;
        }
    }
}

}  // namespace certa::implicit
