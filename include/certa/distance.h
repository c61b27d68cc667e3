#pragma once
// How far two surfaces are apart, both ways: measured on samples, and bounded by a number that is proved.
#include <certa/error.h>
#include <certa/mesh.h>
#include <certa/run_control.h>

#include <cstdint>
#include <vector>

namespace certa {

/// How closely measure_distance looks.
struct DistanceOptions {
    std::uint64_t samples = 30000;  ///< on each surface, in proportion to area, beside all its vertices
    std::uint64_t seed = 1;
    bool bound = true;                   ///< also compute the proved bounds
    double tolerance = 0.02;             ///< bounds may exceed the largest distance found by this factor (below 1) ...
    Length resolution{1e-5, true};       ///< ... or may be this length, whichever is more
    std::uint64_t max_pieces = 1000000;  ///< pieces of triangles that the search for a bound may look at
};

/// Distances from the points of one surface to the other surface.
struct OneSidedDistance {
    double mean = 0.0, rms = 0.0;  ///< over the samples, that is by area
    double largest = 0.0;          ///< over samples and vertices: a lower bound of the maximum
    Point3 largest_place;          ///< a point of the one surface at that distance from the other
    double bound = 0.0;            ///< no point is farther from the other surface; 0 where none was asked for
};

/// Two-sided distance between two surfaces: measured, and bounded.
struct SurfaceDistance {
    OneSidedDistance to_second;    ///< from the points of the first surface to the second
    OneSidedDistance to_first;     ///< from the points of the second surface to the first
    double rms = 0.0;              ///< mean of the two
    double hausdorff = 0.0;        ///< the larger `largest`
    double hausdorff_bound = 0.0;  ///< the larger `bound`
    double diagonal = 0.0;         ///< of the bounding box of the second surface
    bool is_tight = true;  ///< false: `max_pieces` ran out; the bounds hold but are larger than the tolerance allows
    Outcome outcome = Outcome::done;  ///< cancelled: nothing of the rest is meant
};

/// Two-sided distance between two surfaces.
///
/// Definition: of two closed sets A, B: max over a in A of the distance from a to B, and the same the other way.
/// Input:      any polygons: neither orientation, manifoldness nor closedness is asked for. At least one polygon each.
///             A polygon of more than three corners is measured on the triangulation that is nearest to the other
///             surface (a quad on the diagonal nearer to it; where both are, on the one that leaves no needle).
/// Result:     lengths in the input's unit. The bounds hold for every triangulation of every polygon of up to six
///             corners by triangles that face the polygon's own side (by Newell's normal), in any combination. Of
///             larger polygons they hold for every triangulation that is a graph over the plane of the vertices' mean
///             and Newell's normal. A polygon without such a triangulation counts as the triangles that it was measured
///             on.
/// Errors:     InputError non_finite_coordinate, index_out_of_range, repeated_vertex_in_polygon (fewer than three
///             corners too), empty_input, option_out_of_range.
/// Guarantee:  bounds hold in the reals for the coordinates as given: rounding is accounted for.
/// Cost:       about a second for 80,000 against 3,000 triangles. The same numbers for any number of threads.
/// Source:     branch and bound as in Tang, Lee, Kim 2009 (Interactive Hausdorff distance computation); the bound by
///             covering projections is explained in src/verify/distance_bound.cpp.
SurfaceDistance measure_distance(const PolygonMesh& first, const PolygonMesh& second,
                                 const DistanceOptions& options = {}, const RunControl& control = {});

/// A part of one surface that is farther from the other than allowed, or cannot be shown not to be.
struct FarPlace {
    bool is_on_first = true;
    std::uint32_t polygon = 0;  ///< of the surface that the place is on
    std::uint32_t nearest = 0;  ///< polygon of the other one
    Point3 place;
};

/// Where the distance of two surfaces, as measure_distance bounds it, passes a limit.
///
/// Input:      surfaces as for measure_distance; `limit` in their unit.
/// Result:     nothing: no point is farther than `limit`, in the sense of the bounds above. Else, for each polygon of
/// either
///             surface with points beyond 98 % of it, or beyond what `max_pieces` pieces decide, a place. By surface
///             and polygon.
/// Errors:     as measure_distance; option_out_of_range for a limit that is not above 0.
std::vector<FarPlace> find_far_places(const PolygonMesh& first, const PolygonMesh& second, double limit,
                                      std::uint64_t max_pieces = 1000000, const RunControl& control = {});

}  // namespace certa
