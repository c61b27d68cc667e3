// Merging of exactly coplanar neighbours.
//
// Exact coplanarity is transitive, so groups are the classes of a union-find over sides with exactly two facets. Flags
// add modulo two: a side that bounds two facets of a group bounds their union no longer. The frame of a group comes
// from three of its points that are far apart, since the lowest facet may be a needle whose own normal is good for
// little.
#include "conforming/merge_coplanar.h"

#include <algorithm>
#include <optional>

#include "core/union_find.h"
#include "core/vector3.h"
#include "exact/orientation.h"

namespace certa::conforming {
namespace {

class CoplanarMerger {
public:
    CoplanarMerger(const Complex& complex, std::size_t given_segments) : old_(complex), given_(given_segments) {}

    MergedComplex run() {
        find_planes();
        find_groups();
        result_.complex = old_;
        merge_facets();
        build_incidences(result_.complex);
        forget_dropped();
        return std::move(result_);
    }

private:
    using Ids = std::vector<std::uint32_t>;
    using Plane = std::optional<std::array<std::uint32_t, 3>>;

    const Point3& at(std::uint32_t v) const { return old_.points[v]; }
    bool is_in(const Plane& plane, std::uint32_t v) const {
        return exact::orient3d(at((*plane)[0]), at((*plane)[1]), at((*plane)[2]), at(v)) == 0;
    }

    Ids points_of(std::uint32_t f) const {
        Ids points(old_.facet_points[f].begin(), old_.facet_points[f].end());
        for (const Side& side : old_.facet_sides[f]) {
            points.insert(points.end(), old_.segments[side.segment].begin(), old_.segments[side.segment].end());
        }
        std::sort(points.begin(), points.end());
        points.erase(std::unique(points.begin(), points.end()), points.end());
        return points;
    }

    /// Three points of each facet that span its plane; none when not all of its points lie exactly in one.
    void find_planes() {
        planes_.resize(old_.facet_sides.size());
        for (std::uint32_t f = 0; f < planes_.size(); ++f) {
            const Ids points = points_of(f);
            Plane plane;
            for (std::size_t i = 2; i < points.size() && !plane; ++i) {
                if (!exact::are_collinear(at(points[0]), at(points[1]), at(points[i]))) {
                    plane = {points[0], points[1], points[i]};
                }
            }
            const auto inside = [&](std::uint32_t v) { return is_in(plane, v); };
            if (plane && std::all_of(points.begin(), points.end(), inside)) planes_[f] = plane;
        }
    }

    bool are_coplanar(std::uint32_t f, std::uint32_t g) const {
        if (!planes_[f] || !planes_[g]) return false;
        return std::all_of(planes_[g]->begin(), planes_[g]->end(), [&](auto v) { return is_in(planes_[f], v); });
    }

    bool is_boundary_of(std::uint32_t s, std::uint32_t f) const {
        const auto sides = old_.facet_sides[f];
        return std::any_of(sides.begin(), sides.end(), [&](const Side& x) { return x.segment == s && x.boundary; });
    }

    /// The two facets that may merge across a segment.
    bool may_merge(std::uint32_t s) const {
        const auto facets = old_.segment_facets[s];
        if (s < given_ || facets.size() != 2) return false;
        const std::uint32_t f = facets[0], g = facets[1];
        return old_.facet_markers[f] == old_.facet_markers[g] && are_coplanar(f, g) && is_boundary_of(s, f) &&
               is_boundary_of(s, g);
    }

    void find_groups() {
        core::UnionFind groups(old_.facet_sides.size());
        result_.dropped_segments.assign(old_.segments.size(), 0);
        for (std::uint32_t s = 0; s < old_.segments.size(); ++s) {
            if (!may_merge(s)) continue;
            result_.dropped_segments[s] = 1;
            groups.unite(old_.segment_facets[s][0], old_.segment_facets[s][1]);
        }
        for (std::uint32_t f = 0; f < old_.facet_sides.size(); ++f) result_.representatives.push_back(groups.find(f));
    }

    void merge_facets() {
        const auto count = static_cast<std::uint32_t>(old_.facet_sides.size());
        std::vector<Ids> members(count);
        for (std::uint32_t f = 0; f < count; ++f) members[result_.representatives[f]].push_back(f);
        Rows<Side> sides;
        Rows<std::uint32_t> points;
        for (std::uint32_t f = 0; f < count; ++f) {
            if (members[f].empty()) {
                sides.push_row({});
                points.push_row({});
            } else if (members[f].size() == 1) {
                sides.push_row(old_.facet_sides[f]);
                points.push_row(old_.facet_points[f]);
            } else {
                merge_group(f, members[f], sides, points);
            }
        }
        result_.complex.facet_sides = std::move(sides);
        result_.complex.facet_points = std::move(points);
    }

    void merge_group(std::uint32_t f, const Ids& members, Rows<Side>& sides, Rows<std::uint32_t>& points) {
        std::vector<Side> merged;
        Ids all, kept;
        for (const std::uint32_t g : members) {
            for (const Side& side : old_.facet_sides[g]) {
                if (!result_.dropped_segments[side.segment]) merged.push_back(side);
            }
            const Ids own = points_of(g);
            all.insert(all.end(), own.begin(), own.end());
        }
        // In the order of their numbers, and of the same number one, with the flags added modulo two.
        std::stable_sort(merged.begin(), merged.end(), [](auto& a, auto& b) { return a.segment < b.segment; });
        std::vector<Side> unique;
        for (const Side& side : merged) {
            if (!unique.empty() && unique.back().segment == side.segment) {
                unique.back().boundary = unique.back().boundary != side.boundary;
            } else {
                unique.push_back(side);
            }
        }
        for (const Side& side : unique) {
            kept.insert(kept.end(), old_.segments[side.segment].begin(), old_.segments[side.segment].end());
        }
        std::sort(all.begin(), all.end());
        all.erase(std::unique(all.begin(), all.end()), all.end());
        std::sort(kept.begin(), kept.end());
        result_.complex.frames[f] = frame_of(f, all);
        Ids isolated;
        std::set_difference(all.begin(), all.end(), kept.begin(), kept.end(), std::back_inserter(isolated));
        sides.push_row(unique);
        points.push_row(isolated);
    }

    /// A frame from far points, with the direction of the lowest facet's normal.
    Frame frame_of(std::uint32_t f, const Ids& points) const {
        Frame frame = old_.frames[f];
        const Point3 a = at(points[0]);
        const auto farthest = [&](auto&& measure) {
            return at(*std::max_element(points.begin(), points.end(),
                                        [&](auto v, auto w) { return measure(at(v)) < measure(at(w)); }));
        };
        const Point3 b = farthest([&](const Point3& p) { return dot(p - a, p - a); });
        const Point3 c = farthest([&](const Point3& p) {
            const Point3 n = cross(b - a, p - a);
            return dot(n, n);
        });
        const Point3 n = cross(b - a, c - a);
        if (!(norm(n) > 0.0)) return frame;
        frame.normal = (dot(n, frame.normal) < 0.0 ? -1.0 : 1.0) / norm(n) * n;
        const Point3 along = b - a - dot(b - a, frame.normal) * frame.normal;
        frame.u = 1.0 / norm(along) * along;
        frame.v = cross(frame.normal, frame.u);
        Point3 sum{};
        for (const std::uint32_t v : points) sum = sum + (at(v) - a);
        frame.origin = a + 1.0 / static_cast<double>(points.size()) * sum;
        return frame;
    }

    void forget_dropped() {
        Rows<std::uint32_t> rows;
        Ids row;
        const Rows<std::uint32_t>& old = result_.complex.point_segments;
        for (std::size_t v = 0; v < old.size(); ++v) {
            row.clear();
            for (const std::uint32_t s : old[v]) {
                if (!result_.dropped_segments[s]) row.push_back(s);
            }
            rows.push_row(row);
        }
        result_.complex.point_segments = std::move(rows);
    }

    const Complex& old_;
    const std::size_t given_;
    std::vector<Plane> planes_;
    MergedComplex result_;
};

}  // namespace

MergedComplex merge_coplanar(const Complex& complex, std::size_t given_segments) {
    return CoplanarMerger(complex, given_segments).run();
}

}  // namespace certa::conforming
