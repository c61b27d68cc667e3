// Which sides of its ring edges does a facet cover? For facets with several rings, repeated corners or hole points.
// The rings' distinct edges form a plane graph: half-edges are sorted around each corner, faces are traced as cycles
// (face to the left), the one cycle of each connected part that does not turn counter-clockwise bounds the face around
// that part, and each part is located in the innermost cycle of the others that contains it. Faces that infinity or a
// hole point belongs to are no part of the facet. All decisions are exact in the projection along Newell's normal.
#include <algorithm>
#include <numeric>
#include <unordered_map>

#include "verify/distance.h"
#include "verify/plc.h"

namespace certa::verify {
namespace {

class Arrangement {
public:
    Arrangement(const PiecewiseLinearComplex& complex, std::uint32_t facet, const NewellNormal& normal)
        : complex_(complex), facet_(facet), normal_(normal), plane_(facet_corners(complex, facet), normal) {}

    std::vector<RingEdge> run() {
        collect_edges();
        sort_around_corners();
        trace_cycles();
        join_cycles();
        remove_holes();
        std::vector<RingEdge> result;
        for (std::size_t e = 0; e < edges_.size(); ++e) {
            result.push_back(
                {edges_[e][0], edges_[e][1], covered_[faces_[cycle_[2 * e]]], covered_[faces_[cycle_[2 * e + 1]]]});
        }
        return result;
    }

private:
    struct Cycle {
        std::vector<std::size_t> halves;
        std::vector<Point3> points;
        bool encloses = false;  // turns counter-clockwise
        Point3 low, high;
    };

    // Half-edge 2 e runs along edge e from its lower to its higher corner, 2 e + 1 back.
    std::uint32_t tail(std::size_t half) const { return edges_[half / 2][half % 2]; }
    std::uint32_t head(std::size_t half) const { return edges_[half / 2][1 - half % 2]; }
    const Point3& at(std::uint32_t v) const { return complex_.positions[v]; }

    void collect_edges() {
        for (std::uint32_t p = complex_.facet_offsets[facet_]; p < complex_.facet_offsets[facet_ + 1]; ++p) {
            const std::uint32_t begin = complex_.polygon_offsets[p], end = complex_.polygon_offsets[p + 1];
            if (end - begin < 3) continue;
            for (std::uint32_t i = begin; i < end; ++i) {
                const std::uint32_t a = index_of(complex_.corners[i]);
                const std::uint32_t b = index_of(complex_.corners[i + 1 < end ? i + 1 : begin]);
                edges_.push_back({std::min(a, b), std::max(a, b)});
            }
        }
        std::sort(edges_.begin(), edges_.end());
        edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
    }

    /// 0: direction of `reference` itself, 1: less than half a turn from it counter-clockwise, 2: opposite, 3: rest.
    int sector(std::size_t reference, std::size_t half) const {
        const Point3& o = at(tail(half));
        const int side = normal_.side(o, at(head(reference)), at(head(half)));
        if (side != 0) return side > 0 ? 1 : 3;
        return dot_sign(o, at(head(reference)), o, at(head(half))) > 0 ? 0 : 2;
    }

    void sort_around_corners() {
        std::vector<std::size_t> halves(2 * edges_.size());
        std::iota(halves.begin(), halves.end(), std::size_t{0});
        std::stable_sort(halves.begin(), halves.end(), [&](std::size_t a, std::size_t b) { return tail(a) < tail(b); });
        next_.assign(halves.size(), 0);
        for (std::size_t begin = 0; begin < halves.size();) {
            std::size_t end = begin;
            while (end < halves.size() && tail(halves[end]) == tail(halves[begin])) ++end;
            sort_corner(halves, begin, end);
            begin = end;
        }
    }
    void sort_corner(std::vector<std::size_t>& halves, std::size_t begin, std::size_t end) {
        const std::size_t reference = halves[begin];
        std::vector<std::pair<int, std::size_t>> sectors;
        for (std::size_t i = begin; i < end; ++i) sectors.emplace_back(sector(reference, halves[i]), halves[i]);
        std::stable_sort(sectors.begin(), sectors.end(), [&](const auto& a, const auto& b) {
            if (a.first != b.first) return a.first < b.first;
            return normal_.side(at(tail(a.second)), at(head(a.second)), at(head(b.second))) > 0;
        });
        // Arriving against half-edge h, the face on the left continues with the one clockwise from h.
        for (std::size_t i = 0; i < sectors.size(); ++i) {
            const std::size_t clockwise = sectors[(i + sectors.size() - 1) % sectors.size()].second;
            next_[sectors[i].second ^ 1] = clockwise;
        }
    }

    void trace_cycles() {
        cycle_.assign(next_.size(), no_index);
        for (std::size_t start = 0; start < next_.size(); ++start) {
            if (cycle_[start] != no_index) continue;
            const auto index = static_cast<std::uint32_t>(cycles_.size());
            Cycle cycle;
            for (std::size_t h = start; cycle_[h] == no_index; h = next_[h]) {
                cycle_[h] = index;
                cycle.halves.push_back(h);
                cycle.points.push_back(at(tail(h)));
            }
            cycle.encloses = normal_.turn(cycle.points) > 0;
            cycle.low = cycle.high = cycle.points[0];
            for (const Point3& p : cycle.points) {
                cycle.low = {std::min(cycle.low.x, p.x), std::min(cycle.low.y, p.y), std::min(cycle.low.z, p.z)};
                cycle.high = {std::max(cycle.high.x, p.x), std::max(cycle.high.y, p.y), std::max(cycle.high.z, p.z)};
                thickness_ = std::max(thickness_, plane_.distance(p));
            }
            cycles_.push_back(std::move(cycle));
        }
    }

    /// The innermost enclosing cycle, outside part `part`, around a point; no_index: infinity.
    std::uint32_t locate(const Point3& p, std::uint32_t part) const {
        std::uint32_t best = no_index;
        for (std::uint32_t c = 0; c < cycles_.size(); ++c) {
            if (!cycles_[c].encloses || parts_[c] == part || !contains(cycles_[c], p)) continue;
            if (best == no_index || normal_.compare_areas(cycles_[c].points, cycles_[best].points) < 0) best = c;
        }
        return best;
    }
    /// Where p is under a point q of the polygon in projection, and both are within thickness_ of the plane, |p - q| is
    /// at most 2 thickness_.
    bool is_outside(const Cycle& cycle, const Point3& p) const {
        const double slack = 2.001 * std::max(thickness_, plane_.distance(p));
        return p.x < cycle.low.x - slack || p.y < cycle.low.y - slack || p.z < cycle.low.z - slack ||
               p.x > cycle.high.x + slack || p.y > cycle.high.y + slack || p.z > cycle.high.z + slack;
    }

    /// Winding number of the cycle around p, from its crossings with the ray from p in the direction of edge 0. A
    /// corner on the ray's line counts as left of it, as if p were moved a little to the right.
    bool contains(const Cycle& cycle, const Point3& p) const {
        if (is_outside(cycle, p)) return false;
        const Arrow ray{&at(edges_[0][0]), &at(edges_[0][1])};
        int winding = 0;
        for (const std::size_t h : cycle.halves) {
            const Point3 &a = at(tail(h)), &b = at(head(h));
            const bool from_left = normal_.side(ray, {&p, &a}) >= 0, to_left = normal_.side(ray, {&p, &b}) >= 0;
            if (from_left == to_left) continue;
            const int side = normal_.side(a, b, p);
            if (to_left && side > 0) ++winding;
            if (from_left && side < 0) --winding;
        }
        return winding != 0;
    }

    /// Gives every cycle its face: an enclosing cycle is its own; the outer cycle of a part belongs to the face around.
    void join_cycles() {
        std::unordered_map<std::uint32_t, std::uint32_t> leader;
        const auto find = [&](std::uint32_t v) {
            while (leader[v] != v) v = leader[v] = leader[leader[v]];
            return v;
        };
        for (const auto& e : edges_) leader.try_emplace(e[0], e[0]), leader.try_emplace(e[1], e[1]);
        for (const auto& e : edges_) leader[find(e[0])] = find(e[1]);
        for (const Cycle& c : cycles_) parts_.push_back(find(tail(c.halves[0])));
        const auto infinity = static_cast<std::uint32_t>(cycles_.size());
        for (std::uint32_t c = 0; c < infinity; ++c) {
            const std::uint32_t around = cycles_[c].encloses ? c : locate(cycles_[c].points[0], parts_[c]);
            faces_.push_back(around == no_index ? infinity : around);
        }
        covered_.assign(cycles_.size() + 1, true);
        covered_[infinity] = false;
    }

    void remove_holes() {
        for (std::uint32_t i = complex_.hole_offsets[facet_]; i < complex_.hole_offsets[facet_ + 1]; ++i) {
            const std::uint32_t around = locate(complex_.facet_holes[i], no_index);
            if (around != no_index) covered_[around] = false;
        }
    }

    const PiecewiseLinearComplex& complex_;
    std::uint32_t facet_;
    const NewellNormal& normal_;
    const FacetPlane plane_;
    double thickness_ = 0.0;  // largest distance of a ring's corner from the plane
    std::vector<std::array<std::uint32_t, 2>> edges_;
    std::vector<std::size_t> next_;
    std::vector<std::uint32_t> cycle_;  // per half-edge
    std::vector<Cycle> cycles_;
    std::vector<std::uint32_t> parts_, faces_;  // per cycle: a corner that names its connected part, its face
    std::vector<bool> covered_;
};

}  // namespace

std::vector<RingEdge> arrange_rings(const PiecewiseLinearComplex& complex, std::uint32_t facet,
                                    const NewellNormal& normal) {
    return Arrangement(complex, facet, normal).run();
}

}  // namespace certa::verify
