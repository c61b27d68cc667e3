// Faithful meshes pass; each promise, broken on purpose, is found with its place.
#include <certa/surface_check.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "core/vector3.h"
#include "verify/surfaces.h"

namespace certa::test {
namespace {

PolygonMesh without_polygon(const PolygonMesh& mesh, std::size_t skipped) {
    PolygonMesh rest;
    rest.positions = mesh.positions;
    for (std::size_t q = 0; q + 1 < mesh.offsets.size(); ++q) {
        if (q == skipped) continue;
        rest.corners.insert(rest.corners.end(), mesh.corners.begin() + mesh.offsets[q],
                            mesh.corners.begin() + mesh.offsets[q + 1]);
        rest.offsets.push_back(static_cast<std::uint32_t>(rest.corners.size()));
    }
    return rest;
}
PolygonMesh turned_inside_out(PolygonMesh mesh) {
    for (std::size_t q = 0; q + 1 < mesh.offsets.size(); ++q)
        std::reverse(mesh.corners.begin() + mesh.offsets[q], mesh.corners.begin() + mesh.offsets[q + 1]);
    return mesh;
}
PolygonMesh together(PolygonMesh a, const PolygonMesh& b) {
    const auto shift = static_cast<std::uint32_t>(a.positions.size());
    a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
    for (std::size_t q = 0; q + 1 < b.offsets.size(); ++q) {
        for (std::uint32_t i = b.offsets[q]; i < b.offsets[q + 1]; ++i)
            a.corners.push_back(VertexId{index_of(b.corners[i]) + shift});
        a.offsets.push_back(static_cast<std::uint32_t>(a.corners.size()));
    }
    return a;
}
bool breaks(const SurfaceCheck& check, const std::string& promise) {
    return std::any_of(check.violations.begin(), check.violations.end(),
                       [&](const Violation& v) { return v.promise == promise; });
}
std::string text(const SurfaceCheck& check) {
    std::string all;
    for (const Violation& v : check.violations) all += v.promise + ": " + v.message + "\n";
    return all;
}

TEST(SurfaceShape, CountsWhatIsThere) {
    const SurfaceShape torus = compute_surface_shape(make_torus(9, 7, 1.0, 0.4));
    EXPECT_EQ(torus.components, (std::vector<ComponentShape>{{0, 0, 1}}));
    EXPECT_EQ(torus.vertices, 63u);
    EXPECT_EQ(torus.edges, 126u);
    EXPECT_TRUE(torus.is_oriented());
    const SurfaceShape both = compute_surface_shape(
        together(make_sphere(5, 6, 1.0), without_polygon(without_polygon(make_torus(9, 7, 3.0, 0.4), 30), 2)));
    EXPECT_EQ(both.components, (std::vector<ComponentShape>{{2, 0, 0}, {-2, 2, 1}}));
    EXPECT_EQ(both.boundary_edges, 8u);
    EXPECT_EQ(both.boundary_loops, 2u);
    EXPECT_EQ(both.triangles, 12u);
}

TEST(SurfaceShape, FindsWhatIsNotManifold) {
    PolygonMesh book;  // three pages
    book.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, -1, 0}};
    for (const std::uint32_t page : {2u, 3u, 4u}) add_polygon(book, {VertexId{0}, VertexId{1}, VertexId{page}});
    EXPECT_EQ(compute_surface_shape(book).non_manifold_edges, 1u);
    PolygonMesh hourglass;
    hourglass.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
    add_polygon(hourglass, {VertexId{0}, VertexId{1}, VertexId{2}});
    add_polygon(hourglass, {VertexId{0}, VertexId{3}, VertexId{4}});
    const SurfaceShape shape = compute_surface_shape(hourglass);
    EXPECT_EQ(shape.non_manifold_vertices, 1u);
    EXPECT_EQ(shape.components, (std::vector<ComponentShape>{{1, 1, 0}, {1, 1, 0}}));
    PolygonMesh inconsistent;
    inconsistent.positions = hourglass.positions;
    add_polygon(inconsistent, {VertexId{0}, VertexId{1}, VertexId{2}});
    add_polygon(inconsistent, {VertexId{0}, VertexId{1}, VertexId{4}});
    EXPECT_EQ(compute_surface_shape(inconsistent).inconsistent_edges, 1u);
}

TEST(SurfaceCheckValid, CoarseVersions) {
    for (const SurfaceCheck& check : {check_surface(make_torus(20, 12, 1.0, 0.4), make_torus(60, 40, 1.0, 0.4)),
                                      check_surface(make_sphere(8, 12, 1.0), make_sphere(40, 60, 1.0)),
                                      check_surface(make_cube(1), make_cube(8), {.error = Length{1e-5}}),
                                      check_surface(make_cube(8), make_cube(3))}) {
        EXPECT_TRUE(check.ok()) << text(check);
        EXPECT_EQ(check.folded_polygons, 0u);
        EXPECT_EQ(check.contacts, 0u);
    }
}

TEST(SurfaceCheckValid, CreasesOfACube) {
    const SurfaceCheck check = check_surface(make_cube(1), make_cube(8));
    EXPECT_EQ(check.creases.edges, 96u);
    EXPECT_EQ(check.creases.corners, 8u);
    EXPECT_NEAR(check.creases.length, 12.0, 1e-12);
    EXPECT_LE(check.creases.largest_distance, 1e-15);
    EXPECT_EQ(check.creases.corner_distance, 0.0);
}

TEST(SurfaceCheckBroken, MissingPolygonAndComponent) {
    const PolygonMesh torus = make_torus(30, 20, 1.0, 0.4);
    const SurfaceCheck hole = check_surface(without_polygon(torus, 77), torus);
    EXPECT_TRUE(breaks(hole, "topology"));
    const SurfaceCheck missing = check_surface(torus, together(torus, make_sphere(6, 8, 0.2)));
    EXPECT_TRUE(breaks(missing, "topology"));
}

TEST(SurfaceCheckBroken, WrongGenus) {
    EXPECT_TRUE(breaks(check_surface(make_sphere(20, 30, 1.0), make_torus(30, 20, 1.0, 0.4)), "topology"));
}

TEST(SurfaceCheckBroken, ErrorAbovePromise) {
    const PolygonMesh coarse = make_sphere(8, 12, 1.0), fine = make_sphere(40, 60, 1.0);
    const SurfaceCheck first = check_surface(coarse, fine);
    const double h = first.distance.hausdorff;
    EXPECT_TRUE(breaks(check_surface(coarse, fine, {.error = Length{0.99 * h}}), "error"));
    const double bound = first.distance.hausdorff_bound;
    EXPECT_TRUE(check_surface(coarse, fine, {.error = Length{bound}}).ok());
}

TEST(SurfaceCheckBroken, FoldedPolygon) {
    // A vertex of the grid pulled over its neighbours.
    PolygonMesh flat = make_grid(6, 6, [](double u, double v) { return Point3{u, v, 0.0}; });
    const PolygonMesh input = flat;
    EXPECT_TRUE(check_surface(flat, input).ok());
    flat.positions[3 * 7 + 3] = {0.9, 0.5, 0.0};
    const SurfaceCheck check = check_surface(flat, input);
    EXPECT_TRUE(breaks(check, "unfolded"));
    EXPECT_GE(check.folded_polygons, 1u);
    EXPECT_TRUE(breaks(check, "embedded"));
    EXPECT_FALSE(breaks(check, "topology"));
}

TEST(SurfaceCheckBroken, InsideOut) {
    const PolygonMesh sphere = make_sphere(8, 12, 1.0);
    const SurfaceCheck check = check_surface(turned_inside_out(sphere), sphere);
    EXPECT_TRUE(breaks(check, "unfolded"));
    EXPECT_EQ(check.folded_polygons, sphere.offsets.size() - 1);
}

TEST(SurfaceCheckBroken, SelfIntersection) {
    // Two spheres apart; in the mesh one of them has moved into the other.
    const PolygonMesh input = together(make_sphere(8, 12, 1.0), moved(make_sphere(8, 12, 1.0), {2.1, 0, 0}));
    const PolygonMesh mesh = together(make_sphere(8, 12, 1.0), moved(make_sphere(8, 12, 1.0), {1.9, 0, 0}));
    EXPECT_TRUE(check_surface(input, input).ok());
    const SurfaceCheck check = check_surface(mesh, input);
    EXPECT_TRUE(breaks(check, "embedded"));
    EXPECT_GT(check.contacts, 0u);
    EXPECT_GE(check.possible_contacts, check.contacts);
    EXPECT_EQ(check.input_contacts, 0u);
    // Where the input does the same, nothing is promised.
    EXPECT_FALSE(breaks(check_surface(mesh, mesh), "embedded"));
}

TEST(SurfaceCheckBroken, CutCrease) {
    // A cube with one edge chamfered away by a third.
    PolygonMesh cut;
    const double c = 2.0 / 3.0;
    cut.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1},
                     {1, 0, c}, {1, 1, c}, {0, 1, 1}, {c, 0, 1}, {c, 1, 1}};
    const auto add = [&](std::initializer_list<std::uint32_t> ring) {
        for (const std::uint32_t v : ring) cut.corners.push_back(VertexId{v});
        cut.offsets.push_back(static_cast<std::uint32_t>(cut.corners.size()));
    };
    add({0, 3, 2, 1}), add({4, 8, 9, 7}), add({1, 2, 6, 5}), add({5, 6, 9, 8}), add({0, 4, 7, 3});
    add({0, 1, 5, 8, 4}), add({2, 3, 7, 9, 6});
    const SurfaceCheck check = check_surface(cut, make_cube(6));
    EXPECT_TRUE(breaks(check, "creases"));
    EXPECT_NEAR(check.creases.largest_distance, 1.0 / 3.0, 1e-12);
    EXPECT_NEAR(check.creases.corner_distance, 1.0 / 3.0, 1e-12);
    EXPECT_NEAR(check.distance.hausdorff, std::sqrt(0.5) / 3.0, 1e-9);
    EXPECT_FALSE(breaks(check, "topology"));
    EXPECT_FALSE(breaks(check, "unfolded"));
}

TEST(SurfaceCheck, TaggedEdgesAreCreases) {
    const PolygonMesh plane = make_grid(4, 4, [](double u, double v) { return Point3{u, v, 0.0}; });
    SurfaceCheckOptions options;
    for (std::uint32_t i = 0; i < 4; ++i) options.features.push_back({VertexId{10 + i}, VertexId{11 + i}});
    EXPECT_EQ(check_surface(plane, plane, options).creases.edges, 20u);
    const PolygonMesh whole = make_grid(1, 1, [](double u, double v) { return Point3{u, v, 0.0}; });
    EXPECT_TRUE(check_surface(whole, plane).ok());
    EXPECT_TRUE(breaks(check_surface(whole, plane, options), "creases"));
}

TEST(SurfaceCheck, RandomDamageIsNeverPraised) {
    const PolygonMesh sphere = make_sphere(8, 12, 1.0);
    core::Random random(31);
    for (int round = 0; round < 40; ++round) {
        PolygonMesh mesh = sphere;
        const auto q = random.below(mesh.offsets.size() - 1);
        if (round % 3 == 0) {
            mesh = without_polygon(mesh, q);
        } else if (round % 3 == 1) {
            std::reverse(mesh.corners.begin() + mesh.offsets[q], mesh.corners.begin() + mesh.offsets[q + 1]);
        } else {
            Point3& p = mesh.positions[random.below(mesh.positions.size())];
            p = -1.0 * p;
        }
        EXPECT_FALSE(check_surface(mesh, sphere).ok());
    }
}

TEST(SurfaceCheck, RefusesOptionsThatMakeNoSense) {
    const PolygonMesh cube = make_cube(1);
    EXPECT_THROW(check_surface(cube, cube, {.error = Length{-1.0}}), InputError);
    EXPECT_THROW(check_surface(cube, cube, {.feature_angle_radians = 0.0}), InputError);
    EXPECT_THROW(check_surface(cube, cube, {.features = {{VertexId{0}, VertexId{99}}}}), InputError);
}

}  // namespace
}  // namespace certa::test
