#pragma once
// Triangles without area: a corner in the opposite side, which whoever reads the mesh would have to take for a crack.
#include "remeshing/coarse_mesh.h"

namespace certa::remeshing {

/// Gives the corner to the polygon beyond that side, which becomes triangles around it, and leaves the triangle out.
/// Where the polygon is not convex there, nothing is changed.
CoarseMesh without_flat_triangles(const CoarseMesh& mesh);

}  // namespace certa::remeshing
