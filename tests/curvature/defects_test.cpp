// Input that is broken, and surfaces that come as something else than triangles.
#include <certa/io.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "curvature/meshes.h"

using namespace certa;
using namespace certa::testing;

namespace {

DefectKind kind_of_refusal(const TriangleMesh& mesh) {
    try {
        compute_curvature(mesh);
    } catch (const InputError& error) {
        return error.defects().at(0).kind;
    }
    ADD_FAILURE() << "accepted";
    return DefectKind::duplicate_point;
}

void expect_sane(const CurvatureResult& r) {
    for (std::size_t v = 0; v < r.k_min.size(); ++v) {
        ASSERT_TRUE(std::isfinite(r.k_min[v]) && std::isfinite(r.k_max[v]) && std::isfinite(r.mean[v]));
        ASSERT_TRUE(std::isfinite(r.gaussian[v]) && std::isfinite(r.area[v]));
        ASSERT_LE(r.k_min[v], r.k_max[v]);
        ASSERT_GE(r.confidence[v], 0.0);
        ASSERT_LE(r.confidence[v], 1.0);
        if (r.flags[v] & (vertex_flags::unused | vertex_flags::undefined)) {
            ASSERT_EQ(r.k_max[v], 0.0);
        } else {
            ASSERT_NEAR(norm(r.normal[v]), 1.0, 1e-12);
            ASSERT_NEAR(dot(r.normal[v], r.dir_min[v]), 0.0, 1e-12);
            ASSERT_NEAR(dot(r.dir_max[v], r.dir_min[v]), 0.0, 1e-12);
        }
    }
}

TEST(Defects, Refused) {
    TriangleMesh mesh = generators::make_box(1, 1, 1);
    mesh.positions[3].y = NAN;
    EXPECT_EQ(kind_of_refusal(mesh), DefectKind::non_finite_coordinate);
    mesh.positions[3].y = INFINITY;
    EXPECT_EQ(kind_of_refusal(mesh), DefectKind::non_finite_coordinate);
    mesh.positions[3].y = 1;
    mesh.triangles[2][1] = VertexId{8};
    EXPECT_EQ(kind_of_refusal(mesh), DefectKind::index_out_of_range);
    EXPECT_EQ(kind_of_refusal({}), DefectKind::empty_input);
    EXPECT_EQ(kind_of_refusal({{{-1e308, 0, 0}, {1e308, 0, 0}, {0, 1e308, 0}}, {triangle(0, 1, 2)}}),
              DefectKind::coordinate_out_of_range);
}

TEST(Defects, OpenSurfacesHaveNoAngleAtTheirBorder) {
    const TriangleMesh square{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {triangle(0, 1, 2), triangle(0, 2, 3)}};
    const CurvatureResult r = compute_curvature(square);
    EXPECT_EQ(r.statistics.border_edges, 4U);
    EXPECT_NEAR(r.total.gaussian, 2 * pi, 1e-14);  // four corners of pi - pi / 2
    EXPECT_EQ(r.total.mean, 0.0);
    for (const std::uint8_t flags : r.flags) EXPECT_EQ(flags & vertex_flags::border, vertex_flags::border);
    for (std::size_t v = 0; v < 4; ++v) EXPECT_EQ(r.normal[v], (Point3{0, 0, 1}));
    expect_sane(r);
}

TEST(Defects, InconsistentOrientationIsLeftOutAndCounted) {
    TriangleMesh mesh = generators::make_box(1, 1, 1);
    std::swap(mesh.triangles[2][0], mesh.triangles[2][1]);
    const CurvatureResult r = compute_curvature(mesh);
    EXPECT_EQ(r.statistics.excluded_edges, 3U);
    EXPECT_NEAR(r.total.mean, 6 * pi - pi, 1e-13);  // two of the cube's edges are gone
    EXPECT_NE(r.flags[4] & vertex_flags::excluded, 0);
    expect_sane(r);
}

TEST(Defects, RepeatedAndUnusedVertices) {
    TriangleMesh mesh = generators::make_box(1, 1, 1);
    mesh.positions.push_back({5, 5, 5});
    mesh.triangles.push_back(triangle(1, 1, 2));
    const CurvatureResult r = compute_curvature(mesh);
    EXPECT_EQ(r.statistics.repeated_vertices, 1U);
    EXPECT_EQ(r.statistics.unused_vertices, 1U);
    EXPECT_EQ(r.flags[8], vertex_flags::unused);
    EXPECT_NEAR(r.total.gaussian, 4 * pi, 1e-13);
    expect_sane(r);
}

/// From a binary STL whose three corners merged into one: nothing is left to measure, by any neighbourhood.
TEST(Defects, NothingButRepeatedVertices) {
    const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}}, {triangle(0, 0, 0), triangle(0, 1, 0)}};
    for (const bool sheets : {false, true})
        for (const Neighborhood neighborhood :
             {Neighborhood::ball, Neighborhood::rings, Neighborhood::geodesic, Neighborhood::automatic_ball}) {
            if (sheets && neighborhood != Neighborhood::ball) continue;
            CurvatureOptions options{.neighborhood = neighborhood, .all_sheets = sheets};
            options.radius = {5.0, false};
            const CurvatureResult r = compute_curvature(mesh, options);
            EXPECT_EQ(r.statistics.repeated_vertices, 2U);
            EXPECT_EQ(r.flags[0], vertex_flags::unused);
            EXPECT_EQ(r.total.area, 0.0);
            expect_sane(r);
        }
    for (const Estimator estimator : {Estimator::corrected, Estimator::jet, Estimator::automatic})
        expect_sane(compute_curvature(mesh, {.estimator = estimator}));
    EXPECT_EQ(compute_region_measures(mesh, Region{}, {.bounds = true}).measures.area, 0.0);
}

TEST(Defects, TrianglesThatShareAnEdgeThreefold) {
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}};
    mesh.triangles = {triangle(0, 1, 2), triangle(0, 1, 3), triangle(1, 0, 4)};
    const CurvatureResult r = compute_curvature(mesh);
    EXPECT_EQ(r.statistics.non_manifold_edges, 1U);
    EXPECT_EQ(r.statistics.excluded_edges, 1U);
    EXPECT_NE(r.flags[0] & vertex_flags::non_manifold, 0);
    expect_sane(r);
}

TEST(Defects, RandomSoupsAreMeasuredWithoutNonsense) {
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        core::Random random(seed);
        TriangleMesh mesh;
        const auto points = static_cast<std::uint32_t>(3 + random.below(8));
        for (std::uint32_t i = 0; i < points; ++i) {
            Point3 p = random_point(random);
            if (random.coin(0.3)) p = {std::round(p.x), std::round(p.y), std::round(p.z)};
            if (random.coin(0.1)) p = 1e-200 * p;
            mesh.positions.push_back(p);
        }
        const auto index = [&] { return static_cast<std::uint32_t>(random.below(points)); };
        for (std::uint64_t t = 1 + random.below(20); t > 0; --t)
            mesh.triangles.push_back(triangle(index(), index(), index()));
        for (const Neighborhood neighborhood :
             {Neighborhood::rings, Neighborhood::ball, Neighborhood::geodesic, Neighborhood::automatic_ball}) {
            CurvatureOptions options{.neighborhood = neighborhood};
            options.radius.value = random.uniform(0.1, 2.0);
            expect_sane(compute_curvature(mesh, options));
        }
        for (const Rim rim : {Rim::half, Rim::closed, Rim::open})
            expect_sane(compute_curvature(mesh, {.rim = rim, .bounds = true}));
        for (const Weight weight : {Weight::indicator, Weight::kernel2, Weight::kernel4})
            for (const Estimator estimator : {Estimator::corrected, Estimator::normal_cycle}) {
                CurvatureOptions options{.neighborhood = Neighborhood::ball, .weight = weight, .estimator = estimator};
                options.radius.value = random.uniform(0.1, 2.0);
                expect_sane(compute_curvature(mesh, options));
            }
        expect_sane(compute_curvature(mesh, {.weight = Weight::kernel2}));
        for (const Estimator estimator : {Estimator::corrected, Estimator::jet, Estimator::automatic})
            expect_sane(compute_curvature(mesh, {.estimator = estimator}));
        compute_region_measures(mesh, make_ball_region(random_point(random), 0.7), {.bounds = true});
    }
}

TEST(Surfaces, PolygonsAreCutTheSameWayWhereverTheyStart) {
    // A planar polygon with a deep notch: a fan would turn triangles over.
    const std::vector<Point3> points{{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {2, 0.5, 0}, {0, 3, 0}};
    std::vector<Triangle> first;
    for (std::uint32_t start = 0; start < 5; ++start) {
        PolygonMesh mesh;
        mesh.positions = points;
        for (std::uint32_t i = 0; i < 5; ++i) mesh.corners.push_back(VertexId{(start + i) % 5});
        mesh.offsets = {0, 5};
        const TriangulatedSurface surface = triangulate(mesh);
        ASSERT_EQ(surface.mesh.triangles.size(), 3U);
        EXPECT_NEAR(compute_curvature(surface.mesh).total.area, 7.0, 1e-14);
        if (first.empty()) first = surface.mesh.triangles;
        EXPECT_EQ(surface.mesh.triangles, first);
    }
}

TEST(Surfaces, BoundariesOfRegionsOfTetrahedra) {
    MeshDocument document;
    document.complex.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
    document.tetrahedra = {{VertexId{0}, VertexId{1}, VertexId{2}, VertexId{3}},
                           {VertexId{1}, VertexId{2}, VertexId{3}, VertexId{4}}};
    document.fields.push_back({"region", Location::tetrahedra, 1, std::vector<std::int64_t>{1, 2}});
    EXPECT_EQ(find_regions(document), (std::vector<std::int64_t>{1, 2}));
    EXPECT_EQ(triangulate(document).mesh.triangles.size(), 6U);
    const CurvatureMeasures one = compute_curvature(triangulate(document, 1).mesh).total;
    EXPECT_NEAR(one.gaussian, 4 * pi, 1e-12);
    EXPECT_NEAR(one.area, 1.5 + std::sqrt(3.0) / 2, 1e-14);
    EXPECT_GT(one.mean, 0.0);
    EXPECT_GT(compute_curvature(triangulate(document, 2).mesh).total.mean, 0.0);
    EXPECT_THROW(triangulate(document, 3), InputError);
}

TEST(Surfaces, FieldsOfADocument) {
    const CurvatureResult r = compute_curvature(generators::make_box(1, 1, 1), {.tensors = true});
    const std::vector<Field> fields = make_fields(r);
    std::vector<std::string> names;
    for (const Field& field : fields) names.push_back(field.name);
    const std::vector<std::string> expected{"area",    "mean",   "gaussian",   "k_min", "k_max",  "dir_min",
                                            "dir_max", "normal", "confidence", "flags", "tensor", "swapped_tensor"};
    EXPECT_EQ(names, expected);
    EXPECT_EQ(fields.back().components, 6U);
}

/// Every broken model ends with numbers or with a refusal that says why.
TEST(Defects, BrokenModels) {
    const char* models = std::getenv("CERTA_MODELS");
    const std::filesystem::path folder =
        std::filesystem::path(models != nullptr ? models : "../shared/models") / "defects";
    if (!std::filesystem::is_directory(folder)) GTEST_SKIP() << "no models at " << folder;
    std::size_t measured = 0, refused = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        try {
            const TriangulatedSurface surface = triangulate(read_document(entry.path().string()));
            if (surface.mesh.triangles.size() > 50000) continue;
            expect_sane(compute_curvature(surface.mesh));
            CurvatureOptions ball{.neighborhood = Neighborhood::ball};
            ball.radius = {0.03, true};
            expect_sane(compute_curvature(surface.mesh, ball));
            ++measured;
        } catch (const IoError& error) {
            EXPECT_FALSE(error.reason().empty());
            ++refused;
        } catch (const InputError& error) {
            EXPECT_FALSE(error.defects().empty()) << entry.path();
            ++refused;
        }
    }
    EXPECT_GT(measured, 20U);
    EXPECT_GT(refused, 5U);
}

}  // namespace
