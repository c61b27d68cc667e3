// Every kind of defect by its smallest examples: which elements, where, and that the message names the way out.
#include <gmock/gmock.h>

#include <limits>

#include "validation_support.h"

namespace certa::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// A unit square in the plane z = 0 (points 1 to 4) and room for more points.
std::vector<Point3> square(std::vector<Point3> more = {}) {
    std::vector<Point3> points{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    points.insert(points.end(), more.begin(), more.end());
    return points;
}
const Ring whole{0, 1, 2, 3};

TEST(Structure, EmptyInput) { EXPECT_EQ(defects_of(PiecewiseLinearComplex{}), Strings{"empty_input"}); }

TEST(Structure, NumbersThatAreNone) {
    const Defect d = only_defect(report_of(Builder(square({{0, nan, 0}}))));
    EXPECT_EQ(summary_of(d), "non_finite_coordinate v5");
    EXPECT_THAT(d.message, HasSubstr("vertex 5"));
    EXPECT_EQ(defects_of(Builder(square({{0, 1e300 * 1e300, 0}}))), Strings{"non_finite_coordinate v5"});
    EXPECT_EQ(defects_of(Builder(square({{0, 1e60, 0}}))), Strings{"coordinate_out_of_range v5"});
    EXPECT_EQ(defects_of(Builder({{0, 0, 0}, {1e-60, 0, 0}})), Strings{"coordinate_out_of_range"});
    EXPECT_EQ(defects_of(Builder(square()).facet({whole}, {{nan, 0, 0}})), Strings{"non_finite_coordinate f1"});
    Builder seeds(square());
    seeds.complex.region_holes = {{0, 0, nan}};
    seeds.complex.region_seeds = {{{nan, 0, 0}, 1.0, 0.0}};
    EXPECT_EQ(defects_of(seeds), (Strings{"non_finite_coordinate", "non_finite_coordinate"}));
}

TEST(Structure, IndicesOutOfRange) {
    EXPECT_EQ(defects_of(Builder(square()).facet({{0, 1, 9}}).segment(0, 4)),
              (Strings{"index_out_of_range f1", "index_out_of_range s1"}));
}

TEST(Structure, ArraysThatDoNotFit) {
    Builder broken(square());
    broken.facet({whole});
    auto complex = broken.complex;
    complex.polygon_offsets.back() = 9;
    EXPECT_EQ(defects_of(complex), Strings{"index_out_of_range"});
    complex = broken.complex;
    complex.facet_offsets = {0, 2};
    EXPECT_EQ(defects_of(complex), Strings{"index_out_of_range"});
    complex = broken.complex;
    complex.hole_offsets = {0};
    EXPECT_EQ(defects_of(complex), Strings{"index_out_of_range"});
    complex = broken.complex;
    complex.polygon_offsets.clear();
    EXPECT_EQ(defects_of(complex), Strings{"index_out_of_range"});
    complex = broken.complex;
    complex.facet_markers = {1, 2};
    EXPECT_EQ(defects_of(complex), Strings{"index_out_of_range"});
}

TEST(Structure, DuplicatePoints) {
    const auto report = report_of(Builder(square({{1, 1, -0.0}, {2, 2, 0}})).facet({whole}).segment(4, 5));
    const Defect d = only_defect(report);
    EXPECT_EQ(summary_of(d), "duplicate_point v3 v5");
    EXPECT_EQ(d.place, (Point3{1, 1, 0}));
    EXPECT_THAT(d.message, HasSubstr("--repair"));
}

TEST(Structure, UnusedDuplicatesAreIgnored) {
    const auto report = report_of(Builder(square({{1, 1, 0}})).facet({whole}));
    EXPECT_TRUE(report.ok());
    EXPECT_THAT(report.ignored_points, ElementsAre(4u));
    EXPECT_THAT(summaries_of(report.notes), ElementsAre("duplicate_point v3 v5"));
    // The used one of two stays, whichever comes first.
    const auto other = report_of(Builder({{1, 1, 0}, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}}).facet({{1, 2, 3}}));
    EXPECT_TRUE(other.ok());
    EXPECT_THAT(other.ignored_points, ElementsAre(0u));
}

TEST(Structure, DegenerateSegments) {
    EXPECT_EQ(defects_of(Builder(square()).segment(2, 2)), Strings{"degenerate_segment s1 v3"});
    EXPECT_EQ(defects_of(Builder(square()).facet({whole, {2, 2}})), Strings{"degenerate_segment f1 v3"});
    EXPECT_EQ(defects_of(Builder(square({{1, 0, 0}})).segment(1, 4)),
              (Strings{"degenerate_segment s1 v2", "duplicate_point v2 v5"}));
}

TEST(Structure, RepeatedVertexInPolygon) {
    EXPECT_EQ(defects_of(Builder(square()).facet({{0, 1, 1, 2, 3}})), Strings{"repeated_vertex_in_polygon f1 v2"});
    EXPECT_EQ(defects_of(Builder(square()).facet({{0, 1, 2, 3, 0}})), Strings{"repeated_vertex_in_polygon f1 v1"});
}

TEST(Structure, FacetsWithoutArea) {
    const Defect d = only_defect(report_of(Builder({{0, 0, 0}, {1, 1, 1}, {3, 3, 3}}).facet({{0, 1, 2}})));
    EXPECT_EQ(summary_of(d), "degenerate_facet f1");
    // One unit in the last place off the line is a facet.
    const double up = std::nextafter(3.0, 4.0);
    EXPECT_THAT(defects_of(Builder({{0, 0, 0}, {1, 1, 1}, {3, 3, up}}).facet({{0, 1, 2}})), IsEmpty());
}

TEST(Structure, RepeatedFacets) {
    EXPECT_EQ(defects_of(Builder(square()).facet({{0, 1, 2}}).facet({{2, 1, 0}})), Strings{"repeated_facet f1 f2"});
    EXPECT_EQ(defects_of(Builder(square()).facet({{0, 1, 2, 3}}).facet({{2, 3, 0, 1}}).facet({{3, 2, 1, 0}})),
              (Strings{"repeated_facet f1 f2", "repeated_facet f1 f3"}));
}

TEST(Structure, RepeatedSegments) {
    EXPECT_EQ(defects_of(Builder(square()).segment(0, 1).segment(1, 2).segment(1, 0)),
              Strings{"overlapping_segments s1 s3"});
    // A side of a facet that is also given on its own is one segment.
    EXPECT_THAT(defects_of(Builder(square()).segment(0, 1).facet({whole})), IsEmpty());
}

TEST(Structure, AllDefectsInOneRun) {
    const auto report = report_of(Builder(square({{1, 1, 0}, {0.5, 0.5, -1}, {0.5, 0.5, 1}}))
                                      .facet({whole})
                                      .facet({{0, 1, 1}})
                                      .segment(4, 6)
                                      .segment(5, 6));
    EXPECT_EQ(summaries_of(report.defects),
              (Strings{"degenerate_facet f2", "duplicate_point v3 v5", "repeated_vertex_in_polygon f2 v2",
                       "segment_crosses_facet s2 f1"}));
}

TEST(SingleFacets, NonPlanar) {
    const Defect d = only_defect(report_of(Builder({{0, 0, 0}, {1, 0, 0}, {1, 1, 0.1}, {0, 1, 0}}).facet({whole})));
    EXPECT_EQ(d.kind, DefectKind::non_planar_facet);
    EXPECT_THAT(d.message, HasSubstr("--triangulate"));
    const Builder slightly = Builder({{0, 0, 0}, {1, 0, 0}, {1, 1, 1e-10}, {0, 1, 0}}).facet({whole});
    EXPECT_THAT(defects_of(slightly), IsEmpty());
    EXPECT_EQ(defects_of(slightly, {.planarity = {1e-12, true}}).size(), 1u);
}

TEST(SingleFacets, Open) {
    EXPECT_EQ(defects_of(Builder(square()).facet({{0, 1}, {1, 2}, {2, 3}, {3, 0}})), Strings{"open_facet f1"});
    EXPECT_EQ(defects_of(Builder(square()).facet({whole}, {{0.5, 0.5, 0}})), Strings{"open_facet f1"});
    // A spike has the facet on neither side.
    const Defect d = only_defect(report_of(Builder(square({{2, 1, 0}})).facet({{0, 1, 2, 4, 2, 3}})));
    EXPECT_EQ(summary_of(d), "open_facet f1 s3");
    EXPECT_EQ(d.place, (Point3{1.5, 1, 0}));
}

TEST(SingleFacets, EmptyFacetsAreNothing) { EXPECT_THAT(defects_of(Builder(square()).facet({})), IsEmpty()); }

TEST(SingleFacets, SelfCrossing) {
    const Defect d = only_defect(report_of(Builder(square()).facet({{0, 2, 1, 3}})));
    EXPECT_EQ(summary_of(d), "self_crossing_facet f1 s1 s3");
    EXPECT_EQ(d.place, (Point3{0.5, 0.5, 0}));
    // An isolated segment through a side.
    EXPECT_EQ(defects_of(Builder(square({{0.5, 0.5, 0}, {0.5, 2, 0}})).facet({whole, {4, 5}})),
              Strings{"self_crossing_facet f1 s3 s5"});
    // Two isolated segments.
    EXPECT_EQ(defects_of(Builder(square()).facet({whole, {0, 2}, {1, 3}})), Strings{"self_crossing_facet f1 s5 s6"});
}

TEST(SingleFacets, PointsOnOwnSides) {
    const Defect d = only_defect(report_of(Builder(square({{0.5, 0, 0}})).facet({whole, {4}})));
    EXPECT_EQ(summary_of(d), "point_on_segment v5 s1");
    EXPECT_EQ(d.place, (Point3{0.5, 0, 0}));
    EXPECT_EQ(defects_of(Builder(square({{0.5, 0, 1e-12}})).facet({whole, {4}})),
              Strings{"self_crossing_facet f1 v5 s1"});
    EXPECT_EQ(defects_of(Builder(square({{0.25, 0.25, 0}, {0.25, 0.25, 1e-12}})).facet({whole, {4}, {5}})),
              Strings{"self_crossing_facet f1 v5 v6"});
}

TEST(SingleFacets, ElementsOutside) {
    EXPECT_EQ(defects_of(Builder(square({{3, 0, 0}})).facet({whole, {4}})), Strings{"element_outside_facet f1 v5"});
    EXPECT_EQ(defects_of(Builder(square({{3, 0, 0}, {4, 1, 0}})).facet({whole, {4, 5}})),
              Strings{"element_outside_facet f1 s5"});
}

TEST(SingleFacets, HolesOutside) {
    const Defect d = only_defect(report_of(Builder(square()).facet({whole}, {{3, 0, 0}})));
    EXPECT_EQ(summary_of(d), "hole_outside_facet f1");
    EXPECT_EQ(d.place, (Point3{3, 0, 0}));
    EXPECT_EQ(defects_of(Builder(square()).facet({whole}, {{0.5, 0, 0}})), Strings{"hole_outside_facet f1"});
}

TEST(Segments, Crossing) {
    const Defect d = only_defect(report_of(Builder(square()).segment(0, 2).segment(1, 3)));
    EXPECT_EQ(summary_of(d), "crossing_segments s1 s2");
    EXPECT_EQ(d.place, (Point3{0.5, 0.5, 0}));
}

TEST(Segments, Overlapping) {
    EXPECT_EQ(defects_of(Builder({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}).segment(0, 2).segment(1, 3)),
              (Strings{"overlapping_segments s1 s2", "point_on_segment v2 s1", "point_on_segment v3 s2"}));
}

TEST(Segments, PointsOnThem) {
    const Defect d = only_defect(report_of(Builder({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}).segment(0, 2)));
    EXPECT_EQ(summary_of(d), "point_on_segment v2 s1");
    EXPECT_EQ(d.place, (Point3{1, 1, 1}));
    EXPECT_EQ(defects_of(Builder({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}, {1, -1, 1}, {0, -1, 0}})
                             .facet({{0, 2, 3}})
                             .facet({{1, 4, 5}})),
              Strings{"point_on_segment v2 s1"});
}

TEST(Segments, PointsNearThem) {
    const double up = std::nextafter(1.0, 2.0);
    const Defect d = only_defect(report_of(Builder({{0, 0, 0}, {1, 1, up}, {2, 2, 2}}).segment(0, 2)));
    EXPECT_EQ(summary_of(d), "point_near_segment v2 s1");
    EXPECT_EQ(d.place, (Point3{1, 1, up}));
    EXPECT_THAT(defects_of(Builder({{0, 0, 0}, {1, 1, 1 + 1e-13}, {2, 2, 2}}).segment(0, 2)), IsEmpty());
    // A T-junction that rounding hides, between two facets.
    const double eps = 1e-16;
    EXPECT_EQ(defects_of(Builder({{0, 0, 0}, {1, -eps, eps}, {2, 0, 0}, {1, 1, 0}, {1, -1, 1}, {0, -1, 0}})
                             .facet({{0, 2, 3}})
                             .facet({{1, 4, 5}})),
              Strings{"point_near_segment v2 s1"});
    // A very flat triangle fills it: nothing is wrong.
    EXPECT_THAT(defects_of(Builder({{0, 0, 0}, {1, -eps, eps}, {2, 0, 0}, {1, 1, 0}, {1, -1, 1}, {0, -1, 0}})
                               .facet({{0, 2, 3}})
                               .facet({{1, 4, 5}})
                               .facet({{0, 1, 2}})),
                IsEmpty());
}

TEST(FacetsAndSegments, Crossing) {
    const Defect d =
        only_defect(report_of(Builder(square({{0.25, 0.5, -1}, {0.25, 0.5, 3}})).facet({whole}).segment(4, 5)));
    EXPECT_EQ(summary_of(d), "segment_crosses_facet s1 f1");
    EXPECT_EQ(d.place, (Point3{0.25, 0.5, 0}));
}

TEST(FacetsAndSegments, ThroughASide) {
    EXPECT_EQ(defects_of(Builder(square({{0.5, 0, -1}, {0.5, 0, 1}})).facet({whole}).segment(4, 5)),
              Strings{"crossing_segments s1 s2"});
    EXPECT_EQ(defects_of(Builder(square({{0, 0, -1}, {0, 0, 1}})).facet({whole}).segment(4, 5)),
              Strings{"point_on_segment v1 s1"});
}

TEST(FacetsAndSegments, WhollyInAFacetIsAdopted) {
    const auto report = report_of(Builder(square({{0.25, 0.25, 0}, {0.5, 0.75, 0}})).facet({whole}).segment(4, 5));
    EXPECT_TRUE(report.ok());
    EXPECT_THAT(summaries_of(report.notes),
                ElementsAre("point_on_facet v5 f1", "point_on_facet v6 f1", "segment_in_facet s1 f1"));
    ASSERT_EQ(report.adopted_segments.size(), 1u);
    EXPECT_EQ(report.adopted_segments[0].segment, 0u);
    // A fin on the diagonal of a square: its side joins two corners of the facet.
    const auto fin = report_of(Builder(square({{0.5, 0.5, 1}})).facet({whole}).facet({{0, 2, 4}}));
    EXPECT_TRUE(fin.ok());
    EXPECT_THAT(summaries_of(fin.notes), ElementsAre("segment_in_facet s5 f1"));
}

TEST(FacetsAndSegments, PartlyInAFacet) {
    const auto defects = defects_of(Builder(square({{0.5, 0.5, 0}, {0.5, 2, 0}})).facet({whole}).segment(4, 5));
    EXPECT_EQ(defects, (Strings{"crossing_segments s1 s4", "segment_in_facet s1 f1"}));
}

TEST(FacetsAndSegments, WithinRoundingOfAFacet) {
    const double eps = 1e-16;
    EXPECT_EQ(defects_of(Builder(square({{0.25, 0.25, eps}, {0.5, 0.75, eps}})).facet({whole}).segment(4, 5)),
              (Strings{"point_near_facet v5 f1", "point_near_facet v6 f1", "segment_crosses_facet s1 f1"}));
    // Ends on the corners, the facet bent by rounding away from the segment between them.
    const auto defects = defects_of(
        Builder({{0, 0, eps}, {1, 0, 0}, {1, 1, eps}, {0, 1, 0}, {0.5, 0.5, 1}}).facet({whole}).facet({{0, 2, 4}}));
    EXPECT_TRUE(defects.empty() || defects == Strings{"segment_crosses_facet s5 f1"}) << defects.size();
}

TEST(FacetsAndPoints, OnAFacetIsAdopted) {
    const auto report = report_of(Builder(square({{0.5, 0.25, 0}, {2, 2, 2}})).facet({whole}));
    EXPECT_TRUE(report.ok());
    ASSERT_EQ(report.adopted_points.size(), 1u);
    EXPECT_EQ(report.adopted_points[0].point, 4u);
    EXPECT_EQ(report.adopted_points[0].facet, 0u);
    // A cone that stands on the facet with its apex.
    const auto cone =
        report_of(Builder(square({{0.5, 0.25, 0}, {0.5, 0, 1}, {1, 0, 1}})).facet({whole}).facet({{4, 5, 6}}));
    EXPECT_TRUE(cone.ok());
    EXPECT_THAT(summaries_of(cone.notes), ElementsAre("point_on_facet v5 f1"));
}

TEST(FacetsAndPoints, NearAFacet) {
    const Defect d = only_defect(report_of(Builder(square({{0.5, 0.25, 1e-16}})).facet({whole})));
    EXPECT_EQ(summary_of(d), "point_near_facet v5 f1");
    EXPECT_THAT(defects_of(Builder(square({{0.5, 0.25, 1e-13}})).facet({whole})), IsEmpty());
    // Listed there it is welcome.
    EXPECT_THAT(defects_of(Builder(square({{0.5, 0.25, 1e-16}})).facet({whole, {4}})), IsEmpty());
}

TEST(Facets, Crossing) {
    const Defect d = only_defect(report_of(Builder({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, -1}, {1, 1, 1}, {5, 5, 0}})
                                               .facet({{0, 1, 2}})
                                               .facet({{3, 4, 5}})));
    EXPECT_EQ(summary_of(d), "crossing_facets f1 f2");
    EXPECT_EQ(d.place.z, 0.0);
    EXPECT_EQ(d.place.x, 1.5);  // the middle of the intersection, from (1, 1, 0) to (2, 2, 0)
    EXPECT_EQ(d.place.y, 1.5);
}

TEST(Facets, CrossingFromACommonVertex) {
    EXPECT_EQ(
        defects_of(
            Builder({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {3, 1, -1}, {3, 2, 1}}).facet({{0, 1, 2}}).facet({{0, 3, 4}})),
        Strings{"crossing_facets f1 f2"});
    // The same on the far side of the vertex: they touch in it alone.
    EXPECT_THAT(defects_of(Builder({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {-3, -1, -1}, {-3, -2, 1}})
                               .facet({{0, 1, 2}})
                               .facet({{0, 3, 4}})),
                IsEmpty());
}

TEST(Facets, OverlappingInOnePlane) {
    EXPECT_EQ(defects_of(Builder({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, 0}, {5, 1, 0}, {5, 5, 0}})
                             .facet({{0, 1, 2}})
                             .facet({{3, 4, 5}})),
              Strings{"overlapping_facets f1 f2"});
    // Across a common side.
    EXPECT_EQ(defects_of(Builder({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 5, 0}}).facet({{0, 1, 2}}).facet({{0, 1, 3}})),
              Strings{"overlapping_facets f1 f2"});
    // One inside the other.
    const auto inside =
        report_of(Builder(square({{0.25, 0.25, 0}, {0.5, 0.25, 0}, {0.25, 0.5, 0}})).facet({whole}).facet({{4, 5, 6}}));
    EXPECT_EQ(summaries_of(inside.defects), Strings{"overlapping_facets f1 f2"});
}

TEST(Facets, OverlappingWithinRounding) {
    const double eps = 1e-16;
    const auto report = report_of(
        Builder(square({{0.25, 0.25, eps}, {0.5, 0.25, eps}, {0.25, 0.5, eps}})).facet({whole}).facet({{4, 5, 6}}));
    EXPECT_FALSE(report.ok());
    for (const Defect& d : report.defects) {
        EXPECT_TRUE(d.kind == DefectKind::point_near_facet || d.kind == DefectKind::segment_crosses_facet) << d.message;
    }
}

TEST(Regions, SeedsOnFacets) {
    Builder cube(square());
    cube.facet({whole});
    cube.complex.region_seeds = {{{0.5, 0.5, 0}, 1.0, 0.0}, {{0.5, 0.5, 0.5}, 1.0, 0.0}};
    cube.complex.region_holes = {{1, 1, 0}};
    const auto report = report_of(cube);
    EXPECT_EQ(summaries_of(report.defects), (Strings{"region_seed_on_facet f1", "region_seed_on_facet f1"}));
    EXPECT_THAT(report.defects[0].message, HasSubstr("region hole 1"));
    EXPECT_THAT(report.defects[1].message, HasSubstr("region seed 1"));
}

TEST(Report, KeepsTenThousandAndCountsAll) {
    std::vector<Point3> points;
    Builder comb({});
    for (std::uint32_t i = 0; i < 150; ++i) {
        comb.complex.positions.push_back({double(i), -1, 0});
        comb.complex.positions.push_back({double(i), 1000, 0});
        comb.complex.positions.push_back({-1, double(i), 0});
        comb.complex.positions.push_back({1000, double(i), 0});
        comb.segment(4 * i, 4 * i + 1).segment(4 * i + 2, 4 * i + 3);
    }
    const auto report = report_of(comb);
    EXPECT_EQ(report.defect_count, 150u * 150u);
    EXPECT_EQ(report.defects.size(), 10'000u);
}

TEST(Known, PairsOfKnownFacetsAreSkipped) {
    const Builder pair = Builder({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, -1}, {1, 1, 1}, {5, 5, 0}})
                             .facet({{0, 1, 2}})
                             .facet({{3, 4, 5}});
    const auto structure = conforming::validate_structure(pair.complex);
    const auto complex = conforming::build_complex(pair.complex);
    const std::vector<std::uint8_t> both{1, 1}, one{1, 0};
    EXPECT_TRUE(conforming::validate_geometry(pair.complex, complex, structure, {}, {both, {}}).ok());
    EXPECT_FALSE(conforming::validate_geometry(pair.complex, complex, structure, {}, {one, {}}).ok());
}

}  // namespace
}  // namespace certa::test
