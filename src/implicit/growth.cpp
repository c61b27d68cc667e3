// Free growth of W from the surface of sign changes, breadth first: a point that cannot join is tried again when a
// point of its link and sign has joined. The thesis's watershed (1.7.1) follows descending edges instead, which makes W
// about {|f| < c} and far larger near critical values; nothing in Lemma 51 needs that. It is here for comparison.
#include "implicit/growth.h"

#include <algorithm>
#include <bit>
#include <deque>
#include <queue>

#include "core/parallel.h"

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

void LinkCache::begin_round(const Triangulation& triangulation, const RunControl& control) {
    entries_.resize(triangulation.point_count());
    std::vector<std::uint32_t> wanted;
    for (std::uint32_t point = 0; point < entries_.size(); ++point) {
        if (triangulation.is_changed(point)) entries_[point].built = false;
        if (!entries_[point].built && triangulation.may_join(point) && triangulation.box_faces(point) == 0)
            wanted.push_back(point);
    }
    constexpr std::size_t grain = 4096;
    std::vector<Part> parts((wanted.size() + grain - 1) / grain);
    core::parallel_for(parts.size(), 1, control, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            for (std::size_t k = i * grain; k < std::min((i + 1) * grain, wanted.size()); ++k)
                parts[i].add(triangulation, wanted[k]);
        }
    });
    for (std::size_t i = 0; i < parts.size(); ++i) {
        std::size_t first = points_.size();
        for (std::size_t k = 0; k < parts[i].counts.size(); ++k) {
            entries_[wanted[i * grain + k]] = {first, parts[i].counts[k], true};
            first += parts[i].counts[k];
        }
        points_.insert(points_.end(), parts[i].points.begin(), parts[i].points.end());
        masks_.insert(masks_.end(), parts[i].masks.begin(), parts[i].masks.end());
        parts[i] = {};
    }
}

/// Links of more than 64 points are not kept.
void LinkCache::Part::add(const Triangulation& triangulation, std::uint32_t point) {
    const std::size_t first = points.size();
    const auto place_of = [&](std::uint32_t p) {
        std::size_t place = first;
        while (place < points.size() && points[place] != p) ++place;
        if (place == points.size()) points.push_back(p);
        return place - first;
    };
    std::array<std::uint64_t, 64> found{};
    for (const std::uint32_t t : triangulation.around(point)) {
        std::array<std::size_t, 3> face{};
        std::size_t count = 0;
        for (const std::uint32_t p : triangulation.tetrahedra()[t]) {
            if (p != point) face[count++] = place_of(p);
        }
        if (points.size() - first > 64) {
            points.resize(first);
            break;
        }
        for (std::size_t i = 0; i < 3; ++i)
            found[face[i]] |= (std::uint64_t{1} << face[(i + 1) % 3]) | (std::uint64_t{1} << face[(i + 2) % 3]);
    }
    counts.push_back(static_cast<std::uint32_t>(points.size() - first));
    masks.insert(masks.end(), found.begin(), found.begin() + static_cast<std::ptrdiff_t>(counts.back()));
}

namespace {

/// Whether the points of a link in `set` are connected by its edges; not if there are none.
bool is_connected(std::uint64_t set, const std::uint64_t* masks) {
    std::uint64_t reached = set & (~set + 1), work = reached;
    while (work != 0) {
        const std::uint64_t next = masks[std::countr_zero(work)] & set & ~reached;
        work &= work - 1;
        work |= next;
        reached |= next;
    }
    return set != 0 && reached == set;
}

class Grower {
public:
    Grower(const Triangulation& triangulation, const LinkCache& links, std::span<const float> ranks = {})
        : t_(triangulation),
          links_(links),
          test_(triangulation.point_count()),
          state_(triangulation.point_count()),
          ranks_(ranks) {
        growth_.marked.assign(triangulation.point_count(), 0);
        for (std::uint32_t p = 0; p < state_.size(); ++p) state_[p] = t_.sign(p) > 0 ? positive : 0;
    }

    Growth run() {
        for (const Triangulation::Tetrahedron& t : t_.tetrahedra()) {
            unsigned all = positive, any = 0;
            for (const std::uint32_t p : t) {
                all &= state_[p];
                any |= state_[p];
            }
            if (((all ^ any) & positive) == 0) continue;
            for (const std::uint32_t p : t) enqueue(p);
        }
        while (!queue_.empty() || !ranked_.empty()) {
            const std::uint32_t point = next();
            state_[point] &= static_cast<std::uint8_t>(~queued);
            try_to_join(point);
        }
        return std::move(growth_);
    }

private:
    static constexpr std::uint8_t positive = 1, marked = 2, queued = 4;

    void enqueue(std::uint32_t point) {
        if ((state_[point] & (queued | marked)) != 0 || !t_.may_join(point)) return;
        state_[point] |= queued;
        if (ranks_.empty())
            queue_.push_back(point);
        else
            ranked_.push({ranks_[point], arrived_++, point});
    }

    std::uint32_t next() {
        std::uint32_t point = none;
        if (ranks_.empty()) {
            point = queue_.front();
            queue_.pop_front();
        } else {
            point = ranked_.top().point;
            ranked_.pop();
        }
        return point;
    }

    void try_to_join(std::uint32_t point) {
        const LinkCache::Link link =
            t_.box_faces(point) == 0 ? links_.link_of(point) : LinkCache::Link{nullptr, nullptr, 0};
        if (link.count == 0) {
            if (!test_.may_join(t_, growth_.marked, point)) return;
            mark(point, test_.link().data(), test_.link().size());
            return;
        }
        const unsigned own = state_[point] & positive;
        std::uint64_t inside = 0;
        for (unsigned i = 0; i < link.count; ++i) {
            const unsigned state = state_[link.points[i]];
            inside |= std::uint64_t{(state & positive) != own || (state & marked) != 0} << i;
        }
        const std::uint64_t all = ~std::uint64_t{0} >> (64 - link.count);
        if (is_connected(inside, link.masks) && is_connected(all & ~inside, link.masks))
            mark(point, link.points, link.count);
    }

    void mark(std::uint32_t point, const std::uint32_t* link, std::size_t count) {
        growth_.marked[point] = 1;
        growth_.order.push_back(point);
        state_[point] |= marked;
        for (std::size_t i = 0; i < count; ++i) {
            if (((state_[link[i]] ^ state_[point]) & positive) == 0) enqueue(link[i]);
        }
    }

    const Triangulation& t_;
    const LinkCache& links_;
    LinkTest test_;
    std::vector<std::uint8_t> state_;
    struct Ranked {
        float rank;
        std::uint64_t arrived;
        std::uint32_t point;
        bool operator<(const Ranked& o) const {  // the lowest on top
            return rank != o.rank ? rank > o.rank : arrived > o.arrived;
        }
    };
    std::span<const float> ranks_;
    std::deque<std::uint32_t> queue_;
    std::priority_queue<Ranked> ranked_;  ///< instead, where there are ranks
    std::uint64_t arrived_ = 0;
    Growth growth_;
};

}  // namespace

Growth grow(const Triangulation& triangulation, LinkCache& links, const RunControl& control) {
    links.begin_round(triangulation, control);
    return Grower(triangulation, links).run();
}

Growth grow(const Triangulation& triangulation) {
    LinkCache links;
    return grow(triangulation, links, {});
}

Growth grow(const Triangulation& triangulation, std::span<const float> ranks, const RunControl& control) {
    LinkCache links;
    links.begin_round(triangulation, control);
    return Grower(triangulation, links, ranks).run();
}

Growth grow_watershed(const Triangulation& triangulation, std::span<const double> sizes) {
    Growth growth;
    growth.marked.assign(triangulation.point_count(), 0);
    std::vector<std::uint32_t> order;
    for (std::uint32_t p = 0; p < triangulation.point_count(); ++p) {
        if (triangulation.may_join(p)) order.push_back(p);
    }
    const auto is_smaller = [&](std::uint32_t p, std::uint32_t q) {
        return sizes[p] != sizes[q] ? sizes[p] < sizes[q] : p < q;
    };
    std::sort(order.begin(), order.end(), is_smaller);
    LinkTest test(triangulation.point_count());
    for (const std::uint32_t p : order) {
        // Points that joined are smaller: with all smaller ones marked, the test is about the lower link of p.
        const auto blocks = [&](std::uint32_t q) {
            return triangulation.sign(q) == triangulation.sign(p) && !growth.marked[q] && is_smaller(q, p);
        };
        const auto star = triangulation.around(p);
        const bool blocked = std::any_of(star.begin(), star.end(), [&](std::uint32_t t) {
            const auto& points = triangulation.tetrahedra()[t];
            return std::any_of(points.begin(), points.end(), blocks);
        });
        if (blocked || !test.may_join(triangulation, growth.marked, p)) continue;
        growth.marked[p] = 1;
        growth.order.push_back(p);
    }
    return growth;
}

}  // namespace certa::implicit
