#pragma once
// Flat faces with holes, or with several rims: triangles between the vertices that are there already.
#include <optional>
#include <span>
#include <vector>

#include "remeshing/arrangement.h"
#include "remeshing/coarse_mesh.h"
#include "remeshing/merge_ends.h"

namespace certa::remeshing {

/// Triangles that fill what lies between rims in a plane: cycles of vertices with the inside on their left, seen from
/// where `normal` points to. Constrained Delaunay as far as doubles tell; positive areas, no vertex is added. Nothing
/// where the rims are not simple, or cross.
std::optional<std::vector<std::array<Index, 3>>> triangulate_between(std::span<const Point3> points,
                                                                     const std::vector<std::vector<Index>>& rims,
                                                                     const Point3& normal);

/// Adds triangles, or quads of two of them, in place of those open faces that make up a flat part of a patch; their
/// parent is the first of the patch's open faces. Flat: within `tolerance`. Returns the faces, sorted.
std::vector<Index> fill_flat_faces(const Network& network, const Graph& graph,
                                   const std::vector<std::vector<Index>>& faces, std::span<const Index> open,
                                   std::span<const Index> nodes, std::span<const MergedVertex> merged, double tolerance,
                                   CoarseMesh& mesh);

}  // namespace certa::remeshing
