// Builds the box hierarchy by halving along the longest axis, ties broken by index: the depth is at most 32, which the
// fixed stack of the traversal relies on.
#include "verify/vertex_tree.h"

#include <algorithm>
#include <numeric>

namespace certa::verify {
namespace {

constexpr std::uint32_t leaf_size = 8;

double coordinate(const Point3& p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

}  // namespace

VertexTree::VertexTree(const std::vector<Point3>& positions) : positions_(positions) {
    order_.resize(positions.size());
    std::iota(order_.begin(), order_.end(), 0u);
    if (positions.empty()) return;
    nodes_.reserve(2 * positions.size() / (leaf_size / 2) + 1);
    build(0, static_cast<std::uint32_t>(positions.size()));
    sorted_.reserve(order_.size());
    for (const std::uint32_t v : order_) sorted_.push_back(positions[v]);
}

std::uint32_t VertexTree::build(std::uint32_t begin, std::uint32_t end) {
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back();
    Point3 low = positions_[order_[begin]], high = low;
    for (std::uint32_t i = begin + 1; i < end; ++i) {
        const Point3& p = positions_[order_[i]];
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    std::uint32_t second = 0;
    if (end - begin > leaf_size) {
        // Halves, so that a box of 1e300 does not overflow.
        const Point3 size{high.x / 2 - low.x / 2, high.y / 2 - low.y / 2, high.z / 2 - low.z / 2};
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const std::uint32_t middle = begin + (end - begin) / 2;
        std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                         [&](std::uint32_t a, std::uint32_t b) {
                             const double ca = coordinate(positions_[a], axis), cb = coordinate(positions_[b], axis);
                             return ca != cb ? ca < cb : a < b;
                         });
        build(begin, middle);
        second = build(middle, end);
    }
    nodes_[index] = {low, high, begin, end, second};
    return index;
}

}  // namespace certa::verify
