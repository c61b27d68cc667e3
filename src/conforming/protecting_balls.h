#pragma once
// Protecting balls (thesis, Part I, 1.1.2, 1.3, 1.4.2) as a function of the complex, alpha and what is to be protected.
#include <certa/run_control.h>

#include <cstdint>
#include <optional>
#include <vector>

#include "conforming/complex.h"
#include "conforming/facet_interior.h"
#include "conforming/local_feature_size.h"

namespace certa::conforming {

/// Which vertices get a ball and which segments are covered by balls from end to end; one flag per point and segment.
/// A set is closed when both ends of every protected segment are protected.
struct ProtectedSet {
    std::vector<std::uint8_t> vertices, segments;
};

/// The thesis without 1.4.2: every vertex and every segment.
ProtectedSet protect_all(const Complex& complex);

/// 1.4.2: every vertex, and the segments where two sheets of incident facets meet at less than 90 degrees. A facet that
/// lies on both sides of a segment counts as two sheets. An angle that is 90 degrees up to the rounding of the input
/// coordinates counts as 90 degrees, so that boxes stay boxes when they are rotated.
ProtectedSet protect_sharp(const Complex& complex, const FacetInterior& interior);

/// Nothing; for sets that grow.
ProtectedSet protect_nothing(const Complex& complex);

/// Protects the ends of protected segments.
void close_under_ends(ProtectedSet& set, const Complex& complex);

/// Whether two sheets of facets meet at less than 90 degrees along a segment (see protect_sharp).
bool is_sharp_segment(const Complex& complex, const FacetInterior& interior, std::uint32_t segment);

enum class BallKind : std::uint8_t { vertex, segment };

/// A closed ball centred on an input vertex, or on a segment at `distance` from its first end.
struct Ball {
    Point3 center;
    double radius = 0.0;
    BallKind kind = BallKind::vertex;
    std::uint32_t index = 0;  ///< of the vertex or segment
    double distance = 0.0;
};

struct BallOptions {
    double alpha = 0.4;                                                 ///< radius over local feature size, in (0, 0.5)
    double min_radius = 0.0;                                            ///< below it: Outcome::below_min_feature
    std::size_t max_balls = std::numeric_limits<std::uint32_t>::max();  ///< above it: Outcome::over_budget
};

/// What stopped the construction: the vertex or segment to be protected, the face that comes too near, and where.
struct BallObstacle {
    ElementRef protected_face, near_face;
    Point3 place;
    double radius = 0.0;
};

struct ProtectingBalls {
    Outcome outcome = Outcome::done;
    std::optional<BallObstacle> obstacle;  ///< unless done or cancelled
    std::vector<Ball> balls;               ///< of vertices first, by vertex; then of segments, by segment and distance
    std::vector<std::uint32_t> vertex_balls;  ///< per point: its ball, or no_index
    Rows<std::uint32_t> segment_balls;        ///< per segment: if covered, all balls from its first to its second end
};

/// Builds the balls of 1.3.
///
/// Input:      a validated complex; `set` is closed first (see close_under_ends), nothing else is added to it.
/// Guarantee:  up to rounding, conditions (ii)-(vii) of 1.1.2, and (i) for what `set` names: radii depend on the local
///             feature size only, so leaving balls out breaks none of the other conditions. Balls that intersect are
///             neighbours in a row of `segment_balls`; they overlap by more than 0.001 of the smaller radius.
/// Cost:       O(log n) per ball; deterministic.
/// Source:     thesis, Part I, 1.3. Condition (vi) is kept with a margin: near-tangent balls would put points very
/// close
///             to each other.
ProtectingBalls build_protecting_balls(const Complex& complex, const LocalFeatureSize& feature_size, ProtectedSet set,
                                       const BallOptions& options = {}, const RunControl& control = {});

}  // namespace certa::conforming
