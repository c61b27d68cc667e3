#pragma once
// A few vertices fewer, where they do least.
#include <span>

#include "core/triangle_tree.h"
#include "remeshing/contraction.h"

namespace certa::remeshing {

/// Merges `count` vertices, or fewer where there is nothing left to merge: sides and diagonals of quads contract in the
/// order of what that adds to the integral of squared distances, of faces that are planes to the input, as quadrics
/// near them let expect. Vertices are free where `is_free` says so; those
/// that it does not know stay.
///
/// Guarantee: as that of Contraction; no polygon turns by more than a little. Vertices lie on the surface.
/// Deterministic.
std::vector<MergedVertex> coarsen(const core::TriangleTree& tree, const ArrangementRule& rule, std::size_t count,
                                  std::span<const std::uint8_t> is_free, CoarseMesh& mesh);

}  // namespace certa::remeshing
