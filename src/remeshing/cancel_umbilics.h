#pragma once
// Opposite umbilics that lines could not tell apart are smoothed away (remesh, stage 4).
#include "remeshing/field.h"
#include "remeshing/spacing.h"

namespace certa::remeshing {

/// Pairs of a wedge and a trisector that are closer to each other than the spacing there: the field in a disk around
/// the two becomes the smoothest one with the values at the disk's rim, if it turns around nothing within afterwards,
/// or around less. The sum of all indices stays as it is. Deterministic. Returns the number of pairs that are gone.
std::size_t cancel_umbilic_pairs(const WorkMesh& mesh, const Spacing& spacing, DirectionField& field,
                                 const RunControl& control);

}  // namespace certa::remeshing
