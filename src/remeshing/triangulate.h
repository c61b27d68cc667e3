#pragma once
// Cuts polygons into triangles: the triangulation whose diagonals are nearest to the input.
#include <span>
#include <vector>

#include "core/triangle_tree.h"
#include "remeshing/coarse_mesh.h"

namespace certa::remeshing {

/// Appends the triangles of a polygon, n - 2 of them, each as three of its vertices in order. Triangles that turn away
/// from the polygon's own side (Newell's normal) or have no area are avoided where there is a way to; among the rest
/// the sum over the diagonals of length times mean squared distance from `input` decides, ties go to the first. An
/// empty tree: short diagonals.
void triangulate_polygon(std::span<const Point3> points, std::span<const Index> ring, const core::TriangleTree& input,
                         std::vector<std::array<Index, 3>>& triangles);

/// All polygons of a mesh. `polygon_of`, if given, receives the polygon of each triangle.
std::vector<std::array<Index, 3>> triangulate(const CoarseMesh& mesh, const core::TriangleTree& input,
                                              std::vector<Index>* polygon_of = nullptr);

}  // namespace certa::remeshing
