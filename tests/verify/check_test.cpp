// Valid meshes pass.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "verify/grid_mesh.h"

namespace certa::test {
namespace {

void expect_valid(const Case& c, bool full_hull) {
    const ConformingCheck check = check_conforming(c.mesh, c.complex);
    EXPECT_TRUE(check.ok()) << text(check);
    EXPECT_EQ(check.full_hull, full_hull);
    EXPECT_EQ(check.max_deviation, 0.0);
    EXPECT_EQ(check.tetrahedra_checked, c.mesh.tetrahedra.size());
    EXPECT_EQ(check.facets_checked, c.complex.facet_count());
    TetMesh unlabelled = c.mesh;
    unlabelled.edges.clear();
    unlabelled.edge_segments.clear();
    const ConformingCheck looked_up = check_conforming(unlabelled, c.complex);
    EXPECT_TRUE(looked_up.ok()) << text(looked_up);
    unlabelled.vertex_sources.clear();
    const ConformingCheck walked = check_conforming(unlabelled, c.complex);
    EXPECT_TRUE(walked.ok()) << text(walked);
}

TEST(CheckValid, one_tetrahedron) { expect_valid(one_tetrahedron(), true); }
TEST(CheckValid, cubes) {
    expect_valid(cube(true), true);
    expect_valid(cube(false), true);
    expect_valid(cube_of_five(), true);
}

TEST(CheckValid, two_regions_share_a_facet) {
    GridMesh grid(2, 1, 1);
    grid.box({0, 0, 0}, {1, 1, 1});
    grid.rectangle(1, {1, 0, 0}, {2, 0, 1}, true);
    grid.rectangle(1, {1, 1, 0}, {2, 1, 1});
    grid.rectangle(2, {1, 0, 0}, {2, 1, 0}, true);
    grid.rectangle(2, {1, 0, 1}, {2, 1, 1});
    grid.rectangle(0, {2, 0, 0}, {2, 1, 1});
    grid.region_of = [](const Place& p) { return 1 + p[0]; };
    expect_valid(grid.make(), true);
}

TEST(CheckValid, steiner_points_on_sides_and_in_facets) {
    GridMesh grid(3, 3, 3);
    grid.box({0, 0, 0}, {3, 3, 3});
    expect_valid(grid.make(), true);
}

TEST(CheckValid, outside_dropped) {
    GridMesh grid(3, 3, 3);  // an L-shaped solid
    const auto inside = [](const Place& p) { return p[0] < 1 || p[1] < 1; };
    grid.region_of = [&](const Place& p) { return inside(p) ? 1 : -1; };
    grid.rectangle(0, {0, 0, 0}, {0, 3, 3}, true);
    grid.rectangle(1, {0, 0, 0}, {3, 0, 3}, true);
    grid.rectangle(0, {3, 0, 0}, {3, 1, 3});
    grid.rectangle(1, {0, 3, 0}, {1, 3, 3});
    grid.rectangle(0, {1, 1, 0}, {1, 3, 3});
    grid.rectangle(1, {1, 1, 0}, {3, 1, 3});
    for (const int z : {0, 3}) {
        Loop ring{{0, 0, z}, {3, 0, z}, {3, 1, z}, {1, 1, z}, {1, 3, z}, {0, 3, z}};
        if (z == 0) std::reverse(ring.begin(), ring.end());
        std::vector<Place> squares;
        for (int x = 0; x < 3; ++x) {
            for (int y = 0; y < 3; ++y) {
                if (inside({x, y, 0})) squares.push_back({x, y, z});
            }
        }
        grid.facet(2, {ring}, {}, squares);
    }
    expect_valid(grid.make(), false);
    grid.region_of = [&](const Place& p) { return inside(p) ? 1 : 0; };
    expect_valid(grid.make(), true);
}

TEST(CheckValid, open_complex_keeps_hull) {
    GridMesh grid(3, 3, 2);
    grid.region_of = [](const Place&) { return 0; };
    grid.rectangle(2, {1, 1, 1}, {2, 2, 1});
    grid.rectangle(0, {2, 0, 0}, {2, 1, 1}, true);
    grid.segment({0, 0, 0}, {0, 0, 2});
    grid.segment({0, 0, 0}, {3, 3, 0});
    expect_valid(grid.make(), true);
}

GridMesh plate() {
    GridMesh grid(5, 5, 2);
    grid.region_of = [](const Place&) { return 0; };
    // A square with two holes that touch in a corner, a ring that is no hole, isolated segments and points.
    std::vector<Place> squares;
    for (int x = 0; x < 5; ++x) {
        for (int y = 0; y < 5; ++y) {
            if (!(x == 1 && y == 1) && !(x == 2 && y == 2)) squares.push_back({x, y, 1});
        }
    }
    grid.facet(2,
               {{{0, 0, 1}, {5, 0, 1}, {5, 5, 1}, {0, 5, 1}},
                {{1, 1, 1}, {2, 1, 1}, {2, 2, 1}, {1, 2, 1}},
                {{2, 2, 1}, {3, 2, 1}, {3, 3, 1}, {2, 3, 1}},
                {{3, 3, 1}, {3, 4, 1}, {4, 4, 1}, {4, 3, 1}},
                {{1, 3, 1}, {1, 4, 1}},
                {{2, 4, 1}}},
               {{1.5, 1.25, 1}, {2.5, 2.25, 1}}, squares);
    return grid;
}

TEST(CheckValid, facet_with_holes_and_isolated_elements) { expect_valid(plate().make(), true); }

TEST(CheckValid, moved_far_away) {
    for (const double scale : {0.125, 0x1p-12}) {
        GridMesh grid(3, 3, 3);
        grid.shift = {1e6, -3e5, 7};
        grid.scale = scale;
        grid.box({0, 0, 0}, {3, 3, 3});
        expect_valid(grid.make(), true);
    }
}

TEST(CheckValid, hole_removed_and_nested) {
    for (const int outside : {0, -1}) {
        GridMesh grid(7, 7, 7);
        grid.box({1, 1, 1}, {6, 6, 6});
        grid.box({2, 2, 2}, {5, 5, 5});
        grid.box({3, 3, 3}, {4, 4, 4});
        grid.region_hole({2.5, 2.5, 2.5});
        grid.region_of = [&](const Place& p) {
            const int depth = std::min({p[0], p[1], p[2], 6 - p[0], 6 - p[1], 6 - p[2]});
            return depth == 0 ? outside : depth == 1 ? 1 : depth == 2 ? -1 : 2;
        };
        expect_valid(grid.make(), false);
    }
}

TEST(CheckValid, random_complexes) {
    ASSERT_TRUE(rc::check([](std::uint64_t seed) {
        const Case c = random_case(seed);
        const ConformingCheck check = check_conforming(c.mesh, c.complex);
        if (!check.ok()) RC_FAIL(text(check));
    }));
}

}  // namespace
}  // namespace certa::test
