#pragma once
// A surface without curvature inside its faces, two of which have holes.
#include <certa/mesh.h>

#include <cmath>
#include <numbers>

namespace certa::remeshing {

/// A pipe of n flat facets around, between circles of radius 1 and 0.7, from z = 0 to z = 3.
inline TriangleMesh facetted_pipe(std::uint32_t n) {
    TriangleMesh mesh;
    for (const auto& [radius, z] : {std::pair{1.0, 0.0}, {1.0, 3.0}, {0.7, 3.0}, {0.7, 0.0}})
        for (std::uint32_t i = 0; i < n; ++i) {
            const double angle = 2.0 * std::numbers::pi * i / n;
            mesh.positions.push_back({radius * std::cos(angle), radius * std::sin(angle), z});
        }
    for (std::uint32_t ring = 0; ring < 4; ++ring)
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t next = (ring + 1) % 4, j = (i + 1) % n;
            const VertexId a{ring * n + i}, b{ring * n + j}, c{next * n + j}, d{next * n + i};
            mesh.triangles.push_back({a, b, c});
            mesh.triangles.push_back({a, c, d});
        }
    return mesh;
}

}  // namespace certa::remeshing
