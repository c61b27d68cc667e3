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

/// How far creases may be from a result that no error is asked of. The check goes by the bound on the distance.
struct CreaseRule {
    double of_bound = 0.94;  ///< less than all of it, for what is still done to the mesh ...
    double of_reach = 1.0;   ///< ... but where the distance is largest at a crease, there is nothing to gain
};

/// The same as a length. Takes a while, unless nothing is as far as that surely is: then infinite.
double crease_limit(const CreaseRule& rule, const WorkMesh& mesh, const Judge& judge, const CoarseMesh& result,
                    const RunControl& control);

}  // namespace certa::remeshing
