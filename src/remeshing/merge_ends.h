#pragma once
// Ends of lines that lie close to each other on a crease or boundary become one vertex, and nodes in one place.
#include <span>

#include "remeshing/contraction.h"

namespace certa::remeshing {

/// Contracts sides on features that are shorter than `reach` (per vertex; the smaller of the two ends counts), and
/// others that are shorter than half of it, shortest first. Lines of both families, and those on either side of a
/// crease, end where they happen to: one vertex does for two of them. Corners stay; a side keeps to the rule's errors
/// of the nodes that were on it.
///
/// Guarantee: no side is repeated that was not, the topology stays. Vertices that were merged belong to no polygon any
/// more; triangles on contracted sides are gone.
std::vector<MergedVertex> merge_line_ends(CoarseMesh& mesh, std::span<const double> reach, const ArrangementRule& rule);

}  // namespace certa::remeshing
