// Counts and topology against known truth: cube, torus, Moebius strip, pinched and non-manifold surfaces, tetrahedra.
#include <certa/info.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace {

using namespace certa;

/// One facet per polygon.
MeshDocument make_surface(std::vector<Point3> points, const std::vector<std::vector<std::uint32_t>>& polygons) {
    MeshDocument document;
    document.complex.positions = std::move(points);
    for (const auto& polygon : polygons) {
        std::vector<VertexId> corners;
        for (const std::uint32_t v : polygon) corners.push_back(VertexId{v});
        add_facet(document.complex, {corners});
    }
    return document;
}

std::vector<Point3> cube_points(double x = 0.0) {
    std::vector<Point3> points;
    for (int i = 0; i < 8; ++i) points.push_back({x + (i & 1), double((i >> 1) & 1), double((i >> 2) & 1)});
    return points;
}
const std::vector<std::vector<std::uint32_t>> cube_faces{{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                                         {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};

/// A grid of quads that closes up in both directions.
MeshDocument make_torus(std::uint32_t n, std::uint32_t m) {
    std::vector<Point3> points;
    std::vector<std::vector<std::uint32_t>> quads;
    for (std::uint32_t i = 0; i < n; ++i) {
        for (std::uint32_t j = 0; j < m; ++j) {
            const double u = 2 * std::numbers::pi * i / n, v = 2 * std::numbers::pi * j / m;
            points.push_back({(3 + std::cos(v)) * std::cos(u), (3 + std::cos(v)) * std::sin(u), std::sin(v)});
            const std::uint32_t i2 = (i + 1) % n, j2 = (j + 1) % m;
            quads.push_back({i * m + j, i2 * m + j, i2 * m + j2, i * m + j2});
        }
    }
    return make_surface(points, quads);
}

TEST(Info, Cube) {
    const DocumentInfo info = compute_info(make_surface(cube_points(), cube_faces));
    EXPECT_EQ(info.points, 8U);
    EXPECT_EQ(info.facets, 6U);
    EXPECT_EQ(info.duplicate_points + info.unused_points + info.segments, 0U);
    EXPECT_EQ(info.upper, (Point3{1, 1, 1}));
    EXPECT_DOUBLE_EQ(info.diagonal, std::sqrt(3.0));
    const SurfaceInfo& s = info.surface;
    EXPECT_EQ(s.polygons, 6U);
    EXPECT_EQ(s.smallest_degree, 4U);
    EXPECT_EQ(s.largest_degree, 4U);
    EXPECT_EQ(s.edges, 12U);
    EXPECT_EQ(s.components, 1U);
    EXPECT_TRUE(s.closed && s.manifold && s.orientable);
    EXPECT_EQ(s.inconsistent_edges, 0U);
    EXPECT_EQ(s.euler_characteristic, 2);
    EXPECT_EQ(s.genus, 0);
    EXPECT_DOUBLE_EQ(s.area, 6.0);
    ASSERT_TRUE(s.volume.has_value());
    EXPECT_DOUBLE_EQ(*s.volume, 1.0);
}

TEST(Info, FlippedFaceIsInconsistentButOrientable) {
    auto faces = cube_faces;
    std::reverse(faces[2].begin(), faces[2].end());
    const SurfaceInfo s = compute_info(make_surface(cube_points(), faces)).surface;
    EXPECT_EQ(s.inconsistent_edges, 4U);
    EXPECT_TRUE(s.orientable);
    EXPECT_FALSE(s.volume.has_value());
}

TEST(Info, OpenBoxHasOneLoop) {
    auto faces = cube_faces;
    faces.pop_back();
    const SurfaceInfo s = compute_info(make_surface(cube_points(), faces)).surface;
    EXPECT_FALSE(s.closed);
    EXPECT_TRUE(s.manifold);
    EXPECT_EQ(s.boundary_edges, 4U);
    EXPECT_EQ(s.boundary_loops, 1U);
    EXPECT_EQ(s.euler_characteristic, 1);
    EXPECT_EQ(s.genus, 0);
}

TEST(Info, TorusHasGenusOne) {
    const SurfaceInfo s = compute_info(make_torus(12, 7)).surface;
    EXPECT_TRUE(s.closed && s.manifold && s.orientable);
    EXPECT_EQ(s.euler_characteristic, 0);
    EXPECT_EQ(s.genus, 1);
    EXPECT_GT(*s.volume, 0.0);
}

TEST(Info, MoebiusStripIsNotOrientable) {
    // Five quads around; the last joins the first with top and bottom exchanged.
    std::vector<Point3> points;
    std::vector<std::vector<std::uint32_t>> quads;
    for (std::uint32_t i = 0; i < 5; ++i) {
        points.push_back({double(i), 0, double(i * i)});
        points.push_back({double(i), 1, double(i * i)});
        quads.push_back({2 * i, i < 4 ? 2 * i + 2 : 1, i < 4 ? 2 * i + 3 : 0, 2 * i + 1});
    }
    const SurfaceInfo s = compute_info(make_surface(points, quads)).surface;
    EXPECT_TRUE(s.manifold);
    EXPECT_FALSE(s.orientable);
    EXPECT_EQ(s.boundary_loops, 1U);
    EXPECT_EQ(s.euler_characteristic, 0);
    EXPECT_FALSE(s.genus.has_value());
}

TEST(Info, CubesThatShareOnlyAVertexOrAnEdge) {
    // A second cube whose vertex 0 is the first one's vertex 7.
    std::vector<Point3> points = cube_points();
    std::vector<std::vector<std::uint32_t>> faces = cube_faces;
    for (int i = 1; i < 8; ++i) points.push_back({1.0 + (i & 1), 1.0 + ((i >> 1) & 1), 1.0 + ((i >> 2) & 1)});
    for (auto face : cube_faces) {
        for (auto& v : face) v = v == 0 ? 7 : v + 7;
        faces.push_back(face);
    }
    const SurfaceInfo pinched = compute_info(make_surface(points, faces)).surface;
    EXPECT_EQ(pinched.non_manifold_vertices, 1U);
    EXPECT_EQ(pinched.non_manifold_edges, 0U);
    EXPECT_EQ(pinched.components, 2U);
    EXPECT_FALSE(pinched.manifold);
    EXPECT_DOUBLE_EQ(*pinched.volume, 2.0);

    // Three pages of one book.
    const SurfaceInfo book = compute_info(make_surface({{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}},
                                                       {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}))
                                 .surface;
    EXPECT_EQ(book.non_manifold_edges, 1U);
    EXPECT_EQ(book.boundary_edges, 6U);
    EXPECT_EQ(book.components, 1U);
    EXPECT_FALSE(book.genus.has_value());
}

TEST(Info, RepeatedUnusedAndDuplicate) {
    std::vector<Point3> points = cube_points();
    points.push_back({0, 0, 0});
    points.push_back({5, 0, 0});
    auto faces = cube_faces;
    faces.push_back({3, 2, 0, 1});
    const DocumentInfo info = compute_info(make_surface(points, faces));
    EXPECT_EQ(info.duplicate_points, 1U);
    EXPECT_EQ(info.unused_points, 2U);
    EXPECT_EQ(info.surface.repeated_polygons, 1U);
    EXPECT_EQ(info.upper.x, 5.0);
}

TEST(Info, FacetsOfSeveralPolygonsHaveNoEulerCharacteristic) {
    MeshDocument document;
    document.complex.positions = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, 0}, {2, 1, 0}};
    add_facet(document.complex, {{VertexId{0}, VertexId{1}, VertexId{2}}, {VertexId{3}}, {VertexId{3}, VertexId{4}}},
              {{3, 0.5, 0}});
    const DocumentInfo info = compute_info(document);
    EXPECT_EQ(info.surface.polygons, 1U);
    EXPECT_EQ(info.isolated_points, 1U);
    EXPECT_EQ(info.isolated_segments, 1U);
    EXPECT_EQ(info.facet_holes, 1U);
    EXPECT_FALSE(info.surface.euler_characteristic.has_value());
    EXPECT_EQ(info.surface.boundary_edges, 3U);
}

TEST(Info, EmptyDocument) {
    const DocumentInfo info = compute_info({});
    EXPECT_EQ(info.points, 0U);
    EXPECT_FALSE(info.surface.closed || info.surface.manifold || info.surface.orientable);
    EXPECT_EQ(info.tetrahedra.tetrahedra, 0U);
}

TEST(Info, Tetrahedra) {
    MeshDocument document;
    document.complex.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}, {2, 0, 0}, {9, 9, 9}};
    const auto tetrahedron = [](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
        return Tetrahedron{VertexId{a}, VertexId{b}, VertexId{c}, VertexId{d}};
    };
    document.tetrahedra = {tetrahedron(0, 1, 2, 3), tetrahedron(1, 2, 3, 4)};
    document.fields.push_back({"region", Location::tetrahedra, 1, std::vector<std::int64_t>{1, 2}});
    const TetrahedraInfo good = compute_info(document).tetrahedra;
    EXPECT_EQ(good.vertices, 5U);
    EXPECT_EQ(good.components, 1U);
    EXPECT_EQ(good.boundary_triangles, 6U);
    EXPECT_EQ(good.non_manifold_triangles, 0U);
    EXPECT_EQ(good.regions, 2U);
    EXPECT_EQ(good.flat + good.inverted, 0U);
    EXPECT_NEAR(good.volume, 1.0 / 6 + 1.0 / 3, 1e-15);
    EXPECT_NEAR(good.largest_dihedral_radians, std::numbers::pi / 2, 1e-14);
    EXPECT_NEAR(good.smallest_dihedral_radians, std::acos(std::sqrt(1.0 / 3)), 1e-14);

    document.tetrahedra = {tetrahedron(0, 2, 1, 3), tetrahedron(0, 1, 5, 2)};
    const TetrahedraInfo bad = compute_info(document).tetrahedra;
    EXPECT_EQ(bad.inverted, 1U);
    EXPECT_EQ(bad.flat, 1U);
    EXPECT_EQ(bad.volume, 0.0);
}

}  // namespace
