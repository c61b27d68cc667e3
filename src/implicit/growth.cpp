// Free growth of W from the surface of sign changes, breadth first: a point that cannot join is tried again when a
// point of its link and sign has joined. The thesis's watershed (1.7.1) follows descending edges instead, which makes W
// about {|f| < c} and far larger near critical values; nothing in Lemma 51 needs that.
#include "implicit/growth.h"

#include <bit>
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
    const bool closed = triangulation.box_faces(point) == 0 || close_rim(triangulation, point);
    int parts_inside = 0, parts_outside = 0;
    for (std::uint32_t i = 0; i < link_.size(); ++i) {
        index_[link_[i]] = none;
        if (parents_[i] == i) ++(inside_[i] ? parts_inside : parts_outside);
    }
    return closed && parts_inside == 1 && parts_outside == 1;
}

/// Unites the points of the rim that are outside, as the cone over it does, and says whether the rim changes kind as
/// often as it must: twice in the face of the box, or once in each of the two faces at an edge of the box.
bool LinkTest::close_rim(const Triangulation& triangulation, std::uint32_t point) {
    const unsigned faces = triangulation.box_faces(point);
    const int count = std::popcount(faces);
    if (count == 3) return false;
    std::uint32_t outside = none;
    std::array<int, 6> changes{};
    for (const std::uint32_t t : triangulation.around(point)) {
        const auto& tetrahedron = triangulation.tetrahedra()[t];
        for (std::size_t i = 0; i < 4; ++i) {
            const unsigned common = triangulation.box_faces(tetrahedron[i]) & faces;
            if (common == 0 || tetrahedron[i] == point) continue;
            const std::uint32_t a = index_[tetrahedron[i]];
            if (!inside_[a]) {
                if (outside != none) parents_[find(a)] = find(outside);
                outside = a;
            }
            for (std::size_t j = i + 1; j < 4; ++j) {
                if (tetrahedron[j] == point || inside_[a] == inside_[index_[tetrahedron[j]]]) continue;
                const unsigned shared = common & triangulation.box_faces(tetrahedron[j]);
                for (unsigned face = 0; face < 6; ++face) changes[face] += (shared >> face) & 1u;
            }
        }
    }
    for (unsigned face = 0; face < 6; ++face) {
        if (((faces >> face) & 1u) != 0 && changes[face] != (count == 1 ? 2 : 1)) return false;
    }
    return true;
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
