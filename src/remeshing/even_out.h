#pragma once
// Vertices slide along the surface until cells are even in the spacing of lines.
#include "core/triangle_tree.h"
#include "remeshing/coarse_mesh.h"
#include "remeshing/spacing.h"

namespace certa::remeshing {

/// Trimming and lines that end leave sides that zigzag and strips of wide cells. Vertices slide, a few rounds, each to
/// where the polygons around it have the least squared distance from a surface with curvatures that the spacing stands
/// for. Corners stay and what lies beside an open side, vertices of curves stay on them, nothing turns over.
///
/// Input: a mesh with vertices and places on the surface, whose tree is given.
void even_out(const WorkMesh& surface, const DirectionField& field, const Spacing& spacing,
              const core::TriangleTree& tree, CoarseMesh& mesh, const RunControl& control);

}  // namespace certa::remeshing
