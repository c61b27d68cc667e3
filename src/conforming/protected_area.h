#pragma once
// Points and pieces of the protected area (thesis, Part I, 1.1.3): centre-points, h-points, p-points, SOS-points, and
// the isosceles and right-angled triangles between them. Also the pure geometry of the split-on-a-sphere strategy
// (1.1.4).
#include <array>
#include <cstdint>
#include <vector>

#include "conforming/complex.h"
#include "conforming/facet_interior.h"
#include "conforming/protecting_balls.h"

namespace certa::conforming {

enum class PointRole : std::uint8_t {
    center,  ///< centre of a ball inside a segment (centres of vertex balls are input points)
    h,       ///< on a covered segment, in the radical plane of two neighbouring balls
    leave,   ///< where a segment that is not covered leaves a vertex ball (p_1, p_2 of 1.4.2)
    p,       ///< in a facet, on the boundary of two neighbouring balls
    sos,     ///< in a facet, on the boundary of one ball
};

/// A point to be inserted, once, whatever number of facets it lies on. Owner: a segment (center, h, leave), which it
/// cuts at `distance` from the first end, or a facet (p, sos).
struct NewPoint {
    Point3 position;
    PointRole role = PointRole::sos;
    std::uint32_t owner = 0;                                 ///< segment or facet, by role
    double distance = 0.0;                                   ///< along the owner segment
    std::array<std::uint32_t, 2> balls{no_index, no_index};  ///< center: {own}; h, p: both; leave, sos: {own}
    bool on_segment() const { return role <= PointRole::leave; }
};

/// Edge ab of a facet with both ends on the boundary of a ball; center, a, b is its isosceles triangle,
/// counter-clockwise in the facet's frame, so that the unprotected area is to the right of ab.
struct ShieldEdge {
    std::uint32_t a = 0, b = 0;
    std::uint32_t ball = 0;
    std::uint32_t facet = 0;
};

/// Center, h-point and p-point (in `points`, counter-clockwise in the facet's frame), with the right angle at h.
struct RightTriangle {
    std::array<std::uint32_t, 3> points{};
    std::uint32_t ball = 0;
    std::uint32_t facet = 0;
};

/// Everything that is to be inserted before the main procedure. Point ids: input points first, then `points` in order.
struct ProtectedArea {
    std::vector<Ball> balls;
    std::vector<std::uint32_t> ball_centers;  ///< per ball: point id of its centre
    std::vector<NewPoint> points;
    std::uint32_t input_points = 0;

    Rows<std::uint32_t> chains;        ///< per segment: point ids from its first to its second end
    Rows<std::uint32_t> link_balls;    ///< per segment and link of its chain: the ball that contains it, or no_index
    Rows<ShieldEdge> shields;          ///< per facet
    Rows<RightTriangle> right_angled;  ///< per facet

    std::array<std::uint32_t, 3> isosceles(const ShieldEdge& e) const { return {ball_centers[e.ball], e.a, e.b}; }
    const NewPoint& new_point(std::uint32_t id) const { return points[id - input_points]; }
    bool is_new(std::uint32_t id) const { return id >= input_points; }
};

/// Places the points of 1.1.3 for balls that are done.
///
/// Guarantee:  up to rounding, p-, SOS- and leaving points are on their balls' boundaries, h-points in radical planes;
///             every isosceles angle is below 90 degrees by more than 1e-7 radians.
/// Cost:       linear in the result and in the size of the complex; deterministic.
ProtectedArea build_protected_area(const Complex& complex, const FacetInterior& interior, const ProtectingBalls& balls);

/// Where a shield edge is split.
enum class SplitFrom : std::uint8_t {
    middle,  ///< both ends belong to one ball only
    first,   ///< on a power-of-two shell around the first end
    second,  ///< on a power-of-two shell around the second end
};

/// Shells are centred on p-points and leaving points: these are shared by facets whose edges could otherwise split each
/// other for ever. Of two such ends, p-points go before leaving points, then the one that is shared with the ball of
/// smaller index (the same choice for all facets around a segment), then the smaller id. `ball` is the edge's ball.
SplitFrom choose_split(const ProtectedArea& area, std::uint32_t a, std::uint32_t b, std::uint32_t ball);

/// The point that splits the shield edge ab (1.1.4): on the shortest arc ab of the sphere, in its middle or at distance
/// d from the chosen end, d the power of two nearest to |ab| / 2; so d is within [1/3, 2/3] of |ab|.
Point3 split_on_sphere(const Point3& center, double radius, const Point3& a, const Point3& b, SplitFrom from);

}  // namespace certa::conforming
