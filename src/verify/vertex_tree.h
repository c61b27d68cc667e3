#pragma once
// A box hierarchy over the vertices of a mesh: which vertices are inside a region? Boxes are left out only when the
// region provably misses them, so nothing is lost to rounding.
#include <certa/types.h>

#include <array>
#include <cstdint>
#include <vector>

#include "verify/predicates.h"

namespace certa::verify {

class VertexTree {
public:
    explicit VertexTree(const std::vector<Point3>& positions);

    /// Calls visit(vertex, side) for every vertex inside the region (side 1) and, with `closed`, on its boundary
    /// (side 0), until it returns false. The order is fixed by the positions. Vertices in `corners`, known to be on the
    /// boundary, are not visited.
    template <class Region, std::size_t Count, class Visit>
    void visit(const Region& region, const std::array<std::uint32_t, Count>& corners, bool closed,
               const Visit& visit) const {
        if (nodes_.empty()) return;
        std::array<std::uint32_t, 64> stack;
        std::size_t top = 0;
        stack[top++] = 0;
        while (top > 0) {
            const Node& node = nodes_[stack[--top]];
            if (region.misses_box(node.low, node.high, closed)) continue;
            if (node.second == 0) {
                for (std::uint32_t i = node.begin; i < node.end; ++i) {
                    const std::uint32_t vertex = order_[i];
                    if (std::find(corners.begin(), corners.end(), vertex) != corners.end()) continue;
                    const int side = region.side(sorted_[i]);
                    if ((side > 0 || (closed && side == 0)) && !visit(vertex, side)) return;
                }
            } else {
                stack[top++] = node.second;
                stack[top++] = static_cast<std::uint32_t>(&node - nodes_.data()) + 1;
            }
        }
    }

private:
    struct Node {
        Point3 low, high;
        std::uint32_t begin = 0, end = 0;
        std::uint32_t second = 0;  // the second child, the first one follows; 0: leaf
    };
    std::uint32_t build(std::uint32_t begin, std::uint32_t end);

    const std::vector<Point3>& positions_;
    std::vector<std::uint32_t> order_;
    std::vector<Point3> sorted_;
    std::vector<Node> nodes_;
};

}  // namespace certa::verify
