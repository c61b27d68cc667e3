#pragma once
// Polygon meshes with known shape for the tests of distances and of surface checks.
#include <certa/mesh.h>

#include <cmath>
#include <initializer_list>
#include <map>
#include <numbers>

namespace certa::test {

inline void add_polygon(PolygonMesh& mesh, std::initializer_list<VertexId> ring) {
    mesh.corners.insert(mesh.corners.end(), ring.begin(), ring.end());
    mesh.offsets.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
}

/// m x n quads over the unit square; f(u, v) places the vertices.
template <class F>
PolygonMesh make_grid(std::uint32_t m, std::uint32_t n, const F& f) {
    PolygonMesh mesh;
    for (std::uint32_t j = 0; j <= n; ++j)
        for (std::uint32_t i = 0; i <= m; ++i) mesh.positions.push_back(f(i / double(m), j / double(n)));
    for (std::uint32_t j = 0; j < n; ++j)
        for (std::uint32_t i = 0; i < m; ++i) {
            const std::uint32_t v = j * (m + 1) + i;
            add_polygon(mesh, {VertexId{v}, VertexId{v + 1}, VertexId{v + m + 2}, VertexId{v + m + 1}});
        }
    return mesh;
}

/// The unit cube, n x n quads on each side, outwards.
inline PolygonMesh make_cube(std::uint32_t n) {
    PolygonMesh mesh;
    std::map<std::array<std::uint32_t, 3>, VertexId> known;
    const auto vertex = [&](std::array<std::uint32_t, 3> p) {
        const auto [entry, is_new] = known.try_emplace(p, VertexId(mesh.positions.size()));
        if (is_new) mesh.positions.push_back({p[0] / double(n), p[1] / double(n), p[2] / double(n)});
        return entry->second;
    };
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const bool is_far : {false, true})
            for (std::uint32_t i = 0; i < n; ++i)
                for (std::uint32_t j = 0; j < n; ++j) {
                    const auto at = [&](std::uint32_t s, std::uint32_t t) {
                        std::array<std::uint32_t, 3> p{};
                        p[axis] = is_far ? n : 0, p[(axis + 1) % 3] = s, p[(axis + 2) % 3] = t;
                        return vertex(p);
                    };
                    const VertexId a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
                    if (is_far) {
                        add_polygon(mesh, {a, b, c, d});
                    } else {
                        add_polygon(mesh, {a, d, c, b});
                    }
                }
    return mesh;
}

/// Rings of quads between two caps of triangles, outwards.
inline PolygonMesh make_sphere(std::uint32_t rings, std::uint32_t sectors, double radius) {
    PolygonMesh mesh;
    mesh.positions = {{0.0, 0.0, radius}, {0.0, 0.0, -radius}};
    for (std::uint32_t r = 1; r < rings; ++r)
        for (std::uint32_t s = 0; s < sectors; ++s) {
            const double t = std::numbers::pi * r / rings, p = 2.0 * std::numbers::pi * s / sectors;
            mesh.positions.push_back(
                {radius * std::sin(t) * std::cos(p), radius * std::sin(t) * std::sin(p), radius * std::cos(t)});
        }
    const auto at = [&](std::uint32_t r, std::uint32_t s) { return VertexId{2 + (r - 1) * sectors + s % sectors}; };
    for (std::uint32_t s = 0; s < sectors; ++s) {
        add_polygon(mesh, {VertexId{0}, at(1, s), at(1, s + 1)});
        for (std::uint32_t r = 1; r + 1 < rings; ++r)
            add_polygon(mesh, {at(r, s), at(r + 1, s), at(r + 1, s + 1), at(r, s + 1)});
        add_polygon(mesh, {at(rings - 1, s + 1), at(rings - 1, s), VertexId{1}});
    }
    return mesh;
}

/// m x n quads around a torus about the z axis, outwards.
inline PolygonMesh make_torus(std::uint32_t m, std::uint32_t n, double large, double small) {
    PolygonMesh mesh;
    for (std::uint32_t i = 0; i < m; ++i)
        for (std::uint32_t j = 0; j < n; ++j) {
            const double u = 2.0 * std::numbers::pi * i / m, v = 2.0 * std::numbers::pi * j / n;
            const double r = large + small * std::cos(v);
            mesh.positions.push_back({r * std::cos(u), r * std::sin(u), small * std::sin(v)});
        }
    for (std::uint32_t i = 0; i < m; ++i)
        for (std::uint32_t j = 0; j < n; ++j) {
            const auto at = [&](std::uint32_t s, std::uint32_t t) { return VertexId{s % m * n + t % n}; };
            add_polygon(mesh, {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return mesh;
}

inline PolygonMesh moved(PolygonMesh mesh, const Point3& by) {
    for (Point3& p : mesh.positions) p = {p.x + by.x, p.y + by.y, p.z + by.z};
    return mesh;
}
inline PolygonMesh scaled(PolygonMesh mesh, double factor) {
    for (Point3& p : mesh.positions) p = {factor * p.x, factor * p.y, factor * p.z};
    return mesh;
}

}  // namespace certa::test
