#pragma once
// Subdivision that neither folds nor meets itself: as smooth as that allows.
#include "remeshing/damage.h"

namespace certa::remeshing {

struct SubdivisionReport {
    std::size_t held = 0;  ///< vertices that are nearer to where they were within their polygon than smoothing asks for
    std::size_t broken = 0;  ///< polygons that turn away or meet others all the same
};

/// `rounds` of subdivide(). Where polygons of the result would turn away from the input or meet others, their vertices
/// go back, half of the way each time, to where they lie on the coarse polygons. Deterministic.
CoarseMesh subdivide_soundly(const CoarseMesh& mesh, std::uint64_t rounds, const Judge& judge,
                             SubdivisionReport& report, const RunControl& control);

}  // namespace certa::remeshing
