// Builds the box tree: boxes are halved by the median of their centres along the longest axis until eight are left.
// Halving by count makes the shape of the tree a function of the number of boxes alone, so subtrees know their place in
// the array of nodes beforehand and are built in parallel without any effect on the result.
#include "conforming/validate_boxes.h"

#include <numeric>

#include "core/parallel.h"

namespace certa::conforming {
namespace {

constexpr std::uint32_t leaf_size = 8;

std::uint32_t node_count(std::uint32_t boxes) {
    if (boxes <= leaf_size) return 1;
    const std::uint32_t left = boxes / 2;
    return 1 + node_count(left) + node_count(boxes - left);
}

double centre(const Box& box, int axis) {
    return axis == 0 ? box.low.x + box.high.x : axis == 1 ? box.low.y + box.high.y : box.low.z + box.high.z;
}

}  // namespace

BoxTree::BoxTree(std::span<const Box> boxes, std::span<const std::uint8_t> active) {
    const auto count = static_cast<std::uint32_t>(boxes.size());
    if (count == 0) return;
    order_.resize(count);
    std::iota(order_.begin(), order_.end(), 0u);
    active_.assign(count, 1);
    if (!active.empty()) active_.assign(active.begin(), active.end());
    boxes_.resize(count);
    nodes_.resize(node_count(count));
    build(0, 0, count, boxes);
    std::vector<std::uint8_t> in_order(count);
    for (std::uint32_t i = 0; i < count; ++i) in_order[i] = active_[order_[i]];
    active_ = std::move(in_order);
    for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
        if (nodes_[i].right == 0) leaves_.push_back(i);
    }
}

void BoxTree::build(std::uint32_t index, std::uint32_t begin, std::uint32_t end, std::span<const Box> boxes) {
    Node& node = nodes_[index];
    node.begin = begin;
    node.end = end;
    if (end - begin <= leaf_size) {
        node.box = boxes[order_[begin]];
        for (std::uint32_t i = begin; i < end; ++i) {
            boxes_[i] = boxes[order_[i]];
            node.box.extend(boxes_[i]);
            node.active = node.active || active_[order_[i]] != 0;
        }
        return;
    }
    double low[3], high[3];
    for (int axis = 0; axis < 3; ++axis) low[axis] = high[axis] = centre(boxes[order_[begin]], axis);
    for (std::uint32_t i = begin; i < end; ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], centre(boxes[order_[i]], axis));
            high[axis] = std::max(high[axis], centre(boxes[order_[i]], axis));
        }
    }
    int longest = 0;
    for (int axis = 1; axis < 3; ++axis) {
        if (high[axis] - low[axis] > high[longest] - low[longest]) longest = axis;
    }
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b) {
                         const double ca = centre(boxes[a], longest), cb = centre(boxes[b], longest);
                         return ca != cb ? ca < cb : a < b;
                     });
    node.right = index + 1 + node_count(middle - begin);
    const std::uint32_t right = node.right;
    const auto build_left = [&] { build(index + 1, begin, middle, boxes); };
    const auto build_right = [&] { build(right, middle, end, boxes); };
    if (end - begin > 4096) {
        core::parallel_invoke(build_left, build_right);
    } else {
        build_left();
        build_right();
    }
    node.box = nodes_[index + 1].box;
    node.box.extend(nodes_[right].box);
    node.active = nodes_[index + 1].active || nodes_[right].active;
}

}  // namespace certa::conforming
