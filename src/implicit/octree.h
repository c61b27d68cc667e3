#pragma once
// The octree and the points of its triangulation. Cells are split, never joined, so ids stay.
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "implicit/field.h"
#include "implicit/grid.h"

namespace certa::implicit {

inline constexpr std::uint32_t none = no_index;

struct Cell {
    GridPoint low{};
    std::uint32_t children = none;  ///< id of the first of eight; none for leaves
    std::int8_t depth = 0;
    Certainty known;
    bool is_leaf() const { return children == none; }
    /// f is not zero there and no slope is known: the only cells that may hold critical points of f.
    bool is_critical() const { return known.sign != 0 && known.slope == 0; }
    /// Some condition of regular leaves is met: f is not zero, or a slope is known.
    bool is_settled() const { return known.sign != 0 || known.slope != 0; }
};

/// Grid points by their coordinates.
class PointMap {
public:
    PointMap();
    /// The id of a point, or none.
    std::uint32_t find(const GridPoint& p) const;
    /// The id of a point, a new one if it had none.
    std::uint32_t insert(const GridPoint& p);
    std::size_t size() const { return points_.size(); }
    const GridPoint& operator[](std::uint32_t id) const { return points_[id]; }

private:
    /// A place of the table with its key: looking a point up touches one line of memory.
    struct Slot {
        GridPoint point{};
        std::uint32_t id = none;
    };
    std::size_t slot_of(const GridPoint& p) const;
    void grow();
    std::vector<GridPoint> points_;
    std::vector<Slot> slots_;
};

class Octree {
public:
    /// `clipped`: the surface may meet the boundary of the box (docs/implicit-theorem.md), else it may not.
    explicit Octree(const Grid& grid, bool clipped = false);

    const Grid& grid() const { return grid_; }
    bool is_clipped() const { return clipped_; }
    const std::vector<Cell>& cells() const { return cells_; }
    Cell& cell(std::uint32_t id) { return cells_[id]; }
    const Cell& cell(std::uint32_t id) const { return cells_[id]; }

    Coordinate size_of(const Cell& cell) const { return grid_.side() >> cell.depth; }
    int max_depth() const { return grid_.resolution() - 1; }
    GridPoint high_of(const Cell& cell) const;
    GridPoint center_of(const Cell& cell) const;
    Region region_of(const Cell& cell) const { return grid_.region(cell.low, high_of(cell)); }
    bool touches_boundary(const Cell& cell) const;

    /// Splits a leaf; children inherit what is known of it, and their corners become corners. Returns the first child.
    std::uint32_t split(std::uint32_t id);

    /// The leaf that has the unit cube above and beyond `p` on all axes.
    std::uint32_t leaf_at(const GridPoint& p) const;
    /// The leaf, or the cell of the same depth where that is split, across face `axis`, `side` (0 low, 1 high) of a
    /// cell; none outside the box.
    std::uint32_t across(const Cell& cell, int axis, int side) const;

    /// Calls visit(leaf) for the leaves in the eight octants around each corner of a leaf: some more than once, itself
    /// too.
    template <class Visit>
    void visit_around_corners(const Cell& leaf, const Visit& visit) const;
    /// Divides a square that faces `side` along `axis` until no centre is a corner, and calls visit(centre, ring) for
    /// each part: the points on its rim, counter-clockwise seen from outside. Every one of them must have an id.
    template <class Visit>
    void visit_squares(const GridPoint& low, int axis, int side, Coordinate size, const Visit& visit) const;

    /// All points that were ever given an id: corners of leaves, and centres that the triangulation uses.
    PointMap& points() { return points_; }
    const PointMap& points() const { return points_; }
    bool is_corner(std::uint32_t point) const { return point < is_corner_.size() && is_corner_[point] != 0; }
    bool is_corner(const GridPoint& p) const {
        const std::uint32_t id = points_.find(p);
        return id != none && is_corner(id);
    }
    bool on_boundary(const GridPoint& p) const;
    /// The faces of the box that hold a point: bit 2 a for the low one across axis a, bit 2 a + 1 for the high one.
    unsigned box_faces(const GridPoint& p) const;
    /// The axes whose derivatives may settle a leaf, a bit each: of a clipped box those along which a leaf may move
    /// without leaving the faces of the box that it touches, else all.
    unsigned free_axes(const Cell& cell) const;

    std::vector<std::uint32_t> leaves() const;

private:
    void add_corners(const Cell& cell);
    void append_edge(std::uint32_t a, std::uint32_t b, std::vector<std::uint32_t>& ring) const;
    Grid grid_;
    bool clipped_;
    std::vector<Cell> cells_;
    PointMap points_;
    std::vector<char> is_corner_;
};

template <class Visit>
void Octree::visit_around_corners(const Cell& leaf, const Visit& visit) const {
    const GridPoint high = high_of(leaf);
    for (unsigned k = 0; k < 64; ++k) {
        // The unit cube in one of the eight octants around one of the eight corners.
        GridPoint p{};
        bool inside = true;
        for (unsigned a = 0; a < 3; ++a) {
            p[a] = (k >> a) & 1u ? high[a] : leaf.low[a];
            const bool below = ((k >> (3 + a)) & 1u) == 0;
            inside = inside && p[a] != (below ? 0 : grid_.side());
            if (below) --p[a];
        }
        if (inside) visit(leaf_at(p));
    }
}

template <class Visit>
void Octree::visit_squares(const GridPoint& low, int axis, int side, Coordinate size, const Visit& visit) const {
    const auto u = static_cast<std::size_t>((axis + 1) % 3), v = static_cast<std::size_t>((axis + 2) % 3);
    GridPoint center = low;
    center[u] += size / 2;
    center[v] += size / 2;
    if (is_corner(center)) {
        for (unsigned q = 0; q < 4; ++q) {
            GridPoint corner = low;
            corner[u] += (q & 1u) * (size / 2);
            corner[v] += (q >> 1) * (size / 2);
            visit_squares(corner, axis, side, size / 2, visit);
        }
        return;
    }
    std::array<GridPoint, 4> corners{low, low, low, low};  // counter-clockwise around +axis
    corners[1][u] += size;
    corners[2][u] += size;
    corners[2][v] += size;
    corners[3][v] += size;
    if (side == 0) std::reverse(corners.begin(), corners.end());
    std::vector<std::uint32_t> ring;
    std::array<std::uint32_t, 4> ids{};
    for (std::size_t i = 0; i < 4; ++i) ids[i] = points_.find(corners[i]);
    for (std::size_t i = 0; i < 4; ++i) append_edge(ids[i], ids[(i + 1) % 4], ring);
    visit(center, ring);
}

}  // namespace certa::implicit
