// Contractions of short sides of polygons.
//
// A triangle on the side goes, its other two sides become one. A contraction is refused where a polygon would pass the
// vertex twice, or where both ends have a neighbour in common beyond that: links stay disks, and the topology as it is.
#include "remeshing/merge_ends.h"

#include <algorithm>
#include <optional>
#include <queue>

#include "remeshing/segment_distance.h"

namespace certa::remeshing {
namespace {

constexpr double smooth_share = 0.5;  ///< of the reach, for sides that are on no feature

/// A side on a feature curve, and the nodes that it has swallowed.
struct CurveSide {
    Index other = no_index, curve = no_index;
    std::vector<Point3> passed;
};
struct Candidate {
    double length = 0.0;
    Index a = no_index, b = no_index;
    friend bool operator<(const Candidate& l, const Candidate& r) {  // the shortest first
        if (l.length != r.length) return l.length > r.length;
        return l.a != r.a ? l.a > r.a : l.b > r.b;
    }
};

class EndMerger {
public:
    EndMerger(CoarseMesh& mesh, std::span<const double> reach, const ArrangementRule& rule)
        : mesh_(mesh), reach_(reach), rule_(rule), around_(mesh.points.size()), sides_(around_.size()) {
        for (Index q = 0; q < mesh.polygon_count(); ++q) {
            const auto ring = mesh.polygon(q);
            rings_.emplace_back(ring.begin(), ring.end());
            for (const Index v : ring) around_[v].push_back(q);
        }
        for (const FeatureEdge& e : mesh.feature_edges) {
            sides_[e.a].push_back({e.b, e.curve, {}});
            sides_[e.b].push_back({e.a, e.curve, {}});
        }
    }

    std::vector<MergedVertex> run() {
        for (const auto& ring : rings_)
            for (std::size_t i = 0; i < ring.size(); ++i) push(ring[i], ring[(i + 1) % ring.size()]);
        while (!queue_.empty()) {
            const Candidate next = queue_.top();
            queue_.pop();
            if (around_[next.a].empty() || around_[next.b].empty()) continue;
            if (!merge(next.b, next.a)) merge(next.a, next.b);
        }
        write_back();
        return std::move(merged_);
    }

private:
    void push(Index a, Index b) {
        const double length = distance(mesh_.points[a], mesh_.points[b]), reach = std::min(reach_[a], reach_[b]);
        if (length < (find_side(a, b) != nullptr ? reach : smooth_share * reach))
            queue_.push({length, std::min(a, b), std::max(a, b)});
    }
    CurveSide* find_side(Index v, Index other) {
        const auto at = std::find_if(sides_[v].begin(), sides_[v].end(),
                                     [&](const CurveSide& side) { return side.other == other; });
        return at == sides_[v].end() ? nullptr : &*at;
    }
    std::vector<Index> neighbours(Index v) const {
        std::vector<Index> list;
        for (const Index q : around_[v]) {
            const auto& ring = rings_[q];
            const auto at = static_cast<std::size_t>(std::find(ring.begin(), ring.end(), v) - ring.begin());
            list.push_back(ring[(at + 1) % ring.size()]);
            list.push_back(ring[(at + ring.size() - 1) % ring.size()]);
        }
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
        return list;
    }

    bool merge(Index v, Index into) {
        const VertexKind kind = mesh_.kinds[v];
        if (kind == VertexKind::corner) return false;
        std::optional<CurveSide> joined;
        if (kind != VertexKind::smooth) {
            joined = join_sides(v, into);
            if (!joined) return false;
        }
        const std::vector<Index> around = neighbours(v);
        if (std::find(around.begin(), around.end(), into) == around.end() || !may_merge(v, into)) return false;
        for (const Index q : around_[v]) {
            auto& ring = rings_[q];
            if (std::find(ring.begin(), ring.end(), into) != ring.end()) {
                std::erase(ring, v);
                if (ring.size() < 3) drop(q);
            } else {
                std::replace(ring.begin(), ring.end(), v, into);
                around_[into].push_back(q);
            }
        }
        around_[v].clear();
        sides_[v].clear();
        if (joined) {
            *find_side(into, v) = *joined;
            *find_side(joined->other, v) = {into, joined->curve, joined->passed};
        }
        merged_.push_back({v, into});
        for (const Index x : around)
            if (x != into) push(into, x);
        return true;
    }
    /// The side from `into` that is left of those of v on its curve; nothing where that must not be.
    std::optional<CurveSide> join_sides(Index v, Index into) {
        const CurveSide* near = find_side(v, into);
        if (near == nullptr || sides_[v].size() != 2) return std::nullopt;
        const CurveSide& far = sides_[v][sides_[v][0].other == into ? 1 : 0];
        if (far.other == into || far.curve != near->curve || find_side(into, far.other) != nullptr) return std::nullopt;
        CurveSide joined{far.other, far.curve, near->passed};
        joined.passed.push_back(mesh_.points[v]);
        joined.passed.insert(joined.passed.end(), far.passed.begin(), far.passed.end());
        const double error = mesh_.kinds[v] == VertexKind::boundary ? rule_.boundary_error : rule_.crease_error;
        for (const Point3& p : joined.passed)
            if (distance_to_segment(p, mesh_.points[into], mesh_.points[far.other]) > error) return std::nullopt;
        return joined;
    }
    /// What was a triangle: its other two sides are one now.
    void drop(Index q) {
        for (const Index x : rings_[q]) std::erase(around_[x], q);
        rings_[q].clear();
    }
    bool may_merge(Index v, Index into) const {
        std::size_t triangles = 0;
        for (const Index q : around_[v]) {
            const auto& ring = rings_[q];
            const auto at = std::find(ring.begin(), ring.end(), into);
            if (at == ring.end()) continue;
            const auto gap = std::abs(at - std::find(ring.begin(), ring.end(), v));
            const bool is_side = gap == 1 || gap + 1 == static_cast<std::ptrdiff_t>(ring.size());
            if (!is_side) return false;
            if (ring.size() > 3) continue;
            ++triangles;  // its third corner, the middle of four polygons or more, loses one
            const Index third = ring[0] + ring[1] + ring[2] - v - into;
            if (mesh_.kinds[third] != VertexKind::smooth || around_[third].size() < 4) return false;
        }
        const std::vector<Index> of_v = neighbours(v), of_into = neighbours(into);
        const auto common = std::count_if(
            of_v.begin(), of_v.end(), [&](Index x) { return std::binary_search(of_into.begin(), of_into.end(), x); });
        return static_cast<std::size_t>(common) == triangles;
    }

    void write_back() {
        CoarseMesh out = mesh_.without_polygons();
        for (Index q = 0; q < rings_.size(); ++q)
            if (!rings_[q].empty()) out.add_polygon(rings_[q], mesh_.parent(q));
        out.feature_edges.clear();
        for (Index v = 0; v < sides_.size(); ++v)
            for (const CurveSide& side : sides_[v])
                if (v < side.other) out.feature_edges.push_back({v, side.other, side.curve});
        mesh_ = std::move(out);
        std::vector<Index> last(mesh_.points.size());  // what is left at last; later merges first
        for (Index v = 0; v < last.size(); ++v) last[v] = v;
        for (std::size_t i = merged_.size(); i-- > 0;) {
            merged_[i].into = last[merged_[i].into];
            last[merged_[i].vertex] = merged_[i].into;
        }
    }

    CoarseMesh& mesh_;
    const std::span<const double> reach_;
    const ArrangementRule rule_;
    std::vector<std::vector<Index>> rings_, around_;
    std::vector<std::vector<CurveSide>> sides_;  ///< per vertex
    std::priority_queue<Candidate> queue_;
    std::vector<MergedVertex> merged_;
};

}  // namespace

std::vector<MergedVertex> merge_line_ends(CoarseMesh& mesh, std::span<const double> reach,
                                          const ArrangementRule& rule) {
    return EndMerger(mesh, reach, rule).run();
}

}  // namespace certa::remeshing
