#pragma once
// Principal directions on the work mesh: tensors, smoothing, umbilics (thesis 4.1).
#include <optional>
#include <span>

#include "remeshing/work_mesh.h"

namespace certa::remeshing {

/// The families of lines: along the direction of k_max, along that of k_min.
enum Family : std::uint8_t { along_max = 0, along_min = 1 };

/// In place of a family.
constexpr std::uint8_t not_guided = 2;

/// A triangle around which the directions turn.
struct FieldUmbilic {
    Index face = no_index;
    int half_turns = 0;  ///< +1: wedge, -1: trisector
    std::array<double, 3> weights{};
    bool linear_zero = false;  ///< the place is the zero of the linear field; else the centroid
    int typed_half_turns = 0;  ///< by the linear field's polynomial of third order; 0 where it has no zero in the face
};

/// Directions as squares of unit complex numbers along the direction of k_max, one per wedge, in the wedge's frame; and
/// the same seen from half-edges: relative to the half-edge's direction at its start and at its end. Interpolating
/// those along an edge gives the same line from both sides.
struct DirectionField {
    std::vector<double> k_min, k_max;   ///< per wedge
    std::vector<double> confidence;     ///< per wedge: of the measured direction, in [0, 1)
    std::vector<Complex> measured;      ///< unit, or 0
    std::vector<Complex> squares;       ///< smoothed
    std::vector<Complex> starts, ends;  ///< per half-edge
    std::vector<FieldUmbilic> umbilics;
    std::vector<std::uint8_t> guided;  ///< per wedge: the family that follows a guide there, or not_guided; or empty
    double smoothing = 0.0;            ///< length, in the input's unit
    double noise = 0.0;                ///< sigma: differences of curvature below this say nothing

    /// The squared direction of k_max at t in [0, 1] of the half-edge, relative to it.
    Complex at(Index halfedge, double t) const { return (1.0 - t) * starts[halfedge] + t * ends[halfedge]; }
};

/// Curvatures and directions, one-sided at features.
DirectionField measure_directions(const WorkMesh& mesh, const RunControl& control);
/// Smooths over `length`; fills squares, starts, ends and umbilics.
void smooth_directions(const WorkMesh& mesh, DirectionField& field, double length, const RunControl& control);
/// Convolves the tensors with a Gaussian instead, as the thesis does: k_min and k_max change, too.
void smooth_by_gaussian(const WorkMesh& mesh, DirectionField& field, double deviation, const RunControl& control);
/// Part of both: directions where there are none, half-edge values, umbilics.
void finish_directions(const WorkMesh& mesh, DirectionField& field);
/// The umbilic of a face, if the directions turn around it.
std::optional<FieldUmbilic> find_umbilic(const WorkMesh& mesh, const DirectionField& field, Index face);
/// Half-edge values from the wedges' (part of smooth_directions).
void spread_to_halfedges(const WorkMesh& mesh, DirectionField& field);
/// The same in some faces.
void spread_to_halfedges(const WorkMesh& mesh, std::span<const Index> faces, DirectionField& field);
/// The squares at a face's corners in the face's own plane.
std::array<Complex, 3> corner_values(const WorkMesh& mesh, const DirectionField& field, Index face);
struct UmbilicType {
    int half_turns = 0;
    int separatrices = 0;  ///< lines along k_max that end in the umbilic
};
/// The zero of the deviator (a x + b y, c x + d y), typed by the roots of a cubic form as the thesis does.
UmbilicType type_of_linear_field(double a, double b, double c, double d);
UmbilicType type_of_face(const WorkMesh& mesh, const DirectionField& field, Index face);
/// Index of the field around a face, times two: edge rotations and holonomy.
int half_turns_of(const WorkMesh& mesh, const DirectionField& field, Index face);

}  // namespace certa::remeshing
