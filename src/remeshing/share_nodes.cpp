// Nodes on edges that were cut open, for all sheets at once (remesh, stage 1: cuts are stitched in the output).
//
// Lines end on such edges sheet by sheet. Plan: list the nodes per edge of the input; those of different sheets that
// lie close together move into one place; then every sheet is split wherever another has a node. Vertices of the input
// likewise, also those where sheets only touch.
#include "remeshing/share_nodes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace certa::remeshing {
namespace {

/// A node on an edge of a sheet.
struct Item {
    double t = 0.0;     ///< along the edge, from the end with the lower source
    double part = 0.0;  ///< the same along the sheet's curve
    double reach = 0.0;
    Index edge = no_index, node = no_index;
};
/// A place on an edge of the input, and who has a node there.
struct Place {
    Point3 point;
    std::map<Index, double> taken;  ///< per sheet's edge: where its own node is
};

class Sharer {
public:
    Sharer(Graph& graph, const WorkMesh& mesh) : graph_(graph), mesh_(mesh) {}

    void run() {
        find_touching_vertices();
        list_nodes();
        for (auto& [twin, items] : items_) make_places(places_[twin], items);
        const Index count = static_cast<Index>(graph_.edges.size());
        for (Index e = 0; e < count; ++e)
            if (graph_.edges[e].alive() && graph_.edges[e].curve != no_index) split(e);
        for (const GraphEdge& e : graph_.edges) {
            if (!e.alive() || e.curve == no_index) continue;
            if (is_shared(e.curve, e.from)) graph_.nodes[e.a].kind = VertexKind::corner;
            if (is_shared(e.curve, e.to)) graph_.nodes[e.b].kind = VertexKind::corner;
        }
    }

private:
    bool is_along(Index edge) const {
        const Index h = mesh_.edge_halfedges[edge];
        return mesh_.point_sources[mesh_.start_of(h)] < mesh_.point_sources[mesh_.end_of(h)];
    }
    Index twin_of(Index curve, std::size_t k) const { return mesh_.edge_twins[mesh_.curves[curve].edges[k]]; }
    Index vertex_at(Index curve, double at) const {
        const auto& vertices = mesh_.curves[curve].vertices;
        return vertices[static_cast<std::size_t>(at) % vertices.size()];
    }
    std::size_t edge_at(Index curve, double at) const {
        return static_cast<std::size_t>(at) % mesh_.curves[curve].edges.size();
    }
    /// Along edge k of a curve, from the lower source.
    double in_order(Index curve, std::size_t k, double part) const {
        const FeatureCurve& c = mesh_.curves[curve];
        const Index edge = c.edges[k], h = mesh_.edge_halfedges[edge];
        const bool along = (mesh_.start_of(h) == c.vertices[k]) == is_along(edge);
        return along ? part : 1.0 - part;
    }

    /// Vertices of several sheets that are no inner ones of a chain of shared edges: there has to be a node.
    void find_touching_vertices() {
        std::map<Index, std::set<Index>> twins;
        for (Index e = 0; e < mesh_.edge_twins.size(); ++e) {
            if (mesh_.edge_twins[e] == no_index) continue;
            const Index h = mesh_.edge_halfedges[e];
            for (const Index v : {mesh_.start_of(h), mesh_.end_of(h)})
                twins[mesh_.point_sources[v]].insert(mesh_.edge_twins[e]);
        }
        std::map<Index, Index> copies;
        for (const Index source : mesh_.point_sources) ++copies[source];
        for (const auto& [source, count] : copies) {
            if (count < 2) continue;
            is_met_.insert(source);
            const auto at = twins.find(source);
            if (at == twins.end() || at->second.size() != 2) wanted_.insert(source);
        }
    }
    void list_nodes() {
        for (const GraphEdge& e : graph_.edges) {
            if (!e.alive() || e.curve == no_index) continue;
            const double length = distance(graph_.nodes[e.a].point, graph_.nodes[e.b].point);
            for (const bool is_end : {false, true}) {
                const double at = is_end ? e.to : e.from;
                if (at == std::floor(at)) {
                    const Index source = mesh_.point_sources[vertex_at(e.curve, at)];
                    if (is_met_.count(source) > 0) wanted_.insert(source);
                    continue;
                }
                const std::size_t k = edge_at(e.curve, at);
                if (twin_of(e.curve, k) == no_index) continue;
                auto& items = items_[twin_of(e.curve, k)];
                const Index node = is_end ? e.b : e.a;
                const auto known =
                    std::find_if(items.begin(), items.end(), [&](const Item& item) { return item.node == node; });
                if (known != items.end())
                    known->reach = std::min(known->reach, near * length);
                else
                    items.push_back({in_order(e.curve, k, at - std::floor(at)), at - std::floor(at), near * length,
                                     mesh_.curves[e.curve].edges[k], node});
            }
        }
    }
    void make_places(std::vector<Place>& places, std::vector<Item>& items) {
        std::sort(items.begin(), items.end(),
                  [](const Item& a, const Item& b) { return a.t != b.t ? a.t < b.t : a.node < b.node; });
        for (const Item& item : items) {
            GraphNode& node = graph_.nodes[item.node];
            if (!places.empty() && places.back().taken.count(item.edge) == 0 &&
                distance(places.back().point, node.point) <= item.reach)
                node.point = places.back().point;
            else
                places.push_back({node.point, {}});
            places.back().taken[item.edge] = item.part;
        }
    }

    struct Cut {
        double at = 0.0;
        Point3 point;
        bool has_point = false;
    };
    /// Where other sheets have nodes on this piece of a curve.
    void split(Index e) {
        const GraphEdge piece = graph_.edges[e];
        std::vector<Cut> cuts;
        for (double k = std::floor(piece.from); k < piece.to; k += 1.0) {
            if (k > piece.from && wanted_.count(mesh_.point_sources[vertex_at(piece.curve, k)]) > 0)
                cuts.push_back({k, {}, false});
            const std::size_t side = edge_at(piece.curve, k);
            const auto found = places_.find(twin_of(piece.curve, side));
            if (twin_of(piece.curve, side) != no_index && found != places_.end())
                cut_edge(piece, k, side, found->second, cuts);
        }
        for (std::size_t i = cuts.size(); i-- > 0;) {
            SurfacePlace place;
            const Point3 own = point_along_curve(mesh_, piece.curve, cuts[i].at, place);
            const Index n = graph_.split(e, cuts[i].has_point ? cuts[i].point : own, place, cuts[i].at);
            graph_.nodes[n].curve = piece.curve;
            graph_.nodes[n].kind = VertexKind::corner;
        }
    }
    /// On one edge of the curve: places that its sheet has not, as ranks between those that it has.
    void cut_edge(const GraphEdge& piece, double k, std::size_t side, const std::vector<Place>& places,
                  std::vector<Cut>& cuts) const {
        const Index edge = mesh_.curves[piece.curve].edges[side];
        const bool forward = in_order(piece.curve, side, 0.0) == 0.0;
        const double low = std::max(piece.from, k), high = std::min(piece.to, k + 1.0);
        double last = k;
        for (std::size_t i = 0; i < places.size();) {
            const auto place = [&](std::size_t j) -> const Place& {
                return forward ? places[j] : places[places.size() - 1 - j];
            };
            const auto own = [&](std::size_t j) { return k + place(j).taken.at(edge); };
            if (place(i).taken.count(edge) > 0) {
                last = own(i++);
                continue;
            }
            std::size_t end = i;
            while (end < places.size() && place(end).taken.count(edge) == 0) ++end;
            const double next = end < places.size() ? own(end) : k + 1.0;
            // Between two nodes of the sheet, which are the ends of one piece.
            if (last >= low - tiny && next <= high + tiny && next - last > 1e3 * tiny)
                for (std::size_t j = i; j < end; ++j) {
                    const double part = static_cast<double>(j - i + 1) / static_cast<double>(end - i + 1);
                    cuts.push_back({last + part * (next - last), place(j).point, true});
                }
            i = end;
        }
    }
    bool is_shared(Index curve, double at) const {
        if (at == std::floor(at)) return is_met_.count(mesh_.point_sources[vertex_at(curve, at)]) > 0;
        return twin_of(curve, edge_at(curve, at)) != no_index;
    }

    static constexpr double near = 0.15;   ///< of the shorter piece beside a node: so far it may move
    static constexpr double tiny = 1e-10;  ///< on closed curves, places are known so well only
    Graph& graph_;
    const WorkMesh& mesh_;
    std::set<Index> is_met_;  ///< sources with several copies
    std::set<Index> wanted_;  ///< those with a node
    std::map<Index, std::vector<Item>> items_;
    std::map<Index, std::vector<Place>> places_;
};

}  // namespace

void share_nodes(Graph& graph, const WorkMesh& mesh) {
    if (!mesh.is_cut_open) return;
    Sharer(graph, mesh).run();
}

}  // namespace certa::remeshing
