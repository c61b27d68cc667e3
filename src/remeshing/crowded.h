#pragma once
// Edges that cutting polygons has repeated.
#include "remeshing/coarse_mesh.h"

namespace certa::remeshing {

/// Edges of the mesh as it will be written that more than two polygons share, or one twice: their ends.
std::vector<Index> crowded_vertices(const CoarseMesh& mesh);
/// Polygons in which two vertices of a crowded edge are not neighbours become triangles around a new vertex.
CoarseMesh fan_out(const CoarseMesh& mesh, const std::vector<Index>& crowded);

}  // namespace certa::remeshing
