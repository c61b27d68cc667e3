#pragma once
// Together again what was cut open at edges of more than two triangles, and at vertices of several fans.
#include "remeshing/coarse_mesh.h"

namespace certa::remeshing {

/// Makes one vertex of those in the very same place, but where a polygon has two of them; vertices without polygons go.
CoarseMesh stitch(const CoarseMesh& mesh);
/// Per vertex: the one that stands for it then.
std::vector<Index> stitched_vertices(const CoarseMesh& mesh);
/// Vertices that polygons have; `stitched`: as many as there are then.
std::size_t count_vertices(const CoarseMesh& mesh, bool stitched);

}  // namespace certa::remeshing
