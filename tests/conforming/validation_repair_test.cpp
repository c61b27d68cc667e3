// Repairs: each kind by its smallest example, what must not be repaired, and that nothing is renumbered or moved.
#include <gmock/gmock.h>

#include <cmath>

#include "validation_support.h"

namespace certa::test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

const ConformOptions repairing{.repair = true};

/// Repairs and checks what holds for every repair: points first and unchanged, facets keep their numbers, repairing
/// again changes nothing.
RepairedComplex repaired(const Builder& builder, const ConformOptions& options = repairing) {
    const PiecewiseLinearComplex& input = builder.complex;
    RepairedComplex result = repair_complex(input, options);
    EXPECT_GE(result.complex.positions.size(), input.positions.size());
    for (std::size_t v = 0; v < input.positions.size(); ++v) {
        EXPECT_EQ(result.complex.positions[v], input.positions[v]);
    }
    EXPECT_EQ(result.facet_sources.size(), result.complex.facet_count());
    for (std::uint32_t f = 0; f < input.facet_count(); ++f) EXPECT_EQ(result.facet_sources[f], FacetId{f});
    const RepairedComplex again = repair_complex(result.complex, options);
    EXPECT_EQ(again.complex.corners, result.complex.corners);
    EXPECT_EQ(again.complex.positions, result.complex.positions);
    return result;
}

void expect_mended(const Builder& builder, const std::vector<std::string>& repairs) {
    const RepairedComplex result = repaired(builder);
    EXPECT_THAT(defects_of(result.complex, repairing), IsEmpty());
    EXPECT_EQ(summaries_of(result.repairs), repairs);
}

TEST(Repair, LeavesHealthyComplexesAlone) {
    const Builder square = Builder({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}).facet({{0, 1, 2, 3}}).segment(0, 2);
    const RepairedComplex result = repaired(square);
    EXPECT_EQ(result.complex.corners, square.complex.corners);
    EXPECT_EQ(result.complex.segments, square.complex.segments);
    EXPECT_THAT(result.repairs, IsEmpty());
}

TEST(Repair, DoesNothingUnasked) {
    const Builder doubled = Builder({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}).facet({{0, 1, 2}}).facet({{1, 2, 0}});
    EXPECT_EQ(repair_complex(doubled.complex, {}).complex.corners, doubled.complex.corners);
}

TEST(Repair, RefusesWhatCannotBeRead) {
    EXPECT_THROW(repair_complex(Builder({{0, 0, 0}}).facet({{0, 1, 2}}).complex, repairing), InputError);
    EXPECT_THROW(repair_complex(Builder({{0, 0, std::nan("")}}).complex, repairing), InputError);
}

TEST(Repair, MergesDuplicatePoints) {
    const Builder twice = Builder({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}})
                              .facet({{0, 1, 2}})
                              .facet({{3, 5, 4}});
    expect_mended(twice, {"duplicate_point v2 v4", "duplicate_point v3 v5"});
    const auto report = report_of(repaired(twice).complex);
    EXPECT_THAT(report.ignored_points, ElementsAre(3u, 4u));
}

TEST(Repair, DropsWhatIsNothing) {
    expect_mended(
        Builder({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}})
            .facet({{0, 1, 2}})
            .facet({{2, 1, 0}})
            .facet({{0, 0, 1}})
            .segment(2, 2)
            .segment(1, 3)
            .segment(3, 1),
        {"degenerate_segment s1", "overlapping_segments s3", "repeated_facet f1 f2", "repeated_vertex_in_polygon f3"});
    // A triangle without area between two neighbours becomes a T-junction, and that is split.
    const Builder strip = Builder({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}, {1, -1, 0}})
                              .facet({{0, 2, 3}})
                              .facet({{0, 1, 2}})
                              .facet({{0, 4, 1}})
                              .facet({{1, 4, 2}});
    expect_mended(strip, {"degenerate_facet f2", "point_on_segment s1 v2"});
    EXPECT_EQ(repaired(strip).complex.facet_offsets, (std::vector<std::uint32_t>{0, 1, 1, 2, 3}));
}

TEST(Repair, SplitsTJunctions) {
    const Builder pair = Builder({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}, {1, -1, 1}, {0, -1, 0}})
                             .facet({{0, 2, 3}})
                             .facet({{1, 4, 5}});
    expect_mended(pair, {"point_on_segment s1 v2"});
    const RepairedComplex result = repaired(pair);
    const auto id = [](std::uint32_t v) { return VertexId{v}; };
    EXPECT_THAT(result.complex.corners, ElementsAre(id(0), id(1), id(2), id(3), id(1), id(4), id(5)));
    // Several on one segment that two facets share, in both directions; one of them within rounding.
    Builder many(
        {{0, 0, 0}, {4, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}, {3, 1e-16, 0}, {2, 0, 0}, {1, -1, -1}, {3, -1, -1}});
    many.facet({{0, 1, 2}}).facet({{1, 0, 3}}).facet({{4, 6, 7}}).facet({{6, 5, 8}});
    const RepairedComplex mended = repaired(many);
    EXPECT_THAT(defects_of(mended.complex), IsEmpty());
    EXPECT_EQ(mended.complex.polygon_offsets[1], 6u);
    EXPECT_EQ(mended.complex.polygon_offsets[2], 12u);
}

TEST(Repair, ListsPointsNearFacets) {
    expect_mended(Builder({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.25, 1e-16}}).facet({{0, 1, 2, 3}}),
                  {"point_near_facet f1 v5"});
}

TEST(Repair, MergesPointsWithinRounding) {
    // Valid as it is: the points differ. But where something is wrong, they go first.
    const double up = std::nextafter(1.0, 2.0);
    const std::vector<Point3> points{{0, 0, 0}, {1, 0, 0},      {up, 0, 0},    {0, 1, 0},
                                     {2, 1, 1}, {0.5, 0.5, -1}, {0.5, 0.25, 1}};
    const Builder sound = Builder(points).facet({{0, 1, 3}}).facet({{2, 4, 3}});
    EXPECT_THAT(repaired(sound).repairs, IsEmpty());
    Builder pierced = sound;
    pierced.segment(5, 6);
    const RepairedComplex result = repaired(pierced);
    EXPECT_THAT(defects_of(result.complex, repairing), IsEmpty());
    EXPECT_THAT(summaries_of(result.repairs), Contains("duplicate_point v2 v3"));
}

TEST(Repair, TrimsSpikes) {
    const std::vector<Point3> points{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 1, 0}, {3, 1, 0}};
    const auto id = [](std::uint32_t v) { return VertexId{v}; };
    for (const Ring& ring :
         {Ring{0, 1, 2, 4, 5, 4, 2, 3}, Ring{5, 4, 2, 3, 0, 1, 2, 4}, Ring{4, 2, 3, 0, 1, 2, 4, 5}}) {
        const Builder spike = Builder(points).facet({ring});
        expect_mended(spike, {"open_facet f1"});
        EXPECT_EQ(repaired(spike).complex.corners.size(), 4u);
    }
    const Builder nothing = Builder(points).facet({{0, 1, 2, 1}}).facet({{0, 1, 2, 3}});
    expect_mended(nothing, {"open_facet f1"});
    EXPECT_THAT(repaired(nothing).complex.corners, ElementsAre(id(0), id(1), id(2), id(3)));
}

TEST(Repair, CrossesSegments) {
    const Builder cross = Builder({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}).segment(0, 2).segment(1, 3);
    expect_mended(cross, {"crossing_segments s1 v5", "crossing_segments s2 v5"});
    EXPECT_EQ(repaired(cross).complex.positions[4], (Point3{0.5, 0.5, 0}));
    expect_mended(Builder({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}).segment(0, 2).segment(1, 3),
                  {"overlapping_segments s3", "point_on_segment s1 v2", "point_on_segment s2 v3"});
}

TEST(Repair, PiercedFacetsGetAPoint) {
    const Builder needle = Builder({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.25, 0.5, -1}, {0.25, 0.5, 3}})
                               .facet({{0, 1, 2, 3}})
                               .segment(4, 5);
    expect_mended(needle, {"crossing_facets s1 v7", "segment_crosses_facet f1 v7"});
    EXPECT_EQ(repaired(needle).complex.positions[6], (Point3{0.25, 0.5, 0}));
    EXPECT_EQ(repaired(needle).complex.segments.size(), 2u);
}

TEST(Repair, CrossingFacetsShareTheirIntersection) {
    const Builder crossing = Builder({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, -1}, {1, 1, 1}, {5, 5, 0}})
                                 .facet({{0, 1, 2}})
                                 .facet({{3, 4, 5}});
    const RepairedComplex result = repaired(crossing);
    EXPECT_THAT(defects_of(result.complex), IsEmpty());
    ASSERT_EQ(result.complex.positions.size(), 8u);
    const std::vector<Point3> made{result.complex.positions[6], result.complex.positions[7]};
    EXPECT_THAT(made, Contains(Point3{1, 1, 0}));
    EXPECT_THAT(made, Contains(Point3{2, 2, 0}));
    EXPECT_EQ(result.complex.facet_count(), 2u);
    EXPECT_EQ(result.complex.polygon_count(), 4u);  // each ring, and the segment in each
}

TEST(Repair, ThreeFacetsShareTheirCommonPoint) {
    // Three squares through the origin, each across the two others.
    Builder squares({{-1, -1, 0},
                     {1, -1, 0},
                     {1, 1, 0},
                     {-1, 1, 0},
                     {0, -1, -1},
                     {0, 1, -1},
                     {0, 1, 1},
                     {0, -1, 1},
                     {-1, 0, -1},
                     {1, 0, -1},
                     {1, 0, 1},
                     {-1, 0, 1}});
    squares.facet({{0, 1, 2, 3}}).facet({{4, 5, 6, 7}}).facet({{8, 9, 10, 11}});
    const RepairedComplex result = repaired(squares);
    EXPECT_THAT(defects_of(result.complex), IsEmpty());
    EXPECT_EQ(result.complex.positions.size(), 12u + 6u + 1u);
    EXPECT_THAT(result.complex.positions, Contains(Point3{0, 0, 0}));
}

TEST(Repair, CrossingPolygonsInManyPieces) {
    // Two L-shaped plates through each other: the intersection passes from piece to piece without a point in between.
    const Builder plates = Builder({{0, 0, 0},
                                    {3, 0, 0},
                                    {3, 1, 0},
                                    {1, 1, 0},
                                    {1, 3, 0},
                                    {0, 3, 0},
                                    {0.5, -1, -1},
                                    {0.5, 4, -1},
                                    {0.5, 4, 1},
                                    {0.5, -1, 1}})
                               .facet({{0, 1, 2, 3, 4, 5}})
                               .facet({{6, 7, 8, 9}});
    const RepairedComplex result = repaired(plates);
    EXPECT_THAT(defects_of(result.complex), IsEmpty());
    EXPECT_EQ(result.complex.positions.size(), 12u);
}

TEST(Repair, OverlapsHaveNoObviousMeaning) {
    const Builder overlap = Builder({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, 0}, {5, 1, 0}, {5, 5, 0}})
                                .facet({{0, 1, 2}})
                                .facet({{3, 4, 5}});
    EXPECT_THAT(defects_of(repaired(overlap).complex, repairing), Contains("overlapping_facets f1 f2"));
    const Builder bow = Builder({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}).facet({{0, 2, 1, 3}});
    EXPECT_THAT(defects_of(repaired(bow).complex, repairing), Contains(StartsWith("self_crossing_facet")));
}

TEST(Repair, KeepsMarkers) {
    Builder cross = Builder({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}).segment(0, 2).segment(1, 3);
    cross.complex.segment_markers = {5, 6};
    cross.complex.point_markers = {1, 2, 3, 4};
    const RepairedComplex result = repaired(cross);
    EXPECT_THAT(result.complex.segment_markers, ElementsAre(5, 5, 6, 6));
    EXPECT_THAT(result.complex.point_markers, ElementsAre(1, 2, 3, 4, 0));
}

TEST(Triangulate, CutsWhatIsNotPlanar) {
    Builder saddle({{0, 0, 0}, {1, 0, 0}, {1, 1, 1}, {0, 1, 0}, {2, 0, 0}, {2, 1, 0}});
    saddle.facet({{0, 1, 2, 3}}).facet({{1, 4, 5}});
    saddle.complex.facet_markers = {7, 8};
    const RepairedComplex result = repair_complex(saddle.complex, {.triangulate = true});
    EXPECT_EQ(result.complex.facet_count(), 3u);
    EXPECT_THAT(result.facet_sources, ElementsAre(FacetId{0}, FacetId{1}, FacetId{0}));
    EXPECT_THAT(result.complex.facet_markers, ElementsAre(7, 8, 7));
    EXPECT_THAT(defects_of(result.complex), IsEmpty());
    ASSERT_EQ(result.repairs.size(), 1u);
    EXPECT_THAT(result.repairs[0].message, HasSubstr("cut into 2 triangles"));
}

// A quad of a remeshed sphere, convex along its normal, which is nearest to y; seen along y its sides cross.
TEST(Triangulate, CutsWhatCrossesItselfAlongTheNearestAxis) {
    Builder warped({{-0.03121555, -0.19302615, 0.88357516},
                    {-0.16881552, -0.11040324, 0.88759386},
                    {-0.34678645, -0.0263303, 0.83566188},
                    {-0.35283226, -0.02883764, 0.83694136}});
    warped.facet({{0, 1, 2, 3}});
    const RepairedComplex result = repair_complex(warped.complex, {.triangulate = true});
    EXPECT_EQ(result.complex.facet_count(), 2u);
    EXPECT_THAT(defects_of(result.complex), IsEmpty());
}

}  // namespace
}  // namespace certa::test
