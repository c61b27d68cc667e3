// Building T around the open leaves (docs/implicit-theorem.md, "triangulation").
//
// Plan: mark as active every leaf that shares a point with an open one; cone their squares and cells; settle the signs
// of their points; say which points may join W; index the tetrahedra around those.
#include "implicit/triangulation.h"

#include <algorithm>

#include "core/assert.h"

namespace certa::implicit {

Triangulation::Triangulation(Octree& tree, Field& field, std::vector<PointSign>& signs, bool whole) : whole_(whole) {
    choose_active(tree);
    is_new_.assign(active_.size(), 1);
    build_rest(tree, field, signs, nullptr);
}

Triangulation::Triangulation(Octree& tree, Field& field, std::vector<PointSign>& signs, const Triangulation& previous,
                             std::span<const std::uint32_t> split)
    : whole_(previous.whole_) {
    inherit_active(tree, previous, split);
    sign_ = previous.sign_;
    build_rest(tree, field, signs, &previous);
}

void Triangulation::build_rest(Octree& tree, Field& field, std::vector<PointSign>& signs,
                               const Triangulation* previous) {
    offsets_.push_back(0);
    if (previous) tetrahedra_.reserve(previous->tetrahedra_.size() + previous->tetrahedra_.size() / 4);
    std::size_t before = 0;  // both lists of active leaves are sorted
    for (std::uint32_t i = 0; i < active_.size(); ++i) {
        if (is_new_[i]) {
            build_leaf(tree, active_[i]);
        } else {
            while (previous->active_[before] != active_[i]) ++before;
            const auto kept = previous->tetrahedra_of(before);
            tetrahedra_.insert(tetrahedra_.end(), kept.begin(), kept.end());
        }
        offsets_.push_back(static_cast<std::uint32_t>(tetrahedra_.size()));
        leaf_of_.resize(tetrahedra_.size(), i);
    }
    settle_signs(tree, field, signs);
    choose_candidates(tree);
    note_changes();
    index_stars();
}

/// New leaves, and old ones that hold a new corner: there an edge or a square is subdivided now.
void Triangulation::inherit_active(const Octree& tree, const Triangulation& previous,
                                   std::span<const std::uint32_t> split) {
    is_active_ = previous.is_active_;
    is_active_.resize(tree.cells().size(), 0);
    std::vector<char> dirty(tree.cells().size(), 0);
    const Coordinate side = tree.grid().side();
    for (const std::uint32_t parent : split) {
        const Cell& cell = tree.cell(parent);
        for (std::uint32_t c = 0; c < 8; ++c) {
            is_active_[cell.children + c] = previous.is_active_[parent];
            dirty[cell.children + c] = 1;
        }
        is_active_[parent] = 0;
        const Coordinate half = tree.size_of(cell) / 2;
        for (std::uint32_t corner = 0; corner < 27; ++corner) {
            const std::uint32_t steps[3] = {corner % 3, corner / 3 % 3, corner / 9};
            if (steps[0] != 1 && steps[1] != 1 && steps[2] != 1) continue;  // a corner of the parent
            for (unsigned octant = 0; octant < 8; ++octant) {
                GridPoint p;
                bool inside = true;
                for (std::size_t a = 0; a < 3; ++a) {
                    p[a] = cell.low[a] + steps[a] * half;
                    const bool below = ((octant >> a) & 1u) == 0;
                    if (below ? p[a] == 0 : p[a] == side) inside = false;
                    if (below) --p[a];
                }
                if (inside) dirty[tree.leaf_at(p)] = 1;
            }
        }
    }
    for (std::uint32_t leaf = 0; leaf < is_active_.size(); ++leaf) {
        if (!is_active_[leaf]) continue;
        active_.push_back(leaf);
        is_new_.push_back(dirty[leaf]);
    }
}

/// Two leaves share a point exactly when the smaller one's closure has a corner on the larger one's: so the leaves
/// around an open leaf are those that hold a unit cube next to one of its corners, and those one of whose corners is on
/// its surface. Both are found by collecting, for every leaf, the leaves around each of its corners.
void Triangulation::choose_active(Octree& tree) {
    const std::vector<std::uint32_t> leaves = tree.leaves();
    is_active_.assign(tree.cells().size(), 0);
    if (whole_) {
        for (const std::uint32_t leaf : leaves) is_active_[leaf] = 1;
        active_ = leaves;
        return;
    }
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
        tree.visit_squares(low, face / 2, face % 2, size, [&](const GridPoint& center, const auto& ring) {
            const std::uint32_t middle = tree.points().insert(center);
            for (std::size_t i = 0; i < ring.size(); ++i)
                tetrahedra_.push_back({apex, middle, ring[i], ring[(i + 1) % ring.size()]});
        });
    }
}

void Triangulation::settle_signs(const Octree& tree, Field& field, std::vector<PointSign>& signs) {
    signs.resize(tree.points().size());
    sign_.resize(tree.points().size(), 0);
    for (std::size_t i = 0; i < active_.size(); ++i) {
        if (!is_new_[i]) continue;
        const int proved = tree.cell(active_[i]).known.sign;
        for (const Tetrahedron& t : tetrahedra_of(i)) {
            for (const std::uint32_t point : t) settle_sign(tree, field, proved, point, signs[point]);
        }
    }
    for (std::size_t i = 0; i < active_.size(); ++i) {
        if (!is_new_[i]) continue;
        for (const Tetrahedron& t : tetrahedra_of(i)) {
            for (const std::uint32_t point : t) {
                turned_ = turned_ || (sign_[point] != 0 && sign_[point] != signs[point].sign);
                sign_[point] = signs[point].sign;
            }
        }
    }
}

void Triangulation::settle_sign(const Octree& tree, Field& field, int proved, std::uint32_t point, PointSign& known) {
    if (proved != 0) {
        CERTA_ASSERT(!known.proved || known.sign == proved);
        known = {static_cast<std::int8_t>(proved), true};
    } else if (known.sign == 0) {
        const GridPoint& p = tree.points()[point];
        const int certain = field.sign_on(tree.grid().region(p, p));
        const double value = certain == 0 ? field.value(tree.grid().place(p)) : certain;
        known = {static_cast<std::int8_t>(value < 0 ? -1 : 1), certain != 0};
    }
}

/// Where a sign turned, neighbours that lie in old leaves change too: that is rare, so everything is taken as changed.
void Triangulation::note_changes() {
    changed_.assign(point_count(), turned_ ? 1 : 0);
    for (std::size_t i = 0; i < active_.size(); ++i) {
        if (!is_new_[i]) continue;
        for (const Tetrahedron& t : tetrahedra_of(i)) {
            for (const std::uint32_t point : t) changed_[point] = 1;
        }
    }
}

void Triangulation::choose_candidates(const Octree& tree) {
    may_join_.assign(point_count(), 0);
    for (std::size_t i = 0; i < active_.size(); ++i) {
        if (tree.cell(active_[i]).known.sign != 0 && !whole_) continue;
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
