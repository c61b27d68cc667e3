#pragma once
// Outputs of remeshing (thesis 4.3.3, Figure 4.12): polygons cut into quads and triangles, into triangles, or until
// none has too many corners. No vertex is added or moved, so the mesh goes on conforming.
#include "core/triangle_tree.h"
#include "remeshing/coarse_mesh.h"

namespace certa::remeshing {

/// Every polygon of more than four corners becomes quads and triangles: of all ways to cut it the one with the least
/// cost, in which a quad is cheap when its corners are near 90 degrees, a triangle costs more, and a corner without a
/// turn (a T-node) or a reflex one is nearly prohibitive. A quad with such a corner is cut, too.
CoarseMesh make_quad_dominant(const CoarseMesh& mesh);

/// All triangles, on the diagonals nearest to the input.
CoarseMesh make_triangles(const CoarseMesh& mesh, const core::TriangleTree& input);

/// Polygons of more than `most` corners (at least 3) are cut along their best diagonal, again and again.
CoarseMesh limit_degree(const CoarseMesh& mesh, std::size_t most);

/// The pieces of one polygon, as positions 0 ... n - 1 in its ring; pieces of three or four, in order. What
/// make_quad_dominant does.
std::vector<std::vector<Index>> cut_into_quads(std::span<const Point3> ring);

/// The cost of one piece, of three or four corners.
double cutting_cost(std::span<const Point3> piece);

}  // namespace certa::remeshing
