// Free growth of W from the surface of sign changes, breadth first: a point that cannot join is tried again when a
// point of its link and sign has joined. The thesis's watershed (1.7.1) follows descending edges instead, which makes W
// about {|f| < c} and far larger near critical values; nothing in Lemma 51 needs that.
#include "implicit/growth.h"

#include <deque>

namespace certa::implicit {

std::uint32_t LinkTest::local(std::uint32_t point) {
    if (index_[point] == none) {
        index_[point] = static_cast<std::uint32_t>(link_.size());
        link_.push_back(point);
        parents_.push_back(index_[point]);
    }
    return index_[point];
}

std::uint32_t LinkTest::find(std::uint32_t i) {
    while (parents_[i] != i) i = parents_[i] = parents_[parents_[i]];
    return i;
}

bool LinkTest::may_join(const Triangulation& triangulation, const std::vector<char>& marked, std::uint32_t point) {
    link_.clear();
    parents_.clear();
    inside_.clear();
    const int sign = triangulation.sign(point);
    const auto is_inside = [&](std::uint32_t p) { return triangulation.sign(p) != sign || marked[p] != 0; };
    for (const std::uint32_t t : triangulation.around(point)) {
        std::array<std::uint32_t, 3> face{};
        std::size_t count = 0;
        for (const std::uint32_t p : triangulation.tetrahedra()[t]) {
            if (p != point) face[count++] = local(p);
        }
        while (inside_.size() < link_.size()) inside_.push_back(is_inside(link_[inside_.size()]) ? 1 : 0);
        // Points of the same kind on one edge of the link belong together.
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = face[i], b = face[(i + 1) % 3];
            if (inside_[a] == inside_[b]) parents_[find(a)] = find(b);
        }
    }
    int parts_inside = 0, parts_outside = 0;
    for (std::uint32_t i = 0; i < link_.size(); ++i) {
        index_[link_[i]] = none;
        if (parents_[i] == i) ++(inside_[i] ? parts_inside : parts_outside);
    }
    return parts_inside == 1 && parts_outside == 1;
}

Growth grow(const Triangulation& triangulation) {
    Growth growth;
    growth.marked.assign(triangulation.point_count(), 0);
    std::vector<char> queued(triangulation.point_count(), 0);
    std::deque<std::uint32_t> queue;
    const auto enqueue = [&](std::uint32_t point) {
        if (queued[point] || growth.marked[point] || !triangulation.may_join(point)) return;
        queued[point] = 1;
        queue.push_back(point);
    };
    for (const Triangulation::Tetrahedron& t : triangulation.tetrahedra()) {
        bool positive = false, negative = false;
        for (const std::uint32_t p : t) (triangulation.sign(p) > 0 ? positive : negative) = true;
        if (!positive || !negative) continue;
        for (const std::uint32_t p : t) enqueue(p);
    }
    LinkTest test(triangulation.point_count());
    while (!queue.empty()) {
        const std::uint32_t point = queue.front();
        queue.pop_front();
        queued[point] = 0;
        if (!test.may_join(triangulation, growth.marked, point)) continue;
        growth.marked[point] = 1;
        growth.order.push_back(point);
        for (const std::uint32_t p : test.link()) {
            if (triangulation.sign(p) == triangulation.sign(point)) enqueue(p);
        }
    }
    return growth;
}

}  // namespace certa::implicit
