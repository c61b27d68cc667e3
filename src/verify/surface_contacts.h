#pragma once
// Exact contacts between triangles, and a box hierarchy to find candidates.
#include <certa/types.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace certa::verify {

using Corners = std::array<Point3, 3>;

bool is_degenerate(const Corners& t);
/// Whether the closed segment and the closed triangle, not degenerate, share a point.
bool segment_meets(const Point3& p, const Point3& q, const Corners& t);
/// Whether two closed triangles, not degenerate, share a point.
bool triangles_meet(const Corners& s, const Corners& t);
/// Whether triangles with a common corner s[0] = t[0] share another point.
bool meet_beyond_corner(const Corners& s, const Corners& t);
/// Whether triangles with the common edge s[0] s[1] = t[0] t[1] share a point off it.
bool meet_beyond_edge(const Corners& s, const Corners& t);

/// Whether two triangles of a mesh, not degenerate, share a point beyond their common corners. One face twice does.
bool meet_beyond_shared(const std::vector<Point3>& positions, std::array<std::uint32_t, 3> s,
                        std::array<std::uint32_t, 3> t);

/// How a segment crosses a triangle: +1 leaving through the side its normal points to, -1 the other way, 0 not at all;
/// 2: through an edge or a corner, along it, or ending on it.
int crossing(const Point3& from, const Point3& to, const Corners& t);

struct BoundingBox {
    Point3 low, high;
    static BoundingBox of(const Point3& a, const Point3& b) {
        return {{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)},
                {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}};
    }
    static BoundingBox of(const Corners& t) {
        BoundingBox box = of(t[0], t[1]);
        box.add(of(t[2], t[2]));
        return box;
    }
    void add(const BoundingBox& o) {
        low = {std::min(low.x, o.low.x), std::min(low.y, o.low.y), std::min(low.z, o.low.z)};
        high = {std::max(high.x, o.high.x), std::max(high.y, o.high.y), std::max(high.z, o.high.z)};
    }
    bool meets(const BoundingBox& o) const {
        return low.x <= o.high.x && o.low.x <= high.x && low.y <= o.high.y && o.low.y <= high.y && low.z <= o.high.z &&
               o.low.z <= high.z;
    }
};

/// Boxes of things by number.
class BoxTree {
public:
    explicit BoxTree(std::vector<BoundingBox> boxes);
    /// Calls visit(number) for everything whose box meets the given one, in a fixed order, until it returns false.
    template <class Visit>
    void visit(const BoundingBox& box, const Visit& visit) const {
        if (nodes_.empty()) return;
        std::array<std::uint32_t, 64> stack;
        std::size_t top = 0;
        stack[top++] = 0;
        while (top > 0) {
            const std::uint32_t at = stack[--top];
            const Node& node = nodes_[at];
            if (!node.box.meets(box)) continue;
            if (node.second == 0) {
                for (std::uint32_t i = node.begin; i < node.end; ++i) {
                    if (boxes_[order_[i]].meets(box) && !visit(order_[i])) return;
                }
            } else {
                stack[top++] = node.second;
                stack[top++] = at + 1;
            }
        }
    }

private:
    struct Node {
        BoundingBox box;
        std::uint32_t begin = 0, end = 0, second = 0;  ///< the first child follows; second 0: a leaf
    };
    std::uint32_t build(std::uint32_t begin, std::uint32_t end);
    std::vector<BoundingBox> boxes_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
};

}  // namespace certa::verify
