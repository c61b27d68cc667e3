// Masks of the regular cases, topology, creases and corners.
#include "remeshing/subdivision.h"

#include <gtest/gtest.h>

#include <map>
#include <numeric>

#include "core/random.h"
#include "core/vector3.h"
#include "mesh/generators_surfaces.h"
#include "remeshing/coarse_meshes.h"
#include "remeshing/missed_creases.h"
#include "remeshing/sound_subdivision.h"
#include "remeshing/stitch.h"

namespace certa::remeshing {
namespace {

int euler_characteristic(const CoarseMesh& mesh, int& boundary_sides) {
    std::map<std::pair<Index, Index>, int> sides;
    for (std::size_t q = 0; q < mesh.polygon_count(); ++q) {
        const auto ring = mesh.polygon(q);
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Index a = ring[i], b = ring[(i + 1) % ring.size()];
            ++sides[{std::min(a, b), std::max(a, b)}];
        }
    }
    boundary_sides = 0;
    for (const auto& [side, times] : sides) {
        EXPECT_LE(times, 2);
        boundary_sides += times == 1;
    }
    return static_cast<int>(mesh.points.size()) - static_cast<int>(sides.size()) +
           static_cast<int>(mesh.polygon_count());
}

CoarseMesh make_flat_grid(std::uint32_t n) {
    return coarse_mesh(test::make_grid(n, n, [](double u, double v) { return Point3{u, v, 0.0}; }));
}

TEST(Subdivision, RegularQuadsAreTheBicubicSpline) {
    CoarseMesh mesh = make_flat_grid(4);
    const Index v = 2 * 5 + 2;
    mesh.points[v].z = 1.0;
    const CoarseMesh fine = subdivide(mesh);
    EXPECT_NEAR(fine.points[v].z, 36.0 / 64.0, 1e-15);
    EXPECT_NEAR(fine.points[v + 1].z, 6.0 / 64.0, 1e-15);
    EXPECT_NEAR(fine.points[v + 6].z, 1.0 / 64.0, 1e-15);
}

TEST(Subdivision, RegularTrianglesAreLoops) {
    const CoarseMesh quads = make_flat_grid(4);
    CoarseMesh mesh = quads;
    mesh.corners.clear(), mesh.offsets = {0};
    for (std::size_t q = 0; q < quads.polygon_count(); ++q) {
        const auto r = quads.polygon(q);
        mesh.add_polygon(std::array{r[0], r[1], r[2]});
        mesh.add_polygon(std::array{r[0], r[2], r[3]});
    }
    const Index v = 2 * 5 + 2;
    mesh.points[v].z = 1.0;
    const CoarseMesh fine = subdivide(mesh);
    EXPECT_NEAR(fine.points[v].z, 10.0 / 16.0, 1e-15);
    EXPECT_NEAR(fine.points[v + 1].z, 1.0 / 16.0, 1e-15);
    EXPECT_NEAR(fine.points[v + 6].z, 1.0 / 16.0, 1e-15);
    EXPECT_NEAR(fine.points[v + 4].z, 0.0, 1e-15);
}

TEST(Subdivision, KeepsPlanesAndTopology) {
    core::Random random(5);
    CoarseMesh mesh = make_flat_grid(5);
    for (Point3& p : mesh.points) p = {p.x, p.y, 2.0 * p.x - p.y};
    const CoarseMesh twice = subdivide(subdivide(mesh));
    for (const Point3& p : twice.points) EXPECT_NEAR(p.z, 2.0 * p.x - p.y, 1e-14);
    int boundary = 0;
    EXPECT_EQ(euler_characteristic(twice, boundary), 1);
    EXPECT_EQ(boundary, 4 * 5 * 4);
    const CoarseMesh torus = subdivide(coarse_mesh(test::make_torus(8, 6, 1.0, 0.4)));
    EXPECT_EQ(euler_characteristic(torus, boundary), 0);
    EXPECT_EQ(boundary, 0);
    EXPECT_EQ(torus.polygon_count(), 4u * 48u);
    const CoarseMesh sphere = subdivide(coarse_mesh(test::make_sphere(5, 7, 1.0)));
    EXPECT_EQ(euler_characteristic(sphere, boundary), 2);
    for (const Point3& p : sphere.points) EXPECT_LT(norm(p), 1.0);
}

TEST(Subdivision, LargePolygonsBecomeQuads) {
    CoarseMesh mesh;
    for (const Point3& p : {Point3{0, 0, 0}, {2, 0, 0}, {3, 1, 0}, {1, 3, 0}, {-1, 1, 0}}) mesh.add_vertex(p, {});
    mesh.add_polygon(std::vector<Index>{0, 1, 2, 3, 4});
    const CoarseMesh fine = subdivide(mesh);
    EXPECT_EQ(fine.polygon_count(), 5u);
    for (std::size_t q = 0; q < 5; ++q) EXPECT_EQ(fine.polygon(q).size(), 4u);
}

TEST(Subdivision, CreasesAreSplinesAndCornersStay) {
    // A cube whose twelve edges are creases: sides stay flat, edges straight, corners where they are.
    CoarseMesh mesh = coarse_mesh(test::make_cube(2));
    Index curve = 0;
    for (std::size_t q = 0; q < mesh.polygon_count(); ++q) {
        const auto ring = mesh.polygon(q);
        for (std::size_t i = 0; i < 4; ++i) {
            const Point3 m = 0.5 * (mesh.points[ring[i]] + mesh.points[ring[(i + 1) % 4]]);
            const auto at_end = [](double x) { return x == 0.0 || x == 1.0; };
            if (ring[i] < ring[(i + 1) % 4] && at_end(m.x) + at_end(m.y) + at_end(m.z) == 2)
                mesh.feature_edges.push_back({ring[i], ring[(i + 1) % 4], curve++});
        }
    }
    EXPECT_EQ(mesh.feature_edges.size(), 24u);
    const CoarseMesh fine = subdivide(subdivide(mesh));
    EXPECT_EQ(fine.feature_edges.size(), 4u * 24u);
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
        const Point3& p = mesh.points[v];
        const bool is_corner = p.x != 0.5 && p.y != 0.5 && p.z != 0.5;
        if (is_corner) {
            EXPECT_EQ(fine.points[v], p);
        }
    }
    for (const Point3& p : fine.points) {
        const double off = std::min({p.x, p.y, p.z, 1.0 - p.x, 1.0 - p.y, 1.0 - p.z});
        EXPECT_NEAR(off, 0.0, 1e-15);
    }
    for (const FeatureEdge& edge : fine.feature_edges)
        for (const Index v : {edge.a, edge.b}) {
            const Point3& p = fine.points[v];
            const auto at_end = [](double x) { return x < 1e-15 || x > 1.0 - 1e-15; };
            EXPECT_GE(at_end(p.x) + at_end(p.y) + at_end(p.z), 2);
        }
}

/// Rough meshes fold when they are smoothed; held back they do not, and stay smooth elsewhere.
TEST(Subdivision, NeitherFoldsNorMeetsItself) {
    std::size_t broken_before = 0, held = 0, all = 0;
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        const TriangleMesh rough = generators::make_noisy(generators::make_icosphere(2), 0.3, seed);
        CoarseMesh coarse;
        for (const Point3& p : rough.positions) coarse.add_vertex(p, {});
        for (const Triangle& t : rough.triangles)
            coarse.add_polygon(std::array{index_of(t[0]), index_of(t[1]), index_of(t[2])});
        const core::TriangleTree tree(rough.positions, rough.triangles);
        std::vector<Index> names(rough.positions.size());
        std::iota(names.begin(), names.end(), 0U);
        const Judge judge{rough, tree, 2.0, !has_contact(rough, names, {})};
        CoarseMesh smooth = subdivide(subdivide(coarse));
        broken_before += find_damage(judge, smooth, {}).polygons.size();
        SubdivisionReport report;
        CoarseMesh sound = subdivide_soundly(coarse, {2}, judge, report, {});
        EXPECT_EQ(report.rounds, 2U);
        EXPECT_TRUE(find_damage(judge, sound, {}).polygons.empty());
        EXPECT_LT(report.coarse, coarse.polygon_count() / 5);
        EXPECT_GT(sound.points.size(), smooth.points.size() * 9 / 10);
        held += report.held, all += sound.points.size();
    }
    EXPECT_GT(broken_before, 0U);
    EXPECT_GT(held, 0U);
    EXPECT_LT(held, all / 2);
}

/// A piece of a polygon may turn away from what is right below it, though the whole does not.
TEST(Subdivision, IsLeftOutRatherThanBroken) {
    constexpr double height = 1e-3;
    const TriangleMesh input{
        {{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}, {0.6, 0.6, height}, {0.6, 0.8, height}, {0.8, 0.6, height}},
        {{VertexId{0}, VertexId{1}, VertexId{2}}, {VertexId{3}, VertexId{4}, VertexId{5}}}};
    const core::TriangleTree tree(input.positions, input.triangles);
    const Judge judge{input, tree, 20.0, true};
    CoarseMesh coarse;
    for (const Point3& p : {Point3{0, 0, height}, Point3{4, 0, height}, Point3{0, 4, height}})
        coarse.add_vertex(p, {}, VertexKind::corner);
    coarse.add_polygon(std::array<Index, 3>{0, 1, 2});
    ASSERT_TRUE(find_damage(judge, coarse, {}).polygons.empty());
    CoarseMesh broken = subdivide(coarse);
    EXPECT_EQ(find_damage(judge, broken, {}).polygons.size(), 1U);
    SubdivisionReport report;
    const CoarseMesh sound = subdivide_soundly(coarse, {1}, judge, report, {});
    EXPECT_EQ(report.rounds, 0U);
    EXPECT_EQ(report.place, coarse.points[0]);
    EXPECT_EQ(report.coarse, 1U);
    EXPECT_EQ(sound.polygon_count(), 1U);
}

/// The same beside another polygon, which is subdivided but for the side in common.
TEST(Subdivision, OnlyWhatWouldBreakStaysCoarse) {
    constexpr double height = 1e-3;
    const TriangleMesh input{
        {{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}, {0.6, 0.6, height}, {0.6, 0.8, height}, {0.8, 0.6, height}},
        {{VertexId{0}, VertexId{1}, VertexId{2}}, {VertexId{3}, VertexId{4}, VertexId{5}}}};
    const core::TriangleTree tree(input.positions, input.triangles);
    const Judge judge{input, tree, 20.0, true};
    CoarseMesh coarse;
    for (const Point3& p : {Point3{0, 0, height}, Point3{4, 0, height}, Point3{0, 4, height}, Point3{4, 4, height}})
        coarse.add_vertex(p, {}, VertexKind::corner);
    coarse.add_polygon(std::array<Index, 3>{0, 1, 2});
    coarse.add_polygon(std::array<Index, 3>{1, 3, 2});
    SubdivisionReport report;
    const CoarseMesh sound = subdivide_soundly(coarse, {1}, judge, report, {});
    EXPECT_EQ(report.rounds, 1U);
    EXPECT_EQ(report.coarse, 1U);
    EXPECT_EQ(report.place, coarse.points[0]);
    EXPECT_EQ(sound.polygon_count(), 4U);
    EXPECT_EQ(sound.points.size(), 6U);
    int boundary_sides = 0;
    EXPECT_EQ(euler_characteristic(sound, boundary_sides), 1);
    EXPECT_EQ(boundary_sides, 6);
    CoarseMesh again = sound;
    EXPECT_TRUE(find_damage(judge, again, {}).polygons.empty());
    const CoarseMesh twice = subdivide_soundly(coarse, {2}, judge, report, {});
    EXPECT_EQ(report.rounds, 2U);
    EXPECT_EQ(euler_characteristic(twice, boundary_sides), 1);
    EXPECT_EQ(std::count(twice.parents.begin(), twice.parents.end(), 0U), 1);
}

/// Any choice of polygons that stay leaves a mesh that conforms, and covers the same where it is flat.
TEST(Subdivision, FansBesideWhatStaysConform) {
    core::Random random(5);
    for (int round = 0; round < 20; ++round) {
        CoarseMesh coarse = make_flat_grid(4);
        CoarseMesh mixed = coarse.without_polygons();
        for (std::size_t q = 0; q < coarse.polygon_count(); ++q) {
            const auto ring = coarse.polygon(q);
            if (random.uniform() < 0.5) {
                mixed.add_polygon(ring);
            } else {
                mixed.add_polygon(std::array{ring[0], ring[1], ring[2]});
                mixed.add_polygon(std::array{ring[0], ring[2], ring[3]});
            }
        }
        std::vector<std::uint8_t> stays;
        for (std::size_t q = 0; q < mixed.polygon_count(); ++q) stays.push_back(random.uniform() < 0.2 ? 1 : 0);
        const CoarseMesh fine = subdivide(mixed, false, stays);
        int boundary_sides = 0;
        EXPECT_EQ(euler_characteristic(fine, boundary_sides), 1);
        double area = 0.0;
        for (std::size_t q = 0; q < fine.polygon_count(); ++q) {
            const auto ring = fine.polygon(q);
            for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
                const Point3 twice =
                    cross(fine.points[ring[i]] - fine.points[ring[0]], fine.points[ring[i + 1]] - fine.points[ring[0]]);
                EXPECT_GT(twice.z, 0.0);
                area += 0.5 * twice.z;
            }
        }
        EXPECT_NEAR(area, 1.0, 1e-12);
        for (std::size_t q = 0; q < stays.size(); ++q) {
            const auto pieces = std::count(fine.parents.begin(), fine.parents.end(), q);
            EXPECT_EQ(pieces == 1 || stays[q] == 0, true);
            EXPECT_GE(pieces, 1);
        }
    }
}

/// A crease in a plane, zigzag but without corners: smoothed, it would be nowhere near itself.
TEST(Subdivision, CreasesStayCovered) {
    constexpr std::uint32_t n = 8;
    TriangleMesh input;
    RemeshOptions options;
    for (std::uint32_t j = 0; j <= n; ++j)
        for (std::uint32_t i = 0; i <= n; ++i)
            input.positions.push_back({1.0 * i, 1.0 * j + (j == n / 2 ? 0.14 * (i % 2 == 0 ? 1.0 : -1.0) : 0.0), 0.0});
    for (std::uint32_t j = 0; j < n; ++j)
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t a = j * (n + 1) + i;
            input.triangles.push_back({VertexId{a}, VertexId{a + 1}, VertexId{a + n + 2}});
            input.triangles.push_back({VertexId{a}, VertexId{a + n + 2}, VertexId{a + n + 1}});
            if (j == n / 2) options.features.push_back({VertexId{a}, VertexId{a + 1}});
        }
    RemeshStatistics statistics;
    const WorkMesh work = build_work_mesh(input, options, statistics);
    CoarseMesh coarse;
    for (Index v = 0; v < work.points.size(); ++v)
        coarse.add_vertex(work.points[v], {}, work.is_corner[v] ? VertexKind::corner : VertexKind::smooth);
    for (const auto& f : work.faces) coarse.add_polygon(f);
    for (Index e = 0; e < work.edge_curves.size(); ++e) {
        const Index h = work.edge_halfedges[e];
        if (work.edge_curves[e] != no_index)
            coarse.feature_edges.push_back({work.start_of(h), work.end_of(h), work.edge_curves[e]});
    }
    const core::TriangleTree tree(input.positions, input.triangles);
    const Judge judge{input, tree, work.diagonal, true};
    std::vector<Index> missed;
    EXPECT_GT(add_missed_creases(work, judge, subdivide(coarse), 1e-3, missed), 0.01);
    for (const std::uint64_t rounds : {2U}) {
        SubdivisionReport report;
        const CoarseMesh sound = subdivide_soundly(coarse, {rounds, 0.0, &work}, judge, report, {});
        EXPECT_EQ(report.rounds, rounds);
        EXPECT_GT(report.held, 0U);
        EXPECT_LT(add_missed_creases(work, judge, sound, 1e-3, missed), 1e-5);
    }
}

/// Three sheets at one bent edge, each with its copies: what happens to one happens to all.
TEST(Subdivision, CopiesStayTogether) {
    constexpr Index length = 5;
    CoarseMesh coarse;
    TriangleMesh input;
    for (Index sheet = 0; sheet < 3; ++sheet) {
        const double angle = 2.0 * sheet;
        for (Index k = 0; k < length; ++k) {
            coarse.add_vertex({0.0, k % 2 == 0 ? 0.05 : 0.0, 1.0 * k}, {}, VertexKind::boundary, 0);
            coarse.add_vertex({2.0 * std::cos(angle), 2.0 * std::sin(angle), 1.0 * k}, {}, VertexKind::boundary, 0);
        }
        for (Index k = 0; k + 1 < length; ++k) {
            const Index a = 2 * (sheet * length + k);
            coarse.add_polygon(std::array<Index, 3>{a, a + 1, a + 3});
            coarse.add_polygon(std::array<Index, 3>{a, a + 3, a + 2});
        }
    }
    input.positions = coarse.points;
    for (std::size_t q = 0; q < coarse.polygon_count(); ++q) {
        const auto t = coarse.polygon(q);
        input.triangles.push_back({VertexId{t[0]}, VertexId{t[1]}, VertexId{t[2]}});
    }
    // Something turned over, and nearer, below the middle of a piece of the first sheet's second triangle.
    const Point3 place = (1.0 / 6.0) * (4.0 * coarse.points[0] + coarse.points[3] + coarse.points[2]);
    const auto first = static_cast<std::uint32_t>(input.positions.size());
    for (const Point3& off : {Point3{0, 1e-9, 0}, Point3{0.05, 1e-9, 0}, Point3{0, 1e-9, 0.05}})
        input.positions.push_back(place + off + Point3{-0.01, 0, -0.01});
    const Point3 over = cross(coarse.points[3] - coarse.points[0], coarse.points[2] - coarse.points[0]);
    std::array<std::uint32_t, 3> t{first, first + 1, first + 2};
    if (dot(cross(input.positions[t[1]] - input.positions[t[0]], input.positions[t[2]] - input.positions[t[0]]), over) >
        0.0)
        std::swap(t[1], t[2]);
    for (std::size_t q = 0; q < input.triangles.size(); ++q)
        if (q == 1) input.triangles[q] = {VertexId{t[0]}, VertexId{t[1]}, VertexId{t[2]}};
    const core::TriangleTree tree(input.positions, input.triangles);
    const Judge judge{input, tree, 5.0, false, true};
    SubdivisionReport report;
    const CoarseMesh sound = stitch(subdivide_soundly(coarse, {1}, judge, report, {}));
    EXPECT_EQ(report.rounds, 1U);
    EXPECT_GT(report.held + report.coarse, 0U);
    std::map<std::pair<Index, Index>, int> sides;
    for (std::size_t q = 0; q < sound.polygon_count(); ++q) {
        const auto ring = sound.polygon(q);
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Index a = ring[i], b = ring[(i + 1) % ring.size()];
            ++sides[{std::min(a, b), std::max(a, b)}];
        }
    }
    int shared = 0;
    for (const auto& [side, times] : sides) {
        const auto is_inner = [&](Index v) { return std::hypot(sound.points[v].x, sound.points[v].y) < 0.3; };
        if (!is_inner(side.first) || !is_inner(side.second)) continue;
        EXPECT_EQ(times, 3);
        ++shared;
    }
    EXPECT_GE(shared, 4);
}

}  // namespace
}  // namespace certa::remeshing
