#pragma once
// Creases of the input that a coarse mesh has lost.
#include "remeshing/damage.h"
#include "remeshing/work_mesh.h"

namespace certa::remeshing {

/// Appends the polygons of `result` below creases that no side is as near to as `limit`, and below minor corners that
/// no vertex is. Returns how far the farthest is.
double add_missed_creases(const WorkMesh& mesh, const Judge& judge, const CoarseMesh& result, double limit,
                          std::vector<Index>& polygons);

/// How far the input's vertices are from the result, at most: less than the distance of the two.
double reach_of(const WorkMesh& mesh, const Judge& judge, const CoarseMesh& result);

}  // namespace certa::remeshing
