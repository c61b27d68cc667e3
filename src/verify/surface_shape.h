#pragma once
// Sides of polygons sorted by edge, and the creases of a surface.
#include <certa/surface_check.h>

#include <cstdint>
#include <span>
#include <vector>

namespace certa::verify {

/// One side of one polygon, from corner `slot` to the next.
struct PolygonSide {
    std::uint32_t low = 0, high = 0;  // its vertices
    std::uint32_t polygon = 0, slot = 0, next_slot = 0;
    bool is_reversed = false;  // walked from high to low
};
/// Sorted by edge; the sides of one edge are adjacent.
std::vector<PolygonSide> sort_sides(const PolygonMesh& mesh);
/// The end of the group of sides of one edge that starts at `begin`.
std::size_t end_of_edge(const std::vector<PolygonSide>& sides, std::size_t begin);

struct Creases {
    std::vector<std::array<std::uint32_t, 2>> edges;
    std::vector<std::uint32_t> corners;
};
/// As SurfaceCheckOptions and check_surface say.
Creases find_creases(const PolygonMesh& mesh, const SurfaceCheckOptions& options);

}  // namespace certa::verify
