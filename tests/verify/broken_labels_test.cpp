// Broken meshes are reported under the promise that they break: labelled; and what the options change.
#include "verify/broken.h"

namespace certa::test {
namespace {

// --- labelled ---

TEST(CheckBroken, wrong_region) {
    for (const Case& b : all_bases()) {
        for (std::size_t i = 0; i < b.mesh.tetrahedra.size(); ++i) {
            for (const std::uint32_t region : {0u, 1u, 2u, 3u, no_index}) {
                Case c = b;
                if (c.mesh.tetrahedron_regions[i] == RegionId{region}) continue;
                c.mesh.tetrahedron_regions[i] = RegionId{region};
                expect_broken(c, "labelled");
            }
        }
    }
}
TEST(CheckBroken, renumbered_regions) {
    for (const Case& b : {base(), base_outside_kept()}) {
        for (const auto& numbers :
             {std::array<std::uint32_t, 3>{1, 0, 2}, {0, 2, 1}, {0, 1, 1}, {0, 1, 3}, {1, 1, 1}}) {
            Case c = b;
            bool changed = false;
            for (RegionId& r : c.mesh.tetrahedron_regions) {
                changed = changed || numbers[index_of(r)] != index_of(r);
                r = RegionId{numbers[index_of(r)]};
            }
            if (changed) expect_broken(c, "labelled");
        }
    }
}
TEST(CheckBroken, wrong_facet) {
    const Case b = base();
    for (std::size_t i = 0; i < b.mesh.triangles.size(); ++i) {
        for (const std::uint32_t f : {0u, 5u, 11u}) {
            Case c = b;
            if (c.mesh.triangle_facets[i] == FacetId{f}) continue;
            c.mesh.triangle_facets[i] = FacetId{f};
            expect_broken(c, "conforming");
        }
    }
    Case c = b;
    c.mesh.triangle_facets[0] = FacetId{12};
    expect_broken(c, "labelled");
    c.mesh.triangle_facets.clear();
    expect_broken(c, "labelled");
    c = b;
    c.mesh.tetrahedron_regions.clear();
    expect_broken(c, "labelled");
}
TEST(CheckBroken, wrong_segment) {
    const Case b = base();
    for (std::size_t i = 0; i < b.mesh.edges.size(); ++i) {
        for (const std::uint32_t s : {0u, 13u}) {
            Case c = b;
            if (c.mesh.edge_segments[i] == SegmentId{s}) continue;
            c.mesh.edge_segments[i] = SegmentId{s};
            expect_broken(c, "conforming");
        }
    }
    Case c = b;
    c.mesh.edge_segments[0] = SegmentId{24};
    expect_broken(c, "labelled");
    c = b;
    std::swap(c.mesh.edges[3][0], c.mesh.edges[3][1]);
    expect_broken(c, "labelled");
    c = b;
    c.mesh.edge_segments.clear();  // edges without labels are looked up
    expect_fine(c);
}
TEST(CheckBroken, wrong_source) {
    const Case b = base();
    for (std::uint32_t v = 0; v < b.mesh.positions.size(); ++v) {
        const VertexSource right = b.mesh.vertex_sources[v];
        for (const VertexOrigin origin : {VertexOrigin::input, VertexOrigin::segment, VertexOrigin::facet}) {
            for (const std::uint32_t index : {right.index, right.index + 1, no_index}) {
                Case c = b;
                c.mesh.vertex_sources[v] = {origin, index};
                if (c.mesh.vertex_sources[v] == right) continue;
                if (origin == right.origin && origin == VertexOrigin::input) continue;  // no meaning
                expect_broken(c, "labelled");
            }
        }
    }
}
TEST(CheckBroken, holes_of_space) {
    const auto nested = [](bool ask, bool hollow, bool outside) {
        GridMesh grid(5, 5, 5);
        grid.box({1, 1, 1}, {4, 4, 4});
        grid.box({2, 2, 2}, {3, 3, 3});
        if (ask) grid.region_hole({2.5, 2.25, 2.125});
        grid.region_of = [=](const Place& p) {
            const int depth = std::min({p[0], p[1], p[2], 4 - p[0], 4 - p[1], 4 - p[2]});
            return depth == 0 ? (outside ? 0 : -1) : depth == 1 ? 1 : hollow ? -1 : 2;
        };
        return grid.make();
    };
    for (const bool outside : {false, true}) {
        expect_fine(nested(false, false, outside));
        expect_fine(nested(true, true, outside));
        expect_broken(nested(true, false, outside), "labelled");
        expect_broken(nested(false, true, outside), "labelled");
    }
    // A hole point in the outside asks for nothing; one on a facet is in no region.
    Case c = nested(true, true, true);
    c.complex.region_holes.push_back({0.5, 0.5, 0.5});
    expect_fine(c);
    c.complex.region_holes[0] = {2.5, 2.5, 3};
    expect_broken(c, "labelled");
}
TEST(CheckBroken, holes_within_holes) {
    // Boxes in boxes; every second shell of space is left out if its hole point says so.
    const auto nested = [](const std::vector<Point3>& points, bool fill_inner) {
        GridMesh grid(9, 9, 9);
        for (int d = 0; d < 5; ++d) grid.box({d, d, d}, {9 - d, 9 - d, 9 - d});
        for (const Point3& p : points) grid.region_hole(p);
        grid.region_of = [=](const Place& p) {
            const int depth = std::min({p[0], p[1], p[2], 8 - p[0], 8 - p[1], 8 - p[2]});
            return depth == 1 || (depth == 3 && !fill_inner) ? -1 : depth + 1;
        };
        return grid.make();
    };
    const Point3 outer{1.5, 4.25, 4.125}, island{2.5, 4.25, 4.125}, inner{3.5, 4.25, 4.125};
    expect_fine(nested({outer, inner}, false));
    expect_fine(nested({inner, outer, inner}, false));
    expect_fine(nested({outer}, true));
    for (const std::vector<Point3>& points : {std::vector<Point3>{outer}, {inner}, {island, inner}, {island, outer}}) {
        EXPECT_TRUE(tells(nested(points, false), "is left out, but no hole point lies in it"));
    }
    EXPECT_TRUE(tells(nested({island}, true), "is left out, but no hole point lies in it"));
    EXPECT_TRUE(tells(nested({outer, inner}, true), "its region had to be left out"));
}
TEST(CheckBroken, holes_that_would_leave_a_facet_bare) {
    GridMesh grid(2, 1, 1);
    grid.box({0, 0, 0}, {1, 1, 1});
    grid.rectangle(1, {1, 0, 0}, {2, 0, 1}, true);
    grid.rectangle(1, {1, 1, 0}, {2, 1, 1});
    grid.rectangle(2, {1, 0, 0}, {2, 1, 0}, true);
    grid.rectangle(2, {1, 0, 1}, {2, 1, 1});
    grid.rectangle(0, {2, 0, 0}, {2, 1, 1});
    grid.region_of = [](const Place& p) { return 1 + p[0]; };
    grid.region_hole({0.5, 0.25, 0.125});
    expect_fine(grid.make());  // without it, its walls would be faces of no tetrahedron
    grid.region_hole({1.5, 0.25, 0.125});
    expect_fine(grid.make());
}
TEST(CheckBroken, half_of_the_outside) {
    // A wall through the box splits the outside in two; one half is left out.
    for (const int other : {0, -1}) {
        GridMesh grid(4, 2, 2);
        grid.rectangle(0, {2, 0, 0}, {2, 2, 2});
        grid.region_of = [=](const Place& p) { return p[0] < 2 ? 0 : other; };
        if (other == 0) {
            expect_fine(grid.make());
        } else {
            // Its own hull then: the rest is complete without the lost points.
            expect_fine(grid.make());
        }
    }
    const auto notched = [](bool partly) {
        GridMesh grid(3, 3, 1);  // a plus sign; the four corners are outside
        const auto inside = [](const Place& p) { return p[0] == 1 || p[1] == 1; };
        grid.region_of = [=](const Place& p) { return inside(p) ? 1 : partly && p == Place{0, 0, 0} ? -1 : 0; };
        for (const int z : {0, 1}) {
            Loop ring{{1, 0, z}, {2, 0, z}, {2, 1, z}, {3, 1, z}, {3, 2, z}, {2, 2, z},
                      {2, 3, z}, {1, 3, z}, {1, 2, z}, {0, 2, z}, {0, 1, z}, {1, 1, z}};
            if (z == 0) std::reverse(ring.begin(), ring.end());
            std::vector<Place> squares;
            for (int x = 0; x < 3; ++x) {
                for (int y = 0; y < 3; ++y) {
                    if (inside({x, y, 0})) squares.push_back({x, y, z});
                }
            }
            grid.facet(2, {ring}, {}, squares);
        }
        for (const auto& [axis, low, high, down] : {std::tuple<int, Place, Place, bool>{1, {1, 0, 0}, {2, 0, 1}, true},
                                                    {0, {2, 0, 0}, {2, 1, 1}, false},
                                                    {1, {2, 1, 0}, {3, 1, 1}, true},
                                                    {0, {3, 1, 0}, {3, 2, 1}, false},
                                                    {1, {2, 2, 0}, {3, 2, 1}, false},
                                                    {0, {2, 2, 0}, {2, 3, 1}, false},
                                                    {1, {1, 3, 0}, {2, 3, 1}, false},
                                                    {0, {1, 2, 0}, {1, 3, 1}, true},
                                                    {1, {0, 2, 0}, {1, 2, 1}, false},
                                                    {0, {0, 1, 0}, {0, 2, 1}, true},
                                                    {1, {0, 1, 0}, {1, 1, 1}, true},
                                                    {0, {1, 0, 0}, {1, 1, 1}, true}}) {
            grid.rectangle(axis, low, high, down);
        }
        return grid.make();
    };
    expect_fine(notched(false));
    expect_broken(notched(true), "labelled");
}

// --- options ---

TEST(CheckOptions, gabriel) {
    expect_fine(base(), {.gabriel = true});
    // A flat tetrahedron has its apex inside the diametral ball of its base.
    const Case flat = make_case({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, 0.5}},
                                {{VertexId{0}, VertexId{1}, VertexId{2}, VertexId{3}}}, {{0, 1, 2}},
                                {{VertexId{0}, VertexId{1}, VertexId{2}}}, {0});
    Case c = flat;
    c.mesh.tetrahedron_regions[0] = RegionId{0};
    expect_fine(c);
    expect_broken(c, "gabriel", {.gabriel = true});
}
TEST(CheckOptions, merge_coplanar) {
    // A cube from twelve triangles, meshed as if from six squares.
    Case c = cube(false);
    const Case squares = cube(true);
    ASSERT_EQ(c.mesh.positions, squares.mesh.positions);
    for (std::size_t i = 0; i < 12; ++i) c.mesh.triangle_facets[i] = FacetId{static_cast<std::uint32_t>(i / 2 * 2)};
    Case without = c;  // no edge is labelled with a merged side
    for (std::size_t i = without.mesh.edges.size(); i-- > 0;) {
        const Point3 &a = c.mesh.positions[index_of(c.mesh.edges[i][0])],
                     &b = c.mesh.positions[index_of(c.mesh.edges[i][1])];
        if ((a.x != b.x) + (a.y != b.y) + (a.z != b.z) < 2) continue;
        erase_at(without.mesh.edges, i);
        erase_at(without.mesh.edge_segments, i);
    }
    ASSERT_EQ(without.mesh.edges.size(), 12u);
    expect_fine(without, {.merge_coplanar = true});
    expect_fine(c, {.merge_coplanar = true});
    expect_broken(c, "conforming");
    Case unlabelled = c;
    unlabelled.mesh.edges.clear();
    unlabelled.mesh.edge_segments.clear();
    expect_fine(unlabelled, {.merge_coplanar = true});
    Case unmerged = c;
    for (std::size_t i = 0; i < 12; ++i) unmerged.mesh.triangle_facets[i] = FacetId{static_cast<std::uint32_t>(i)};
    expect_broken(unmerged, "labelled", {.merge_coplanar = true});
    // Different markers, a given segment on the common side, a facet off the plane by an ulp: not merged.
    Case marked = without;
    for (int i = 0; i < 12; ++i) marked.complex.facet_markers.push_back(i % 2);
    expect_broken(marked, "conforming", {.merge_coplanar = true});
    Case given = unlabelled;
    Edge diagonal{};  // of the first square
    for (std::size_t i = 0, n = 0; i < 3; ++i) {
        const Triangle& second = c.mesh.triangles[1];
        const VertexId v = c.mesh.triangles[0][i];
        if (std::find(second.begin(), second.end(), v) != second.end()) diagonal[n++] = v;
    }
    given.complex.segments.push_back(diagonal);
    expect_broken(given, "conforming", {.merge_coplanar = true});
    given.mesh.triangle_facets[1] = FacetId{1};
    expect_fine(given, {.merge_coplanar = true});
    Case bent = without;
    const std::uint32_t v = find_vertex(bent, {1, 1, 1});
    bent.complex.positions[v].x = bent.mesh.positions[v].x = std::nextafter(1.0, 2.0);
    expect_broken(bent, "conforming", {.merge_coplanar = true});
}
TEST(CheckOptions, merged_boundary) {
    // Two rectangles side by side, merged; the side between them may be anything, their common outline not.
    GridMesh grid(2, 2, 1);
    grid.rectangle(2, {0, 0, 0}, {1, 2, 0});
    grid.rectangle(2, {1, 0, 0}, {2, 2, 0}, true);
    grid.region_of = [](const Place&) { return 0; };
    Case c = grid.make();
    for (std::size_t i = 0; i < c.mesh.triangles.size(); ++i) {
        if (c.mesh.triangle_facets[i] == FacetId{1}) std::swap(c.mesh.triangles[i][1], c.mesh.triangles[i][2]);
        c.mesh.triangle_facets[i] = FacetId{0};
    }
    c.mesh.vertex_sources.clear();
    expect_fine(c, {.merge_coplanar = true});
    Case missing = c;
    missing.mesh.triangles.pop_back();
    missing.mesh.triangle_facets.pop_back();
    expect_broken(missing, "conforming", {.merge_coplanar = true});
}
TEST(CheckOptions, bad_input_and_options_are_refused) {
    const Case c = base();
    EXPECT_THROW(check_conforming(c.mesh, c.complex, {.deviation = {-1.0, false}}), InputError);
    EXPECT_THROW(check_conforming(c.mesh, c.complex, {.planarity = {NAN, false}}), InputError);
    PiecewiseLinearComplex bad = c.complex;
    bad.corners[0] = VertexId{no_index};
    EXPECT_THROW(check_conforming(c.mesh, bad), InputError);
    bad = c.complex;
    bad.polygon_offsets.back() += 1;
    EXPECT_THROW(check_conforming(c.mesh, bad), InputError);
    bad = c.complex;
    bad.hole_offsets.pop_back();
    EXPECT_THROW(check_conforming(c.mesh, bad), InputError);
    bad = c.complex;
    bad.positions[2].x = NAN;
    EXPECT_THROW(check_conforming(c.mesh, bad), InputError);
}
TEST(CheckOptions, cancelled_proves_nothing) {
    const Case c = base();
    const std::atomic<bool> cancel{true};
    RunControl control;
    control.cancel = &cancel;
    EXPECT_FALSE(check_conforming(c.mesh, c.complex, {}, control).ok());
}
TEST(CheckOptions, at_most_100_violations_per_promise_are_kept) {
    Case c = base();
    for (RegionId& r : c.mesh.tetrahedron_regions) r = RegionId{7 + index_of(r)};
    for (Tetrahedron& t : c.mesh.tetrahedra) std::swap(t[0], t[1]);
    const ConformingCheck check = check_conforming(c.mesh, c.complex);
    EXPECT_GT(check.violation_count, check.violations.size());
    const auto kept = std::count_if(check.violations.begin(), check.violations.end(),
                                    [](const Violation& v) { return v.promise == "well-formed"; });
    EXPECT_EQ(kept, 100);
}

}  // namespace
}  // namespace certa::test
