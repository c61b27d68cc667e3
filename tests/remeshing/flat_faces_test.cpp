// Flat faces with holes: triangles between the vertices that are there, and what they do for a count.
#include "remeshing/flat_faces.h"

#include <certa/remeshing.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/vector3.h"
#include "facetted_pipe.h"
#include "remeshing/damage.h"

namespace certa::remeshing {
namespace {

constexpr double pi = std::numbers::pi;

/// Points on a circle in the plane that `u` and `v` span; the cycle runs around u x v, or the other way.
std::vector<Index> add_circle(std::vector<Point3>& points, const Point3& u, const Point3& v, const Point3& center,
                              double radius, Index n, bool around) {
    std::vector<Index> rim;
    for (Index i = 0; i < n; ++i) {
        const double angle = (around ? 2.0 : -2.0) * pi * i / n;
        rim.push_back(static_cast<Index>(points.size()));
        points.push_back(center + radius * std::cos(angle) * u + radius * std::sin(angle) * v);
    }
    return rim;
}

TEST(FlatFaces, HolesCostTwoTrianglesEach) {
    for (const double tilt : {0.0, 0.7, 2.0, 3.1, 4.0, 5.5}) {
        const Point3 u{std::cos(tilt), 0.3, std::sin(tilt)}, side{-std::sin(tilt), 0.2, std::cos(tilt)};
        const Point3 x = (1.0 / norm(u)) * u, normal = (1.0 / norm(cross(x, side))) * cross(x, side),
                     y = cross(normal, x);
        std::vector<Point3> points;
        std::vector<std::vector<Index>> rims{add_circle(points, x, y, {}, 3.0, 40, true)};
        rims.push_back(add_circle(points, x, y, 1.2 * x + 0.3 * y, 0.8, 11, false));
        rims.push_back(add_circle(points, x, y, -1.1 * x + 0.3 * y, 1.1, 7, false));
        rims.push_back(add_circle(points, x, y, -1.1 * x + 0.3 * y, 0.5, 6, true));  // an island in the hole
        const auto triangles = triangulate_between(points, rims, normal);
        ASSERT_TRUE(triangles.has_value());
        EXPECT_EQ(triangles->size(), 40U + 11U + 7U + 2U * 2U - 2U + 6U - 2U);
        double sum = 0.0;
        for (const auto& [a, b, c] : *triangles) {
            const double area = 0.5 * dot(cross(points[b] - points[a], points[c] - points[a]), normal);
            EXPECT_GT(area, 0.0);
            sum += area;
        }
        const auto polygon = [](double n, double radius) { return 0.5 * n * radius * radius * std::sin(2.0 * pi / n); };
        EXPECT_NEAR(sum, polygon(40, 3.0) - polygon(11, 0.8) - polygon(7, 1.1) + polygon(6, 0.5), 1e-9);
    }
}

TEST(FlatFaces, RefusesRimsThatCross) {
    std::vector<Point3> points;
    const Point3 x{1, 0, 0}, y{0, 1, 0};
    std::vector<std::vector<Index>> rims{add_circle(points, x, y, {}, 1.0, 12, true)};
    rims.push_back(add_circle(points, x, y, {0.8, 0.0, 0.0}, 0.5, 9, false));
    EXPECT_FALSE(triangulate_between(points, rims, {0, 0, 1}).has_value());
    rims.pop_back();
    rims.push_back({rims[0][2], rims[0][1], rims[0][0]});  // a vertex on two rims
    EXPECT_FALSE(triangulate_between(points, rims, {0, 0, 1}).has_value());
}

/// A pipe of flat facets: its ends are flat rings, whose rims have all the vertices that they need.
TEST(FlatFaces, RingsAreNotMended) {
    RemeshOptions options;
    options.vertices = 400;
    const RemeshResult result = remesh(facetted_pipe(16), options);
    ASSERT_EQ(result.outcome, Outcome::done);
    EXPECT_NEAR(static_cast<double>(result.statistics.vertices), 400.0, 20.0);
    EXPECT_EQ(result.statistics.mended_triangles, 0U);
    EXPECT_GT(3 * result.statistics.quads, 2 * result.statistics.faces);
}

/// Over an edge, both diagonals of a quad may lie in the surface. Which one is nearer is rounding then, and everybody's
/// own: the quad is cut where only one is sound, however the surface lies.
TEST(Damage, DiagonalsInTheSurfaceAreBothTried) {
    for (int k = 0; k < 20; ++k) {
        const double s = std::sin(0.3 * k), c = std::cos(0.3 * k);
        const auto turned = [&](const Point3& p) {
            const Point3 q{c * p.x - s * p.y, s * p.x + c * p.y, p.z};
            return Point3{q.x, c * q.y - s * q.z, s * q.y + c * q.z};
        };
        TriangleMesh input;  // a wall x = 0 that faces -x, below a floor z = 0 that faces +z
        for (const Point3& p : {Point3{0, 10, 0}, {0, -10, 0}, {0, -10, -8}, {0, 10, -8}, {8, -10, 0}, {8, 10, 0}})
            input.positions.push_back(turned(p));
        for (const auto& [a, b, d] : {std::array{0U, 1U, 2U}, {0U, 2U, 3U}, {1U, 0U, 5U}, {1U, 5U, 4U}})
            input.triangles.push_back({VertexId{a}, VertexId{d}, VertexId{b}});
        const core::TriangleTree tree(input.positions, input.triangles);
        CoarseMesh mesh;
        for (const Point3& p : {Point3{0, 1.7, -0.7}, {0, 0.5, 0}, {0, 0, 0}, {1, -2.2, 0}})
            mesh.add_vertex(turned(p), {});
        mesh.add_polygon(std::array<Index, 4>{0, 1, 2, 3});
        const Damage damage = find_damage({input, tree, 30.0}, mesh, {});
        EXPECT_TRUE(damage.polygons.empty()) << k;
        EXPECT_EQ(damage.split, 1U) << k;
    }
}

}  // namespace
}  // namespace certa::remeshing
