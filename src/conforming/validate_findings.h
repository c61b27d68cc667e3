#pragma once
// The parts of geometric validation: facets one by one, then all pairs of pieces of different elements.
#include <vector>

#include "conforming/validate.h"
#include "conforming/validate_contacts.h"

namespace certa::conforming {

/// The complex as simplices: the triangles of each facet (size 3), segments that are sides of no facet (2), points
/// that nothing uses (1). The owner is the facet, the segment or the point.
struct Pieces {
    std::vector<Simplex> simplices;
    std::vector<std::uint32_t> owners;
    /// Per facet: how far from its plane a point is still as good as on it. 16 ulps of its largest coordinate, plus
    /// what its own points deviate from the plane.
    std::vector<double> near;

    void add(const Simplex& simplex, std::uint32_t owner) {
        simplices.push_back(simplex);
        owners.push_back(owner);
    }
};

/// Checks every facet by itself, reports into `report`, and returns the pieces of the facets that are sound.
Pieces check_facets(const PiecewiseLinearComplex& input, const Complex& complex, const ConformOptions& options,
                    const ValidationReport& structure, ValidationReport& report);

/// 16 units in the last place of the largest coordinate of the points.
double near_of(std::span<const Point3> points, std::span<const std::uint32_t> vertices);

/// What two pieces have in common that they should not. In order of precedence where two say the same.
enum class FindingKind : std::uint8_t {
    point_on_segment,       ///< vertex, segment
    overlapping_segments,   ///< segment, segment: collinear, an end of each inside the other
    crossing_segments,      ///< segment, segment: in one point
    point_on_facet,         ///< vertex, facet: exactly, inside
    overlapping_facets,     ///< facet, facet: coplanar
    crossing_facets,        ///< facet, facet
    segment_in_facet,       ///< segment, facet: a part of it lies in the facet
    segment_crosses_facet,  ///< segment, facet: passes through
    segment_near_facet,     ///< segment, facet: runs within rounding of its inside
    point_near_segment,     ///< vertex, segment: within rounding
    point_near_facet,       ///< vertex, facet: within rounding of its inside
};

struct Finding {
    FindingKind kind{};
    std::uint32_t first = 0, second = 0;     ///< elements, see FindingKind; of one kind ascending
    std::uint32_t piece_a = 0, piece_b = 0;  ///< the pieces that show it
    friend auto operator<=>(const Finding&, const Finding&) = default;  // NOLINT(modernize-use-nullptr)
};

/// All findings, sorted; without `every_piece` one per kind and pair of elements.
std::vector<Finding> find_findings(const Complex& complex, const Pieces& pieces, const KnownClean& known,
                                   bool every_piece = false);

/// The side of the owner along an edge of a piece; no_index for edges inside a facet.
std::uint32_t side_along(const Complex& complex, const Pieces& pieces, std::uint32_t piece, Feature edge);

/// The edge of a simplex whose closure has both features; `inside` when there is none.
Feature edge_with(const Simplex& simplex, Feature f, Feature g);

/// A point where the finding shows.
Point3 place_of(const Complex& complex, const Pieces& pieces, const Finding& finding);

/// Facets that carry one of `places` exactly: pairs of index into `places` and facet.
std::vector<std::pair<std::uint32_t, std::uint32_t>> find_places_on_facets(const Complex& complex, const Pieces& pieces,
                                                                           std::span<const Point3> places);

}  // namespace certa::conforming
