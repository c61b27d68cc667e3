#pragma once
// From what the stages work on to what the caller gets.
#include <certa/remeshing.h>

#include "remeshing/coarse_mesh.h"
#include "remeshing/network.h"

namespace certa::remeshing {

/// The mesh, its feature edges and the numbers of both; what was there before goes.
void give_polygons(const CoarseMesh& mesh, RemeshResult& result);
/// Numbers of lines, umbilics and, on demand, the lines themselves.
void give_lines(const Network& network, const DirectionField& field, const WorkMesh& mesh, bool with_lines,
                RemeshResult& result);

/// By index; those beyond 1/2, if there are any, with a note.
void count_umbilics(const DirectionField& field, const WorkMesh& mesh, RemeshStatistics& statistics);

/// A note where a count misses what was wanted by more than 5 %. `network`: before mending.
void note_count(double count, double wanted, double network, RemeshStatistics& statistics);

}  // namespace certa::remeshing
