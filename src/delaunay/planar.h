#pragma once
// Constrained Delaunay triangulation of a polygonal region in the plane, over indices.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace certa::delaunay {

struct PlanarPoint {
    double x = 0.0, y = 0.0;
};

/// An edge that must appear. Crossing a boundary edge changes between inside and outside.
struct PlanarEdge {
    std::uint32_t a = 0, b = 0;
    bool boundary = true;
};

struct PlanarTriangulation {
    bool valid = false;  ///< false: edges cross, run through points, or points coincide
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< inside, counter-clockwise
    std::vector<std::array<std::uint32_t, 3>> neighbors;  ///< opposite each corner; no_index outside or across an edge
};

/// Triangulates with exact predicates on the given coordinates; what is inside is found by flood fill from infinity.
///
/// Cost: O(n log n). Never throws on bad geometry: see `valid`.
PlanarTriangulation triangulate_region(std::span<const PlanarPoint> points, std::span<const PlanarEdge> edges);

}  // namespace certa::delaunay
