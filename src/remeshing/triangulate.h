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

/// The same by clipping ears, seen along Newell's normal, from the first corner on.
void clip_ears(std::span<const Point3> points, std::span<const Index> ring, const core::TriangleTree& input,
               std::vector<std::array<Index, 3>>& triangles);

/// Every way to cut a polygon of n corners into triangles, by the numbers of its corners: 5 for n = 5, 14 for 6, 42
/// for 7.
std::vector<std::vector<std::array<std::size_t, 3>>> all_triangulations(std::size_t n);

/// All polygons of a mesh. `polygon_of`, if given, receives the polygon of each triangle.
std::vector<std::array<Index, 3>> triangulate(const CoarseMesh& mesh, const core::TriangleTree& input,
                                              std::vector<Index>* polygon_of = nullptr);

}  // namespace certa::remeshing
