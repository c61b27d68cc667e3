// The generators keep their promises: valid complexes (by the exact validator of another room), the shapes their names
// say, and the same bytes for the same seed.
#include "mesh/generators.h"

#include <certa/conforming.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <set>

#include "conforming/build_complex.h"
#include "conforming/validate.h"
#include "core/random.h"

namespace certa::generators {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

void expect_valid(const PiecewiseLinearComplex& input, const std::string& name) {
    const auto report = conforming::validate(input, {});
    EXPECT_EQ(report.defect_count, 0u) << name << ": " << (report.defects.empty() ? "" : report.defects[0].message);
    EXPECT_TRUE(report.notes.empty()) << name << ": " << (report.notes.empty() ? "" : report.notes[0].message);
}

struct Family {
    std::string name;
    std::function<PiecewiseLinearComplex(std::uint64_t seed)> make;
};

std::vector<Family> families() {
    std::vector<Family> all;
    for (const double angle : {360.0, 90.0, 1.0, 0.001}) {
        const double width = angle * degree;
        const std::string at = " " + std::to_string(angle);
        all.push_back({"fan" + at, [=](std::uint64_t s) { return make_fan(12, width, s); }});
        all.push_back({"book" + at, [=](std::uint64_t s) { return make_book(2 + s % 9, 0.9 * width); }});
        if (width < 2) all.push_back({"cone" + at, [=](std::uint64_t s) { return make_cone(30, width, s); }});
    }
    all.push_back({"star", [](std::uint64_t s) { return make_star(40, 2.0, s); }});
    all.push_back({"umbrella", [](std::uint64_t s) { return make_umbrella(7 + s % 8, s); }});
    all.push_back({"wedge", [](std::uint64_t s) { return make_wedge((1.0 + 17.0 * double(s)) * degree, s % 2 == 0); }});
    all.push_back({"cube", [](std::uint64_t s) { return make_cube(1 + s % 5, s % 2 == 0); }});
    all.push_back({"nested", [](std::uint64_t s) { return make_nested_cubes(1 + s % 5); }});
    all.push_back({"plate", [](std::uint64_t s) { return make_plate(50, 20, 10, s); }});
    all.push_back({"near", [](std::uint64_t s) { return make_near_facets(1e-6, s); }});
    all.push_back({"coplanar", [](std::uint64_t s) { return make_coplanar_facets(6, s); }});
    all.push_back({"glued", [](std::uint64_t s) { return make_glued_tetrahedra(40, s); }});
    all.push_back({"cloud", [](std::uint64_t s) { return make_flat_cloud(80, 0.01, s); }});
    all.push_back({"soup", [](std::uint64_t s) { return make_soup(60, s); }});
    all.push_back({"mixture", [](std::uint64_t s) { return make_mixture(s); }});
    all.push_back({"geology", [](std::uint64_t s) { return make_geology(12, 5, s); }});
    return all;
}

TEST(Generators, MakeValidComplexes) {
    for (const Family& family : families()) {
        for (std::uint64_t seed = 1; seed <= 8; ++seed) {
            expect_valid(family.make(seed), family.name + ", seed " + std::to_string(seed));
        }
    }
}

TEST(Generators, AreJudgedByAValidatorThatRefuses) {
    PiecewiseLinearComplex crossing = make_wedge(1.0, false);
    crossing.positions.push_back({0.5, 0.3, 0.5});
    crossing.positions.push_back({0.5, -0.3, 0.5});
    crossing.positions.push_back({0.6, -0.3, 0.6});
    add_facet(crossing, {{VertexId{4}, VertexId{5}, VertexId{6}}});
    EXPECT_GT(conforming::validate(crossing, {}).defect_count, 0u);
}

TEST(Generators, StayValidWhenMoved) {
    for (const Family& family : families()) {
        if (family.name == "near") continue;  // 1e-6 apart is not apart in coordinates of 1e6
        const PiecewiseLinearComplex still = family.make(5);
        const PiecewiseLinearComplex moved = make_moved(still, 17, {1e3, -2e3, 3e3});
        ASSERT_EQ(still.positions.size(), moved.positions.size());
        expect_valid(moved, family.name);
        for (std::size_t i = 1; i < still.positions.size(); ++i) {  // lengths are kept
            const auto distance = [&](const PiecewiseLinearComplex& c) {
                const Point3 &p = c.positions[i], &q = c.positions[i - 1];
                return std::hypot(p.x - q.x, p.y - q.y, p.z - q.z);
            };
            EXPECT_NEAR(distance(still), distance(moved), 1e-11);
        }
    }
}

TEST(Generators, AreDeterministic) {
    for (const Family& family : families()) {
        const PiecewiseLinearComplex a = family.make(3), b = family.make(3), c = family.make(4);
        EXPECT_EQ(a.positions, b.positions) << family.name;
        EXPECT_EQ(a.corners, b.corners) << family.name;
        EXPECT_TRUE(a.positions != c.positions || a.corners != c.corners) << family.name;
    }
}

TEST(Random, IsTheSameEverywhere) {
    core::Random random(42);  // SplitMix64's published recurrence, evaluated independently
    EXPECT_EQ(random.next(), 0xbdd732262feb6e95ull);
    EXPECT_EQ(random.next(), 0x28efe333b266f103ull);
    core::Random other(7);
    std::array<int, 6> counts{};
    for (int i = 0; i < 6000; ++i) ++counts[other.below(6)];
    for (const int n : counts) EXPECT_NEAR(n, 1000, 150);
    for (int i = 0; i < 1000; ++i) {
        const double u = other.uniform();
        EXPECT_TRUE(u >= 0.0 && u < 1.0);
    }
}

TEST(Fan, DiffersInNothingButTheAngle) {
    const auto wide = make_fan(20, 90 * degree, 6), thin = make_fan(20, 0.001 * degree, 6);
    ASSERT_EQ(wide.positions.size(), 42u);
    EXPECT_EQ(wide.facet_count(), 20u);
    EXPECT_EQ(wide.corners, thin.corners);
    for (std::size_t i = 2; i < wide.positions.size(); ++i) {
        const Point3 &p = wide.positions[i], &q = thin.positions[i];
        EXPECT_EQ(p.z, q.z);
        EXPECT_NEAR(std::hypot(p.x, p.y), std::hypot(q.x, q.y), 1e-15);
        EXPECT_NEAR(std::atan2(p.y, p.x), 9e4 * std::atan2(q.y, q.x), 1e-9);
        EXPECT_GT(std::atan2(q.y, q.x), 0.0);
        EXPECT_LT(std::atan2(p.y, p.x), 90 * degree);
    }
}

TEST(Cone, KeepsWithinItsAngle) {
    for (const double width : {1.0, 0.01, 1e-5}) {
        const auto cone = make_cone(50, width, 3);
        ASSERT_EQ(cone.positions.size(), 101u);
        for (std::size_t i = 1; i < cone.positions.size(); ++i) {
            const Point3& p = cone.positions[i];
            EXPECT_LE(std::atan2(std::hypot(p.x, p.y), p.z), width / 2);
        }
    }
}

TEST(Cube, HasItsCounts) {
    for (const std::uint32_t n : {1u, 2u, 7u}) {
        EXPECT_EQ(make_cube(n, false).positions.size(), 6 * n * n + 2);
        EXPECT_EQ(make_cube(n, false).facet_count(), 6 * n * n);
        EXPECT_EQ(make_cube(n, true).facet_count(), 12 * n * n);
    }
}

/// Six times the signed volume under outward facets.
double volume6(const PiecewiseLinearComplex& c) {
    double sum = 0;
    for (std::uint32_t p = 0; p < c.polygon_count(); ++p) {
        const std::uint32_t begin = c.polygon_offsets[p];
        const auto at = [&](std::uint32_t i) { return c.positions[index_of(c.corners[i])]; };
        for (std::uint32_t i = begin + 1; i + 1 < c.polygon_offsets[p + 1]; ++i) {
            const Point3 a = at(begin), b = at(i), d = at(i + 1);
            sum += a.x * (b.y * d.z - b.z * d.y) + a.y * (b.z * d.x - b.x * d.z) + a.z * (b.x * d.y - b.y * d.x);
        }
    }
    return sum;
}

TEST(Cube, FacesOutwards) {
    EXPECT_NEAR(volume6(make_cube(4, false)), 6.0, 1e-12);
    EXPECT_NEAR(volume6(make_cube(4, true)), 6.0, 1e-12);
    EXPECT_GT(volume6(make_nested_cubes(1)), 5.9);
}

TEST(NestedCubes, ShareTheOriginOnly) {
    const auto cubes = make_nested_cubes(4);
    EXPECT_EQ(cubes.positions.size(), 1 + 4 * 7u);
    EXPECT_EQ(cubes.facet_count(), 24u);
    EXPECT_EQ(std::count(cubes.corners.begin(), cubes.corners.end(), VertexId{0}), 12);
}

TEST(GluedTetrahedra, MeetInAllWays) {
    // Facets with the same four neighbours: count by how many tetrahedra's faces share an edge or vertex.
    const auto glued = make_glued_tetrahedra(60, 5);
    EXPECT_LT(glued.facet_count(), 4 * 60u);  // some are glued by faces, which are listed once
    EXPECT_GT(glued.facet_count(), 2 * 60u);
    const auto complex = conforming::build_complex(glued);
    std::set<std::size_t> valences;
    for (std::size_t s = 0; s < complex.segments.size(); ++s) valences.insert(complex.segment_facets[s].size());
    EXPECT_TRUE(valences.contains(2));  // the edge of one tetrahedron
    EXPECT_TRUE(valences.contains(3) || valences.contains(4));
}

TEST(Geology, IsAClosedBoxWithPinchOuts) {
    const auto input = make_geology(20, 5, 9);
    const auto complex = conforming::build_complex(input);
    std::size_t branching = 0;  // where a layer pinches out inside the box, three triangles meet
    for (std::size_t s = 0; s < complex.segments.size(); ++s) {
        const auto facets = complex.segment_facets[s];
        EXPECT_GE(facets.size(), 2u);  // no free edge
        bool horizons = true;
        for (const std::uint32_t f : facets) horizons &= std::abs(complex.frames[f].normal.z) > 1e-9;
        branching += horizons && facets.size() >= 3;
    }
    EXPECT_GT(branching, 20u);
    const std::size_t columns = 21 * 21;
    EXPECT_LT(input.positions.size(), 6 * columns);  // some vertices are shared by two horizons
    EXPECT_GT(input.positions.size(), 3 * columns);
    std::size_t horizon_triangles = 0;
    for (const auto& frame : complex.frames) horizon_triangles += std::abs(frame.normal.z) > 1e-9;
    EXPECT_LT(horizon_triangles, 2u * 20 * 20 * 6);  // triangles that two horizons have in common are there once
    EXPECT_GT(horizon_triangles, 2u * 20 * 20 * 3);
}

TEST(Geology, GrowsToItsSize) { EXPECT_NEAR(double(make_geology(100, 6, 1).facet_count()), 1.1e5, 2e4); }

TEST(FlatCloud, CoversItsHullOnce) {
    const auto cloud = make_flat_cloud(300, 0.0, 4);
    // Triangles are counter-clockwise in the plane, and Euler's formula gives their number from the hull's.
    double area2 = 0;
    std::map<std::pair<VertexId, VertexId>, int> edges;
    for (std::uint32_t f = 0; f < cloud.facet_count(); ++f) {
        const auto corner = [&](std::uint32_t i) { return cloud.corners[3 * f + i % 3]; };
        const Point3 a = cloud.positions[index_of(corner(0))], b = cloud.positions[index_of(corner(1))],
                     c = cloud.positions[index_of(corner(2))];
        const double turn = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        EXPECT_GT(turn, 0.0);
        area2 += turn;
        for (std::uint32_t i = 0; i < 3; ++i) ++edges[{corner(i), corner(i + 1)}];
    }
    std::size_t hull = 0;
    for (const auto& [edge, count] : edges) {
        EXPECT_EQ(count, 1);
        hull += !edges.contains({edge.second, edge.first});
    }
    EXPECT_EQ(cloud.facet_count(), 2 * 300 - 2 - hull);
    EXPECT_LT(area2, 2.0);
    EXPECT_GT(area2, 1.8);
}

}  // namespace
}  // namespace certa::generators
