#pragma once
// The octree and the points of its triangulation. Cells are split, never joined, so ids stay.
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
    std::size_t slot_of(const GridPoint& p) const;
    void grow();
    std::vector<GridPoint> points_;
    std::vector<std::uint32_t> slots_;
};

class Octree {
public:
    /// `clipped`: the surface may meet the boundary of the box (docs/implicit-clip.md), else it may not.
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
    Grid grid_;
    bool clipped_;
    std::vector<Cell> cells_;
    PointMap points_;
    std::vector<char> is_corner_;
};

}  // namespace certa::implicit
