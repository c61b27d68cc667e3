#pragma once
// A proved bound on how far the points of one surface are from another.
#include <certa/run_control.h>

#include <vector>

#include "verify/polygon_surface.h"

namespace certa::verify {

struct BoundOptions {
    double lowest = 0.0;      ///< a distance that is known to occur
    double tolerance = 0.0;   ///< the bound need not be below (1 + tolerance) times a distance that occurs,
    double resolution = 0.0;  ///< nor below this
    std::size_t max_pieces = 0;
};
struct DistanceBound {
    double bound = 0.0;
    double lowest = 0.0;  ///< the largest distance that was found on the way, at ...
    Point3 place;         ///< ... (set where it is above BoundOptions::lowest)
    bool is_tight = true;
    bool is_cancelled = false;
};

/// No point of any triangulation of `from` is farther than `bound` from any triangulation of `to`; which
/// triangulations: certa/distance.h. `tree` holds to.triangles(). Coordinates are at most 1.
DistanceBound bound_distance(const PolygonSurface& from, const PolygonSurface& to, const core::TriangleTree& tree,
                             const BoundOptions& options, const RunControl& control);

/// A piece of a polygon that is too far away, or too hard to tell.
struct FarPiece {
    std::uint32_t polygon = 0;  ///< of `from`
    std::uint32_t nearest = 0;  ///< polygon of `to`
    Point3 place;
};
/// Pieces that are not within `limit`; those beyond 98 % of it may be among them. None: bound_distance is at most
/// `limit`.
std::vector<FarPiece> find_far_pieces(const PolygonSurface& from, const PolygonSurface& to,
                                      const core::TriangleTree& tree, double limit, std::size_t max_pieces,
                                      const RunControl& control);

}  // namespace certa::verify
