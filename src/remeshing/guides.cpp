// Guides (remesh, stage 4). Directions within half a spacing are those of the guide, beyond they fade to what was
// measured.
//
// Plan: edges that hang together make a guide. Its directions at the wedges it passes are those of its edges there;
// the sum over the guide of how well they agree with what was measured says which family it becomes a line of. A guide
// is no crease: vertices are not bound to it, lines cross it, the surface is measured across it.
#include "remeshing/guides.h"

#include <algorithm>
#include <queue>

#include "core/union_find.h"

namespace certa::remeshing {
namespace {

/// Confidence of a guide: the solve hardly moves what has this much.
constexpr double firm = 50.0;

/// Per wedge: the sum of squared directions of guide edges there.
std::vector<Complex> directions_along(const WorkMesh& mesh) {
    std::vector<Complex> along(mesh.wedge_count());
    for (Index h = 0; h < mesh.edges.size(); ++h) {
        if (!mesh.is_guide[mesh.edges[h]]) continue;
        along[mesh.wedges[h]] += std::polar(1.0, 2.0 * mesh.corner_start[h]);
        const Index end = next_of(h);  // seen from there, where no face lies on the other side
        if (mesh.is_feature(h))
            along[mesh.wedges[end]] += std::polar(1.0, 2.0 * (mesh.corner_start[end] + mesh.corner_angle[end]));
    }
    return along;
}

/// What the nearest guide says at a wedge: how far it is along edges, and its direction, carried over on the way.
struct Nearest {
    double distance = 0.0;
    Complex square;
    Index vertex = no_index;  ///< of the guide
};
std::vector<Nearest> carry(const WorkMesh& mesh, const std::vector<Complex>& along, double reach) {
    using Entry = std::pair<double, Index>;
    std::vector<Nearest> nearest(mesh.wedge_count(), Nearest{reach, 0.0, no_index});
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (Index w = 0; w < along.size(); ++w)
        if (std::abs(along[w]) > 1e-9) {
            nearest[w] = {0.0, along[w] / std::abs(along[w]), mesh.wedge_vertices[w]};
            queue.push({0.0, w});
        }
    while (!queue.empty()) {
        const auto [d, w] = queue.top();
        queue.pop();
        if (d > nearest[w].distance) continue;
        const Nearest own = nearest[w];
        const auto relax = [&](Index other, Index edge, double turn) {
            const double reached = own.distance + mesh.lengths[edge];
            if (!(reached < nearest[other].distance)) return;
            nearest[other] = {reached, own.square * std::polar(1.0, 2.0 * turn), own.vertex};
            queue.push({reached, other});
        };
        Index c = mesh.wedge_first[w];
        const Index first = c;
        do {
            const Index n = next_of(c), p = previous_of(c);
            relax(mesh.wedges[n], mesh.edges[c], mesh.corner_start[n] + mesh.corner_angle[n] - mesh.corner_start[c]);
            relax(mesh.wedges[p], mesh.edges[p], mesh.corner_start[p] - mesh.corner_start[c] - mesh.corner_angle[c]);
            c = mesh.next_corner(c);
        } while (c != no_index && c != first);
    }
    return nearest;
}

}  // namespace

void follow_guides(const WorkMesh& mesh, DirectionField& field, double band, double reach) {
    if (mesh.is_guide.empty()) return;
    const std::vector<Complex> along = directions_along(mesh);
    core::UnionFind guides(mesh.points.size());
    for (Index e = 0; e < mesh.is_guide.size(); ++e)
        if (mesh.is_guide[e]) guides.unite(mesh.start_of(mesh.edge_halfedges[e]), mesh.end_of(mesh.edge_halfedges[e]));
    std::vector<double> agreement(mesh.points.size(), 0.0);
    for (Index w = 0; w < along.size(); ++w)
        agreement[guides.find(mesh.wedge_vertices[w])] +=
            field.confidence[w] * (field.measured[w] * std::conj(along[w])).real();
    const std::vector<Nearest> nearest = carry(mesh, along, reach);
    field.guided.assign(along.size(), not_guided);
    for (Index w = 0; w < along.size(); ++w) {
        const Nearest& n = nearest[w];
        if (n.vertex == no_index) continue;
        const bool is_max = agreement[guides.find(n.vertex)] >= 0.0;
        if (n.distance == 0.0) field.guided[w] = is_max ? along_max : along_min;
        if (n.distance < band) {
            field.measured[w] = is_max ? n.square : -n.square;
            field.confidence[w] = firm * (1.0 - n.distance / band);
        } else {
            const double part = (n.distance - band) / (reach - band);
            field.confidence[w] *= part * part;
        }
    }
}

}  // namespace certa::remeshing
