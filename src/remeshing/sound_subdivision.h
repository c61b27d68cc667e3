#pragma once
// Subdivision that neither folds nor meets itself: as smooth as that allows.
#include <string>

#include "remeshing/damage.h"
#include "remeshing/work_mesh.h"

namespace certa::remeshing {

struct SubdivisionReport {
    std::size_t held = 0;  ///< vertices that are nearer to their polygon than smoothing asks for
    std::size_t coarse =
        0;  ///< polygons that were not cut in some round: their pieces would be broken however they lie
    std::uint64_t rounds = 0;  ///< that were done: fewer where all would have to stay coarse
    Point3 place;              ///< a corner of the first polygon that stays coarse
};

/// `rounds` of subdivide(). Where polygons of the result would turn away from the input or meet others, their vertices
/// go back, half of the way each time, to where they lie on the polygons of the round before; quads that are broken
/// even then are cut in two first; what is broken after that is not subdivided. `input`: whose creases stay covered, as
/// closely as the distance of the result allows; those too short to be curves stay as they are. Deterministic.
///
/// Guarantee: nothing is broken that was not before.
/// Cost:      everything is looked at a few times a round; in between, what has moved.
CoarseMesh subdivide_soundly(const CoarseMesh& mesh, std::uint64_t rounds, const Judge& judge,
                             SubdivisionReport& report, const RunControl& control, const WorkMesh* input = nullptr);

/// What somebody who asked for `rounds` should know; empty: nothing. `place`: the report's, in words.
std::string describe(const SubdivisionReport& report, std::uint64_t rounds, const std::string& place);

}  // namespace certa::remeshing
