#pragma once
// Pieces that come within rounding of each other without touching.
#include <optional>

#include "conforming/validate_findings.h"

namespace certa::conforming {

/// Adds point_near_segment, point_near_facet and segment_near_facet for two pieces of different owners. A vertex that
/// has a facet in common with a side is never near it, nor one that is near an end of it.
void find_near(const Complex& complex, const Pieces& pieces, std::uint32_t piece_a, std::uint32_t piece_b,
               std::vector<Finding>& findings);

/// The part of segment `ends` over triangle `piece`, further than `near` from its owner's sides, in the owner's frame:
/// the middle of it, if there is any.
std::optional<Point3> clip_to_piece(const Complex& complex, const Pieces& pieces, std::uint32_t piece,
                                    const std::array<std::uint32_t, 2>& ends, double near);

}  // namespace certa::conforming
