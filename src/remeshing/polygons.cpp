// Polygons of the graph (thesis 4.3.3; remesh, stages 8 and 9).
//
// Plan: the faces of a graph on a connected surface are disks exactly when the graph is connected there and
// V - E + F is the surface's; both are checked per component. Nodes become vertices. A T-node is where a line ends on
// another: it is a corner of all polygons around, though one of them is straight there.
#include "remeshing/polygons.h"

#include <algorithm>

#include "core/union_find.h"

namespace certa::remeshing {

std::vector<BadRegion> find_bad_regions(const Graph& graph, const WorkMesh& mesh,
                                        const std::vector<std::vector<Index>>& faces) {
    const Index count = mesh.component_count;
    std::vector<std::int64_t> surface(count, 0), found(count, 0);
    std::vector<Index> parts(count, 0), any_face(count, no_index);
    // Of the work mesh: V - E + F per component.
    std::vector<bool> seen(mesh.points.size(), false);
    for (Index f = 0; f < mesh.face_count(); ++f) {
        const Index c = mesh.components[f];
        ++surface[c];
        if (any_face[c] == no_index) any_face[c] = f;
        for (const Index v : mesh.faces[f])
            if (!seen[v]) seen[v] = true, ++surface[c];
    }
    for (const Index h : mesh.edge_halfedges) --surface[mesh.components[h / 3]];
    core::UnionFind sets(graph.nodes.size());
    const auto component_of = [&](Index node) { return mesh.components[graph.nodes[node].place.face]; };
    for (const GraphEdge& e : graph.edges) {
        if (!e.alive()) continue;
        --found[component_of(e.a)];
        sets.unite(e.a, e.b);
    }
    for (Index n = 0; n < graph.nodes.size(); ++n) {
        if (graph.nodes[n].arms.empty()) continue;
        ++found[component_of(n)];
        parts[component_of(n)] += sets.find(n) == n ? 1 : 0;
    }
    for (const auto& face : faces) ++found[component_of(graph.tail(face.front()))];
    std::vector<BadRegion> bad;
    for (Index c = 0; c < count; ++c)
        if (parts[c] != 1 || found[c] != surface[c])
            bad.push_back({c, mesh.points[mesh.faces[any_face[c]][0]], any_face[c], found[c] - surface[c]});
    return bad;
}

CoarseMesh make_polygons(const Graph& graph, const std::vector<std::vector<Index>>& faces, PolygonCounts& counts) {
    CoarseMesh coarse;
    std::vector<Index> numbers(graph.nodes.size(), no_index);
    for (Index n = 0; n < graph.nodes.size(); ++n) {
        const GraphNode& node = graph.nodes[n];
        if (node.arms.empty()) continue;
        numbers[n] = coarse.add_vertex(node.point, node.place, node.kind, node.curve);
    }
    std::vector<Index> ring;
    std::vector<Index> last_seen(coarse.points.size(), no_index);
    for (std::size_t f = 0; f < faces.size(); ++f) {
        ring.clear();
        std::size_t corners = 0;
        bool pinched = false;
        for (const Index h : faces[f]) {
            const Index n = numbers[graph.tail(h)];
            pinched = pinched || last_seen[n] == f;
            last_seen[n] = static_cast<Index>(f);
            ring.push_back(n);
            // No turn: the side that arrives here and the one that leaves are of one line or curve.
            const auto& arms = graph.nodes[graph.tail(h)].arms;
            const auto at = std::find(arms.begin(), arms.end(), h);
            const Index before = at + 1 == arms.end() ? arms.front() : *(at + 1);
            const GraphEdge &p = graph.edges[before / 2], &q = graph.edges[h / 2];
            const bool straight = arms.size() > 1 && before % 2 != h % 2 && p.line == q.line && p.curve == q.curve;
            corners += straight ? 0 : 1;
            counts.t_nodes += straight ? 1 : 0;
        }
        counts.pinched += pinched ? 1 : 0;
        ++counts.polygons;
        counts.quads_with_t += ring.size() == 4 ? 1 : 0;
        counts.quads_without_t += corners == 4 ? 1 : 0;
        coarse.add_polygon(ring);
    }
    for (const GraphEdge& e : graph.edges)
        if (e.alive() && e.curve != no_index) coarse.feature_edges.push_back({numbers[e.a], numbers[e.b], e.curve});
    return coarse;
}

}  // namespace certa::remeshing
