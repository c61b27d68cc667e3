#pragma once
// From the graph to polygons (thesis 4.3.3; remesh, stages 8 and 9).
#include <span>

#include "remeshing/arrangement.h"

namespace certa::remeshing {

/// Nodes beside a patch near which one more line might help.
struct FlawPlace {
    Index patch = no_index;
    std::vector<Index> nodes;
    double size = 0.0;  ///< of what they surround; 0 where they are one node
};

/// Where the graph's faces are no polygons yet.
struct Flaws {
    std::vector<Index> patches;     ///< of the work mesh: not all faces there are disks
    std::vector<Index> faces;       ///< of the graph: they meet themselves in a node
    std::vector<FlawPlace> places;  ///< nodes that faces meet themselves in, parts of the graph that lines do not tie
    bool empty() const { return patches.empty() && faces.empty(); }
};
/// The patch of the work mesh to the left of a half-edge; no_index outside the boundary.
Index patch_beside(const Graph& graph, const Network& network, Index halfedge);
/// Checks all faces: in every patch V - E + F over what lies inside it must be the patch's own, which holds exactly
/// when each face has one rim and no handle; and no face may pass a node twice.
Flaws find_flaws(const Graph& graph, const Network& network, const std::vector<std::vector<Index>>& faces);

/// The triangle of the work mesh to the left of a half-edge's beginning; no_index outside the boundary.
Index triangle_beside(const Graph& graph, const Network& network, Index halfedge);

struct PolygonCounts {
    std::size_t t_nodes = 0, polygons = 0, quads_with_t = 0, quads_without_t = 0;
};
/// The faces, but those of `open` (sorted), as polygons over the graph's nodes; `nodes` receives the node of each
/// vertex.
CoarseMesh make_polygons(const Graph& graph, const std::vector<std::vector<Index>>& faces, std::span<const Index> open,
                         PolygonCounts& counts, std::vector<Index>& nodes);

}  // namespace certa::remeshing
