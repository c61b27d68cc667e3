// Finding what is broken, patches of the input, and mending: judged by what shares no code with it.
#include "remeshing/mend.h"

#include <certa/io.h>
#include <certa/surface_check.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "core/vector3.h"
#include "mesh/generators_surfaces.h"
#include "remeshing/coarse_meshes.h"
#include "remeshing/templates.h"
#include "remeshing/trace_lines.h"

namespace certa::remeshing {
namespace {

/// A network on a surface and its polygons.
struct Fixture {
    explicit Fixture(const TriangleMesh& surface, double error) : mesh(build_work_mesh(surface, {}, statistics)) {
        input.positions = mesh.points;
        for (const auto& f : mesh.faces) input.triangles.push_back({VertexId{f[0]}, VertexId{f[1]}, VertexId{f[2]}});
        tree.emplace(input.positions, input.triangles);
        DirectionField field = measure_directions(mesh, {});
        smooth_directions(mesh, field, 3.0 * mesh.mean_edge, {});
        SpacingRule rule;
        rule.error = error * mesh.diagonal;
        network.emplace(trace_lines(mesh, field, compute_spacing(mesh, field, rule, {}), {}, {}));
        graph = build_graph(*network, {rule.error, rule.error});
        simplify_graph(graph, *network);
        faces = graph.trace_faces(mesh);
        PolygonCounts counts;
        polygons = make_quad_dominant(make_polygons(graph, faces, open, counts, nodes));
    }
    Layout layout() const { return {*network, graph, faces, nodes, merged, open}; }
    Judge judge() const { return {input, *tree, mesh.diagonal, true}; }

    RemeshStatistics statistics;
    WorkMesh mesh;
    TriangleMesh input;
    std::optional<core::TriangleTree> tree;
    std::optional<Network> network;
    Graph graph;
    std::vector<std::vector<Index>> faces;
    std::vector<Index> nodes, open;
    std::vector<MergedVertex> merged;
    CoarseMesh polygons;
};

TEST(Contacts, OfTwoTriangles) {
    const std::vector<Point3> p{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0.5, 0.5, -1}, {0.5, 0.5, 1},
                                {3, 3, 1}, {2, 2, 0}, {0, 0, 1}, {0.4, 0.4, 0},  {1, -1, 0}};
    EXPECT_TRUE(do_meet(p, {0, 1, 2}, {3, 4, 5}));   // pierced
    EXPECT_FALSE(do_meet(p, {0, 1, 2}, {1, 6, 2}));  // neighbours in a plane
    EXPECT_TRUE(do_meet(p, {0, 1, 2}, {0, 1, 8}));   // folded over onto it
    EXPECT_FALSE(do_meet(p, {0, 1, 2}, {1, 0, 7}));  // at right angles
    EXPECT_TRUE(do_meet(p, {0, 1, 2}, {0, 8, 7}));   // a common corner and a side in it
    EXPECT_FALSE(do_meet(p, {0, 1, 2}, {0, 9, 7}));  // a common corner only
    EXPECT_TRUE(do_meet(p, {0, 1, 2}, {2, 1, 0}));   // the same, turned
    EXPECT_FALSE(do_meet(p, {0, 1, 2}, {4, 5, 7}));  // apart
}

/// Random pairs against the checker's own answer.
TEST(Contacts, AgreeWithTheChecker) {
    core::Random random(5);
    int met = 0;
    for (int k = 0; k < 400; ++k) {
        PolygonMesh mesh;
        for (int i = 0; i < 6; ++i)  // few different coordinates: many special positions
            mesh.positions.push_back(
                {std::floor(4 * random.uniform()), std::floor(4 * random.uniform()), std::floor(3 * random.uniform())});
        const Index shared = static_cast<Index>(3.0 * random.uniform());
        const std::array<Index, 3> s{0, 1, 2}, t{shared > 0 ? 0U : 3U, shared > 1 ? 1U : 4U, 5};
        for (const auto& c : {s, t}) {
            for (const Index v : c) mesh.corners.push_back(VertexId{v});
            mesh.offsets.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
        }
        const bool meets = do_meet(mesh.positions, s, t);
        EXPECT_EQ(meets, !find_contacts(mesh).empty()) << k;
        met += meets ? 1 : 0;
    }
    EXPECT_GT(met, 50);
    EXPECT_LT(met, 350);
}

TEST(Damage, FindsFoldsAndSplitsQuadsOnTheirSoundDiagonal) {
    const TriangleMesh flat{{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}},
                            {{VertexId{0}, VertexId{1}, VertexId{2}}, {VertexId{0}, VertexId{2}, VertexId{3}}}};
    const core::TriangleTree tree(flat.positions, flat.triangles);
    const Judge judge{flat, tree, 6.0, true};
    CoarseMesh mesh;
    for (const Point3& p : {Point3{0, 0, 0}, Point3{2, 0, 0}, Point3{0.4, 0.4, 0}, Point3{0, 2, 0}})
        mesh.add_vertex(p, {});
    mesh.add_polygon(std::array<Index, 4>{0, 1, 2, 3});  // not convex: one diagonal only
    EXPECT_TRUE(find_damage(judge, mesh, {}).polygons.empty());
    CoarseMesh turned = mesh.without_polygons();
    turned.add_polygon(std::array<Index, 3>{0, 2, 1});
    turned.add_polygon(std::array<Index, 3>{0, 1, 3});
    const Damage damage = find_damage(judge, turned, {});
    EXPECT_EQ(damage.folds, 1U);
    EXPECT_EQ(damage.polygons, (std::vector<Index>{0, 1}));  // they overlap, too
}

/// Two faces of a tetrahedron as a quad: across its other diagonal one triangle is upright on it, the third face
/// inside out. Who rounds otherwise would take that.
TEST(Damage, SplitsQuadsWhoseOtherDiagonalHardlyTurnsAway) {
    const auto triangle = [](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        return Triangle{VertexId{a}, VertexId{b}, VertexId{c}};
    };
    const TriangleMesh input{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                             {triangle(0, 2, 1), triangle(0, 1, 3), triangle(1, 2, 3), triangle(0, 3, 2)}};
    const core::TriangleTree tree(input.positions, input.triangles);
    CoarseMesh mesh;
    for (const Point3& p : input.positions) mesh.add_vertex(p, {});
    mesh.add_polygon(std::array<Index, 4>{0, 1, 3, 2});
    mesh.add_polygon(std::array<Index, 3>{0, 2, 1});
    mesh.add_polygon(std::array<Index, 3>{1, 2, 3});
    const Damage damage = find_damage({input, tree, 1.8, true}, mesh, {});
    EXPECT_EQ(damage.split, 1U);
    EXPECT_TRUE(damage.polygons.empty());
    EXPECT_EQ(mesh.polygon_count(), 4U);
}

TEST(RegionPatch, HasTheTopologyOfItsRegion) {
    const Fixture torus(generators::make_torus(2.0, 0.7, 6000, 1), 3e-3);
    RegionPatcher patcher(torus.layout());
    std::size_t made = 0;
    double areas = 0.0;
    // All faces, then some with those around.
    std::vector<std::vector<Index>> regions;
    for (Index f = 0; f < patcher.face_count(); ++f) regions.push_back({f});
    for (Index f = 0; f < patcher.face_count(); f += 11) regions.push_back(patcher.grow({f}));
    for (const std::vector<Index>& region : regions) {
        std::optional<RegionPatch> patch = patcher.make(region);
        if (!patch) continue;
        ++made;
        std::vector<std::uint8_t> is_on_side(patch->outer.size() + patch->inner.size(), 0);
        std::size_t side_parts = 0;
        for (const RegionSide& side : patch->sides) {
            for (const Index v : side.corners) is_on_side[v] = 1;
            side_parts += side.corners.size() - 1;
        }
        // It is the input: its area is that of the faces, and every triangle lies in one of the input's.
        double area = 0.0;
        const auto point = [&](Index v) {
            return v < patch->outer.size() ? torus.graph.nodes[torus.nodes[patch->outer[v]]].point
                                           : patch->inner[v - patch->outer.size()].point;
        };
        for (const auto& t : patch->triangles) {
            area += 0.5 * norm(cross(point(t[1]) - point(t[0]), point(t[2]) - point(t[0])));
            const Point3 middle = (1.0 / 3.0) * (point(t[0]) + point(t[1]) + point(t[2]));
            ASSERT_LT(torus.tree->find_nearest(middle).squared_distance, 1e-20);
        }
        areas += region.size() == 1 ? area : 0.0;
        // Euler's characteristic of a disk.
        std::vector<std::array<Index, 2>> sides;
        for (const auto& t : patch->triangles)
            for (std::size_t i = 0; i < 3; ++i) sides.push_back({t[i], t[(i + 1) % 3]});
        std::sort(sides.begin(), sides.end());
        ASSERT_EQ(std::adjacent_find(sides.begin(), sides.end()), sides.end());
        std::size_t rim = 0;
        for (const auto& [a, b] : sides)
            if (!std::binary_search(sides.begin(), sides.end(), std::array{b, a})) {
                ++rim;
                EXPECT_TRUE(is_on_side[a] != 0 && is_on_side[b] != 0);
            }
        EXPECT_EQ(rim, side_parts);
        const std::size_t edges = (sides.size() + rim) / 2;
        EXPECT_EQ(patch->outer.size() + patch->inner.size() + patch->triangles.size(), edges + 1);
    }
    EXPECT_GT(made, 95 * regions.size() / 100);
    double whole = 0.0;
    for (const Triangle& t : torus.input.triangles) {
        const Point3& a = torus.input.positions[index_of(t[0])];
        whole +=
            0.5 * norm(cross(torus.input.positions[index_of(t[1])] - a, torus.input.positions[index_of(t[2])] - a));
    }
    EXPECT_NEAR(areas, whole, 1e-9 * whole);  // single faces tile the surface
}

/// Corners of quads pulled over the opposite ones: what folds is replaced, and the checker is content.
/// Two faces that share a node only: those at the node make one region of them, and that is all it takes.
TEST(RegionPatch, GrowsWhereItsRimTouchesItself) {
    const Fixture torus(generators::make_torus(2.0, 0.7, 6000, 1), 3e-3);
    const RegionPatcher patcher(torus.layout());
    std::size_t tried = 0;
    for (Index n = 0; n < torus.graph.nodes.size(); ++n) {
        const std::vector<Index>& around = patcher.faces_at(n);
        if (around.size() != 4) continue;
        std::vector<Index> beside;
        for (const Index h : torus.faces[around[0]]) beside.push_back(patcher.face_beside(h ^ 1U));
        Index across = no_index;
        for (const Index f : around)
            if (f != around[0] && std::find(beside.begin(), beside.end(), f) == beside.end()) across = f;
        if (across == no_index) continue;
        std::vector<Index> pair{around[0], across}, four = around;
        sort_unique(pair);
        sort_unique(four);
        EXPECT_FALSE(patcher.make(pair).has_value());
        EXPECT_EQ(patcher.grow_for_patch(pair), four);
        EXPECT_GT(patcher.grow(pair).size(), four.size());
        // What does not touch itself grows all around.
        EXPECT_EQ(patcher.grow_for_patch(four), patcher.grow(four));
        if (++tried == 50) break;
    }
    EXPECT_EQ(tried, 50U);
}

TEST(Mend, RepairsWhatIsSpoilt) {
    const TriangleMesh surface = generators::make_torus(2.0, 0.7, 1500, 1);
    const Fixture torus(surface, 6e-3);
    CoarseMesh mesh = torus.polygons;
    for (const std::size_t q : {mesh.polygon_count() / 5, mesh.polygon_count() / 2}) {
        const auto ring = mesh.polygon(q);
        const Point3 a = mesh.points[ring[0]], c = mesh.points[ring[2]];
        mesh.points[ring[0]] = torus.tree->find_nearest(c + 0.3 * (c - a)).point;
    }
    EXPECT_FALSE(check_surface(polygon_mesh(mesh), make_polygon_mesh(surface)).ok());
    const MendingReport report =
        mend(torus.layout(), torus.judge(), {.tolerance = 1e-3 * torus.mesh.diagonal}, mesh, {});
    EXPECT_TRUE(report.left.empty());
    EXPECT_GE(report.regions, 1U);
    const SurfaceCheck check = check_surface(polygon_mesh(mesh), make_polygon_mesh(surface));
    for (const Violation& violation : check.violations) ADD_FAILURE() << violation.promise << ": " << violation.message;
    EXPECT_EQ(check.mesh.components.size(), 1U);
    EXPECT_EQ(check.mesh.components[0].genus, 1);
}

TEST(Mend, LeavesSoundPolygonsAlone) {
    const TriangleMesh surface = generators::make_torus(2.0, 0.7, 3000, 1);
    const Fixture torus(surface, 3e-3);
    CoarseMesh mesh = torus.polygons;
    const MendingReport report = mend(torus.layout(), torus.judge(), {.tolerance = 1e-3}, mesh, {});
    EXPECT_EQ(report.regions, 0U);
    EXPECT_EQ(mesh.corners.size(), torus.polygons.corners.size());
}

TEST(Mend, BringsFarPolygonsWithinTheError) {
    const TriangleMesh surface = generators::make_torus(2.0, 0.7, 3000, 1);
    const Fixture torus(surface, 6e-3);
    CoarseMesh mesh = torus.polygons;
    const double error = 9e-3 * torus.mesh.diagonal;
    EXPECT_GT(measure_distance(polygon_mesh(mesh), make_polygon_mesh(surface)).hausdorff_bound, error);
    const MendingRule rule{.tolerance = 0.5 * error, .side_tolerance = error, .error = error};
    const MendingReport report = mend(torus.layout(), torus.judge(), rule, mesh, {});
    EXPECT_GT(report.cut_faces + report.faces, 0U);
    // What is proved is that, whatever way the polygons are filled; the proof is good to 2 %.
    EXPECT_LE(measure_distance(polygon_mesh(mesh), make_polygon_mesh(surface)).hausdorff_bound, 1.02 * error);
}

TEST(ThinInput, KeepsCornersCreasesAndGenus) {
    const TriangleMesh box = generators::make_box(1.0, 2.0, 3.0);
    const Fixture fixture(box, 2e-2);
    const CoarseMesh thin = thin_input(fixture.mesh, fixture.judge(), 1e-6, 0, {});
    EXPECT_EQ(thin.points.size(), 8U);
    EXPECT_EQ(thin.polygon_count(), 12U);
    EXPECT_EQ(thin.feature_edges.size(), 12U);
    const TriangleMesh surface = generators::make_torus(2.0, 0.7, 2000, 1);
    const Fixture torus(surface, 6e-3);
    const CoarseMesh few = thin_input(torus.mesh, torus.judge(), 2e-3 * torus.mesh.diagonal, 0, {});
    EXPECT_LT(few.points.size(), 9 * torus.mesh.points.size() / 10);
    const SurfaceCheck check = check_surface(polygon_mesh(few), make_polygon_mesh(surface));
    EXPECT_TRUE(check.ok());
    EXPECT_LT(check.distance.hausdorff, 4e-3 * torus.mesh.diagonal);
}

}  // namespace
}  // namespace certa::remeshing
