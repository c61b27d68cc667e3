// Evening makes zigzags straight and nothing worse: distances, folds, curves and corners are looked at.
#include "remeshing/even_out.h"

#include <certa/io.h>
#include <certa/surface_check.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <optional>

#include "core/random.h"
#include "core/vector3.h"
#include "remeshing/coarse_meshes.h"
#include "remeshing/damage.h"
#include "remeshing/triangulate.h"

namespace certa::remeshing {
namespace {

constexpr double error = 5e-3;

/// A surface with its field, spacing and tree.
struct Surface {
    explicit Surface(const PolygonMesh& fine) {
        input.positions = fine.positions;
        for (const auto& t : triangulate(coarse_mesh(fine), core::TriangleTree({}, {})))
            input.triangles.push_back({VertexId{t[0]}, VertexId{t[1]}, VertexId{t[2]}});
        mesh = build_work_mesh(input, {}, statistics);
        field = measure_directions(mesh, {});
        smooth_directions(mesh, field, 3.0 * mesh.mean_edge, {});
        SpacingRule rule;
        rule.error = error;
        spacing = compute_spacing(mesh, field, rule, {});
        tree.emplace(input.positions, input.triangles);
    }
    /// Vertices come to lie on the surface.
    void put(CoarseMesh& coarse) const {
        for (Index v = 0; v < coarse.points.size(); ++v) {
            const core::NearestPoint at = tree->find_nearest(coarse.points[v]);
            coarse.points[v] = at.point;
            coarse.places[v] = {at.triangle, at.weights};
        }
    }
    double rms(const CoarseMesh& coarse) const {
        return measure_distance(polygon_mesh(coarse), make_polygon_mesh(input), {.samples = 20000, .bound = false}).rms;
    }
    std::size_t damage(CoarseMesh coarse) const {
        return find_damage({input, *tree, mesh.diagonal, true}, coarse, {}).polygons.size();
    }

    TriangleMesh input;
    RemeshStatistics statistics;
    WorkMesh mesh;
    DirectionField field;
    Spacing spacing;
    std::optional<core::TriangleTree> tree;
};

Point3 on_torus(double u, double v) {
    constexpr double turn = 6.283185307179586, large = 1.0, small = 0.4;
    const double r = large + small * std::cos(turn * v);
    return {r * std::cos(turn * u), r * std::sin(turn * u), small * std::sin(turn * v)};
}

TEST(EvenOut, StraightensZigzags) {
    const Surface torus(test::make_torus(160, 90, 1.0, 0.4));
    constexpr std::uint32_t m = 28, n = 18;
    // Every second vertex of a ring is a third of a cell off, along it.
    CoarseMesh mesh = coarse_mesh(test::make_torus(m, n, 1.0, 0.4));
    core::Random random(5);
    for (Point3& p : mesh.points) {
        const double u = std::atan2(p.y, p.x) / 6.283185307179586;
        const double v = std::atan2(p.z, std::hypot(p.x, p.y) - 1.0) / 6.283185307179586;
        p = on_torus(u + random.uniform(-0.33, 0.33) / m, v + random.uniform(-0.33, 0.33) / n);
    }
    torus.put(mesh);
    CoarseMesh grid = coarse_mesh(test::make_torus(m, n, 1.0, 0.4));
    torus.put(grid);
    const double before = torus.rms(mesh), best = torus.rms(grid);
    EXPECT_GT(before, 1.15 * best);
    even_out(torus.mesh, torus.field, torus.spacing, *torus.tree, mesh, {});
    std::printf("%.3f of the regular grid's error, %.3f before\n", torus.rms(mesh) / best, before / best);
    EXPECT_LT(torus.rms(mesh), 1.05 * best);
    EXPECT_EQ(torus.damage(mesh), 0U);
    for (Index v = 0; v < mesh.points.size(); ++v) {
        EXPECT_LT(torus.tree->find_nearest(mesh.points[v]).squared_distance, 1e-24);
        const auto& [face, weights] = mesh.places[v];
        Point3 at;
        for (std::size_t i = 0; i < 3; ++i)
            at = at + weights[i] * torus.input.positions[index_of(torus.input.triangles[face][i])];
        EXPECT_LT(distance(at, mesh.points[v]), 1e-12);
    }
}

/// Where polygons are missing, what is left must not move in.
TEST(EvenOut, WhatLiesBesideAHoleStays) {
    const Surface torus(test::make_torus(120, 60, 1.0, 0.4));
    CoarseMesh whole = coarse_mesh(test::make_torus(28, 18, 1.0, 0.4));
    torus.put(whole);
    CoarseMesh mesh = whole.without_polygons();
    for (Index q = 5; q < whole.polygon_count(); ++q) mesh.add_polygon(whole.polygon(q));
    const std::vector<Point3> before = mesh.points;
    even_out(torus.mesh, torus.field, torus.spacing, *torus.tree, mesh, {});
    std::size_t moved = 0;
    for (Index v = 0; v < mesh.points.size(); ++v) moved += mesh.points[v] == before[v] ? 0 : 1;
    EXPECT_GT(moved, mesh.points.size() / 2);
    for (Index q = 0; q < 5; ++q)
        for (const Index v : whole.polygon(q)) EXPECT_EQ(mesh.points[v], before[v]);
    // Nothing at all: nothing to do.
    CoarseMesh none = whole.without_polygons();
    even_out(torus.mesh, torus.field, torus.spacing, *torus.tree, none, {});
    EXPECT_EQ(none.points, whole.points);
}

TEST(EvenOut, CornersStayAndCurvesAreKept) {
    const auto saddle = [](double u, double v) {
        const double x = 2.0 * u - 1.0, y = 2.0 * v - 1.0;
        return Point3{x, y, 0.5 * (x * x - y * y)};
    };
    const Surface surface(test::make_grid(80, 80, saddle));
    constexpr std::uint32_t n = 10;
    CoarseMesh mesh = coarse_mesh(test::make_grid(n, n, saddle));
    core::Random random(9);
    for (std::uint32_t j = 0; j <= n; ++j)
        for (std::uint32_t i = 0; i <= n; ++i) {
            const Index v = j * (n + 1) + i;
            const bool on_x = i == 0 || i == n, on_y = j == 0 || j == n;
            const double u = i + (on_x ? 0.0 : random.uniform(-0.3, 0.3)),
                         w = j + (on_y ? 0.0 : random.uniform(-0.3, 0.3));
            mesh.points[v] = saddle(u / n, w / n);
            if (on_x || on_y) mesh.kinds[v] = on_x && on_y ? VertexKind::corner : VertexKind::boundary;
        }
    surface.put(mesh);
    // The curves of the input, by what they run through.
    const auto curve_at = [&](const Point3& p) {
        for (Index c = 0; c < surface.mesh.curves.size(); ++c)
            for (const Index v : surface.mesh.curves[c].vertices)
                if (distance(surface.mesh.points[v], p) < 0.03 && !surface.mesh.is_corner[v]) return c;
        return no_index;
    };
    for (std::uint32_t i = 0; i < n; ++i)
        for (const auto& [a, b] : {std::pair{i, i + 1},
                                   {n * (n + 1) + i, n * (n + 1) + i + 1},
                                   {i * (n + 1), (i + 1) * (n + 1)},
                                   {i * (n + 1) + n, (i + 1) * (n + 1) + n}}) {
            const Index curve = curve_at(0.5 * (mesh.points[a] + mesh.points[b]));
            ASSERT_NE(curve, no_index);
            mesh.feature_edges.push_back({a, b, curve});
            for (const Index v : {a, b})
                if (mesh.kinds[v] == VertexKind::boundary) mesh.curves[v] = curve;
        }
    const CoarseMesh before = mesh;
    even_out(surface.mesh, surface.field, surface.spacing, *surface.tree, mesh, {});
    EXPECT_LT(surface.rms(mesh), 0.95 * surface.rms(before));
    EXPECT_EQ(surface.damage(mesh), 0U);
    std::size_t moved = 0;
    for (Index v = 0; v < mesh.points.size(); ++v) {
        const Point3 &p = mesh.points[v], &q = before.points[v];
        moved += distance(p, q) > 1e-6;
        if (mesh.kinds[v] == VertexKind::corner) {
            EXPECT_EQ(p, q);
        }
        if (mesh.kinds[v] != VertexKind::boundary) continue;
        // It lies on its side of the square still.
        EXPECT_LT(std::abs(std::abs(q.x) - 1.0) < 1e-12 ? std::abs(p.x - q.x) : std::abs(p.y - q.y), 1e-12);
    }
    EXPECT_GT(moved, mesh.points.size() / 2);
}

}  // namespace
}  // namespace certa::remeshing
