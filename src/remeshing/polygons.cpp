// Polygons of the graph (thesis 4.3.3; remesh, stages 8 and 9).
//
// Plan: a face with k rims and g handles adds 2 - 2 g - k to the characteristic of its patch, but counts as k faces
// when rims are counted. So V - E + rims equals the patch's characteristic exactly when every face has one rim and no
// handle: nothing cancels. Nodes become vertices. A T-node is where a line ends on another: it is a corner of all
// polygons around, though one of them is straight there.
#include "remeshing/polygons.h"

#include <algorithm>
#include <map>

#include "core/vector3.h"

namespace certa::remeshing {

namespace {

/// V - E + F of the open patches of the work mesh.
std::vector<std::int64_t> characteristics(const WorkMesh& mesh) {
    std::vector<std::int64_t> chi(mesh.patch_count, 0);
    for (const Index p : mesh.patches) ++chi[p];
    std::vector<bool> on_feature(mesh.points.size(), false);
    for (const Index h : mesh.edge_halfedges) {
        if (mesh.is_feature(h))
            on_feature[mesh.start_of(h)] = on_feature[mesh.end_of(h)] = true;
        else
            --chi[mesh.patches[h / 3]];
    }
    for (Index w = 0; w < mesh.wedge_count(); ++w)
        if (!on_feature[mesh.wedge_vertices[w]]) ++chi[mesh.patches[mesh.wedge_first[w] / 3]];
    return chi;
}

}  // namespace

Index patch_beside(const Graph& graph, const Network& network, Index h) {
    const Index face = triangle_beside(graph, network, h);
    return face == no_index ? no_index : network.mesh().patches[face];
}

Index triangle_beside(const Graph& graph, const Network& network, Index h) {
    const WorkMesh& mesh = network.mesh();
    const GraphEdge& e = graph.edges[h / 2];
    if (e.line != no_index) {
        const auto& faces = network.lines()[e.line].faces;
        return faces[static_cast<std::size_t>(e.from) % faces.size()];
    }
    const FeatureCurve& curve = mesh.curves[e.curve];
    const std::size_t k = static_cast<std::size_t>(e.from) % curve.edges.size();
    const Index first = mesh.edge_halfedges[curve.edges[k]];
    const bool along = (mesh.start_of(first) == curve.vertices[k]) == (h % 2 == 0);
    const Index side = along ? first : mesh.opposites[first];
    return side == no_index ? no_index : side / 3;
}

namespace {

/// The graph's parts in a patch that nothing ties to the largest of them: rims of holes that no line has reached.
void add_islands(const Graph& graph, const Network& network, Index patch, std::vector<FlawPlace>& places) {
    std::vector<Index> above(graph.nodes.size(), no_index);  // a tree towards one node of each part
    const auto root_of = [&](Index n) {
        while (above[n] != n) n = above[n] = above[above[n]];
        return n;
    };
    for (Index e = 0; e < graph.edges.size(); ++e) {
        const GraphEdge& edge = graph.edges[e];
        if (!edge.alive()) continue;
        if (patch_beside(graph, network, 2 * e) != patch && patch_beside(graph, network, 2 * e + 1) != patch) continue;
        for (const Index n : {edge.a, edge.b})
            if (above[n] == no_index) above[n] = n;
        above[root_of(edge.a)] = root_of(edge.b);
    }
    std::map<Index, FlawPlace> parts;
    for (Index n = 0; n < above.size(); ++n)
        if (above[n] != no_index) parts[root_of(n)].nodes.push_back(n);
    std::size_t most = 0;
    double largest = -1.0;
    std::vector<FlawPlace> found;
    for (auto& [root, part] : parts) {
        Point3 low = graph.nodes[root].point, high = low;
        for (const Index n : part.nodes) {
            const Point3& p = graph.nodes[n].point;
            low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
        }
        part.patch = patch;
        part.size = distance(low, high);
        if (part.size > largest) largest = part.size, most = found.size();
        found.push_back(std::move(part));
    }
    for (std::size_t i = 0; i < found.size(); ++i)
        if (i != most) places.push_back(std::move(found[i]));
}

}  // namespace

Flaws find_flaws(const Graph& graph, const Network& network, const std::vector<std::vector<Index>>& faces) {
    const WorkMesh& mesh = network.mesh();
    std::vector<std::int64_t> rest = characteristics(mesh);
    std::vector<bool> met(mesh.patch_count, false);
    for (const GraphNode& node : graph.nodes)
        if (!node.arms.empty() && node.curve == no_index) --rest[mesh.patches[node.place.face]];
    for (Index e = 0; e < graph.edges.size(); ++e)
        if (graph.edges[e].alive() && graph.edges[e].line != no_index) ++rest[patch_beside(graph, network, 2 * e)];
    std::vector<Index> last_seen(graph.nodes.size(), no_index);
    Flaws flaws;
    for (Index f = 0; f < faces.size(); ++f) {
        const Index patch = patch_beside(graph, network, faces[f].front());
        if (patch != no_index) --rest[patch], met[patch] = true;
        bool pinched = faces[f].size() < 3;
        for (const Index h : faces[f]) {
            const Index n = graph.tail(h);
            if (last_seen[n] == f) {
                pinched = true;
                flaws.places.push_back({patch, {n}, 0.0});
            }
            last_seen[n] = f;
        }
        if (pinched) flaws.faces.push_back(f);
    }
    for (Index p = 0; p < mesh.patch_count; ++p)
        if (rest[p] != 0 || !met[p]) {
            flaws.patches.push_back(p);
            add_islands(graph, network, p, flaws.places);
        }
    return flaws;
}

CoarseMesh make_polygons(const Graph& graph, const std::vector<std::vector<Index>>& faces, std::span<const Index> open,
                         PolygonCounts& counts, std::vector<Index>& nodes) {
    CoarseMesh coarse;
    std::vector<Index> numbers(graph.nodes.size(), no_index);
    for (Index n = 0; n < graph.nodes.size(); ++n) {
        const GraphNode& node = graph.nodes[n];
        if (node.arms.empty()) continue;
        nodes.push_back(n);
        numbers[n] = coarse.add_vertex(node.point, node.place, node.kind, node.curve);
    }
    std::vector<Index> ring;
    for (std::size_t f = 0; f < faces.size(); ++f) {
        if (std::binary_search(open.begin(), open.end(), f)) continue;
        ring.clear();
        std::size_t corners = 0;
        for (const Index h : faces[f]) {
            const Index n = numbers[graph.tail(h)];
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
        ++counts.polygons;
        counts.quads_with_t += ring.size() == 4 ? 1 : 0;
        counts.quads_without_t += corners == 4 ? 1 : 0;
        coarse.add_polygon(ring, static_cast<Index>(f));
    }
    for (const GraphEdge& e : graph.edges)
        if (e.alive() && e.curve != no_index) coarse.feature_edges.push_back({numbers[e.a], numbers[e.b], e.curve});
    return coarse;
}

}  // namespace certa::remeshing
