// What `conform` says about its result: regions, holes, seeds, facets, segments, sources. Shapes whose volumes, areas
// and lengths are known in closed form.
#include <certa/io.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "conforming/conform_support.h"
#include "mesh/generators.h"

namespace certa::test {
namespace {

std::vector<std::uint32_t> regions_of(const ConformResult& result) {
    std::set<std::uint32_t> regions;
    for (const RegionId r : result.mesh.tetrahedron_regions) regions.insert(index_of(r));
    return {regions.begin(), regions.end()};
}

bool warns_of(const ConformResult& result, const std::string& words) {
    return std::any_of(result.warnings.begin(), result.warnings.end(),
                       [&](const Defect& w) { return w.message.find(words) != std::string::npos; });
}

using Regions = std::vector<std::uint32_t>;

// --- regions ---

TEST(ConformRegions, OneBox) {
    const ConformResult result = expect_conforms(make_box({0, 0, 0}, {1, 2, 3}));
    EXPECT_EQ(regions_of(result), (Regions{1}));
    EXPECT_DOUBLE_EQ(volume_of(result.mesh), 6.0);
    EXPECT_TRUE(result.warnings.empty());
}

/// Boxes in a row that share walls, the first listed last.
PiecewiseLinearComplex three_rooms() {
    PiecewiseLinearComplex c;
    for (int i = 0; i < 4; ++i) {
        for (const double y : {0.0, 1.0}) {
            for (const double z : {0.0, 1.0}) put_point(c, {std::array{5.0, 3.0, 1.0, 0.0}[i], y, z});
        }
    }
    for (std::uint32_t i = 0; i < 4; ++i) put_facet(c, {{4 * i, 4 * i + 1, 4 * i + 3, 4 * i + 2}});
    for (std::uint32_t i = 0; i < 12; i += 4) {
        for (const std::array<std::uint32_t, 2>& side : {std::array<std::uint32_t, 2>{0, 1}, {1, 3}, {3, 2}, {2, 0}})
            put_facet(c, {{i + side[0], i + side[1], i + side[1] + 4, i + side[0] + 4}});
    }
    return c;
}

TEST(ConformRegions, AreNumberedByTheirLowestInputVertex) {
    const ConformResult result = expect_conforms(three_rooms());
    EXPECT_EQ(regions_of(result), (Regions{1, 2, 3}));
    EXPECT_DOUBLE_EQ(volume_of(result.mesh, 1), 2.0);  // x from 3 to 5 holds the points 0 to 7
    EXPECT_DOUBLE_EQ(volume_of(result.mesh, 2), 2.0);
    EXPECT_DOUBLE_EQ(volume_of(result.mesh, 3), 1.0);
}

TEST(ConformRegions, NestedAndApart) {
    PiecewiseLinearComplex c = make_box({0, 0, 0}, {10, 10, 10});
    put_box(c, {2, 2, 2}, {6, 6, 6});
    put_box(c, {3, 3, 3}, {5, 5, 5});
    put_box(c, {20, 0, 0}, {21, 1, 1});
    const ConformResult result = expect_conforms(c);
    EXPECT_EQ(regions_of(result), (Regions{1, 2, 3, 4}));
    EXPECT_NEAR(volume_of(result.mesh, 1), 1000 - 64, 1e-9);
    EXPECT_NEAR(volume_of(result.mesh, 2), 64 - 8, 1e-9);
    EXPECT_NEAR(volume_of(result.mesh, 3), 8, 1e-9);
    EXPECT_NEAR(volume_of(result.mesh, 4), 1, 1e-9);
}

TEST(ConformRegions, SharingACornerOrASideOnly) {
    PiecewiseLinearComplex c = generators::make_nested_cubes(3);
    EXPECT_EQ(regions_of(expect_conforms(c)), (Regions{1, 2, 3}));
    // Two tetrahedra on one side of each.
    PiecewiseLinearComplex d;
    for (const Point3& p : {Point3{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0.2}, {-1, -1, 0}})
        put_point(d, p);
    for (const std::uint32_t other : {2u, 4u}) {
        const Ids t{0, 1, other, other + 1};
        for (int skip = 0; skip < 4; ++skip) {
            Ids ring;
            for (int i = 0; i < 4; ++i) {
                if (i != skip) ring.push_back(t[i]);
            }
            put_facet(d, {ring});
        }
    }
    EXPECT_EQ(regions_of(expect_conforms(d)), (Regions{1, 2}));
}

TEST(ConformRegions, KeepOutsideFillsTheHull) {
    PiecewiseLinearComplex c = make_box({0, 0, 0}, {1, 1, 1});
    put_box(c, {2, 0, 0}, {3, 1, 1});
    const ConformResult without = expect_conforms(c);
    EXPECT_EQ(regions_of(without), (Regions{1, 2}));
    EXPECT_DOUBLE_EQ(volume_of(without.mesh), 2.0);
    const ConformResult with = expect_conforms(c, {.keep_outside = true});
    EXPECT_EQ(regions_of(with), (Regions{0, 1, 2}));
    EXPECT_DOUBLE_EQ(volume_of(with.mesh), 3.0);
    EXPECT_TRUE(with.warnings.empty());
    EXPECT_EQ(with.mesh.positions, without.mesh.positions);
    EXPECT_TRUE(check_conforming(with.mesh, c).full_hull);
}

TEST(ConformRegions, NothingBoundedKeepsTheHullAndSaysSo) {
    PiecewiseLinearComplex c = generators::make_fan(4, 1.0, 1);
    const ConformResult result = expect_conforms(c);
    EXPECT_EQ(regions_of(result), (Regions{0}));
    EXPECT_TRUE(warns_of(result, "region 0"));
    EXPECT_TRUE(check_conforming(result.mesh, c).full_hull);
    // Points alone.
    PiecewiseLinearComplex points;
    for (const Point3& p : {Point3{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.1, 0.2, 0.3}}) put_point(points, p);
    const ConformResult cloud = expect_conforms_or_says_where(points);
    EXPECT_EQ(cloud.mesh.positions.size(), 5u);
    EXPECT_NEAR(volume_of(cloud.mesh), 1.0 / 6.0, 1e-12);
    // A box without lid.
    PiecewiseLinearComplex open = make_box({0, 0, 0}, {1, 1, 1});
    open.facet_offsets.pop_back();
    open.hole_offsets.pop_back();
    open.polygon_offsets.pop_back();
    open.corners.resize(open.polygon_offsets.back());
    const ConformResult lidless = expect_conforms(open);
    EXPECT_EQ(regions_of(lidless), (Regions{0}));
    EXPECT_TRUE(warns_of(lidless, "region 0"));
}

TEST(ConformRegions, DanglingInsideChangesNothingOutside) {
    PiecewiseLinearComplex c = make_box({0, 0, 0}, {4, 4, 4});
    const std::uint32_t a = put_point(c, {1, 1, 1}), b = put_point(c, {3, 1, 1.5}), d = put_point(c, {2, 3, 2});
    put_facet(c, {{a, b, d}});      // hangs free inside
    put_segment(c, 0, a);           // from a corner of the box
    put_point(c, {3.5, 3.5, 3.5});  // isolated in space
    const ConformResult result = expect_conforms(c);
    EXPECT_EQ(regions_of(result), (Regions{1}));
    EXPECT_NEAR(volume_of(result.mesh), 64.0, 1e-9);
    EXPECT_TRUE(result.warnings.empty());
}

TEST(ConformRegions, DanglingOutsideKeepsTheHullAndSaysSo) {
    PiecewiseLinearComplex c = make_box({0, 0, 0}, {1, 1, 1});
    const std::uint32_t a = put_point(c, {2, 0, 0.5}), b = put_point(c, {2, 1, 0.5});
    PiecewiseLinearComplex with_segment = c;
    put_facet(c, {{1, a, b}});
    const ConformResult facet = expect_conforms(c);
    EXPECT_EQ(regions_of(facet), (Regions{0, 1}));
    EXPECT_TRUE(warns_of(facet, "region 0"));
    EXPECT_NEAR(volume_of(facet.mesh, 1), 1.0, 1e-12);
    put_segment(with_segment, a, b);
    const ConformResult segment = expect_conforms(with_segment);
    EXPECT_EQ(regions_of(segment), (Regions{0, 1}));
    EXPECT_TRUE(warns_of(segment, "region 0"));
}

// --- hole points and seeds ---

TEST(ConformHoles, RemoveTheirRegions) {
    PiecewiseLinearComplex c = make_box({0, 0, 0}, {10, 10, 10});
    put_box(c, {2, 2, 2}, {4, 4, 4});
    put_box(c, {6, 6, 6}, {9, 9, 9});
    c.region_holes = {{3, 3, 3}};
    const ConformResult result = expect_conforms(c);
    EXPECT_NEAR(volume_of(result.mesh), 1000.0 - 8.0, 1e-9);
    EXPECT_EQ(regions_of(result), (Regions{1, 3}));
    EXPECT_NEAR(volume_of(result.mesh, 3), 27.0, 1e-9);
    // Without the region around them, the outermost facets would touch nothing: it stays, and a warning says why.
    c.region_holes = {{1, 1, 1}};
    const ConformResult kept = expect_conforms(c);
    EXPECT_NEAR(volume_of(kept.mesh), 1000.0, 1e-9);
    EXPECT_TRUE(warns_of(kept, "hole point"));
}

TEST(ConformHoles, NeverTakeTheLastTetrahedronOfAFacet) {
    PiecewiseLinearComplex c = make_box({0, 0, 0}, {1, 1, 1});
    c.region_holes = {{0.5, 0.4, 0.3}};
    const ConformResult result = expect_conforms(c);  // nothing is left but the hull
    EXPECT_TRUE(!result.warnings.empty());
    EXPECT_GT(result.mesh.tetrahedra.size(), 0u);
}

TEST(ConformHoles, OutsideRemoveNothingAndSaySo) {
    PiecewiseLinearComplex c = make_box({0, 0, 0}, {1, 1, 1});
    for (const Point3& p : {Point3{5, 5, 5}, {-1e9, 0, 0}, {0.5, 0.5, 1.0000001}}) {
        c.region_holes = {p};
        const ConformResult result = expect_conforms(c);
        EXPECT_DOUBLE_EQ(volume_of(result.mesh), 1.0);
        EXPECT_TRUE(warns_of(result, "hole point"));
    }
}

TEST(ConformSeeds, NameTheirRegions) {
    PiecewiseLinearComplex c = three_rooms();
    c.region_seeds = {{{0.5, 0.5, 0.5}, -7.5, 0.0}, {{4, 0.3, 0.9}, 42.0, 0.1}};
    const ConformResult result = expect_conforms(c);
    ASSERT_EQ(result.region_attributes.size(), 4u);
    EXPECT_EQ(result.region_attributes, (std::vector{0.0, 42.0, 0.0, -7.5}));
    c.region_seeds.push_back({{4.9, 0.1, 0.1}, 42.0, 0.0});  // the same word twice
    EXPECT_EQ(expect_conforms(c).region_attributes, result.region_attributes);
}

TEST(ConformSeeds, MayNotContradictEachOther) {
    PiecewiseLinearComplex c = three_rooms();
    c.region_seeds = {{{0.5, 0.5, 0.5}, 1.0, 0.0}, {{4, 0.3, 0.9}, 2.0, 0.0}, {{0.25, 0.5, 0.5}, 3.0, 0.0}};
    try {
        conform(c);
        ADD_FAILURE() << "accepted";
    } catch (const InputError& error) {
        ASSERT_EQ(error.defects().size(), 1u);
        const Defect& defect = error.defects()[0];
        EXPECT_EQ(defect.kind, DefectKind::conflicting_region_seeds);
        EXPECT_EQ(defect.place, (Point3{0.25, 0.5, 0.5}));
        EXPECT_NE(defect.message.find("seeds 1 and 3"), std::string::npos) << defect.message;
    }
}

TEST(ConformSeeds, MayNotLieOnFacets) {
    PiecewiseLinearComplex c = three_rooms();
    for (const Point3& p : {Point3{3, 0.5, 0.5}, {4, 0, 0.5}, {0, 0, 0}, {1, 1, 0.5}}) {
        c.region_seeds = {{p, 1.0, 0.0}};
        EXPECT_EQ(expect_refused(c), std::vector{DefectKind::region_seed_on_facet});
    }
}

TEST(ConformSeeds, FindRegionsOfCurvedShapes) {
    // Seeds at random places of nested cubes: the right one is known in closed form.
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        PiecewiseLinearComplex c = make_box({0, 0, 0}, {8, 8, 8});
        const double low = 1.0 + 0.3 * static_cast<double>(seed), high = 5.0 + 0.2 * static_cast<double>(seed);
        put_box(c, {low, low, low}, {high, high, high});
        c.region_seeds = {{{low - 1e-9, 4, 4}, 1.0, 0.0}, {{low + 1e-9, 4, 4}, 2.0, 0.0}};
        const ConformResult result = expect_conforms(c);
        EXPECT_EQ(result.region_attributes, (std::vector{0.0, 1.0, 2.0}));
    }
}

// --- facets, segments, sources ---

TEST(ConformLabels, FacetsKeepTheirAreas) {
    PiecewiseLinearComplex c;
    for (const Point3& p : {Point3{0, 0, 0},
                            {10, 0, 0},
                            {10, 10, 0},
                            {0, 10, 0},
                            {2, 2, 0},
                            {4, 2, 0},
                            {4, 5, 0},
                            {2, 5, 0},
                            {6, 6, 0},
                            {9, 6, 0},
                            {7, 9, 0},
                            {1, 8, 0},
                            {5, 1, 0},
                            {9, 1.5, 0}})
        put_point(c, p);
    put_facet(c, {{0, 1, 2, 3}, {4, 5, 6, 7}, {8, 9, 10}, {11}, {12, 13}}, {{3, 3, 0}});  // the second ring is no hole
    const std::uint32_t top = put_point(c, {5, 5, 6});
    put_facet(c, {{0, 1, top}});
    put_segment(c, top, 11);
    const ConformResult result = expect_conforms(c);
    EXPECT_NEAR(area_of(result.mesh, 0), 100.0 - 6.0, 1e-10);
    EXPECT_NEAR(area_of(result.mesh, 1), 0.5 * 10.0 * std::hypot(5.0, 6.0), 1e-10);
    for (std::uint32_t s = 0; s < result.segments.size(); ++s) {
        const Point3 a = c.positions[index_of(result.segments[s][0])], b = c.positions[index_of(result.segments[s][1])];
        EXPECT_NEAR(length_of(result.mesh, s), std::hypot(a.x - b.x, a.y - b.y, a.z - b.z), 1e-10);
    }
}

TEST(ConformLabels, SegmentsAreNumberedAsDocumented) {
    PiecewiseLinearComplex c;
    for (const Point3& p : {Point3{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {2, 2, 2}}) put_point(c, p);
    put_segment(c, 4, 3);
    put_segment(c, 1, 0);  // a side of facets, given against their direction
    for (const Ids& ring : {Ids{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}) put_facet(c, {ring});
    const ConformResult result = expect_conforms(c);
    const auto edge = [](std::uint32_t a, std::uint32_t b) { return Edge{VertexId{a}, VertexId{b}}; };
    EXPECT_EQ(result.segments,
              (std::vector{edge(4, 3), edge(1, 0), edge(0, 2), edge(2, 1), edge(1, 3), edge(3, 0), edge(2, 3)}));
    for (std::size_t e = 0; e < result.mesh.edges.size(); ++e) {
        const Edge& segment = result.segments[index_of(result.mesh.edge_segments[e])];
        const auto at = [&](VertexId v) { return result.mesh.positions[index_of(v)]; };
        const Point3 a = at(segment[0]), b = at(segment[1]), p = at(result.mesh.edges[e][0]),
                     q = at(result.mesh.edges[e][1]);
        EXPECT_GT((b.x - a.x) * (q.x - p.x) + (b.y - a.y) * (q.y - p.y) + (b.z - a.z) * (q.z - p.z), 0.0);
    }
}

TEST(ConformLabels, SourcesNameWhereSteinerPointsLie) {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        const PiecewiseLinearComplex c = generators::make_fan(9, 0.2, seed);
        const ConformResult result = expect_conforms(c);
        ASSERT_GT(steiner_points(result), 0u);
        std::set<std::pair<std::uint32_t, std::uint32_t>> on_segment, on_facet;  // (segment or facet, vertex)
        for (std::size_t e = 0; e < result.mesh.edges.size(); ++e) {
            for (const VertexId v : result.mesh.edges[e])
                on_segment.emplace(index_of(result.mesh.edge_segments[e]), index_of(v));
        }
        for (std::size_t t = 0; t < result.mesh.triangles.size(); ++t) {
            for (const VertexId v : result.mesh.triangles[t])
                on_facet.emplace(index_of(result.mesh.triangle_facets[t]), index_of(v));
        }
        for (std::uint32_t v = 0; v < result.mesh.positions.size(); ++v) {
            const VertexSource& source = result.mesh.vertex_sources[v];
            const auto& carried = source.origin == VertexOrigin::segment ? on_segment : on_facet;
            if (source.origin != VertexOrigin::input) {
                EXPECT_TRUE(carried.contains({source.index, v}));
            }
        }
        EXPECT_LE(result.statistics.max_displacement, 1e-15);
    }
}

TEST(ConformLabels, PointsOnFacetsAreAdopted) {
    PiecewiseLinearComplex c = make_box({0, 0, 0}, {1, 1, 1});
    const std::uint32_t p = put_point(c, {0.25, 0.5, 0.0}), q = put_point(c, {0.75, 0.5, 0.0});
    put_segment(c, p, q);  // lies in the floor without being listed there
    put_point(c, {1.0, 0.5, 0.25});
    const ConformResult result = expect_conforms(c);
    EXPECT_FALSE(result.warnings.empty());
    const auto is_corner_of_facet = [&](std::uint32_t v) {
        return std::any_of(result.mesh.triangles.begin(), result.mesh.triangles.end(),
                           [&](const Triangle& t) { return std::find(t.begin(), t.end(), VertexId{v}) != t.end(); });
    };
    for (const std::uint32_t v : {p, q, q + 1}) EXPECT_TRUE(is_corner_of_facet(v));
    EXPECT_NEAR(area_of(result.mesh, 0), 1.0, 1e-12);
}

TEST(ConformLabels, MarkersReachTheDocument) {
    PiecewiseLinearComplex c = three_rooms();
    put_segment(c, 0, 1);
    c.segment_markers = {-5};
    for (std::size_t f = 0; f < c.facet_count(); ++f) c.facet_markers.push_back(static_cast<std::int32_t>(100 + f / 4));
    for (std::size_t v = 0; v < c.positions.size(); ++v) c.point_markers.push_back(static_cast<std::int32_t>(v * v));
    c.region_seeds = {{{4, 0.5, 0.5}, 2.5, 0.0}};
    const ConformResult result = expect_conforms(c);
    const MeshDocument document = make_document(result.mesh, c, Reference::marker, result.region_attributes);
    ASSERT_EQ(document.complex.facet_markers.size(), result.mesh.triangles.size());
    for (std::size_t t = 0; t < result.mesh.triangles.size(); ++t)
        EXPECT_EQ(document.complex.facet_markers[t], c.facet_markers[index_of(result.mesh.triangle_facets[t])]);
    ASSERT_EQ(document.complex.segment_markers.size(), result.mesh.edges.size());
    for (std::size_t e = 0; e < result.mesh.edges.size(); ++e)
        EXPECT_EQ(document.complex.segment_markers[e], index_of(result.mesh.edge_segments[e]) == 0 ? -5 : 0);
    for (std::size_t v = 0; v < c.positions.size(); ++v)
        EXPECT_EQ(document.complex.point_markers[v], c.point_markers[v]);
}

TEST(ConformLabels, MergedFacetsAnswerToTheLowest) {
    const PiecewiseLinearComplex c = generators::make_cube(3, true);
    const ConformResult result = expect_conforms(c, {.merge_coplanar = true});
    std::set<std::uint32_t> facets;
    for (const FacetId f : result.mesh.triangle_facets) facets.insert(index_of(f));
    EXPECT_EQ(facets.size(), 6u);
    for (const std::uint32_t f : facets) EXPECT_NEAR(area_of(result.mesh, f), 1.0, 1e-12);
    EXPECT_TRUE(facets.contains(0));
}

TEST(ConformLabels, MergingStopsAtMarkersAndGivenSegments) {
    PiecewiseLinearComplex c = generators::make_cube(2, true);
    for (std::size_t f = 0; f < c.facet_count(); ++f) c.facet_markers.push_back(static_cast<std::int32_t>(f % 2));
    const ConformResult marked = expect_conforms(c, {.merge_coplanar = true});
    std::set<std::uint32_t> facets;
    for (const FacetId f : marked.mesh.triangle_facets) facets.insert(index_of(f));
    EXPECT_GT(facets.size(), 6u);
    PiecewiseLinearComplex d = make_box({0, 0, 0}, {1, 1, 1});
    const ConformResult plain = expect_conforms(d, {.merge_coplanar = true});
    EXPECT_EQ(steiner_points(plain), 0u);
    put_segment(d, 0, 3);  // the floor's diagonal, given: it must be there
    const ConformResult given = expect_conforms(d, {.merge_coplanar = true});
    EXPECT_NEAR(length_of(given.mesh, 0), std::sqrt(2.0), 1e-12);
}

}  // namespace
}  // namespace certa::test
