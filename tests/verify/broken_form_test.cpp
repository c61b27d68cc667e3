// Broken meshes are reported under the promise that they break: well-formed, delaunay.
#include "verify/broken.h"
#include "verify/predicates.h"

namespace certa::test {
namespace {

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

}  // namespace
}  // namespace certa::test
