// Broken meshes are reported, under the promise that they break: one test per kind of damage on hand-made meshes, and
// random damage on random ones, where whatever passes has to be provably harmless.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "verify/grid_mesh.h"
#include "verify/predicates.h"

namespace certa::test {
namespace {

void expect_broken(const Case& c, const std::string& promise, const ConformingCheckOptions& options = {}) {
    const ConformingCheck check = check_conforming(c.mesh, c.complex, options);
    EXPECT_FALSE(check.ok());
    EXPECT_TRUE(has(check, promise)) << "expected " << promise << ", found:\n" << text(check);
    EXPECT_GE(check.violation_count, check.violations.size());
}
bool tells(const Case& c, const std::string& words, const ConformingCheckOptions& options = {}) {
    return text(check_conforming(c.mesh, c.complex, options)).find(words) != std::string::npos;
}
void expect_fine(const Case& c, const ConformingCheckOptions& options = {}) {
    const ConformingCheck check = check_conforming(c.mesh, c.complex, options);
    EXPECT_TRUE(check.ok()) << text(check);
}

/// A box of 3 x 3 x 3 with added points on sides and in facets, a wall inside, a dangling segment.
Case base() {
    GridMesh grid(3, 3, 3);
    grid.box({0, 0, 0}, {3, 3, 3});
    grid.box({1, 1, 1}, {2, 2, 2});
    grid.region_of = [](const Place& p) { return p == Place{1, 1, 1} ? 2 : 1; };
    return grid.make();
}
Case base_outside_kept() {
    GridMesh grid(4, 4, 4);
    grid.box({1, 1, 1}, {3, 3, 3});
    grid.region_of = [](const Place& p) {
        return std::all_of(p.begin(), p.end(), [](int c) { return c == 1 || c == 2; }) ? 1 : 0;
    };
    return grid.make();
}
std::vector<Case> all_bases() { return {base(), base_outside_kept(), one_tetrahedron(), cube_of_five()}; }

template <class T>
void erase_at(std::vector<T>& values, std::size_t i) {
    values.erase(values.begin() + static_cast<std::ptrdiff_t>(i));
}

std::uint32_t find_vertex(const Case& c, const Point3& p) {
    for (std::uint32_t v = 0; v < c.mesh.positions.size(); ++v) {
        if (c.mesh.positions[v] == p) return v;
    }
    return no_index;
}

// --- well-formed ---

TEST(CheckBroken, no_tetrahedra) {
    for (Case c : all_bases()) {
        c.mesh.tetrahedra.clear();
        c.mesh.tetrahedron_regions.clear();
        expect_broken(c, "well-formed");
    }
    expect_broken({}, "well-formed");
}
TEST(CheckBroken, index_out_of_range) {
    Case c = base();
    c.mesh.tetrahedra[5][2] = VertexId{static_cast<std::uint32_t>(c.mesh.positions.size())};
    expect_broken(c, "well-formed");
    c = base();
    c.mesh.triangles[5][2] = VertexId{no_index};
    expect_broken(c, "well-formed");
    c = base();
    c.mesh.edges[5][1] = VertexId{no_index};
    expect_broken(c, "well-formed");
}
TEST(CheckBroken, not_finite) {
    Case c = base();
    c.mesh.positions.back().y = NAN;
    expect_broken(c, "well-formed");
    c.mesh.positions.back().y = INFINITY;
    expect_broken(c, "well-formed");
}
TEST(CheckBroken, wrong_length_of_labels) {
    Case c = base();
    c.mesh.tetrahedron_regions.pop_back();
    expect_broken(c, "well-formed");
    c = base();
    c.mesh.vertex_sources.pop_back();
    expect_broken(c, "well-formed");
}
TEST(CheckBroken, swapped_corners) {
    for (const Case& b : all_bases()) {
        Case c = b;
        std::swap(c.mesh.tetrahedra[0][1], c.mesh.tetrahedra[0][3]);
        expect_broken(c, "well-formed");
        c = b;
        for (Tetrahedron& t : c.mesh.tetrahedra) std::swap(t[1], t[3]);
        expect_broken(c, "well-formed");
    }
}
TEST(CheckBroken, missing_tetrahedron) {
    const Case b = base();
    for (std::size_t i = 0; i < b.mesh.tetrahedra.size(); ++i) {
        Case c = b;
        erase_at(c.mesh.tetrahedra, i);
        erase_at(c.mesh.tetrahedron_regions, i);
        expect_broken(c, "well-formed");
    }
}
TEST(CheckBroken, repeated_tetrahedron) {
    for (Case c : all_bases()) {
        c.mesh.tetrahedra.push_back(c.mesh.tetrahedra[0]);
        c.mesh.tetrahedron_regions.push_back(c.mesh.tetrahedron_regions[0]);
        expect_broken(c, "well-formed");
        EXPECT_TRUE(tells(c, "belongs to tetrahedra"));
    }
}
TEST(CheckBroken, flat_tetrahedron) {
    // Over the two triangles of a side of the cube, ending in the two of the other diagonal: everything matches.
    Case c = cube(false);
    c.complex = {};
    c.complex.positions = c.mesh.positions;
    TetMesh& m = c.mesh;
    m.triangles.clear(), m.triangle_facets.clear(), m.edges.clear(), m.edge_segments.clear();
    m.tetrahedron_regions.assign(7, RegionId{0});
    const auto v = [&](int x, int y) { return VertexId{find_vertex(c, {x * 1.0, y * 1.0, 0})}; };
    m.tetrahedra.push_back({v(0, 0), v(1, 0), v(1, 1), v(0, 1)});
    const bool first = tells(c, "is flat");
    const bool matched = !tells(c, "belongs to tetrahedra");
    std::swap(m.tetrahedra.back()[0], m.tetrahedra.back()[1]);
    EXPECT_TRUE(first && tells(c, "is flat"));
    EXPECT_NE(matched, !tells(c, "belongs to tetrahedra"));  // one of the two orders is on the right side
    expect_broken(c, "well-formed");
}
TEST(CheckBroken, repeated_vertex) {
    Case c = base();
    // One tetrahedron gets its own copy of an added vertex.
    c.mesh.positions.push_back(c.mesh.positions.back());
    c.mesh.vertex_sources.push_back(c.mesh.vertex_sources.back());
    for (Tetrahedron& t : c.mesh.tetrahedra) {
        for (VertexId& v : t) {
            if (index_of(v) + 2 != c.mesh.positions.size()) continue;
            v = VertexId{index_of(v) + 1};
            EXPECT_TRUE(tells(c, "are both at"));
            return;
        }
    }
}
TEST(CheckBroken, unused_vertex) {
    Case c = base();
    c.mesh.positions.push_back({1.5, 1.5, 0});
    c.mesh.vertex_sources.push_back({VertexOrigin::facet, 4});
    expect_broken(c, "well-formed");
    expect_broken(c, "delaunay");
    c = base_outside_kept();  // an isolated input point that nothing holds, where nothing is left out
    c.complex.positions.push_back({0.5, 0.25, 0.125});
    c.mesh.positions.insert(c.mesh.positions.begin() + static_cast<std::ptrdiff_t>(c.complex.positions.size()) - 1,
                            c.complex.positions.back());
    c.mesh.vertex_sources.clear();
    const auto first = static_cast<std::uint32_t>(c.complex.positions.size() - 1);
    const auto shift = [&](auto& elements) {
        for (auto& e : elements) {
            for (VertexId& v : e) v = VertexId{index_of(v) + (index_of(v) >= first ? 1 : 0)};
        }
    };
    shift(c.mesh.tetrahedra);
    shift(c.mesh.triangles);
    shift(c.mesh.edges);
    expect_broken(c, "delaunay");
}
TEST(CheckValid, coincident_input_points_that_repair_left_over) {
    for (const Case& b : {base(), base_outside_kept(), one_tetrahedron()}) {
        Case c = b;
        // The new input points come right after the others.
        const auto first = static_cast<std::uint32_t>(c.complex.positions.size());
        const auto shift = [&](auto& elements) {
            for (auto& e : elements) {
                for (VertexId& v : e) v = VertexId{index_of(v) + (index_of(v) >= first ? 2 : 0)};
            }
        };
        shift(c.mesh.tetrahedra);
        shift(c.mesh.triangles);
        shift(c.mesh.edges);
        for (int i = 0; i < 2; ++i) {
            c.complex.positions.push_back(c.complex.positions[0]);
            c.mesh.positions.insert(c.mesh.positions.begin() + first, c.complex.positions[0]);
            c.mesh.vertex_sources.insert(c.mesh.vertex_sources.begin() + first, VertexSource{});
        }
        expect_fine(c);
        EXPECT_TRUE(check_conforming(c.mesh, c.complex).full_hull);
        c.complex.segments.push_back({VertexId{first}, VertexId{1}});
        expect_broken(c, "well-formed");
    }
}
TEST(CheckBroken, hull_filled_twice) {
    // A cube filled by Kuhn's six tetrahedra and again by two corners and an octahedron in four: no face in common (all
    // diagonals of its sides differ), all on one sphere, all positive, each filling valid on its own.
    Case c = cube(false);
    c.complex = {};
    c.complex.positions = c.mesh.positions;
    c.mesh.triangles.clear();
    c.mesh.triangle_facets.clear();
    c.mesh.edges.clear();
    c.mesh.edge_segments.clear();
    c.mesh.tetrahedron_regions.assign(6, RegionId{0});
    expect_fine(c);
    const std::vector<Tetrahedron> first = c.mesh.tetrahedra;
    const auto v = [&](int x, int y, int z) { return VertexId{find_vertex(c, {x * 1.0, y * 1.0, z * 1.0})}; };
    const VertexId a = v(1, 0, 0), b = v(0, 1, 1);
    const std::array<VertexId, 4> ring{v(0, 1, 0), v(0, 0, 1), v(1, 0, 1), v(1, 1, 0)};
    std::vector<Tetrahedron> second{{v(0, 0, 0), a, ring[0], ring[1]}, {v(1, 1, 1), b, ring[2], ring[3]}};
    for (std::size_t i = 0; i < 4; ++i) second.push_back({a, b, ring[i], ring[(i + 1) % 4]});
    for (Tetrahedron& t : second) {
        const auto at = [&](std::size_t i) { return c.mesh.positions[index_of(t[i])]; };
        if (verify::orientation(at(0), at(1), at(2), at(3)) < 0) std::swap(t[2], t[3]);
    }
    c.mesh.tetrahedra = second;
    expect_fine(c);
    c.mesh.tetrahedra.insert(c.mesh.tetrahedra.end(), first.begin(), first.end());
    c.mesh.tetrahedron_regions.assign(12, RegionId{0});
    expect_broken(c, "well-formed");
    EXPECT_FALSE(check_conforming(c.mesh, c.complex).full_hull);
}
TEST(CheckBroken, overlap_on_one_sphere_without_hull) {
    // The same two fillings of a cube, this time with all their surfaces as facets and next to another cube, so that
    // neither the hull nor the emptiness of circumballs shows the overlap.
    std::vector<Point3> positions;
    for (int x = 0; x < 4; ++x) {
        for (int y = 0; y < 2; ++y) {
            for (int z = 0; z < 2; ++z) positions.push_back({x + (x > 1 ? 1.0 : 0.0), y * 1.0, z * 1.0 + (x > 1)});
        }
    }
    std::vector<Tetrahedron> tetrahedra;
    std::vector<RegionId> regions;
    std::vector<Triangle> triangles;
    std::vector<std::vector<std::uint32_t>> facets;
    std::vector<std::uint32_t> labels;
    const auto add = [&](const Case& c, const Point3& shift, std::uint32_t region) {
        const auto map = [&](VertexId v) {
            const Point3& p = c.mesh.positions[index_of(v)];
            const Point3 q{p.x + shift.x, p.y + shift.y, p.z + shift.z};
            return VertexId{
                static_cast<std::uint32_t>(std::find(positions.begin(), positions.end(), q) - positions.begin())};
        };
        for (const Tetrahedron& t : c.mesh.tetrahedra) {
            tetrahedra.push_back({map(t[0]), map(t[1]), map(t[2]), map(t[3])});
            regions.push_back(RegionId{region});
        }
        for (const Triangle& t : c.mesh.triangles) {
            std::array<VertexId, 3> s{map(t[0]), map(t[1]), map(t[2])};
            auto key = s;
            std::sort(key.begin(), key.end());
            const bool known = std::any_of(triangles.begin(), triangles.end(), [&](Triangle o) {
                std::sort(o.begin(), o.end());
                return o == key;
            });
            if (known) continue;
            labels.push_back(static_cast<std::uint32_t>(facets.size()));
            facets.push_back({index_of(s[0]), index_of(s[1]), index_of(s[2])});
            triangles.push_back(s);
        }
    };
    add(cube(false), {0, 0, 0}, 1);
    add(cube(false), {3, 0, 1}, 2);
    Case c = make_case(positions, tetrahedra, facets, triangles, labels);
    c.mesh.tetrahedron_regions = regions;
    expect_fine(c);
    EXPECT_FALSE(check_conforming(c.mesh, c.complex).full_hull);
    add(cube_of_five(), {0, 0, 0}, 3);
    c = make_case(positions, tetrahedra, facets, triangles, labels);
    c.mesh.tetrahedron_regions = regions;
    expect_broken(c, "well-formed");
    const ConformingCheck check = check_conforming(c.mesh, c.complex);
    EXPECT_NE(text(check).find("on one circumsphere, overlap"), std::string::npos) << text(check);
}
TEST(CheckBroken, overlapping_boxes) {
    GridMesh left(2, 1, 1), right(1, 1, 1);
    left.box({0, 0, 0}, {1, 1, 1});
    left.region_of = [](const Place& p) { return p[0] == 0 ? 1 : -1; };
    Case c = left.make();
    right.shift = {0.5, 0.25, 0.25};
    right.box({0, 0, 0}, {1, 1, 1});
    const Case d = right.make();
    const auto first = static_cast<std::uint32_t>(c.mesh.positions.size());
    const auto facets = static_cast<std::uint32_t>(c.complex.facet_count());
    const auto polygons = static_cast<std::uint32_t>(c.complex.corners.size());
    const auto segments = static_cast<std::uint32_t>(c.mesh.edges.size());
    c.complex.positions.insert(c.complex.positions.end(), d.complex.positions.begin(), d.complex.positions.end());
    for (const VertexId v : d.complex.corners) c.complex.corners.push_back(VertexId{index_of(v) + first});
    for (std::uint32_t f = 1; f <= 6; ++f) {
        c.complex.polygon_offsets.push_back(polygons + d.complex.polygon_offsets[f]);
        c.complex.facet_offsets.push_back(facets + f);
        c.complex.hole_offsets.push_back(0);
    }
    c.mesh.positions.insert(c.mesh.positions.end(), d.mesh.positions.begin(), d.mesh.positions.end());
    c.mesh.vertex_sources.clear();
    for (Tetrahedron t : d.mesh.tetrahedra) {
        for (VertexId& v : t) v = VertexId{index_of(v) + first};
        c.mesh.tetrahedra.push_back(t);
        c.mesh.tetrahedron_regions.push_back(RegionId{2});
    }
    for (Triangle t : d.mesh.triangles) {
        for (VertexId& v : t) v = VertexId{index_of(v) + first};
        c.mesh.triangles.push_back(t);
    }
    for (const FacetId f : d.mesh.triangle_facets) c.mesh.triangle_facets.push_back(FacetId{index_of(f) + facets});
    for (Edge e : d.mesh.edges) {
        for (VertexId& v : e) v = VertexId{index_of(v) + first};
        c.mesh.edges.push_back(e);
    }
    for (const SegmentId s : d.mesh.edge_segments) c.mesh.edge_segments.push_back(SegmentId{index_of(s) + segments});
    expect_broken(c, "delaunay");
}

// --- delaunay ---

TEST(CheckBroken, vertex_in_circumball) {
    // One face of the tetrahedron gets a second one on it, with its apex inside the first one's circumsphere.
    for (const bool inside : {false, true}) {
        const double far = inside ? 0.9 : 1.1;
        const Case c = make_case({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {far, far, far}},
                                 {{VertexId{0}, VertexId{1}, VertexId{2}, VertexId{3}},
                                  {VertexId{1}, VertexId{2}, VertexId{3}, VertexId{4}}},
                                 {{1, 2, 3}}, {{VertexId{1}, VertexId{2}, VertexId{3}}}, {0});
        Case d = c;
        d.mesh.tetrahedron_regions = {RegionId{0}, RegionId{0}};
        if (inside) {
            expect_broken(d, "delaunay");
        } else {
            expect_fine(d);
        }
    }
}
TEST(CheckBroken, one_ulp_off_a_sphere) {
    // All eight corners are on one sphere, all tetrahedra share the corner (1, 1, 1). Moved into the sphere it must be
    // a corner of them all; moved out of it, the other seven have spheres that are empty without it.
    Case c = cube(false);
    const std::uint32_t v = find_vertex(c, {1, 1, 1});
    c.mesh.positions[v].z = c.complex.positions[v].z = std::nextafter(1.0, 0.0);
    expect_fine(c);
    c.mesh.positions[v].z = c.complex.positions[v].z = std::nextafter(1.0, 2.0);
    expect_broken(c, "delaunay");
}
TEST(CheckBroken, unmeshed_vertex_in_circumball_beyond_the_boundary) {
    // The far input point belongs to a second piece; no inner face sees it.
    std::vector<Point3> positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const auto piece = [&](double d) {
        positions.resize(4);
        positions.push_back({0.6 + d, 0.6 + d, 0.6 + d});
        positions.push_back({4, 1, 1});
        positions.push_back({1, 4, 1.5});
        positions.push_back({1, 1.25, 4});
        const auto tet = [](std::uint32_t a) {
            return Tetrahedron{VertexId{a}, VertexId{a + 1}, VertexId{a + 2}, VertexId{a + 3}};
        };
        std::vector<Triangle> triangles;
        std::vector<std::vector<std::uint32_t>> facets;
        for (const std::uint32_t a : {0u, 4u}) {
            for (const std::array<std::uint32_t, 3> f :
                 {std::array<std::uint32_t, 3>{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}) {
                triangles.push_back({VertexId{a + f[0]}, VertexId{a + f[1]}, VertexId{a + f[2]}});
                facets.push_back({a + f[0], a + f[1], a + f[2]});
            }
        }
        Case c = make_case(positions, {tet(0), tet(4)}, facets, triangles, {0, 1, 2, 3, 4, 5, 6, 7});
        c.mesh.tetrahedron_regions[1] = RegionId{2};
        return c;
    };
    expect_fine(piece(0.5));
    expect_broken(piece(0.25), "delaunay");
}

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
