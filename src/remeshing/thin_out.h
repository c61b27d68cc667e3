#pragma once
// Fewer triangles in a patch of the input, as long as they stay close and nothing turns.
#include <span>

#include "remeshing/damage.h"
#include "remeshing/region_patch.h"

namespace certa::remeshing {

struct ThinningRule {
    double tolerance = 0.0;          ///< distance that may be lost, in the input's unit
    double side_tolerance = 0.0;     ///< the same for triangles at the patch's sides
    double side_reach = 0.0;         ///< how far a side that is a crease may move
    double side_share = 0.0;         ///< how far a side may move along the surface, in its lengths
    std::size_t least_vertices = 0;  ///< no fewer than this
    /// Vertices outside that an edge joins already, each pair with the lower number first, sorted.
    std::span<const std::array<Index, 2>> joined;
    std::vector<std::uint8_t>
        is_fixed;  ///< per corner of the patch: stays; outer corners always do, on sides others may
};

/// Collapses edges onto one of their ends, the least error first (Garland and Heckbert 1997). `points`: per corner of
/// the patch. Vertices on creases move along them only; outer corners that are joined outside are not joined inside.
///
/// Guarantee: the topology is kept, no triangle turns away from the input; contacts are not looked for.
void thin_out(RegionPatch& patch, const std::vector<Point3>& points, const Judge& judge, const ThinningRule& rule,
              const RunControl& control);

}  // namespace certa::remeshing
