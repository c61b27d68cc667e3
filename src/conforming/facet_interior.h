#pragma once
// What a facet covers of its plane: triangles over its own points, and on which side of each of its sides it lies.
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "conforming/complex.h"

namespace certa::conforming {

/// A facet lies to the left, to the right, or on both sides of one of its segments. The segment is directed from its
/// first to its second end; left is cross(normal, direction) with the normal of the facet's frame.
enum SideCover : std::uint8_t { cover_left = 1, cover_right = 2 };

struct Sheet {
    std::uint32_t facet = 0;
    std::uint8_t cover = 0;
};

/// The corners of a facet that is one triangle with nothing on it, counter-clockwise about its normal; exact. Nothing
/// for any other facet, or without area.
std::optional<std::array<std::uint32_t, 3>> triangle_of(const Complex& complex, std::uint32_t facet);

struct FacetInterior {
    /// Per facet, triangles over input points that tile it, counter-clockwise in its frame.
    Rows<std::array<std::uint32_t, 3>> triangles;
    /// Parallel to Complex::facet_sides.values: SideCover bits.
    std::vector<std::uint8_t> side_covers;
    /// Per segment: the facets that have it as a side, in order, and where they lie.
    Rows<Sheet> sheets;
};

/// Triangulates every facet in its frame: triangle facets directly, others by a constrained Delaunay triangulation
/// whose inside is found by flood fill across the sides (never by coordinates).
///
/// Input:  a validated complex. Errors: InternalError where the sides of a facet cross in its plane.
/// Cost:   O(n log n) in the sides of a facet; nothing but copying for triangles.
FacetInterior build_facet_interior(const Complex& complex);

}  // namespace certa::conforming
