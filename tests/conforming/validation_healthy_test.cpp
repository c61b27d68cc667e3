// Valid complexes that look dangerous must pass, whole and turned so that no plane is along the axes; and the complex
// that the mesher gets is numbered, flagged and framed as docs/conventions.md says.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "conforming/merge_coplanar.h"
#include "core/vector3.h"
#include "mesh/generators.h"
#include "validation_support.h"

namespace certa::test {
namespace {

using conforming::build_complex;
using conforming::Complex;
using conforming::merge_coplanar;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr double degree = std::numbers::pi / 180.0;

/// As it is; turned; turned and far away.
void expect_healthy(const PiecewiseLinearComplex& complex, const std::string& name) {
    EXPECT_THAT(defects_of(complex), IsEmpty()) << name;
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
        EXPECT_THAT(defects_of(generators::make_moved(complex, seed)), IsEmpty()) << name << " turned " << seed;
        EXPECT_THAT(defects_of(generators::make_moved(complex, seed, {1e3, -2e3, 3e3})), IsEmpty())
            << name << " far " << seed;
    }
}

TEST(Healthy, Fans) {
    for (const double angle : {10.0, 0.1, 1e-3, 1e-5}) {
        expect_healthy(generators::make_fan(9, angle * degree, 1), "fan " + std::to_string(angle));
        expect_healthy(generators::make_book(5, angle * degree), "book " + std::to_string(angle));
        expect_healthy(generators::make_cone(9, angle * degree, 1), "cone " + std::to_string(angle));
    }
}

TEST(Healthy, SubdividedCubes) {
    // Every edge of the cube is a chain of points that are collinear up to rounding once it is turned, and the facets
    // are polygons that are flat up to rounding.
    for (const std::uint32_t n : {1u, 3u, 7u}) {
        expect_healthy(generators::make_cube(n, false), "squares " + std::to_string(n));
        expect_healthy(generators::make_cube(n, true), "triangles " + std::to_string(n));
    }
}

TEST(Healthy, LargeFacetsWithFinelyDividedSides) {
    // A prism of two 60-gons with 5 points on each side, and walls: each wall is one facet of 12 corners.
    Builder prism({});
    Ring bottom, top;
    for (int i = 0; i < 60; ++i) {
        for (int j = 0; j < 5; ++j) {
            const double a = 2 * std::numbers::pi * i / 60, b = 2 * std::numbers::pi * (i + 1) / 60, t = j / 5.0;
            const double x = (1 - t) * std::cos(a) + t * std::cos(b), y = (1 - t) * std::sin(a) + t * std::sin(b);
            bottom.push_back(static_cast<std::uint32_t>(prism.complex.positions.size()));
            prism.complex.positions.push_back({x, y, 0});
            top.push_back(static_cast<std::uint32_t>(prism.complex.positions.size()));
            prism.complex.positions.push_back({x, y, 1});
        }
    }
    prism.facet({bottom}).facet({top});
    for (std::size_t i = 0; i < 300; i += 5) {
        Ring wall;
        for (std::size_t j = 0; j <= 5; ++j) wall.push_back(bottom[(i + j) % 300]);
        for (std::size_t j = 6; j-- > 0;) wall.push_back(top[(i + j) % 300]);
        prism.facet({wall});
    }
    expect_healthy(prism.complex, "prism");
}

TEST(Healthy, PlatesAndCrowds) {
    expect_healthy(generators::make_plate(50, 20, 10, 1), "plate");
    expect_healthy(generators::make_near_facets(1e-6, 1), "near facets");
    expect_healthy(generators::make_coplanar_facets(5, 1), "coplanar facets");
    expect_healthy(generators::make_nested_cubes(4), "nested cubes");
    expect_healthy(generators::make_glued_tetrahedra(60, 1), "glued tetrahedra");
    expect_healthy(generators::make_flat_cloud(60, 1e-3, 1), "flat cloud");
    expect_healthy(generators::make_geology(8, 4, 1), "geology");
}

TEST(Healthy, TinyFeatures) {
    // Points one unit in the last place apart, joined by an edge: short, but no T-junction.
    const double up = std::nextafter(1.0, 2.0);
    EXPECT_THAT(defects_of(Builder({{1, 0, 0}, {up, 0, 0}, {0, 1, 0}, {2, 1, 1}, {1, -1, 1}})
                               .facet({{0, 1, 2}})
                               .facet({{1, 3, 2}})
                               .facet({{0, 4, 1}})),
                IsEmpty());
}

// The complex ---------------------------------------------------------------------------------------------------------

using SideList = std::vector<std::pair<std::uint32_t, bool>>;
SideList sides_of(const Complex& complex, std::uint32_t facet) {
    SideList list;
    for (const conforming::Side& side : complex.facet_sides[facet]) list.emplace_back(side.segment, side.boundary);
    return list;
}
constexpr bool bounds = true, inner = false;

const std::vector<Point3> annulus{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {1, 1, 0},
                                  {3, 1, 0}, {3, 3, 0}, {1, 3, 0}, {2, 2, 0}, {0.5, 0.5, 0}};
const Ring outer_ring{0, 1, 2, 3}, inner_ring{4, 5, 6, 7};

TEST(BuildComplex, NumbersSegments) {
    const Complex c = build_complex(
        Builder(annulus).segment(8, 9).segment(5, 4).facet({outer_ring, inner_ring, {9}}, {{2, 2, 0}}).complex);
    using Ends = std::array<std::uint32_t, 2>;
    EXPECT_THAT(c.segments, ElementsAre(Ends{8, 9}, Ends{5, 4}, Ends{0, 1}, Ends{1, 2}, Ends{2, 3}, Ends{3, 0},
                                        Ends{5, 6}, Ends{6, 7}, Ends{7, 4}));
    EXPECT_EQ(
        sides_of(c, 0),
        (SideList{
            {2, bounds}, {3, bounds}, {4, bounds}, {5, bounds}, {1, bounds}, {6, bounds}, {7, bounds}, {8, bounds}}));
    EXPECT_THAT(std::vector<std::uint32_t>(c.facet_points[0].begin(), c.facet_points[0].end()), ElementsAre(9u));
    EXPECT_THAT(std::vector<std::uint32_t>(c.point_segments[4].begin(), c.point_segments[4].end()),
                ElementsAre(1u, 8u));
    EXPECT_TRUE(c.segment_facets[0].empty());
    EXPECT_EQ(c.point_facets[9].size(), 1u);
    EXPECT_TRUE(c.point_facets[8].empty());
    EXPECT_EQ(c.diagonal, std::hypot(4, 4));
}

TEST(BuildComplex, RingsWithoutHolePointsAreInner) {
    const Complex c = build_complex(Builder(annulus).facet({outer_ring, inner_ring, {8}}).complex);
    EXPECT_EQ(
        sides_of(c, 0),
        (SideList{{0, bounds}, {1, bounds}, {2, bounds}, {3, bounds}, {4, inner}, {5, inner}, {6, inner}, {7, inner}}));
}

TEST(BuildComplex, BridgesAndIsolatedSegmentsAreInner) {
    // One ring that walks to the inner square and back; a hole point makes it a hole.
    const Complex c = build_complex(Builder(annulus).facet({{0, 1, 2, 3, 0, 4, 7, 6, 5, 4}}, {{2, 2, 0}}).complex);
    EXPECT_EQ(sides_of(c, 0), (SideList{{0, bounds},
                                        {1, bounds},
                                        {2, bounds},
                                        {3, bounds},
                                        {4, inner},
                                        {5, bounds},
                                        {6, bounds},
                                        {7, bounds},
                                        {8, bounds}}));
    const Complex d = build_complex(Builder(annulus).facet({outer_ring, {4, 6}, {0, 1}}).complex);
    EXPECT_EQ(sides_of(d, 0), (SideList{{0, bounds}, {1, bounds}, {2, bounds}, {3, bounds}, {4, inner}}));
}

TEST(BuildComplex, FramesAreOrthonormalEvenForNeedles) {
    const double up = std::nextafter(1.0, 2.0);
    for (const Point3& tip : {Point3{0.3, 2, -1}, Point3{0.5, 0.5, up - 0.5}, Point3{1e-9, 1e-9, 2e-9}}) {
        const std::vector<Point3> points{{0, 0, 0}, {1, 1, 1}, tip};
        const Complex c = build_complex(Builder(points).facet({{0, 1, 2}}).complex);
        const conforming::Frame& f = c.frames[0];
        EXPECT_NEAR(norm(f.normal), 1, 1e-15);
        EXPECT_NEAR(norm(f.u), 1, 1e-15);
        EXPECT_NEAR(distance(cross(f.u, f.v), f.normal), 0, 1e-15);
        for (const Point3& p : points) EXPECT_NEAR(dot(p - f.origin, f.normal), 0, 1e-15);
        const Point3 expected = cross(points[1], tip);
        EXPECT_NEAR(dot(f.normal, expected) / norm(expected), 1, 1e-12);
    }
}

TEST(BuildComplex, FromMeshes) {
    const std::vector<Point3> points{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    const auto v = [](std::uint32_t i) { return VertexId{i}; };
    const auto quads = make_complex(PolygonMesh{points, {v(0), v(1), v(2), v(3)}, {0, 4}});
    EXPECT_EQ(quads.facet_count(), 1u);
    EXPECT_THAT(defects_of(quads), IsEmpty());
    const auto triangles = make_complex(TriangleMesh{points, {{v(0), v(1), v(2)}, {v(0), v(2), v(3)}}});
    EXPECT_EQ(triangles.facet_count(), 2u);
    EXPECT_EQ(triangles.hole_offsets.size(), 3u);
    EXPECT_EQ(build_complex(triangles).segments.size(), 5u);
}

TEST(Adoption, ReachesTheComplex) {
    const Builder fin =
        Builder({{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {1, 1, 0}, {2, 1, 0}, {1, 1, 1}, {3, 3, 0}})
            .facet({{0, 1, 2, 3}, {4}})
            .facet({{4, 5, 6}});
    Complex c = build_complex(fin.complex);
    const auto report = report_of(fin);
    ASSERT_TRUE(report.ok());
    conforming::adopt_elements(c, report);
    EXPECT_EQ(sides_of(c, 0), (SideList{{0, bounds}, {1, bounds}, {2, bounds}, {3, bounds}, {4, inner}}));
    EXPECT_THAT(std::vector<std::uint32_t>(c.facet_points[0].begin(), c.facet_points[0].end()), ElementsAre(7u));
    EXPECT_EQ(c.segment_facets[4].size(), 2u);
    EXPECT_EQ(c.point_facets[7].size(), 1u);
}

// Merging -------------------------------------------------------------------------------------------------------------

std::size_t count_groups(const conforming::MergedComplex& merged) {
    std::size_t groups = 0;
    for (std::uint32_t f = 0; f < merged.representatives.size(); ++f) groups += merged.representatives[f] == f;
    return groups;
}

TEST(MergeCoplanar, CubesHaveSixFaces) {
    const auto input = generators::make_cube(3, true);
    const Complex c = build_complex(input);
    const auto merged = merge_coplanar(c, 0);
    EXPECT_EQ(count_groups(merged), 6u);
    for (std::uint32_t f = 0; f < c.facet_sides.size(); ++f) {
        if (merged.representatives[f] != f) {
            EXPECT_TRUE(merged.complex.facet_sides[f].empty());
            EXPECT_LT(merged.representatives[f], f);
            continue;
        }
        EXPECT_EQ(merged.complex.facet_sides[f].size(), 12u);
        EXPECT_EQ(merged.complex.facet_points[f].size(), 4u);
        for (const auto& side : merged.complex.facet_sides[f]) EXPECT_TRUE(side.boundary);
        EXPECT_GT(dot(merged.complex.frames[f].normal, c.frames[f].normal), 0.999);
    }
    EXPECT_EQ(merged.complex.segments, c.segments);
    std::size_t used = 0;
    for (std::uint32_t s = 0; s < c.segments.size(); ++s) {
        EXPECT_EQ(merged.dropped_segments[s] != 0, merged.complex.segment_facets[s].empty());
        used += merged.dropped_segments[s] == 0;
    }
    EXPECT_EQ(used, 36u);
    std::size_t ends = 0;
    for (std::uint32_t v = 0; v < c.points.size(); ++v) ends += merged.complex.point_segments[v].size();
    EXPECT_EQ(ends, 72u);
}

TEST(MergeCoplanar, WhatHoldsOnToASideKeepsIt) {
    const std::vector<Point3> points{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}};
    const Builder plain = Builder(points).facet({{0, 1, 2}}).facet({{0, 2, 3}});
    EXPECT_EQ(count_groups(merge_coplanar(build_complex(plain.complex), 0)), 1u);
    // A given segment, a third facet, another marker, a point off the plane.
    const Builder given = Builder(points).segment(2, 0).facet({{0, 1, 2}}).facet({{0, 2, 3}});
    EXPECT_EQ(count_groups(merge_coplanar(build_complex(given.complex), 1)), 2u);
    const Builder fin = Builder(points).facet({{0, 1, 2}}).facet({{0, 2, 3}}).facet({{0, 2, 4}});
    EXPECT_EQ(count_groups(merge_coplanar(build_complex(fin.complex), 0)), 3u);
    Builder marked = plain;
    marked.complex.facet_markers = {1, 2};
    EXPECT_EQ(count_groups(merge_coplanar(build_complex(marked.complex), 0)), 2u);
    auto bent = points;
    bent[3].z = 1e-300;
    EXPECT_EQ(
        count_groups(merge_coplanar(build_complex(Builder(bent).facet({{0, 1, 2}}).facet({{0, 2, 3}}).complex), 0)),
        2u);
}

TEST(MergeCoplanar, SidesBetweenTheSameGroupStayInnerWhenHeld) {
    // A square in four triangles around its centre, with a given segment on one spoke.
    const Builder square = Builder({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {1, 1, 0}})
                               .segment(4, 0)
                               .facet({{0, 1, 4}})
                               .facet({{1, 2, 4}})
                               .facet({{2, 3, 4}})
                               .facet({{3, 0, 4}});
    const auto merged = merge_coplanar(build_complex(square.complex), 1);
    EXPECT_EQ(count_groups(merged), 1u);
    EXPECT_EQ(sides_of(merged.complex, 0), (SideList{{0, inner}, {1, bounds}, {3, bounds}, {5, bounds}, {7, bounds}}));
    EXPECT_TRUE(merged.complex.facet_points[0].empty());
}

}  // namespace
}  // namespace certa::test
