#pragma once
// The input complex as the checker reads it: numbered segments, and on which side of each segment each facet lies.
// Derived from docs/conventions.md alone.
#include <certa/mesh.h>

#include <cstdint>
#include <vector>

#include "core/index_map.h"
#include "verify/predicates.h"

namespace certa::verify {

/// A segment as a side of a facet.
struct PlcSide {
    std::uint32_t segment = 0;
    /// +1: the facet lies to the left of the segment, directed from its first to its second end and seen from the tip
    /// of the facet's normal; -1: to its right; 0: on both sides, or on neither.
    std::int8_t cover = 0;
    bool ring = false;   ///< a side of a ring, not only an isolated segment
    bool inner = false;  ///< the facet lies on both sides
};

struct Plc {
    /// Errors: InputError when indices or offsets are out of range, coordinates are not finite, or a side joins a
    /// point to itself.
    Plc(const PiecewiseLinearComplex& complex, bool merge_coplanar);

    std::vector<std::array<std::uint32_t, 2>> segments;
    core::PairMap segment_of_ends;
    std::vector<std::uint8_t> dropped;  ///< per segment: merging removed it

    /// Facets in groups; a group is named by its lowest facet. Without merging every facet is a group.
    std::vector<std::uint32_t> leaders;        ///< per facet
    std::vector<std::uint64_t> side_offsets;   ///< per facet; empty rows but for leaders
    std::vector<PlcSide> sides;                ///< of the whole group, about the leader's normal, without dropped ones
    std::vector<std::uint64_t> point_offsets;  ///< per facet; empty rows but for leaders
    std::vector<std::uint32_t> points;         ///< all input points of the group, ascending, each once
    std::vector<std::uint8_t> is_isolated;     ///< per input point: no segment and no facet mentions it

    std::size_t facet_count() const { return leaders.size(); }
};

/// Corners of polygon p as points.
std::vector<Point3> ring_points(const PiecewiseLinearComplex& complex, std::uint32_t polygon);
/// Corners of all polygons of a facet as points.
std::vector<Point3> facet_corners(const PiecewiseLinearComplex& complex, std::uint32_t facet);
/// The first ring of a facet, or no_index.
std::uint32_t first_ring(const PiecewiseLinearComplex& complex, std::uint32_t facet);
/// Newell's normal of a facet's first ring.
NewellNormal facet_normal(const PiecewiseLinearComplex& complex, std::uint32_t facet);

/// Where a facet lies of one undirected edge of its rings: seen along from `a` to `b`.
struct RingEdge {
    std::uint32_t a = 0, b = 0;
    bool left = false, right = false;
};

/// The distinct edges of a facet's rings, and on which sides of them the facet lies: everything in the plane that
/// cannot be reached from infinity nor from a hole point without crossing a ring. Exact in the projection along the
/// facet's normal.
///
/// Input: rings whose edges meet in common corners only (else the answer means nothing, but comes).
std::vector<RingEdge> arrange_rings(const PiecewiseLinearComplex& complex, std::uint32_t facet,
                                    const NewellNormal& normal);

}  // namespace certa::verify
