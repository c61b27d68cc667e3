// Faces of the tetrahedra of W that occur once, in a hierarchy of boxes. (W may also have triangles without tetrahedra;
// a mesh may pass through those: docs/implicit-theorem.md, "any mesh".)
#include "implicit/frontier.h"

#include <algorithm>
#include <numeric>

namespace certa::implicit {

Frontier::Frontier(const Octree& tree, const Triangulation& triangulation, const Growth& growth) {
    struct Face {
        std::array<std::uint32_t, 3> points;
        std::uint32_t leaf;
    };
    std::vector<Face> faces;
    for (std::size_t k = 0; k < triangulation.tetrahedra().size(); ++k) {
        const auto& t = triangulation.tetrahedra()[k];
        if (!std::all_of(t.begin(), t.end(), [&](std::uint32_t p) { return growth.marked[p] != 0; })) continue;
        for (std::size_t i = 0; i < 4; ++i) {
            Face face{{t[(i + 1) % 4], t[(i + 2) % 4], t[(i + 3) % 4]},
                      triangulation.active_leaves()[triangulation.leaf_of(k)]};
            std::sort(face.points.begin(), face.points.end());
            faces.push_back(face);
        }
    }
    std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) {
        return a.points != b.points ? a.points < b.points : a.leaf < b.leaf;
    });
    const auto place = [&](std::uint32_t p) { return tree.grid().place(tree.points()[p]); };
    for (std::size_t i = 0; i < faces.size();) {
        std::size_t end = i;
        while (end < faces.size() && faces[end].points == faces[i].points) ++end;
        if (end - i == 1) {
            faces_.push_back({place(faces[i].points[0]), place(faces[i].points[1]), place(faces[i].points[2])});
            leaves_.push_back(faces[i].leaf);
            boxes_.push_back(Bounds::of(faces_.back()));
        }
        i = end;
    }
    order_.resize(faces_.size());
    std::iota(order_.begin(), order_.end(), 0u);
    if (!faces_.empty()) build(0, static_cast<std::uint32_t>(faces_.size()));
}

void Frontier::build(std::uint32_t begin, std::uint32_t end) {
    Bounds box = boxes_[order_[begin]];
    for (std::uint32_t i = begin + 1; i < end; ++i) {
        const Bounds& o = boxes_[order_[i]];
        box.low = {std::min(box.low.x, o.low.x), std::min(box.low.y, o.low.y), std::min(box.low.z, o.low.z)};
        box.high = {std::max(box.high.x, o.high.x), std::max(box.high.y, o.high.y), std::max(box.high.z, o.high.z)};
    }
    const std::size_t id = nodes_.size();
    nodes_.push_back({box, begin, end, 0});
    if (end - begin <= 4) return;
    const double sides[3] = {box.high.x - box.low.x, box.high.y - box.low.y, box.high.z - box.low.z};
    const auto axis = std::max_element(sides, sides + 3) - sides;
    const auto middle = [&](std::uint32_t i) {
        const Bounds& b = boxes_[i];
        return axis == 0 ? b.low.x + b.high.x : axis == 1 ? b.low.y + b.high.y : b.low.z + b.high.z;
    };
    const std::uint32_t half = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + half, order_.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b) {
                         const double x = middle(a), y = middle(b);
                         return x != y ? x < y : a < b;
                     });
    build(begin, half);
    nodes_[id].second = static_cast<std::uint32_t>(nodes_.size());
    build(half, end);
}

template <class Visit>
void Frontier::visit(const Bounds& box, const Visit& visit) const {
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

bool Frontier::is_clear(const Corners& t) const {
    bool clear = true;
    visit(Bounds::of(t), [&](std::uint32_t face) {
        clear = triangles_apart(t, faces_[face]);
        return clear;
    });
    return clear;
}

void Frontier::find_leaves(const Corners& t, std::vector<std::uint32_t>& leaves) const {
    visit(Bounds::of(t), [&](std::uint32_t face) {
        if (!triangles_apart(t, faces_[face])) leaves.push_back(leaves_[face]);
        return true;
    });
}

}  // namespace certa::implicit
