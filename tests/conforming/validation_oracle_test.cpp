// The validator against brute force: random triangles on a small integer grid, where every way to touch is common, are
// compared pair by pair with an oracle that clips in rational numbers; crowds of them with all their pairs; everything
// with itself under other threads, numberings and rotations of the axes.
#include <tbb/global_control.h>

#include <map>
#include <numeric>
#include <set>

#include "core/random.h"
#include "exact/orientation.h"
#include "oracle/intersection_oracle.h"
#include "validation_support.h"

namespace certa::test {
namespace {

using oracle::IntegerPoint;
using oracle::IntegerTriangle;
using oracle::Meeting;

IntegerPoint random_point(core::Random& random, long long size) {
    const auto next = [&] { return static_cast<long long>(random.below(size)); };
    const long long x = next(), y = next(), z = next();
    return {x, y, z};
}

IntegerTriangle random_triangle(core::Random& random, long long size) {
    for (;;) {
        const IntegerTriangle t{random_point(random, size), random_point(random, size), random_point(random, size)};
        const auto at = [&](int i) { return Point3{double(t[i][0]), double(t[i][1]), double(t[i][2])}; };
        if (!exact::are_collinear(at(0), at(1), at(2))) return t;
    }
}

/// Triangles as facets; equal points become one vertex.
PiecewiseLinearComplex complex_of(const std::vector<IntegerTriangle>& triangles) {
    std::map<IntegerPoint, std::uint32_t> ids;
    Builder builder({});
    for (const IntegerTriangle& t : triangles) {
        Ring ring;
        for (const IntegerPoint& p : t) {
            const auto [it, fresh] = ids.emplace(p, static_cast<std::uint32_t>(ids.size()));
            if (fresh) builder.complex.positions.push_back({double(p[0]), double(p[1]), double(p[2])});
            ring.push_back(it->second);
        }
        builder.facet({ring});
    }
    return builder.complex;
}

void expect_agreement(const IntegerTriangle& a, const IntegerTriangle& b) {
    const Meeting meeting = oracle::meet(a, b);
    const auto report = report_of(complex_of({a, b}));
    const std::string text = ::testing::PrintToString(a) + ::testing::PrintToString(b);
    EXPECT_EQ(report.ok(), meeting != Meeting::forbidden) << text << (report.ok() ? "" : report.defects[0].message);
    if (meeting == Meeting::nothing) {
        EXPECT_TRUE(report.notes.empty()) << text;
    }
    if (meeting == Meeting::point_inside) {
        EXPECT_EQ(report.adopted_points.size(), 1u) << text;
    }
    if (meeting == Meeting::side_inside) {
        EXPECT_EQ(report.adopted_segments.size(), 1u) << text;
    }
}

TEST(Oracle, AllWaysOfTwoTrianglesToMeet) {
    core::Random random(1);
    std::map<Meeting, int> seen;
    for (int i = 0; i < 60'000; ++i) {
        const long long size = 2 + static_cast<long long>(random.below(4));
        const IntegerTriangle a = random_triangle(random, size), b = random_triangle(random, size);
        if (std::set<IntegerPoint>(a.begin(), a.end()) == std::set<IntegerPoint>(b.begin(), b.end())) continue;
        ++seen[oracle::meet(a, b)];
        expect_agreement(a, b);
        if (HasFailure()) break;
    }
    for (const Meeting m : {Meeting::nothing, Meeting::point_inside, Meeting::side_inside, Meeting::forbidden}) {
        EXPECT_GT(seen[m], 30) << static_cast<int>(m);
    }
}

TEST(Oracle, CrowdsAreTheSumOfTheirPairs) {
    core::Random random(2);
    for (int round = 0; round < 60; ++round) {
        std::vector<IntegerTriangle> crowd;
        std::set<std::set<IntegerPoint>> known;
        while (crowd.size() < 30) {
            const IntegerTriangle t = random_triangle(random, 5 + round % 40);
            if (known.emplace(t.begin(), t.end()).second) crowd.push_back(t);
        }
        const auto complex = complex_of(crowd);
        std::set<std::pair<std::uint32_t, std::uint32_t>> expected, found;
        for (std::uint32_t i = 0; i < crowd.size(); ++i) {
            for (std::uint32_t j = i + 1; j < crowd.size(); ++j) {
                const auto pair = report_of(complex_of({crowd[i], crowd[j]}));
                for (const Defect& d : pair.defects) {
                    if (d.elements[0].kind == ElementKind::facet) expected.insert({i, j});
                }
            }
        }
        for (const Defect& d : report_of(complex).defects) {
            if (d.elements[0].kind == ElementKind::facet) found.insert({d.elements[0].index, d.elements[1].index});
        }
        EXPECT_EQ(found, expected) << "round " << round;
    }
}

TEST(Oracle, ThreadsAndNumbersLeaveNoTrace) {
    core::Random random(3);
    std::vector<IntegerTriangle> crowd;
    for (int i = 0; i < 2'000; ++i) crowd.push_back(random_triangle(random, 60));
    const auto report = report_of(complex_of(crowd));
    ASSERT_GT(report.defect_count, 1'000u);
    {
        const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
        const auto alone = report_of(complex_of(crowd));
        ASSERT_EQ(alone.defect_count, report.defect_count);
        for (std::size_t i = 0; i < alone.defects.size(); ++i) {
            ASSERT_EQ(alone.defects[i].message, report.defects[i].message);
            ASSERT_EQ(alone.defects[i].elements, report.defects[i].elements);
            ASSERT_EQ(alone.defects[i].place, report.defects[i].place);
        }
    }
    std::reverse(crowd.begin(), crowd.end());
    EXPECT_EQ(report_of(complex_of(crowd)).defect_count, report.defect_count);
    for (IntegerTriangle& t : crowd) {
        for (IntegerPoint& p : t) p = {-p[2], p[0], -p[1]};
    }
    EXPECT_EQ(report_of(complex_of(crowd)).defect_count, report.defect_count);
}

TEST(Predicates, AgreeWithIntegers) {
    core::Random random(4);
    int zeros = 0;
    for (int i = 0; i < 100'000; ++i) {
        const long long size = i % 2 == 0 ? 6 : 1ll << 30;
        std::array<IntegerPoint, 4> p;
        for (auto& q : p) q = random_point(random, size);
        // Nearly or exactly coplanar: the last point on the line through two others, up to one step.
        if (i % 3 == 0) {
            for (int k = 0; k < 3; ++k) p[3][k] = (p[1][k] + p[2][k]) / 2 + static_cast<long long>(random.below(2));
        }
        const auto at = [&](int j) { return Point3{double(p[j][0]), double(p[j][1]), double(p[j][2])}; };
        const int sign = oracle::volume_sign(p[0], p[1], p[2], p[3]);
        ASSERT_EQ(exact::orient3d(at(0), at(1), at(2), at(3)), sign);
        ASSERT_EQ(exact::orient3d(at(1), at(0), at(2), at(3)), -sign);
        zeros += sign == 0;
    }
    EXPECT_GT(zeros, 1'000);
}

TEST(Predicates, SurviveUnderflow) {
    const double tiny = 1e-200;
    EXPECT_EQ(exact::orient3d({0, 0, 0}, {tiny, 0, 0}, {0, tiny, 0}, {0, 0, tiny}), 1);
    EXPECT_EQ(exact::orient3d({0, 0, 0}, {tiny, 0, 0}, {0, tiny, 0}, {tiny, tiny, 0}), 0);
    EXPECT_EQ(exact::orient2d({0, 0}, {tiny, 0}, {0, tiny}), 1);
    EXPECT_EQ(exact::orient2d({0, 0}, {tiny, tiny}, {3 * tiny, 3 * tiny}), 0);
}

}  // namespace
}  // namespace certa::test
