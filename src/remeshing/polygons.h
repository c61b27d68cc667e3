#pragma once
// From the graph to polygons (thesis 4.3.3; remesh, stages 8 and 9).
#include "remeshing/arrangement.h"

namespace certa::remeshing {

/// Parts of the surface where the graph's faces are not disks; empty: all of them are.
std::vector<BadRegion> find_bad_regions(const Graph& graph, const WorkMesh& mesh,
                                        const std::vector<std::vector<Index>>& faces);

struct PolygonCounts {
    std::size_t t_nodes = 0, polygons = 0, quads_with_t = 0, quads_without_t = 0;
    std::size_t pinched = 0;  ///< polygons that meet themselves in a vertex
};
/// The faces as polygons over the graph's nodes.
CoarseMesh make_polygons(const Graph& graph, const std::vector<std::vector<Index>>& faces, PolygonCounts& counts);

}  // namespace certa::remeshing
