#pragma once
// Subdivision that neither folds nor meets itself: as smooth as that allows.
#include "remeshing/damage.h"
#include "remeshing/work_mesh.h"

namespace certa::remeshing {

struct SubdivisionRule {
    std::uint64_t rounds = 1;
    double error = 0.0;  ///< bound on the distance from the input, both ways, that the mesh keeps; 0: none is asked for
    /// Whose creases stay covered, as closely as the error allows, or else the distance of the result; those too short
    /// to be curves stay as they are. Null: nothing is asked of creases.
    const WorkMesh* input = nullptr;
};

struct SubdivisionReport {
    std::size_t held = 0;  ///< vertices that are nearer to their polygon than smoothing asks for
    std::size_t coarse =
        0;  ///< polygons that were not cut in some round: their pieces would be broken however they lie
    std::uint64_t rounds = 0;  ///< that were done: fewer where all would have to stay coarse
    Point3 place;              ///< a corner of the first polygon that stays coarse
};

/// Rounds of subdivide(). Where polygons of the result would turn away from the input or meet others, or be too far,
/// their vertices go back, half of the way each time, to where they lie on the polygons of the round before; quads that
/// are broken even then are cut in two first; what is broken after that is not subdivided. Deterministic.
///
/// Guarantee: nothing is broken that was not before.
/// Cost:      everything is looked at a few times a round; in between, what has moved.
CoarseMesh subdivide_soundly(const CoarseMesh& mesh, const SubdivisionRule& rule, const Judge& judge,
                             SubdivisionReport& report, const RunControl& control);
/// Into the statistics, with a note where not all of `rounds` was done everywhere.
void give_report(const SubdivisionReport& report, std::uint64_t rounds, RemeshStatistics& statistics);

}  // namespace certa::remeshing
