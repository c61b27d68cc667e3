#pragma once
// Points where the surface has no direction (thesis 4.2.2; remesh, stage 7), and the faces around them (4.3.2).
#include "remeshing/arrangement.h"
#include "remeshing/spacing.h"

namespace certa::remeshing {

/// Says in which face of the graph a place on the surface lies. Within a triangle coordinates decide between its pieces
/// of lines; beyond it, the order of crossings on edges alone.
class FaceLocator {
public:
    FaceLocator(const Graph& graph, const Network& network, const std::vector<std::vector<Index>>& faces);
    /// The face's number, or no_index outside the boundary.
    Index find(const SurfacePlace& place);

private:
    /// What the graph has of one chord of a line.
    struct Piece {
        Index face = no_index, half = no_index;                  ///< triangle; half-edge of the graph along the line
        Complex from, to;                                        ///< in the triangle's plane
        Index from_crossing = no_index, to_crossing = no_index;  ///< no_index: ends within the triangle
    };
    std::span<const Piece> pieces_of(Index face) const {
        return std::span(pieces_).subspan(offsets_[face], offsets_[face + 1] - offsets_[face]);
    }
    void collect_pieces();
    void collect_features();
    /// The half-edge of the graph that has half-edge h of the mesh, a feature, at t along it.
    Index on_feature(Index h, double t) const;
    /// The half-edge of the graph that is met first, counter-clockwise around a triangle from a place without one.
    Index walk(Index face, Index side, double t) const;
    /// From a triangle without pieces to the nearest one that has some.
    Index flood(Index face);

    const Graph& graph_;
    const Network& network_;
    const WorkMesh& mesh_;
    std::vector<Index> face_of_half_;
    std::vector<Piece> pieces_;
    std::vector<Index> offsets_;
    std::vector<Index> places_on_curve_;           ///< per edge of the mesh on a feature: its number there
    std::vector<std::vector<Index>> curve_edges_;  ///< per curve: edges of the graph
    std::vector<Index> known_;                     ///< per triangle without pieces: its face, once asked
    std::vector<Index> seen_;
    Index stamp_ = 0;
};

struct SampleRule {
    /// Whether centroids of triangles in spherical parts are candidates, too, and faces that are quads get samples;
    /// else umbilics are samples where their face is no quad and would pass too far below them.
    bool everywhere = false;
    double error = 0.0;      ///< not everywhere: what cuts of the face miss the umbilic by must be more than this
    double least_fit = 0.4;  ///< of the actual distance to the desired one
};

/// A point that the face of the graph around it is triangulated around.
struct IsotropicSample {
    Point3 point;
    SurfacePlace place;
    Index face = no_index;
};

/// Per wedge: curved, and alike in all directions.
std::vector<bool> find_spherical_wedges(const DirectionField& field);

/// Umbilics, and on demand centroids of triangles in spherical parts, best fit of desired and actual distance (to other
/// samples, features and the sides of the face) first, until none fits. None where the surface is flat.
std::vector<IsotropicSample> choose_samples(const Graph& graph, const Network& network,
                                            const std::vector<std::vector<Index>>& faces, const DirectionField& field,
                                            const Spacing& spacing, const SampleRule& rule);

/// The polygon of a face (its parent) becomes triangles around the samples there. A polygon that its first sample does
/// not see whole stays. Returns how many samples are vertices now.
std::size_t triangulate_around(const std::vector<IsotropicSample>& samples, CoarseMesh& polygons);

}  // namespace certa::remeshing
