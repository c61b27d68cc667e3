#pragma once
// Meshes and transformations for the tests of curvature.
#include <certa/curvature.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/random.h"
#include "core/vector3.h"
#include "mesh/generators_surfaces.h"

namespace certa::testing {

inline constexpr double pi = std::numbers::pi;

inline Triangle triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    return {VertexId{a}, VertexId{b}, VertexId{c}};
}

inline TriangleMesh tetrahedron(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
    TriangleMesh mesh{{a, b, c, d}, {triangle(0, 2, 1), triangle(0, 1, 3), triangle(1, 2, 3), triangle(2, 0, 3)}};
    if (dot(cross(b - a, c - a), d - a) < 0.0) std::swap(mesh.positions[0], mesh.positions[1]);
    return mesh;
}

/// Both as one mesh; equal points become one vertex when `glue`.
inline TriangleMesh joined(TriangleMesh first, const TriangleMesh& second, bool glue) {
    std::vector<VertexId> ids;
    for (const Point3& p : second.positions) {
        std::uint32_t at = static_cast<std::uint32_t>(first.positions.size());
        for (std::uint32_t i = 0; glue && i < first.positions.size(); ++i)
            if (first.positions[i] == p) at = i;
        if (at == first.positions.size()) first.positions.push_back(p);
        ids.push_back(VertexId{at});
    }
    for (const auto& [a, b, c] : second.triangles)
        first.triangles.push_back({ids[index_of(a)], ids[index_of(b)], ids[index_of(c)]});
    return first;
}

inline Point3 random_point(core::Random& random) {
    return {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
}

/// A rotation about a random axis, as three rows.
struct Rotation {
    Point3 x, y, z;
    explicit Rotation(core::Random& random) {
        const auto unit = [](const Point3& p) { return (1.0 / norm(p)) * p; };
        x = unit(random_point(random));
        y = unit(cross(x, random_point(random)));
        z = cross(x, y);
    }
    Point3 operator()(const Point3& p) const { return {dot(x, p), dot(y, p), dot(z, p)}; }
};

/// A closed surface whose vertices are moved at random; `flatten`: some onto each other and onto lines, so that
/// triangles lose their area.
inline TriangleMesh shaken(TriangleMesh mesh, double distance, bool flatten, core::Random& random) {
    for (Point3& p : mesh.positions) p = p + distance * random_point(random);
    if (!flatten) return mesh;
    for (int i = 0; i < 10; ++i) {
        const auto& t = mesh.triangles[random.below(mesh.triangles.size())];
        Point3 &a = mesh.positions[index_of(t[0])], &b = mesh.positions[index_of(t[1])];
        Point3& c = mesh.positions[index_of(t[2])];
        if (random.coin())
            c = a;
        else
            c = 0.5 * (a + b);
    }
    return mesh;
}

inline double difference(const SymmetricTensor3& a, const SymmetricTensor3& b) {
    return std::abs(a.xx - b.xx) + std::abs(a.xy - b.xy) + std::abs(a.xz - b.xz) + std::abs(a.yy - b.yy) +
           std::abs(a.yz - b.yz) + std::abs(a.zz - b.zz);
}

}  // namespace certa::testing
