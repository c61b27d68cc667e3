#pragma once
// Creases of the input that a coarse mesh has lost.
#include "remeshing/damage.h"
#include "remeshing/work_mesh.h"

namespace certa::remeshing {

/// A point of a crease and the polygon below it.
struct MissedCrease {
    Index polygon = no_index;
    Point3 point;
    double distance = 0.0;  ///< from the nearest side, or vertex
};

/// Points of creases that no side of `result` is as near to as `limit`, and minor corners that no vertex is; the
/// farthest first.
std::vector<MissedCrease> find_missed_creases(const WorkMesh& mesh, const Judge& judge, const CoarseMesh& result,
                                              double limit);

/// Appends the polygons of `result` below creases that no side is as near to as `limit`, and below minor corners that
/// no vertex is. Returns how far the farthest is.
double add_missed_creases(const WorkMesh& mesh, const Judge& judge, const CoarseMesh& result, double limit,
                          std::vector<Index>& polygons);

/// How far the input's vertices are from the result, at most: less than the distance of the two.
double reach_of(const WorkMesh& mesh, const Judge& judge, const CoarseMesh& result);

}  // namespace certa::remeshing
