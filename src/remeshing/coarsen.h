#pragma once
// A few vertices fewer, where they do least.
#include "core/triangle_tree.h"
#include "remeshing/contraction.h"

namespace certa::remeshing {

/// Merges `count` vertices, or fewer where there is nothing left to merge: sides and diagonals of quads contract in the
/// order of what that adds to the integral of squared distances, of faces that are planes to the input, as quadrics
/// near them let expect. Vertices from `most` on stay.
///
/// Guarantee: as that of Contraction; no polygon turns by more than a little. Vertices lie on the surface.
/// Deterministic.
std::vector<MergedVertex> coarsen(const core::TriangleTree& tree, const ArrangementRule& rule, std::size_t count,
                                  Index most, CoarseMesh& mesh);

}  // namespace certa::remeshing
