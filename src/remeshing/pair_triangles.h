#pragma once
// Quads from pairs of triangles that lie in one plane, nearly: most of what mending leaves in flat parts.
#include <cstdint>
#include <vector>

#include "remeshing/coarse_mesh.h"

namespace certa::remeshing {

/// Joins triangles with the same number in `group` (per polygon; no_index: stays) over sides that are no features, the
/// best-shaped pairs first: convex quads without sharp corners, whose diagonals pass within `height` of each other.
/// Numbers of polygons change, their order does not.
CoarseMesh pair_triangles(const CoarseMesh& mesh, const std::vector<Index>& group, double height);

}  // namespace certa::remeshing
