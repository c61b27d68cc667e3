#pragma once
// A tree of axis-aligned boxes that answers which pairs of boxes overlap, and which boxes overlap a given one.
#include <certa/types.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace certa::conforming {

struct Box {
    Point3 low, high;
    bool overlaps(const Box& b) const {
        return low.x <= b.high.x && b.low.x <= high.x && low.y <= b.high.y && b.low.y <= high.y && low.z <= b.high.z &&
               b.low.z <= high.z;
    }
    void extend(const Box& b) {
        low = {std::min(low.x, b.low.x), std::min(low.y, b.low.y), std::min(low.z, b.low.z)};
        high = {std::max(high.x, b.high.x), std::max(high.y, b.high.y), std::max(high.z, b.high.z)};
    }
};

/// Immutable; queries may run in parallel. Built by halving along the longest axis, O(n log n), in parallel.
class BoxTree {
public:
    /// `active` has one entry per box: pairs of two inactive boxes are never visited. Empty: all are active.
    BoxTree(std::span<const Box> boxes, std::span<const std::uint8_t> active);

    std::size_t leaf_count() const { return leaves_.size(); }

    /// visit(i, j) for every overlapping pair of different boxes whose first member is in leaf `leaf`; over all leaves
    /// every pair comes once, in either order of its members.
    template <class Visit>
    void visit_pairs(std::size_t leaf, Visit&& visit) const {
        const Node& own = nodes_[leaves_[leaf]];
        for (std::uint32_t i = own.begin; i < own.end; ++i) {
            for (std::uint32_t j = i + 1; j < own.end; ++j) visit_pair(i, j, visit);
        }
        descend([&](const Node& n) { return n.end > own.end && (n.active || own.active) && n.box.overlaps(own.box); },
                [&](const Node& n) {
                    for (std::uint32_t i = own.begin; i < own.end; ++i) {
                        if (!boxes_[i].overlaps(n.box)) continue;
                        for (std::uint32_t j = n.begin; j < n.end; ++j) visit_pair(i, j, visit);
                    }
                });
    }

    /// visit(i) for every box that overlaps `box`.
    template <class Visit>
    void visit_overlapping(const Box& box, Visit&& visit) const {
        descend([&](const Node& n) { return n.box.overlaps(box); },
                [&](const Node& n) {
                    for (std::uint32_t i = n.begin; i < n.end; ++i) {
                        if (boxes_[i].overlaps(box)) visit(order_[i]);
                    }
                });
    }

private:
    /// In preorder: the left child follows its parent. Leaves have right == 0.
    struct Node {
        Box box;
        std::uint32_t begin = 0, end = 0, right = 0;
        bool active = false;
    };

    template <class Visit>
    void visit_pair(std::uint32_t i, std::uint32_t j, Visit& visit) const {
        if ((active_[i] | active_[j]) != 0 && boxes_[i].overlaps(boxes_[j])) visit(order_[i], order_[j]);
    }

    template <class Enter, class Leaf>
    void descend(Enter&& enter, Leaf&& at_leaf) const {
        if (nodes_.empty()) return;
        std::uint32_t stack[64];
        int size = 0;
        stack[size++] = 0;
        while (size > 0) {
            const std::uint32_t index = stack[--size];
            const Node& node = nodes_[index];
            if (!enter(node)) continue;
            if (node.right == 0) {
                at_leaf(node);
            } else {
                stack[size++] = node.right;
                stack[size++] = index + 1;
            }
        }
    }

    void build(std::uint32_t index, std::uint32_t begin, std::uint32_t end, std::span<const Box> boxes);

    std::vector<std::uint32_t> order_;
    std::vector<Box> boxes_;  // in tree order
    std::vector<std::uint8_t> active_;
    std::vector<Node> nodes_;
    std::vector<std::uint32_t> leaves_;
};

}  // namespace certa::conforming
