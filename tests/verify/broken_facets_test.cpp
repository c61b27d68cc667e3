// Broken meshes are reported under the promise that they break: conforming, faithful.
#include "verify/broken.h"

namespace certa::test {
namespace {

// --- conforming ---

TEST(CheckBroken, missing_chain_edge) {
    const Case b = base();
    for (std::size_t i = 0; i < b.mesh.edges.size(); ++i) {
        Case c = b;
        erase_at(c.mesh.edges, i);
        erase_at(c.mesh.edge_segments, i);
        expect_broken(c, "conforming");
    }
}
TEST(CheckBroken, extra_chain_edge) {
    Case c = base();
    c.mesh.edges.push_back(c.mesh.edges.back());
    c.mesh.edge_segments.push_back(c.mesh.edge_segments.back());
    expect_broken(c, "conforming");
    c = base();
    c.mesh.edges.push_back({c.mesh.tetrahedra[0][0], c.mesh.tetrahedra[0][3]});
    c.mesh.edge_segments.push_back(SegmentId{0});
    expect_broken(c, "conforming");
}
TEST(CheckBroken, segment_that_no_edge_follows) {
    Case c = cube(true);  // a diagonal that Kuhn's cut does not have
    c.complex.segments.push_back({VertexId{find_vertex(c, {1, 0, 0})}, VertexId{find_vertex(c, {0, 1, 1})}});
    c.mesh.edges.clear();
    c.mesh.edge_segments.clear();
    expect_broken(c, "conforming");
    c.complex.segments[0] = {VertexId{find_vertex(c, {0, 0, 0})}, VertexId{find_vertex(c, {1, 1, 1})}};
    expect_fine(c);
}
TEST(CheckBroken, chain_with_an_edge_of_no_tetrahedron) {
    Case c = cube(true);
    c.complex.segments.push_back({VertexId{find_vertex(c, {1, 0, 0})}, VertexId{find_vertex(c, {0, 1, 1})}});
    for (SegmentId& s : c.mesh.edge_segments) s = SegmentId{index_of(s) + 1};
    c.mesh.edges.push_back(c.complex.segments[0]);
    c.mesh.edge_segments.push_back(SegmentId{0});
    expect_broken(c, "conforming");
}
TEST(CheckBroken, chain_around_a_corner) {
    // The chain of a cube's side leads over another corner.
    Case c = cube(true);
    const std::uint32_t a = index_of(c.mesh.edges[0][0]), b = index_of(c.mesh.edges[0][1]);
    for (std::uint32_t v = 0; v < 8; ++v) {
        if (v == a || v == b) continue;
        Case d = c;
        d.mesh.edges[0] = {VertexId{a}, VertexId{v}};
        d.mesh.edges.push_back({VertexId{v}, VertexId{b}});
        d.mesh.edge_segments.push_back(d.mesh.edge_segments[0]);
        expect_broken(d, "conforming");
    }
}
/// A facet on the floor, so that added points lie on its sides and inside.
Case floor_of(int n) {
    GridMesh grid(n, n, 1);
    grid.rectangle(2, {0, 0, 0}, {n, n, 0});
    grid.region_of = [](const Place&) { return 0; };
    return grid.make();
}
TEST(CheckBroken, chain_that_goes_back) {
    Case c = floor_of(3);
    const auto v = [&](int x, int y) { return VertexId{find_vertex(c, {x * 1.0, y * 1.0, 0})}; };
    const SegmentId first = c.mesh.edge_segments[0];
    ASSERT_EQ(c.mesh.edges[0], (Edge{v(0, 0), v(1, 0)}));
    // Through inner points, all steps along mesh edges; with this tolerance nothing is too far away.
    c.mesh.edges[1] = {v(1, 0), v(2, 1)};
    for (const Edge& e : {Edge{v(2, 1), v(1, 1)}, Edge{v(1, 1), v(2, 2)}, Edge{v(2, 2), v(3, 2)}}) {
        c.mesh.edges.push_back(e);
        c.mesh.edge_segments.push_back(first);
    }
    c.mesh.edges[2] = {v(3, 2), v(3, 1)};
    c.mesh.edges.push_back({v(3, 1), v(3, 0)});
    c.mesh.edge_segments.push_back(first);
    EXPECT_TRUE(tells(c, "goes back", {.deviation = {10.0, false}}));
    expect_broken(c, "conforming", {.deviation = {10.0, false}});
}
TEST(CheckBroken, chain_off_its_segment) {
    const Case b = floor_of(3);
    const std::uint32_t v = find_vertex(b, {1, 0, 0});
    for (const double off : {1e-9, 1e-13}) {
        Case c = b;
        c.mesh.positions[v].y = -off;
        EXPECT_EQ(tells(c, "away from segment"), off > 1e-12);
        EXPECT_DOUBLE_EQ(check_conforming(c.mesh, c.complex).max_deviation, off);
        EXPECT_TRUE(tells(c, "away from segment", {.deviation = {off / 2, false}}));
        EXPECT_FALSE(tells(c, "away from segment", {.deviation = {off * 2, false}}));
    }
}
TEST(CheckBroken, chain_through_an_input_point) {
    GridMesh grid(2, 1, 1);
    grid.segment({0, 0, 0}, {2, 0, 0});
    grid.point({1, 0, 0});
    grid.region_of = [](const Place&) { return 0; };
    expect_broken(grid.make(), "conforming");
}
TEST(CheckBroken, chains_that_cross) {
    GridMesh grid(2, 2, 1);
    grid.segment({0, 1, 0}, {2, 1, 0});
    grid.region_of = [](const Place&) { return 0; };
    expect_fine(grid.make());
    grid.segment({1, 0, 0}, {1, 2, 0});
    expect_broken(grid.make(), "conforming");
}
TEST(CheckBroken, isolated_segment_across_a_hole) {
    GridMesh grid(3, 3, 1);
    std::vector<Place> squares;
    for (int x = 0; x < 3; ++x) {
        for (int y = 0; y < 3; ++y) {
            if (x != 1 || y != 1) squares.push_back({x, y, 0});
        }
    }
    grid.region_of = [](const Place&) { return 0; };
    grid.facet(2,
               {{{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}},
                {{1, 1, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}},
                {{1, 1, 0}, {2, 2, 0}}},
               {{1.5, 1.25, 0}}, squares);
    expect_broken(grid.make(), "conforming");
}
TEST(CheckBroken, missing_triangle) {
    for (const Case& b : all_bases()) {
        for (std::size_t i = 0; i < b.mesh.triangles.size(); ++i) {
            Case c = b;
            erase_at(c.mesh.triangles, i);
            erase_at(c.mesh.triangle_facets, i);
            expect_broken(c, "conforming");
        }
    }
}
TEST(CheckBroken, facet_without_triangles) {
    Case c = base();
    for (std::size_t i = c.mesh.triangles.size(); i-- > 0;) {
        if (index_of(c.mesh.triangle_facets[i]) != 7) continue;
        erase_at(c.mesh.triangles, i);
        erase_at(c.mesh.triangle_facets, i);
    }
    expect_broken(c, "conforming");
}
TEST(CheckBroken, triangle_of_no_tetrahedron) {
    Case c = cube(true);
    // The other diagonal of one side.
    for (std::size_t i = 0; i + 1 < c.mesh.triangles.size(); ++i) {
        if (c.mesh.triangle_facets[i] != c.mesh.triangle_facets[i + 1]) continue;
        const Triangle s = c.mesh.triangles[i], t = c.mesh.triangles[i + 1];  // (p, u, r), (p, r, v) up to direction
        std::vector<VertexId> ring;
        for (const VertexId v : s) {
            if (std::find(t.begin(), t.end(), v) == t.end()) ring.push_back(v);
        }
        ASSERT_EQ(ring.size(), 1u);
        const auto at = static_cast<std::size_t>(std::find(s.begin(), s.end(), ring[0]) - s.begin());
        const VertexId before = s[(at + 2) % 3], after = s[(at + 1) % 3];
        VertexId far{};
        for (const VertexId v : t) {
            if (v != before && v != after) far = v;
        }
        c.mesh.triangles[i] = {before, ring[0], far};
        c.mesh.triangles[i + 1] = {ring[0], after, far};
        break;
    }
    expect_broken(c, "conforming");
}
GridMesh plate(const std::vector<Place>& extra, const std::vector<Place>& missing) {
    GridMesh grid(4, 4, 2);
    grid.region_of = [](const Place&) { return 0; };
    std::vector<Place> squares;
    for (int x = 0; x < 4; ++x) {
        for (int y = 0; y < 4; ++y) {
            const Place p{x, y, 1};
            const bool hole = x == 1 && y == 1;
            if (hole ? std::find(extra.begin(), extra.end(), p) != extra.end()
                     : std::find(missing.begin(), missing.end(), p) == missing.end()) {
                squares.push_back(p);
            }
        }
    }
    grid.facet(2,
               {{{0, 0, 1}, {4, 0, 1}, {4, 4, 1}, {0, 4, 1}},
                {{1, 1, 1}, {2, 1, 1}, {2, 2, 1}, {1, 2, 1}},
                {{2, 2, 1}, {3, 2, 1}, {3, 3, 1}, {2, 3, 1}},
                {{1, 3, 1}, {2, 3, 1}},
                {{3, 1, 1}}},
               {{1.25, 1.5, 1}}, squares);
    return grid;
}
TEST(CheckBroken, holes_of_facets) {
    expect_fine(plate({}, {}).make());
    expect_broken(plate({{1, 1, 1}}, {}).make(), "conforming");  // the hole filled
    expect_broken(plate({}, {{2, 2, 1}}).make(), "conforming");  // a ring that is no hole left open
    expect_broken(plate({}, {{0, 0, 1}}).make(), "conforming");
    Case c = plate({}, {}).make();
    c.complex.facet_holes[0] = {2.5, 2.25, 1};  // the other ring is the hole
    expect_broken(c, "conforming");
    c.complex.facet_holes.clear();
    c.complex.hole_offsets.back() = 0;
    expect_broken(c, "conforming");
}
TEST(CheckBroken, isolated_elements_of_facets) {
    // A facet whose isolated point or segment is somewhere else in the mesh.
    Case c = plate({}, {}).make();
    const std::uint32_t above = find_vertex(c, {3, 1, 2});
    for (VertexId& v : c.complex.corners) {
        if (index_of(v) == find_vertex(c, {3, 1, 1})) v = VertexId{above};
    }
    expect_broken(c, "conforming");
    c = plate({}, {}).make();
    const std::uint32_t end = find_vertex(c, {1, 3, 1});
    for (VertexId& v : c.complex.corners) {
        if (index_of(v) == end) v = VertexId{find_vertex(c, {2, 3, 2})};
    }
    expect_broken(c, "conforming");
}

// --- faithful ---

TEST(CheckBroken, moved_input_point) {
    for (const Case& b : all_bases()) {
        for (std::uint32_t v = 0; v < b.complex.positions.size(); ++v) {
            Case c = b;
            c.mesh.positions[v].x = std::nextafter(c.mesh.positions[v].x, 10.0);
            expect_broken(c, "faithful");
        }
    }
}
TEST(CheckBroken, missing_input_point) {
    Case c = base();
    c.complex.positions.resize(c.mesh.positions.size() + 1);
    expect_broken(c, "faithful");
}
TEST(CheckBroken, added_point_off_its_place) {
    const Case b = base();
    for (auto v = static_cast<std::uint32_t>(b.complex.positions.size()); v < b.mesh.positions.size(); ++v) {
        for (int axis = 0; axis < 3; ++axis) {
            Case c = b;
            double& x = axis == 0 ? c.mesh.positions[v].x : axis == 1 ? c.mesh.positions[v].y : c.mesh.positions[v].z;
            x += 1e-9;  // along its facet or segment it stays faithful, but nothing here is Delaunay any more
            const ConformingCheck check = check_conforming(c.mesh, c.complex);
            EXPECT_FALSE(check.ok());
            EXPECT_TRUE(has(check, "faithful") || has(check, "delaunay")) << text(check);
            if (has(check, "faithful")) {
                EXPECT_GE(check.max_deviation, 0.9e-9);
            }
        }
    }
}
TEST(CheckBroken, far_vertex) {
    for (const double far : {1e15, 1e300}) {
        Case c = one_tetrahedron();
        c.mesh.positions.push_back({far, far, far});
        c.mesh.vertex_sources.push_back({VertexOrigin::facet, 0});
        c.mesh.tetrahedra.push_back({VertexId{1}, VertexId{2}, VertexId{3}, VertexId{4}});
        c.mesh.tetrahedron_regions.push_back(RegionId{0});
        expect_broken(c, "faithful");
        expect_broken(c, "labelled");
    }
}
TEST(CheckBroken, facet_over_a_bump) {
    // The facet's two triangles replaced by the other two faces of the tetrahedra below: same boundary, another
    // surface.
    Case c = make_case({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.4, 0.45, -1}, {0.5, 0.5, 1e-3}},
                       {{VertexId{0}, VertexId{1}, VertexId{5}, VertexId{4}},
                        {VertexId{1}, VertexId{2}, VertexId{5}, VertexId{4}},
                        {VertexId{2}, VertexId{3}, VertexId{5}, VertexId{4}},
                        {VertexId{3}, VertexId{0}, VertexId{5}, VertexId{4}}},
                       {{0, 1, 2, 3}},
                       {{VertexId{0}, VertexId{1}, VertexId{5}},
                        {VertexId{1}, VertexId{2}, VertexId{5}},
                        {VertexId{2}, VertexId{3}, VertexId{5}},
                        {VertexId{3}, VertexId{0}, VertexId{5}}},
                       {0, 0, 0, 0});
    for (Tetrahedron& t : c.mesh.tetrahedra) std::swap(t[0], t[1]);
    for (RegionId& r : c.mesh.tetrahedron_regions) r = RegionId{0};
    const ConformingCheck check = check_conforming(c.mesh, c.complex);
    EXPECT_FALSE(has(check, "well-formed")) << text(check);
    EXPECT_FALSE(has(check, "conforming")) << text(check);
    EXPECT_TRUE(has(check, "faithful")) << text(check);
    c.complex.positions[5].z = c.mesh.positions[5].z = 0.0;
    expect_fine(c);
}
TEST(CheckBroken, facet_tiled_twice) {
    Case c = base();
    for (std::size_t i = 0, n = c.mesh.triangles.size(); i < n; ++i) {
        if (index_of(c.mesh.triangle_facets[i]) != 2) continue;
        c.mesh.triangles.push_back(c.mesh.triangles[i]);
        c.mesh.triangle_facets.push_back(c.mesh.triangle_facets[i]);
    }
    expect_broken(c, "faithful");
}
TEST(CheckBroken, turned_triangle) {
    for (const Case& b : all_bases()) {
        for (std::size_t i = 0; i < b.mesh.triangles.size(); ++i) {
            Case c = b;
            std::swap(c.mesh.triangles[i][0], c.mesh.triangles[i][1]);
            expect_broken(c, "faithful");
        }
    }
}
TEST(CheckBroken, facet_that_is_not_planar) {
    Case c = cube(true);
    const std::uint32_t v = find_vertex(c, {1, 1, 1});
    c.mesh.positions[v].z = c.complex.positions[v].z = 1 + 1e-6;
    expect_broken(c, "faithful");
}

}  // namespace
}  // namespace certa::test
