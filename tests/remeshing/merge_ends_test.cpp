// Short sides that go, triangles that become quads, faces that are no disks: what may go goes, and the mesh stays one.
#include "remeshing/merge_ends.h"

#include <certa/io.h>
#include <certa/remeshing.h>
#include <certa/surface_check.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "coarse_meshes.h"
#include "remeshing/pair_triangles.h"

namespace certa::remeshing {
namespace {

/// A row of quads above the x axis; ends of lines at the given places of it, the boundary's curve. Above they spread.
CoarseMesh row(const std::vector<double>& below) {
    CoarseMesh mesh;
    const std::size_t n = below.size();
    for (std::size_t i = 0; i < n; ++i) {
        const bool is_end = i == 0 || i + 1 == n;
        mesh.add_vertex({below[i], 0.0, 0.0}, {}, is_end ? VertexKind::corner : VertexKind::boundary, 0);
    }
    for (std::size_t i = 0; i < n; ++i) mesh.add_vertex({4.0 * below[i], 1.0, 0.0}, {});
    for (Index i = 0; i + 1 < n; ++i) {
        const auto up = static_cast<Index>(n);
        mesh.add_polygon(std::array{i, i + 1, i + 1 + up, i + up});
        mesh.feature_edges.push_back({i, i + 1, 0});
    }
    return mesh;
}

std::size_t used_vertices(const CoarseMesh& mesh) {
    std::vector<Index> used = mesh.corners;
    std::sort(used.begin(), used.end());
    return static_cast<std::size_t>(std::unique(used.begin(), used.end()) - used.begin());
}

constexpr ArrangementRule rule{0.05, 0.05};

TEST(MergeEnds, ContractsShortSidesOnly) {
    CoarseMesh mesh = row({0.0, 1.0, 1.1, 2.0, 3.0, 3.05, 4.0});
    const std::vector<double> reach(mesh.points.size(), 0.3);
    const auto merged = merge_line_ends(mesh, reach, rule);
    ASSERT_EQ(merged.size(), 2U);
    EXPECT_EQ(mesh.polygon_count(), 6U);
    EXPECT_EQ(used_vertices(mesh), 12U);
    EXPECT_EQ(mesh.feature_edges.size(), 4U);
    std::size_t triangles = 0;
    for (std::size_t q = 0; q < mesh.polygon_count(); ++q) triangles += mesh.polygon(q).size() == 3 ? 1 : 0;
    EXPECT_EQ(triangles, 2U);
    for (const MergedVertex& m : merged) {
        EXPECT_EQ(mesh.kinds[m.vertex], VertexKind::boundary);
        EXPECT_EQ(std::count(mesh.corners.begin(), mesh.corners.end(), m.vertex), 0);
    }
}

TEST(MergeEnds, KeepsCornersAndGoesIntoThem) {
    CoarseMesh mesh = row({0.0, 0.1, 1.0, 1.9, 2.0});
    const auto merged = merge_line_ends(mesh, std::vector<double>(mesh.points.size(), 0.3), rule);
    ASSERT_EQ(merged.size(), 2U);
    for (const MergedVertex& m : merged) EXPECT_EQ(mesh.kinds[m.into], VertexKind::corner);
}

TEST(MergeEnds, ChainsEndInOneVertex) {
    CoarseMesh mesh = row({0.0, 1.0, 1.11, 1.23, 1.36, 2.0});
    const auto merged = merge_line_ends(mesh, std::vector<double>(mesh.points.size(), 0.3), rule);
    ASSERT_EQ(merged.size(), 3U);
    for (const MergedVertex& m : merged) EXPECT_EQ(m.into, merged.front().into);
    EXPECT_EQ(mesh.feature_edges.size(), 2U);
}

TEST(MergeEnds, OffFeaturesOnlyShorterSidesGo) {
    // Two rows: vertices 4 to 7 are inside, 5 and 6 next to each other.
    CoarseMesh mesh;
    for (const double y : {0.0, 1.0, 2.0})
        for (const double x : {0.0, 0.9, 1.1, 2.0}) mesh.add_vertex({x, y, 0.0}, {});
    for (const Index low : {0U, 4U})
        for (Index i = low; i < low + 3; ++i) mesh.add_polygon(std::array{i, i + 1, i + 5, i + 4});
    CoarseMesh near = mesh;
    near.points[6] = {0.95, 1.0, 0.0};
    const std::vector<double> reach(mesh.points.size(), 0.3);
    EXPECT_TRUE(merge_line_ends(mesh, reach, rule).empty());
    const auto merged = merge_line_ends(near, reach, rule);
    ASSERT_EQ(merged.size(), 1U);
    EXPECT_EQ(merged[0].vertex + merged[0].into, 11U);
    EXPECT_EQ(near.polygon_count(), 6U);
    EXPECT_TRUE(compute_surface_shape(polygon_mesh(near)).is_oriented());
}

TEST(MergeEnds, LeavesWhatWouldMoveTheCurve) {
    CoarseMesh mesh = row({0.0, 1.0, 1.1, 2.0});
    mesh.points[1].y = -0.2;  // the curve bends here
    mesh.points[2].y = -0.2;
    CoarseMesh bent = mesh;
    EXPECT_TRUE(merge_line_ends(bent, std::vector<double>(mesh.points.size(), 0.3), {0.01, 0.01}).empty());
    EXPECT_EQ(merge_line_ends(mesh, std::vector<double>(mesh.points.size(), 0.3), rule).size(), 1U);
}

TEST(MergeEnds, ATriangleOnTheSideGoes) {
    // Two lines that meet at vertex 8 and end at 1 and 2.
    CoarseMesh mesh;
    for (const double x : {0.0, 1.0, 1.1, 2.0})
        mesh.add_vertex({x, 0.0, 0.0}, {}, x == 0.0 || x == 2.0 ? VertexKind::corner : VertexKind::boundary, 0);
    for (const double x : {0.0, 1.0, 1.1, 2.0}) mesh.add_vertex({x, 2.0, 0.0}, {});
    mesh.add_vertex({1.05, 1.0, 0.0}, {});
    mesh.add_polygon(std::array<Index, 3>{1, 2, 8});
    mesh.add_polygon(std::array<Index, 5>{0, 1, 8, 5, 4});
    mesh.add_polygon(std::array<Index, 5>{2, 3, 7, 6, 8});
    mesh.add_polygon(std::array<Index, 3>{8, 6, 5});
    for (Index i = 0; i < 3; ++i) mesh.feature_edges.push_back({i, i + 1, 0});
    ASSERT_EQ(merge_line_ends(mesh, std::vector<double>(mesh.points.size(), 0.3), rule).size(), 1U);
    EXPECT_EQ(mesh.polygon_count(), 3U);
    const SurfaceShape shape = compute_surface_shape(polygon_mesh(mesh));
    EXPECT_TRUE(shape.is_oriented());
    EXPECT_EQ(shape.components.size(), 1U);
    EXPECT_EQ(shape.components[0].boundary_loops, 1U);
}

TEST(Stitch, SheetsAtOneEdgeAreOneMeshAgain) {
    // Three half-planes at the z axis, of 4 x 4 squares each: their common edge has three triangles on each side.
    TriangleMesh book;
    for (const Point3& page : {Point3{1, 0, 0}, Point3{-0.5, 0.8, 0}, Point3{-0.5, -0.8, 0}})
        for (std::uint32_t j = 0; j <= 4; ++j)
            for (std::uint32_t i = 0; i <= 4; ++i) book.positions.push_back(0.25 * i * page + Point3{0, 0, 0.25 * j});
    const auto at = [](std::uint32_t page, std::uint32_t i, std::uint32_t j) {
        return VertexId{i == 0 ? 5 * j : 25 * page + 5 * j + i};
    };
    for (std::uint32_t page = 0; page < 3; ++page)
        for (std::uint32_t j = 0; j < 4; ++j)
            for (std::uint32_t i = 0; i < 4; ++i) {
                book.triangles.push_back({at(page, i, j), at(page, i + 1, j), at(page, i + 1, j + 1)});
                book.triangles.push_back({at(page, i, j), at(page, i + 1, j + 1), at(page, i, j + 1)});
            }
    const RemeshResult result = remesh(book);
    EXPECT_EQ(result.statistics.vertices, 8U);  // two ends of the edge, two corners of each page
    EXPECT_EQ(result.mesh.positions.size(), 8U);
    EXPECT_EQ(result.statistics.faces, 3U);
    EXPECT_GT(result.statistics.non_manifold_edges, 0U);
    const SurfaceCheck check = check_surface(result.mesh, make_polygon_mesh(book));
    for (const Violation& violation : check.violations) ADD_FAILURE() << violation.message;
}

/// Two triangles over a square, one corner lifted.
CoarseMesh folded_square(double height) {
    CoarseMesh mesh;
    for (const Point3& p : {Point3{0, 0, 0}, Point3{1, 0, 0}, Point3{1, 1, height}, Point3{0, 1, 0}})
        mesh.add_vertex(p, {});
    mesh.add_polygon(std::array<Index, 3>{0, 1, 3}, 7);
    mesh.add_polygon(std::array<Index, 3>{1, 2, 3}, 7);
    return mesh;
}

TEST(PairTriangles, JoinsWhatIsFlat) {
    const CoarseMesh quad = pair_triangles(folded_square(1e-3), {0, 0}, 1e-3);
    ASSERT_EQ(quad.polygon_count(), 1U);
    const auto ring = quad.polygon(0);
    ASSERT_EQ(ring.size(), 4U);
    for (Index i = 0; i < 4; ++i) EXPECT_EQ((ring[(i + 1) % 4] + 4 - ring[i]) % 4, 1U);  // 0 1 2 3 from somewhere
    EXPECT_EQ(quad.parent(0), 7U);
}

TEST(PairTriangles, LeavesFoldsFeaturesAndOtherGroups) {
    EXPECT_EQ(pair_triangles(folded_square(0.1), {0, 0}, 1e-3).polygon_count(), 2U);
    EXPECT_EQ(pair_triangles(folded_square(0.0), {0, 1}, 1e-3).polygon_count(), 2U);
    EXPECT_EQ(pair_triangles(folded_square(0.0), {no_index, no_index}, 1e-3).polygon_count(), 2U);
    CoarseMesh creased = folded_square(0.0);
    creased.feature_edges.push_back({3, 1, 0});
    EXPECT_EQ(pair_triangles(creased, {0, 0}, 1e-3).polygon_count(), 2U);
    CoarseMesh dart = folded_square(0.0);
    dart.points[2] = {0.4, 0.4, 0.0};  // not convex
    EXPECT_EQ(pair_triangles(dart, {0, 0}, 1e-3).polygon_count(), 2U);
}

/// A square sheet of 40 x 40 squares with square holes.
TriangleMesh sheet_with_holes(double height) {
    TriangleMesh mesh;
    constexpr std::uint32_t n = 40;
    for (std::uint32_t j = 0; j <= n; ++j)
        for (std::uint32_t i = 0; i <= n; ++i) {
            const double x = double(i) / n, y = double(j) / n;
            mesh.positions.push_back({x, y, height * (x * x + 0.5 * y * y)});
        }
    const auto is_hole = [](std::uint32_t i, std::uint32_t j) {
        return (i >= 8 && i < 14 && j >= 8 && j < 14) || (i >= 22 && i < 34 && j >= 10 && j < 30);
    };
    for (std::uint32_t j = 0; j < n; ++j)
        for (std::uint32_t i = 0; i < n; ++i) {
            if (is_hole(i, j)) continue;
            const VertexId a{j * (n + 1) + i}, b{j * (n + 1) + i + 1}, c{(j + 1) * (n + 1) + i + 1},
                d{(j + 1) * (n + 1) + i};
            mesh.triangles.push_back({a, b, c});
            mesh.triangles.push_back({a, c, d});
        }
    return mesh;
}

TEST(OpenFaces, AFlatPlateWithHolesNeedsItsCornersOnly) {
    const TriangleMesh sheet = sheet_with_holes(0.0);
    const RemeshResult result = remesh(sheet);
    EXPECT_TRUE(check_surface(result.mesh, make_polygon_mesh(sheet)).ok());
    EXPECT_EQ(result.statistics.vertices, 12U);  // of the sheet and of two holes
    EXPECT_LE(result.statistics.faces, 9U);      // 14 triangles, most of them in pairs
    EXPECT_GE(result.statistics.quads, 5U);
    EXPECT_LT(result.statistics.distance_bound, 1e-5);
}

TEST(OpenFaces, ACurvedPlateWithHolesKeepsThem) {
    const TriangleMesh sheet = sheet_with_holes(0.4);
    for (const std::uint64_t count : {60u, 300u}) {
        RemeshOptions options;
        options.vertices = count;
        const RemeshResult result = remesh(sheet, options);
        const SurfaceCheck check = check_surface(result.mesh, make_polygon_mesh(sheet));
        for (const Violation& violation : check.violations) ADD_FAILURE() << count << ": " << violation.message;
        EXPECT_EQ(check.mesh.components.size(), 1U);
        EXPECT_EQ(check.mesh.components[0].boundary_loops, 3U);
    }
}

}  // namespace
}  // namespace certa::remeshing
