// Generators of surfaces with known curvatures (see generators_surfaces.h).
//
// The torus is sampled by rejection on its area element and triangulated in the conformal chart, where ds^2 is a
// multiple of the flat metric, so that Delaunay there is nearly Delaunay on the surface. The cylinder is a torus of
// larger period, opened. The ellipsoid is the affine image of a sphere, and convex hulls are affine.
#include "mesh/generators_surfaces.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "core/random.h"
#include "core/vector3.h"
#include "mesh/generator_parts.h"
#include "mesh/lawson.h"

namespace certa::generators {
namespace {

using core::Random;
using std::numbers::pi;

VertexId id(std::size_t i) { return VertexId{static_cast<std::uint32_t>(i)}; }

/// Larger when the two triangles on (a, b) would gain from the other diagonal: angles opposite the edge beyond pi.
bool is_delaunay_edge(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
    const auto cotangent = [](const Point3& u, const Point3& v) { return dot(u, v) / norm(cross(u, v)); };
    return cotangent(a - c, b - c) + cotangent(a - d, b - d) > -1e-9;
}

/// Flips edges of a closed surface in space until both angles opposite every edge sum to at most pi.
void flip_in_space(Triangulation& mesh, const std::vector<Point3>& positions) {
    constexpr std::array<std::uint32_t, 3> next{1, 2, 0}, previous{2, 0, 1};
    const auto at = [&](std::uint32_t t, std::uint32_t i) { return positions[mesh.triangles[t][i].vertex]; };
    const auto link = [&](std::uint32_t h, std::uint32_t g) { mesh.twins[h] = g, mesh.twins[g] = h; };
    for (int round = 0; round < 100; ++round) {
        bool again = false;
        for (std::uint32_t h = 0; h < mesh.twins.size(); ++h) {
            const std::uint32_t g = mesh.twins[h], t = h / 3, s = g / 3, i = h % 3, j = g % 3;
            if (is_delaunay_edge(at(t, next[i]), at(t, previous[i]), at(t, i), at(s, j))) continue;
            const Corner a = mesh.triangles[t][i], b = mesh.triangles[t][next[i]], c = mesh.triangles[t][previous[i]];
            const Corner d = mesh.triangles[s][j];
            const std::uint32_t ca = mesh.twins[3 * t + next[i]], ab = mesh.twins[3 * t + previous[i]];
            const std::uint32_t bd = mesh.twins[3 * s + next[j]], dc = mesh.twins[3 * s + previous[j]];
            mesh.triangles[t] = {a, b, d};
            mesh.triangles[s] = {a, d, c};
            link(3 * t + 2, ab), link(3 * t, bd), link(3 * s, dc), link(3 * s + 1, ca), link(3 * t + 1, 3 * s + 2);
            again = true;
        }
        if (!again) return;
    }
}

std::vector<Triangle> triangles_of(const Triangulation& mesh) {
    std::vector<Triangle> triangles;
    triangles.reserve(mesh.triangles.size());
    for (const auto& t : mesh.triangles) triangles.push_back({id(t[0].vertex), id(t[1].vertex), id(t[2].vertex)});
    return triangles;
}

}  // namespace

TriangleMesh make_torus(double major, double minor, std::uint32_t points, std::uint64_t seed) {
    Random random(seed);
    TriangleMesh mesh;
    std::vector<std::array<double, 2>> chart;
    // y(v) = integral of minor dv / (major + minor cos v).
    const double root = std::sqrt(major * major - minor * minor), stretch = 2.0 * minor / root;
    const double ratio = std::sqrt((major - minor) / (major + minor)), height = stretch * pi;
    while (chart.size() < points) {
        const double u = random.uniform(0.0, 2.0 * pi), v = random.uniform(-pi, pi);
        const double r = major + minor * std::cos(v);
        if (random.uniform(0.0, major + minor) > r) continue;
        mesh.positions.push_back({r * std::cos(u), r * std::sin(u), minor * std::sin(v)});
        chart.push_back({u, stretch * std::atan(ratio * std::tan(v / 2.0)) + height / 2.0});
    }
    mesh.triangles = triangles_of(triangulate_flat_torus(chart, 2.0 * pi, height));
    return mesh;
}

TriangleMesh make_ellipsoid(double a, double b, double c, std::uint32_t points, std::uint64_t seed) {
    Random random(seed);
    std::vector<Point3> sphere;
    TriangleMesh mesh;
    const double largest = std::max({b * c, a * c, a * b});
    while (sphere.size() < points) {
        const Point3 n = random_direction(random);
        // Area of the image of the sphere's area element.
        const double element = norm({b * c * n.x, a * c * n.y, a * b * n.z});
        if (random.uniform(0.0, largest) > element) continue;
        sphere.push_back(n);
        mesh.positions.push_back({a * n.x, b * n.y, c * n.z});
    }
    Triangulation hull = triangulate_sphere(sphere);
    flip_in_space(hull, mesh.positions);
    mesh.triangles = triangles_of(hull);
    return mesh;
}

TriangleMesh make_cylinder(double radius, double height, std::uint32_t points, std::uint64_t seed) {
    Random random(seed);
    TriangleMesh mesh;
    std::vector<std::array<double, 2>> chart;
    const double circumference = 2.0 * pi * radius, gap = 6.0 * std::sqrt(circumference * height / points);
    for (std::uint32_t i = 0; i < points; ++i) {
        const double u = random.uniform(0.0, 2.0 * pi), z = random.uniform(0.0, height);
        mesh.positions.push_back({radius * std::cos(u), radius * std::sin(u), z});
        chart.push_back({radius * u, z});
    }
    const Triangulation closed = triangulate_flat_torus(chart, circumference, height + gap);
    for (const auto& t : closed.triangles)
        if (t[0].dy == t[1].dy && t[0].dy == t[2].dy)
            mesh.triangles.push_back({id(t[0].vertex), id(t[1].vertex), id(t[2].vertex)});
    return mesh;
}

TriangleMesh make_helicoid(std::uint32_t fibres, std::uint32_t axial) {
    TriangleMesh mesh;
    const std::uint32_t columns = 4 * fibres + 1, rows = axial + 1;  // half a spacing between columns
    // Even columns hold points at even heights, odd columns at odd ones.
    std::map<std::array<std::uint32_t, 2>, VertexId> ids;
    for (std::uint32_t i = 0; i < columns; ++i)
        for (std::uint32_t j = i % 2; j < 2 * rows; j += 2) {
            const double s = -1.0 + 0.5 * i / fibres, z = static_cast<double>(j) / axial;
            ids[{i, j}] = id(mesh.positions.size());
            mesh.positions.push_back({s * std::cos(z), s * std::sin(z), z});
        }
    const auto find = [&](std::uint32_t i, std::uint32_t j) {
        const auto found = ids.find({i, j});
        return found == ids.end() ? id(no_index) : found->second;
    };
    for (std::uint32_t i = 0; i < columns; ++i)
        for (std::uint32_t j = i % 2; j + 2 < 2 * rows; j += 2) {
            // Vertical edge from (i, j) to (i, j + 2), with the point between them in the columns on both sides.
            const VertexId a = find(i, j), b = find(i, j + 2);
            if (i + 1 < columns && find(i + 1, j + 1) != id(no_index))
                mesh.triangles.push_back({a, find(i + 1, j + 1), b});
            if (i > 0 && find(i - 1, j + 1) != id(no_index)) mesh.triangles.push_back({a, b, find(i - 1, j + 1)});
        }
    return mesh;
}

TriangleMesh make_noisy(TriangleMesh mesh, double distance, std::uint64_t seed) {
    Random random(seed);
    for (Point3& p : mesh.positions) {
        const Point3 direction = random_direction(random);  // the order in one expression would be the compiler's
        p = p + distance * std::cbrt(random.uniform()) * direction;
    }
    return mesh;
}

TriangleMesh make_grid_torus(double major, double minor, std::uint32_t n, std::uint32_t m) {
    TriangleMesh mesh;
    mesh.positions.reserve(std::size_t{n} * m);
    mesh.triangles.reserve(2 * std::size_t{n} * m);
    for (std::uint32_t i = 0; i < n; ++i)
        for (std::uint32_t j = 0; j < m; ++j) {
            const double u = 2.0 * pi * i / n, v = 2.0 * pi * j / m, r = major + minor * std::cos(v);
            mesh.positions.push_back({r * std::cos(u), r * std::sin(u), minor * std::sin(v)});
        }
    for (std::uint32_t i = 0; i < n; ++i)
        for (std::uint32_t j = 0; j < m; ++j) {
            const std::size_t k = (i + 1) % n, l = (j + 1) % m, row = std::size_t{i} * m, above = k * m;
            mesh.triangles.push_back({id(row + j), id(above + j), id(above + l)});
            mesh.triangles.push_back({id(row + j), id(above + l), id(row + l)});
        }
    return mesh;
}

TriangleMesh make_icosphere(std::uint32_t levels) {
    TriangleMesh mesh;
    const double g = std::numbers::phi;
    mesh.positions = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                      {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    constexpr std::array<std::array<std::uint32_t, 3>, 20> faces{
        {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
         {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
         {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
    for (const auto& f : faces) mesh.triangles.push_back({id(f[0]), id(f[1]), id(f[2])});
    const auto on_sphere = [](const Point3& p) { return (1.0 / norm(p)) * p; };
    for (Point3& p : mesh.positions) p = on_sphere(p);
    for (std::uint32_t level = 0; level < levels; ++level) {
        std::map<std::array<std::uint32_t, 2>, VertexId> middles;
        const auto middle = [&](VertexId a, VertexId b) {
            const std::uint32_t low = std::min(index_of(a), index_of(b)), high = std::max(index_of(a), index_of(b));
            const auto [entry, fresh] = middles.try_emplace({low, high}, VertexId{});
            if (fresh) {
                entry->second = id(mesh.positions.size());
                mesh.positions.push_back(on_sphere(mesh.positions[low] + mesh.positions[high]));
            }
            return entry->second;
        };
        std::vector<Triangle> finer;
        for (const auto& [a, b, c] : mesh.triangles) {
            const VertexId ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
        }
        mesh.triangles = std::move(finer);
    }
    return mesh;
}

TriangleMesh make_box(double x, double y, double z) {
    TriangleMesh mesh;
    for (std::uint32_t k = 0; k < 8; ++k) mesh.positions.push_back({k & 1 ? x : 0.0, k & 2 ? y : 0.0, k & 4 ? z : 0.0});
    constexpr std::array<std::array<std::uint32_t, 4>, 6> sides{
        {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
    for (const auto& s : sides) {
        mesh.triangles.push_back({id(s[0]), id(s[1]), id(s[2])});
        mesh.triangles.push_back({id(s[0]), id(s[2]), id(s[3])});
    }
    return mesh;
}

}  // namespace certa::generators
