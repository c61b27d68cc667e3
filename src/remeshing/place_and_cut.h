#pragma once
// Placement and cutting in turn: how polygons are cut best shows when vertices are placed, and the other way round.
#include <functional>

#include "remeshing/join_triangles.h"
#include "remeshing/placement.h"

namespace certa::remeshing {

using PlaceMesh = std::function<PlacementReport(CoarseMesh&, const PlacementOptions&)>;

/// Moves the vertices of `coarse`: the polygons and, where faces are open, triangles of the input. A few rounds show
/// where sides are far off and where T-nodes cancel; the rest is placed as cut then, and once more where sides are far
/// off after that. Quickly: with less patience, because others will go on placing. Returns how the polygons are to be
/// cut anew.
std::vector<Recut> place_and_cut(const CoarseMesh& polygons, const core::TriangleTree& input, const PlaceMesh& place,
                                 bool is_quick, CoarseMesh& coarse);

}  // namespace certa::remeshing
