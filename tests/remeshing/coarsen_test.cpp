// Vertices that matter least go first, and what is left is a mesh as before.
#include "remeshing/coarsen.h"

#include <certa/remeshing.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace certa::remeshing {
namespace {

constexpr Index side = 13;  ///< vertices of a grid

/// Flat where x < 0; a saddle beyond that bends both ways.
double height_at(double x, double y, double bend) { return x > 0.0 ? bend * x * (x - y * y) : 0.0; }

const std::vector<std::uint8_t> all(side* side, 1);

/// A grid over [-1, 1]^2; corners and boundary are features.
CoarseMesh grid(double bend) {
    CoarseMesh mesh;
    for (Index j = 0; j < side; ++j)
        for (Index i = 0; i < side; ++i) {
            const double x = 2.0 * i / (side - 1.0) - 1.0, y = 2.0 * j / (side - 1.0) - 1.0;
            const bool on_x = i == 0 || i + 1 == side, on_y = j == 0 || j + 1 == side;
            const VertexKind kind = on_x && on_y   ? VertexKind::corner
                                    : on_x || on_y ? VertexKind::boundary
                                                   : VertexKind::smooth;
            mesh.add_vertex({x, y, height_at(x, y, bend)}, {}, kind, kind == VertexKind::smooth ? no_index : 0);
        }
    for (Index j = 0; j + 1 < side; ++j)
        for (Index i = 0; i + 1 < side; ++i) {
            const Index a = j * side + i;
            mesh.add_polygon(std::array{a, a + 1, a + 1 + side, a + side}, j * (side - 1) + i);
        }
    for (Index k = 0; k + 1 < side; ++k)
        for (const auto& [a, b] :
             {std::array{k, k + 1}, std::array{side * (side - 1) + k, side * (side - 1) + k + 1},
              std::array{k * side, (k + 1) * side}, std::array{k * side + side - 1, (k + 1) * side + side - 1}})
            mesh.feature_edges.push_back({a, b, 0});
    return mesh;
}

/// The surface itself, in triangles much smaller.
core::TriangleTree surface(double bend) {
    constexpr Index n = 97;
    std::vector<Point3> points;
    std::vector<Triangle> triangles;
    for (Index j = 0; j < n; ++j)
        for (Index i = 0; i < n; ++i) {
            const double x = 2.0 * i / (n - 1.0) - 1.0, y = 2.0 * j / (n - 1.0) - 1.0;
            points.push_back({x, y, height_at(x, y, bend)});
        }
    for (Index j = 0; j + 1 < n; ++j)
        for (Index i = 0; i + 1 < n; ++i) {
            const Index a = j * n + i;
            triangles.push_back({VertexId{a}, VertexId{a + 1}, VertexId{a + 1 + n}});
            triangles.push_back({VertexId{a}, VertexId{a + 1 + n}, VertexId{a + n}});
        }
    return {points, triangles};
}

/// V - E + F of what polygons use; every side once each way at most.
std::int64_t characteristic_of(const CoarseMesh& mesh) {
    std::vector<Index> used = mesh.corners;
    std::vector<std::array<Index, 2>> sides, edges;
    for (std::size_t q = 0; q < mesh.polygon_count(); ++q) {
        const auto ring = mesh.polygon(q);
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Index a = ring[i], b = ring[(i + 1) % ring.size()];
            sides.push_back({a, b});
            edges.push_back({std::min(a, b), std::max(a, b)});
        }
    }
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    std::sort(sides.begin(), sides.end());
    EXPECT_EQ(std::adjacent_find(sides.begin(), sides.end()), sides.end());
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return static_cast<std::int64_t>(used.size() + mesh.polygon_count()) - static_cast<std::int64_t>(edges.size());
}

TEST(Coarsen, FlatPartsGoFirstAndTheMeshStaysOne) {
    constexpr double bend = 0.5;
    const core::TriangleTree tree = surface(bend);
    for (const std::size_t count : {1U, 8U, 30U, 60U}) {
        CoarseMesh mesh = grid(bend);
        const std::vector<MergedVertex> merged = coarsen(tree, {0.01, 0.01}, count, all, mesh);
        ASSERT_EQ(merged.size(), count);
        EXPECT_EQ(characteristic_of(mesh), 1);
        for (const MergedVertex& m : merged) {
            EXPECT_LT(mesh.points[m.vertex].x, 0.2);
            EXPECT_NE(mesh.kinds[m.vertex], VertexKind::corner);
            EXPECT_EQ(std::count(mesh.corners.begin(), mesh.corners.end(), m.vertex), 0);
            EXPECT_GT(std::count(mesh.corners.begin(), mesh.corners.end(), m.into), 0);
        }
        for (const Index v : mesh.corners)  // cut, two polygons with the same corners might be the same
            EXPECT_GE(std::count(mesh.corners.begin(), mesh.corners.end(), v),
                      mesh.kinds[v] == VertexKind::smooth ? 3 : 1)
                << v;
        for (const Index v : mesh.corners)
            EXPECT_NEAR(mesh.points[v].z, height_at(mesh.points[v].x, mesh.points[v].y, bend), 1e-3) << v;
    }
}

TEST(Coarsen, QuadsStayQuads) {
    const core::TriangleTree tree = surface(0.5);
    CoarseMesh mesh = grid(0.5);
    coarsen(tree, {0.01, 0.01}, 12, all, mesh);
    std::size_t quads = 0;
    for (std::size_t q = 0; q < mesh.polygon_count(); ++q) quads += mesh.polygon(q).size() == 4 ? 1 : 0;
    EXPECT_GE(static_cast<double>(quads), 0.9 * static_cast<double>(mesh.polygon_count()));
}

TEST(Coarsen, AFaceThatGoesIsKnownToThoseThatTakeItsPart) {
    const core::TriangleTree tree = surface(0.5);
    CoarseMesh mesh = grid(0.5);
    coarsen(tree, {0.01, 0.01}, 10, all, mesh);
    std::vector<Index> left = mesh.parents;
    std::sort(left.begin(), left.end());
    std::size_t gone = 0;
    for (Index f = 0; f < (side - 1) * (side - 1); ++f) {
        if (std::binary_search(left.begin(), left.end(), f)) continue;
        ++gone;
        EXPECT_TRUE(std::any_of(mesh.joined.begin(), mesh.joined.end(), [&](const std::array<Index, 2>& pair) {
            return pair[0] == f;
        })) << f;
    }
    EXPECT_GT(gone, 0U);
}

TEST(Coarsen, VerticesBeyondAndCornersStay) {
    const core::TriangleTree tree = surface(0.5);
    CoarseMesh mesh = grid(0.5);
    EXPECT_TRUE(coarsen(tree, {0.01, 0.01}, 10, {}, mesh).empty());
    // All that there is: no more vertices go than may.
    const auto merged = coarsen(tree, {1.0, 1.0}, 10000, all, mesh);
    EXPECT_LE(merged.size(), side * side - 4U);
    EXPECT_EQ(characteristic_of(mesh), 1);
    for (const Index v : {0U, side - 1, side * (side - 1), side * side - 1})
        EXPECT_GT(std::count(mesh.corners.begin(), mesh.corners.end(), v), 0);
}

TEST(AppendMerged, LaterMergesMoveWhatEarlierOnesLeft) {
    std::vector<MergedVertex> merged{{1, 2}, {3, 4}};
    append_merged(merged, {{2, 5}});
    ASSERT_EQ(merged.size(), 3U);
    EXPECT_EQ(merged[0].into, 5U);
    EXPECT_EQ(merged[1].into, 4U);
}

}  // namespace
}  // namespace certa::remeshing
