#pragma once
// One facet from exactly coplanar neighbours: fewer constraints where a surface mesh cuts a flat face into triangles.
#include "conforming/complex.h"

namespace certa::conforming {

/// Facets and segments keep their numbers. A facet that went into another has no sides and no points; a dropped segment
/// is in no incidence list.
struct MergedComplex {
    Complex complex;
    std::vector<std::uint32_t> representatives;  ///< per facet: the lowest facet of its group, itself when alone
    std::vector<std::uint8_t> dropped_segments;  ///< 1 for segments that constrain nothing any more
};

/// Merges facets that lie exactly in one plane, have equal markers, and are the only two at a common side that is not
/// one of the first `given_segments` segments. Such sides are dropped; points that lose all their sides in the merged
/// facet become isolated points of it. Where a third element holds on to a side, it stays, with the facet on both
/// sides.
///
/// Input: a validated complex with what it adopted. Cost: O(n).
MergedComplex merge_coplanar(const Complex& complex, std::size_t given_segments);

}  // namespace certa::conforming
