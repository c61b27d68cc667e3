// Placement lowers the distance by what theory promises, keeps what is fixed where it is, and folds nothing.
#include "remeshing/placement.h"

#include <certa/io.h>
#include <certa/surface_check.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "core/vector3.h"
#include "remeshing/coarse_meshes.h"
#include "remeshing/triangulate.h"

namespace certa::remeshing {
namespace {

using test::make_grid;
using test::make_torus;

TriangleMesh triangle_mesh(const PolygonMesh& mesh) {
    TriangleMesh triangles;
    triangles.positions = mesh.positions;
    for (const auto& t : triangulate(coarse_mesh(mesh), core::TriangleTree({}, {})))
        triangles.triangles.push_back({VertexId{t[0]}, VertexId{t[1]}, VertexId{t[2]}});
    return triangles;
}

double error(const CoarseMesh& coarse, const TriangleMesh& input) {
    return measure_distance(polygon_mesh(coarse), make_polygon_mesh(input), {.samples = 20000, .bound = false}).rms;
}

/// Cosine between each triangle and the nearest triangle of the input, the least.
double least_agreement(const CoarseMesh& mesh, const TriangleMesh& input) {
    const core::TriangleTree tree(input.positions, input.triangles);
    double least = 1.0;
    for (const auto& t : triangulate(mesh, tree)) {
        const Point3 &a = mesh.points[t[0]], &b = mesh.points[t[1]], &c = mesh.points[t[2]];
        const Triangle& below = input.triangles[tree.find_nearest((1.0 / 3.0) * (a + b + c)).triangle];
        const Point3 n = cross(b - a, c - a);
        const Point3 m = cross(input.positions[index_of(below[1])] - input.positions[index_of(below[0])],
                               input.positions[index_of(below[2])] - input.positions[index_of(below[0])]);
        least = std::min(least, dot(n, m) / (norm(n) * norm(m)));
    }
    return least;
}

TEST(Placement, GainsOnTheTorusWhatTheoryPromises) {
    const TriangleMesh input = triangle_mesh(make_torus(160, 90, 1.0, 0.4));
    CoarseMesh mesh = coarse_mesh(make_torus(28, 18, 1.0, 0.4));
    const CoarseMesh before = mesh;
    const PlacementReport report = place_vertices(input, {}, mesh);
    const double first = error(before, input), last = error(mesh, input);
    EXPECT_LT(last, first / 2.8);
    EXPECT_LT(last / 4.03, 5.6e-4);  // of the diagonal; quads cannot do better than 4.79e-4
    EXPECT_NEAR(report.rms_before, first, 0.05 * first);
    EXPECT_NEAR(report.rms_after, last, 0.08 * last);
    EXPECT_LT(report.largest_after, report.largest_before);
    EXPECT_GT(least_agreement(mesh, input), 0.7);
    EXPECT_EQ(mesh.corners, before.corners);
    EXPECT_EQ(mesh.offsets, before.offsets);
    for (const SurfacePlace& place : mesh.places) EXPECT_LT(place.face, input.triangles.size());
}

TEST(Placement, DoesNotDependOnThreads) {
    const TriangleMesh input = triangle_mesh(make_torus(80, 40, 1.0, 0.4));
    CoarseMesh mesh = coarse_mesh(make_torus(20, 12, 1.0, 0.4)), other = mesh;
    RunControl one_thread;
    one_thread.threads = 1;
    place_vertices(input, {}, mesh);
    place_vertices(input, {}, other, {}, one_thread);
    EXPECT_EQ(mesh.points, other.points);
}

/// The square [-1, 1]^2 under a saddle, its four sides as curves; n by n.
CoarseMesh make_saddle(std::uint32_t n, std::vector<FeatureEdge>& sides) {
    CoarseMesh mesh = coarse_mesh(make_grid(n, n, [](double u, double v) {
        const double x = 2.0 * u - 1.0, y = 2.0 * v - 1.0;
        return Point3{x, y, 0.5 * (x * x - y * y)};
    }));
    const auto at = [&](std::uint32_t i, std::uint32_t j) { return j * (n + 1) + i; };
    for (std::uint32_t i = 0; i < n; ++i) {
        const FeatureEdge edges[4] = {{at(i, 0), at(i + 1, 0), 0},
                                      {at(n, i), at(n, i + 1), 1},
                                      {at(i, n), at(i + 1, n), 2},
                                      {at(0, i), at(0, i + 1), 3}};
        for (const FeatureEdge& edge : edges) {
            sides.push_back(edge);
            for (const Index v : {edge.a, edge.b}) {
                const bool is_corner = mesh.kinds[v] == VertexKind::boundary && mesh.curves[v] != edge.curve;
                mesh.kinds[v] = is_corner ? VertexKind::corner : VertexKind::boundary;
                mesh.curves[v] = is_corner ? no_index : edge.curve;
            }
        }
    }
    return mesh;
}

TEST(Placement, KeepsBoundaryVerticesOnTheirCurveAndCornersWhereTheyAre) {
    std::vector<FeatureEdge> sides, coarse_sides;
    const CoarseMesh fine = make_saddle(80, sides);
    const TriangleMesh input = triangle_mesh(polygon_mesh(fine));
    CoarseMesh mesh = make_saddle(9, coarse_sides);
    mesh.feature_edges = coarse_sides;
    // Where K < 0 a regular grid of vertices on the surface is best already: placement must find back to it.
    const double best = error(mesh, input);
    core::Random random(17);
    for (Index v = 0; v < mesh.points.size(); ++v)
        if (mesh.kinds[v] == VertexKind::smooth) mesh.points[v].z += random.uniform(-0.02, 0.02);
    const CoarseMesh before = mesh;
    EXPECT_GT(error(before, input), 2.5 * best);
    place_vertices(input, sides, mesh);
    EXPECT_LT(error(mesh, input), 1.1 * best);
    int moved = 0;
    for (Index v = 0; v < mesh.points.size(); ++v) {
        if (mesh.kinds[v] == VertexKind::corner) {
            EXPECT_LT(distance(mesh.points[v], before.points[v]), 1e-15);
        }
        if (mesh.kinds[v] != VertexKind::boundary) continue;
        double least = 1.0;
        for (const FeatureEdge& side : sides) {
            if (side.curve != mesh.curves[v]) continue;
            const Point3 &a = fine.points[side.a], &b = fine.points[side.b];
            least =
                std::min(least, std::sqrt(core::find_nearest_on_triangle(mesh.points[v], a, b, b).squared_distance));
        }
        EXPECT_LT(least, 1e-14);
        moved += distance(mesh.points[v], before.points[v]) > 1e-6;
    }
    EXPECT_GT(moved, 0);
}

/// Where K < 0 nothing is better than a regular grid on the surface: the noise of samples must not move it.
TEST(Placement, SamplesDoNotDecideForNoise) {
    std::vector<FeatureEdge> sides, coarse_sides;
    const TriangleMesh input = triangle_mesh(polygon_mesh(make_saddle(160, sides)));
    CoarseMesh mesh = make_saddle(22, coarse_sides);
    mesh.feature_edges = coarse_sides;
    const double best = error(mesh, input);
    place_vertices(input, sides, mesh);
    std::printf("%.4f of the grid's error\n", error(mesh, input) / best);
    EXPECT_LT(error(mesh, input), 1.008 * best);
}

TEST(Placement, LooksAtTheBoundaryTooNotOnlyAtTheInside) {
    // Without samples of the curves the sides would get 20 % farther away, because the inside gains by it.
    std::vector<FeatureEdge> sides, coarse_sides;
    const CoarseMesh fine = make_saddle(80, sides);
    CoarseMesh mesh = make_saddle(9, coarse_sides);
    mesh.feature_edges = coarse_sides;
    const auto farthest = [&](const CoarseMesh& m) {  // of the input's boundary from the coarse one
        double far = 0.0;
        for (const FeatureEdge& side : sides) {
            double near = 1e300;
            for (const FeatureEdge& e : coarse_sides) {
                const Point3 &a = m.points[e.a], &b = m.points[e.b];
                near = std::min(near, core::find_nearest_on_triangle(fine.points[side.a], a, b, b).squared_distance);
            }
            far = std::max(far, std::sqrt(near));
        }
        return far;
    };
    const double before = farthest(mesh);
    place_vertices(triangle_mesh(polygon_mesh(fine)), sides, mesh);
    EXPECT_LT(farthest(mesh), 1.02 * before);
}

TEST(Placement, FoldsNothingWhereTheMeshIsFarTooCoarse) {
    const TriangleMesh input = triangle_mesh(test::make_sphere(40, 60, 1.0));
    for (const auto& [rings, sectors] : {std::pair{3u, 4u}, std::pair{4u, 5u}, std::pair{8u, 5u}}) {
        CoarseMesh mesh = coarse_mesh(test::make_sphere(rings, sectors, 1.0));
        const double before = error(mesh, input);
        place_vertices(input, {}, mesh);
        EXPECT_LT(error(mesh, input), before);
        EXPECT_GT(least_agreement(mesh, input), 0.3);
    }
}

TEST(Placement, UnfoldsWhatWasFolded) {
    const TriangleMesh input = triangle_mesh(make_torus(100, 60, 1.0, 0.4));
    CoarseMesh mesh = coarse_mesh(make_torus(24, 14, 1.0, 0.4));
    // A vertex pulled along the surface over its neighbour.
    mesh.points[5 * 14 + 3] = 0.5 * (mesh.points[5 * 14 + 4] + mesh.points[5 * 14 + 5]);
    ASSERT_FALSE(find_contacts(polygon_mesh(mesh)).empty());
    place_vertices(input, {}, mesh);
    EXPECT_TRUE(find_contacts(polygon_mesh(mesh)).empty());
    EXPECT_GT(least_agreement(mesh, input), 0.0);
}

TEST(Placement, LeavesAPerfectMeshAlone) {
    const PolygonMesh cube = test::make_cube(4);
    CoarseMesh mesh = coarse_mesh(cube);
    for (VertexKind& kind : mesh.kinds) kind = VertexKind::corner;
    const PlacementReport report = place_vertices(triangle_mesh(cube), {}, mesh);
    EXPECT_EQ(report.rounds, 0u);
    for (std::size_t v = 0; v < mesh.points.size(); ++v) EXPECT_LT(distance(mesh.points[v], cube.positions[v]), 1e-15);
}

TEST(Placement, ScaleAndPlaceDoNotMatter) {
    PolygonMesh fine = make_torus(60, 30, 1.0, 0.4), coarse = make_torus(16, 10, 1.0, 0.4);
    CoarseMesh mesh = coarse_mesh(coarse), other = coarse_mesh(test::scaled(coarse, 1024.0));
    place_vertices(triangle_mesh(fine), {}, mesh);
    place_vertices(triangle_mesh(test::scaled(fine, 1024.0)), {}, other);
    for (std::size_t v = 0; v < mesh.points.size(); ++v)
        EXPECT_LT(distance(1024.0 * mesh.points[v], other.points[v]), 1e-6);
}

TEST(Triangulate, AvoidsNeedlesAndTurnsAway) {
    // A square with a corner in the middle of a side: the needle on that side is not cut.
    CoarseMesh mesh = coarse_mesh(make_grid(1, 1, [](double u, double v) { return Point3{u, v, 0.0}; }));
    mesh.add_vertex({0.5, 0.0, 0.0}, {});
    mesh.corners = {0, 4, 1, 3, 2}, mesh.offsets = {0, 5};
    const auto area = [](const CoarseMesh& m, const std::array<Index, 3>& t) {
        return 0.5 * cross(m.points[t[1]] - m.points[t[0]], m.points[t[2]] - m.points[t[0]]).z;
    };
    for (const auto& t : triangulate(mesh, core::TriangleTree({}, {}))) EXPECT_GT(area(mesh, t), 0.1);
    // An L: two of its diagonals would leave it.
    CoarseMesh l_shape;
    for (const Point3& p : {Point3{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}})
        l_shape.add_vertex(p, {});
    l_shape.add_polygon(std::vector<Index>{0, 1, 2, 3, 4, 5});
    double sum = 0.0;
    for (const auto& t : triangulate(l_shape, core::TriangleTree({}, {}))) {
        EXPECT_GT(area(l_shape, t), 0.1);
        sum += area(l_shape, t);
    }
    EXPECT_DOUBLE_EQ(sum, 3.0);
}

TEST(Triangulate, LargePolygonsToo) {
    CoarseMesh star;
    std::vector<Index> ring;
    for (Index i = 0; i < 300; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / 300.0, radius = i % 2 == 0 ? 1.0 : 0.6;
        star.add_vertex({radius * std::cos(angle), radius * std::sin(angle), 0.0}, {});
        ring.push_back(i);
    }
    star.add_polygon(ring);
    double sum = 0.0;
    const auto triangles = triangulate(star, core::TriangleTree({}, {}));
    for (const auto& t : triangles) {
        const double z = cross(star.points[t[1]] - star.points[t[0]], star.points[t[2]] - star.points[t[0]]).z;
        EXPECT_GE(z, -1e-15);
        sum += 0.5 * z;
    }
    EXPECT_EQ(triangles.size(), 298u);
    EXPECT_NEAR(sum, 150.0 * 0.6 * std::sin(2.0 * std::numbers::pi / 300.0), 1e-12);
}

}  // namespace
}  // namespace certa::remeshing
