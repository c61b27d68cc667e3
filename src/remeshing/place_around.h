#pragma once
// Placement after mending.
#include <functional>

#include "remeshing/missed_creases.h"
#include "remeshing/place_and_cut.h"

namespace certa::remeshing {

/// Mending puts corners back on the surface: they and what is beside them are placed once more, vertices from
/// `first_added` on stay. What that would spoil goes back; where too much would be, all of it.
///
/// `find_broken`: polygons of a mesh that are, or that miss creases; it may cut quads.
void place_around(Index first_added, const PlaceMesh& place,
                  const std::function<std::vector<Index>(CoarseMesh&)>& find_broken, CoarseMesh& mesh,
                  const RunControl& control);

}  // namespace certa::remeshing
