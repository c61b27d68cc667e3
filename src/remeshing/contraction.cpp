// Contractions on rings of vertices.
//
// One is refused where a polygon would pass the vertex twice, or where both ends have neighbours in common beyond those
// of triangles that go: links stay disks, and the topology as it is. Of a quad whose diagonal goes, the other two
// corners lose a polygon and are neighbours of both ends before.
#include "remeshing/contraction.h"

#include <algorithm>

#include "remeshing/segment_distance.h"

namespace certa::remeshing {
namespace {

bool contains(const std::vector<Index>& ring, Index v) { return std::find(ring.begin(), ring.end(), v) != ring.end(); }

}  // namespace

void append_merged(std::vector<MergedVertex>& merged, const std::vector<MergedVertex>& next) {
    for (MergedVertex& m : merged)
        for (const MergedVertex& n : next)
            if (m.into == n.vertex) {
                m.into = n.into;
                break;
            }
    merged.insert(merged.end(), next.begin(), next.end());
}

Contraction::Contraction(CoarseMesh& mesh, const ArrangementRule& rule)
    : mesh_(mesh), rule_(rule), around_(mesh.points.size()), sides_(mesh.points.size()) {
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

const Contraction::CurveSide* Contraction::find_side(Index v, Index other) const {
    const auto at =
        std::find_if(sides_[v].begin(), sides_[v].end(), [&](const CurveSide& side) { return side.other == other; });
    return at == sides_[v].end() ? nullptr : &*at;
}

bool Contraction::is_feature_side(Index a, Index b) const { return find_side(a, b) != nullptr; }

std::vector<Index> Contraction::neighbours(Index v) const {
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

std::vector<Index> Contraction::changed_by(Index v, Index into) const {
    if (v == into || around_[v].empty() || around_[into].empty() || mesh_.kinds[v] == VertexKind::corner) return {};
    if (mesh_.kinds[v] != VertexKind::smooth && !join_sides(v, into)) return {};
    const std::vector<Index> near = neighbours(v);
    const bool is_side = std::binary_search(near.begin(), near.end(), into);
    const Index quad = is_side ? no_index : quad_between(v, into);
    if (is_side ? !may_merge_side(v, into) : quad == no_index) return {};
    std::vector<Index> changed;
    std::size_t left = around_[into].size();  // polygons of the vertex that both become
    for (const Index q : around_[v]) {
        const bool has_both = contains(rings_[q], into), goes = q == quad || (has_both && rings_[q].size() == 3);
        if (!goes) changed.push_back(q);
        left = left + (has_both ? 0 : 1) - (goes ? 1 : 0);
    }
    // Two polygons around a vertex have the same corners there: cut, they may be the same.
    if (mesh_.kinds[into] != VertexKind::boundary && left < 3 && left < around_[into].size()) return {};
    return changed;
}

bool Contraction::merge(Index v, Index into) {
    if (changed_by(v, into).empty()) return false;
    const std::optional<CurveSide> joined = mesh_.kinds[v] != VertexKind::smooth ? join_sides(v, into) : std::nullopt;
    const Index quad = quad_between(v, into);
    if (quad != no_index) {
        const Index parent = mesh_.parent(quad);
        for (const Index q : around_[v])  // what is left of them has the quad's part, too
            if (q != quad && parent != no_index && mesh_.parent(q) != no_index && mesh_.parent(q) != parent)
                mesh_.joined.push_back({parent, mesh_.parent(q)});
        drop(quad);
    }
    for (const Index q : std::vector<Index>(around_[v])) {
        auto& ring = rings_[q];
        if (contains(ring, into)) {
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
    return true;
}

/// The side from `into` that is left of those of v on its curve; nothing where that must not be.
std::optional<Contraction::CurveSide> Contraction::join_sides(Index v, Index into) const {
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

/// Whether a polygon at x may go whose side from v to x becomes one with another: the middle of four polygons or more,
/// and on features what has a polygon beyond that side.
bool Contraction::may_lose_polygon(Index x, Index v) const {
    if (mesh_.kinds[x] == VertexKind::boundary) return around_[x].size() >= 2 && !is_feature_side(x, v);
    return around_[x].size() >= 4 && !is_feature_side(x, v);
}

bool Contraction::may_merge_side(Index v, Index into) const {
    std::size_t triangles = 0;
    for (const Index q : around_[v]) {
        const auto& ring = rings_[q];
        const auto at = std::find(ring.begin(), ring.end(), into);
        if (at == ring.end()) continue;
        const auto gap = std::abs(at - std::find(ring.begin(), ring.end(), v));
        const bool is_side = gap == 1 || gap + 1 == static_cast<std::ptrdiff_t>(ring.size());
        if (!is_side) return false;
        if (ring.size() > 3) continue;
        ++triangles;
        if (!may_lose_polygon(ring[0] + ring[1] + ring[2] - v - into, v)) return false;
    }
    const std::vector<Index> of_v = neighbours(v), of_into = neighbours(into);
    const auto common = std::count_if(of_v.begin(), of_v.end(),
                                      [&](Index x) { return std::binary_search(of_into.begin(), of_into.end(), x); });
    return static_cast<std::size_t>(common) == triangles;
}

/// The quad in which v, which is smooth, lies opposite to `into`, if the one may go to the other over it.
Index Contraction::quad_between(Index v, Index into) const {
    if (mesh_.kinds[v] != VertexKind::smooth) return no_index;
    Index quad = no_index;
    for (const Index q : around_[v]) {
        if (!contains(rings_[q], into)) continue;
        if (quad != no_index || rings_[q].size() != 4) return no_index;
        quad = q;
    }
    if (quad == no_index) return no_index;
    const auto& ring = rings_[quad];
    const auto at = static_cast<std::size_t>(std::find(ring.begin(), ring.end(), v) - ring.begin());
    if (ring[(at + 2) % 4] != into || !may_lose_polygon(ring[(at + 1) % 4], v) ||
        !may_lose_polygon(ring[(at + 3) % 4], v))
        return no_index;
    const std::vector<Index> of_v = neighbours(v), of_into = neighbours(into);
    const auto common = std::count_if(of_v.begin(), of_v.end(),
                                      [&](Index x) { return std::binary_search(of_into.begin(), of_into.end(), x); });
    return common == 2 ? quad : no_index;
}

void Contraction::drop(Index q) {
    for (const Index x : rings_[q]) std::erase(around_[x], q);
    rings_[q].clear();
}

std::vector<MergedVertex> Contraction::write_back() {
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
    return std::move(merged_);
}

}  // namespace certa::remeshing
