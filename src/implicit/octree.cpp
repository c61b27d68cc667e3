// Octree by arrays of cells; a hash table of grid points that answers "is this point a corner of some leaf?", on which
// the triangulation rests: an edge or square of the octree is subdivided if and only if its midpoint is a corner.
#include "implicit/octree.h"

#include "core/assert.h"

namespace certa::implicit {

namespace {
/// Written out: comparing arrays calls memcmp.
bool same(const GridPoint& a, const GridPoint& b) { return a[0] == b[0] && a[1] == b[1] && a[2] == b[2]; }
}  // namespace

PointMap::PointMap() : slots_(1024) {}

std::size_t PointMap::slot_of(const GridPoint& p) const {
    std::uint64_t key = p[0] * 0x9e3779b97f4a7c15ull;
    key = (key ^ (key >> 29) ^ p[1]) * 0xbf58476d1ce4e5b9ull;
    key = (key ^ (key >> 31) ^ p[2]) * 0x94d049bb133111ebull;
    return static_cast<std::size_t>(key ^ (key >> 32)) & (slots_.size() - 1);
}

std::uint32_t PointMap::find(const GridPoint& p) const {
    for (std::size_t s = slot_of(p);; s = (s + 1) & (slots_.size() - 1)) {
        if (slots_[s].id == none || same(slots_[s].point, p)) return slots_[s].id;
    }
}

std::uint32_t PointMap::insert(const GridPoint& p) {
    if (2 * (points_.size() + 1) > slots_.size()) grow();
    std::size_t s = slot_of(p);
    while (slots_[s].id != none) {
        if (same(slots_[s].point, p)) return slots_[s].id;
        s = (s + 1) & (slots_.size() - 1);
    }
    slots_[s] = {p, static_cast<std::uint32_t>(points_.size())};
    points_.push_back(p);
    return slots_[s].id;
}

void PointMap::grow() {
    slots_.assign(2 * slots_.size(), Slot{});
    for (std::uint32_t id = 0; id < points_.size(); ++id) {
        std::size_t s = slot_of(points_[id]);
        while (slots_[s].id != none) s = (s + 1) & (slots_.size() - 1);
        slots_[s] = {points_[id], id};
    }
}

Octree::Octree(const Grid& grid, bool clipped) : grid_(grid), clipped_(clipped), cells_(1) {
    add_corners(cells_.front());
}

GridPoint Octree::high_of(const Cell& cell) const {
    const Coordinate size = size_of(cell);
    return {cell.low[0] + size, cell.low[1] + size, cell.low[2] + size};
}

GridPoint Octree::center_of(const Cell& cell) const {
    const Coordinate half = size_of(cell) / 2;
    return {cell.low[0] + half, cell.low[1] + half, cell.low[2] + half};
}

bool Octree::on_boundary(const GridPoint& p) const {
    for (const Coordinate c : p) {
        if (c == 0 || c == grid_.side()) return true;
    }
    return false;
}

unsigned Octree::box_faces(const GridPoint& p) const {
    unsigned faces = 0;
    for (unsigned a = 0; a < 3; ++a) faces |= (p[a] == 0 ? 1u : p[a] == grid_.side() ? 2u : 0u) << (2 * a);
    return faces;
}

unsigned Octree::free_axes(const Cell& cell) const {
    if (!clipped_) return 7;
    const unsigned faces = box_faces(cell.low) | box_faces(high_of(cell));
    unsigned axes = 0;
    for (unsigned a = 0; a < 3; ++a) axes |= ((faces >> (2 * a)) & 3u) == 0 ? 1u << a : 0u;
    return axes;
}

bool Octree::touches_boundary(const Cell& cell) const { return on_boundary(cell.low) || on_boundary(high_of(cell)); }

void Octree::add_corners(const Cell& cell) {
    const Coordinate size = size_of(cell);
    for (unsigned c = 0; c < 8; ++c) {
        const std::uint32_t id = points_.insert({cell.low[0] + (c & 1u) * size, cell.low[1] + ((c >> 1) & 1u) * size,
                                                 cell.low[2] + ((c >> 2) & 1u) * size});
        if (is_corner_.size() <= id) is_corner_.resize(points_.size(), 0);
        is_corner_[id] = 1;
    }
}

std::uint32_t Octree::split(std::uint32_t id) {
    CERTA_ASSERT(cells_[id].is_leaf() && cells_[id].depth < max_depth());
    const auto first = static_cast<std::uint32_t>(cells_.size());
    cells_[id].children = first;
    const Cell parent = cells_[id];
    const Coordinate half = size_of(parent) / 2;
    for (unsigned c = 0; c < 8; ++c) {
        Cell child;
        child.low = {parent.low[0] + (c & 1u) * half, parent.low[1] + ((c >> 1) & 1u) * half,
                     parent.low[2] + ((c >> 2) & 1u) * half};
        child.depth = static_cast<std::int8_t>(parent.depth + 1);
        child.known = parent.known;
        cells_.push_back(child);
        add_corners(child);
    }
    return first;
}

std::uint32_t Octree::leaf_at(const GridPoint& p) const {
    std::uint32_t id = 0;
    while (!cells_[id].is_leaf()) {
        const int shift = grid_.resolution() - cells_[id].depth - 1;
        const unsigned c = ((p[0] >> shift) & 1u) | (((p[1] >> shift) & 1u) << 1) | (((p[2] >> shift) & 1u) << 2);
        id = cells_[id].children + c;
    }
    return id;
}

std::uint32_t Octree::across(const Cell& cell, int axis, int side) const {
    GridPoint p = cell.low;
    const auto a = static_cast<std::size_t>(axis);
    const Coordinate size = size_of(cell);
    if (side == 0 ? p[a] == 0 : p[a] + size == grid_.side()) return none;
    p[a] = side == 0 ? p[a] - size : p[a] + size;
    std::uint32_t id = 0;
    while (!cells_[id].is_leaf() && cells_[id].depth < cell.depth) {
        const int shift = grid_.resolution() - cells_[id].depth - 1;
        const unsigned c = ((p[0] >> shift) & 1u) | (((p[1] >> shift) & 1u) << 1) | (((p[2] >> shift) & 1u) << 2);
        id = cells_[id].children + c;
    }
    return id;
}

/// The points of the edge from a to b, without b.
void Octree::append_edge(std::uint32_t a, std::uint32_t b, std::vector<std::uint32_t>& ring) const {
    CERTA_ASSERT(a != none && b != none);
    const GridPoint &p = points_[a], &q = points_[b];
    GridPoint middle;
    Coordinate length = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const Coordinate low = std::min(p[i], q[i]), high = std::max(p[i], q[i]);
        middle[i] = low + (high - low) / 2;
        length = std::max(length, high - low);
    }
    const std::uint32_t m = length < 2 ? none : points_.find(middle);
    if (m == none || !is_corner(m)) {
        ring.push_back(a);
        return;
    }
    append_edge(a, m, ring);
    append_edge(m, b, ring);
}

std::vector<std::uint32_t> Octree::leaves() const {
    std::vector<std::uint32_t> result;
    for (std::uint32_t id = 0; id < cells_.size(); ++id) {
        if (cells_[id].is_leaf()) result.push_back(id);
    }
    return result;
}

}  // namespace certa::implicit
