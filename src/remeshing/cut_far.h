#pragma once
// What is done to polygons that are too far from the input, before they are given up.
#include "core/triangle_tree.h"
#include "remeshing/join_triangles.h"
#include "remeshing/missed_creases.h"

namespace certa::remeshing {

/// Ways to cut the polygons of `far`: those of more than three corners along their best diagonals; with `may_add`
/// triangles around a new vertex on the input, in the middle of the side that is farthest (then what is beyond the side
/// is cut, too) or in their own middle. Sides on features stay. The new vertices are added to the mesh. No polygon is
/// in two of the cuts, so that some of `far` may have to wait for the next time. Deterministic.
std::vector<Recut> cut_far_polygons(CoarseMesh& mesh, const std::vector<Index>& far, const core::TriangleTree& input,
                                    bool may_add);

/// Triangles around a new vertex at each of these places, the first one where a polygon has several; the same besides.
std::vector<Recut> cut_around_points(CoarseMesh& mesh, const std::vector<MissedCrease>& points,
                                     const core::TriangleTree& input);

}  // namespace certa::remeshing
