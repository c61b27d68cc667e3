#pragma once
// One set of nodes for all sheets that meet in an edge: where the input was cut open, it can be put together again.
#include "remeshing/arrangement.h"

namespace certa::remeshing {

/// Gives every sheet at edges that were cut open the nodes that any of them has there, in the very same places. Those
/// that lie close to each other become one place. Points where sheets touch without an edge get nodes likewise, if they
/// lie on curves.
///
/// Guarantee: nodes at such edges are corners, which nothing moves or merges; faces keep their number.
void share_nodes(Graph& graph, const WorkMesh& mesh);

}  // namespace certa::remeshing
