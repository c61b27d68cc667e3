#pragma once
// From the public input to the complex that the mesher works on.
#include "conforming/complex.h"

namespace certa::conforming {

/// Builds the complex: segments deduplicated and numbered as docs/conventions.md says, flagged sides, isolated points,
/// frames, incidences.
///
/// Input:      offsets and indices in range, coordinates finite, no polygon side from a point to itself (what
///             validate_structure accepts).
/// Result:     facets whose sides cross have flags as if every ring were a boundary; validate_geometry refuses them.
/// Cost:       O(n); facets that are one ring of distinct vertices take no triangulation.
Complex build_complex(const PiecewiseLinearComplex& input);

/// The orthonormal frame of one facet: origin at the mean of its vertices, Newell normal of its first ring, or any
/// normal to the points when that ring has no area.
Frame build_frame(const PiecewiseLinearComplex& input, std::uint32_t facet);

}  // namespace certa::conforming
