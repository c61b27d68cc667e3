#pragma once
// Moves the vertices of a coarse mesh to where the distance to the input is least (beyond the thesis).
#include <certa/mesh.h>
#include <certa/run_control.h>

#include <span>
#include <vector>

#include "remeshing/coarse_mesh.h"

namespace certa::remeshing {

struct PlacementOptions {
    std::uint32_t rounds = 12;       ///< of closest points and least squares ...
    std::uint32_t peak_rounds = 20;  ///< ... and then reweighted towards the largest distances
    double peak_power = 6.0;         ///< the mean of the distances' power that these lower
    double anchor = 0.001;           ///< stiffness against sliding along the surface, relative to that across it
    std::uint32_t samples_per_triangle = 9;
    bool both_diagonals = false;  ///< quads count as cut along either diagonal: for a bound that holds for both
    std::uint64_t seed = 1;
    Index fixed_from = no_index;  ///< vertices from this one on stay
};

struct PlacementReport {
    double rms_before = 0.0, rms_after = 0.0;          ///< of the samples' distances, both ways
    double largest_before = 0.0, largest_after = 0.0;  ///< of the samples
    std::vector<double> farthest;  ///< per polygon: the largest distance of samples on it, and of those nearest to it
    std::uint32_t rounds = 0;      ///< that lowered the objective
    Outcome outcome = Outcome::done;  ///< cancelled: the mesh is as after the last whole round
};

/// Alternates closest points (samples of either surface on the other) and a linear least-squares step on their
/// distances along the input's normals. Corners stay where they are; crease and boundary vertices move along their
/// curve of `features` (edges of the input), on it; a step that would turn a triangle away from the input is halved,
/// and polygons that end up turned away or meeting others go back towards where they were.
///
/// With no rounds at all, only distances are measured.
///
/// Input:      an oriented triangle mesh with unit-size coordinates or any other (scaled inside), its feature edges,
///             a coarse mesh with vertices on or near it. mesh.places need not be set; they are set at the end.
/// Guarantee:  connectivity, kinds and curves are untouched; the objective does not grow but where something is taken
/// back. Deterministic. Cost:       linear in vertices times samples, with the logarithm of the input's size.
PlacementReport place_vertices(const TriangleMesh& input, std::span<const FeatureEdge> features, CoarseMesh& mesh,
                               const PlacementOptions& options = {}, const RunControl& control = {});

}  // namespace certa::remeshing
