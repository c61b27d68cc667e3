#pragma once
// Subdivision that neither folds nor meets itself: as smooth as that allows.
#include "remeshing/damage.h"
#include "remeshing/work_mesh.h"

namespace certa::remeshing {

struct SubdivisionReport {
    std::size_t held = 0;  ///< vertices that are nearer to where they were within their polygon than smoothing asks for
    std::uint64_t rounds = 0;  ///< that were done: fewer where polygons would turn away or meet others all the same ...
    Point3 place;              ///< ... first here
};

/// `rounds` of subdivide(). Where polygons of the result would turn away from the input or meet others, their vertices
/// go back, half of the way each time, to where they lie on the coarse polygons; coarse quads that are broken even then
/// are cut in two first. `creases`: the input, whose creases too short to be curves stay as they are. Deterministic.
///
/// Guarantee: nothing is broken that was not before.
CoarseMesh subdivide_soundly(const CoarseMesh& mesh, std::uint64_t rounds, const Judge& judge,
                             SubdivisionReport& report, const RunControl& control, const WorkMesh* creases = nullptr);

}  // namespace certa::remeshing
