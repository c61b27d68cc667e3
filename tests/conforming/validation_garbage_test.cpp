// Garbage in, a report out: random nonsense on small grids, where everything coincides, overlaps and degenerates, must
// neither crash nor hang nor throw, in validation, repair, triangulation and merging; and what repair claims to have
// mended must hold.
#include "conforming/merge_coplanar.h"
#include "core/random.h"
#include "validation_support.h"

namespace certa::test {
namespace {

Point3 random_place(core::Random& random, int size, bool flat) {
    const auto next = [&] { return static_cast<double>(random.below(size)); };
    const double x = next(), y = next(), z = flat ? 0.0 : next();
    const double noise = random.coin(0.1) ? 1e-16 : 0.0;
    return {x, y + noise, z};
}

PiecewiseLinearComplex random_nonsense(core::Random& random) {
    const int size = 2 + static_cast<int>(random.below(4));
    const bool flat = random.coin(0.3);
    const auto points = static_cast<std::uint32_t>(1 + random.below(12));
    Builder builder({});
    for (std::uint32_t i = 0; i < points; ++i) builder.complex.positions.push_back(random_place(random, size, flat));
    const auto vertex = [&] { return static_cast<std::uint32_t>(random.below(points)); };
    for (std::uint64_t i = random.below(4); i > 0; --i) builder.segment(vertex(), vertex());
    for (std::uint64_t i = random.below(6); i > 0; --i) {
        std::vector<Ring> polygons;
        for (std::uint64_t j = 1 + random.below(3); j > 0; --j) {
            Ring& ring = polygons.emplace_back();
            for (std::uint64_t k = random.below(6); k > 0; --k) ring.push_back(vertex());
        }
        std::vector<Point3> holes;
        if (random.coin(0.3)) holes.push_back(random_place(random, size, flat));
        builder.facet(polygons, holes);
    }
    if (random.coin(0.3)) builder.complex.region_seeds.push_back({random_place(random, size, flat), 1.0, 0.0});
    return builder.complex;
}

TEST(Garbage, IsReportedAndNothingElse) {
    core::Random random(7);
    int sound = 0, mended = 0;
    for (int round = 0; round < 6'000; ++round) {
        const PiecewiseLinearComplex input = random_nonsense(random);
        const auto report = report_of(input);
        for (const Defect& d : report.defects) ASSERT_FALSE(d.message.empty());
        const ConformOptions options{.triangulate = random.coin(), .repair = random.coin()};
        const RepairedComplex repaired = repair_complex(input, options);
        const auto after = report_of(repaired.complex, options);
        ASSERT_EQ(repaired.facet_sources.size(), repaired.complex.facet_count());
        if (report.ok()) {
            ++sound;
            ASSERT_TRUE(after.ok());
            ASSERT_EQ(repaired.complex.corners, input.corners);
            conforming::Complex complex = conforming::build_complex(input);
            conforming::adopt_elements(complex, report);
            const auto merged = conforming::merge_coplanar(complex, input.segments.size());
            ASSERT_EQ(merged.representatives.size(), input.facet_count());
        } else if (after.ok()) {
            ++mended;
            ASSERT_FALSE(repaired.repairs.empty());
        }
    }
    EXPECT_GT(sound, 50);
    EXPECT_GT(mended, 200);
}

/// Crossing triangles in general position have one obvious repair.
TEST(Garbage, CrowdsOfTrianglesAreMended) {
    core::Random random(8);
    int mended = 0;
    for (int round = 0; round < 60; ++round) {
        Builder crowd({});
        for (std::uint32_t i = 0; i < 12; ++i) {
            const Point3 c{random.uniform(), random.uniform(), random.uniform()};
            for (int j = 0; j < 3; ++j) {
                crowd.complex.positions.push_back({c.x + random.uniform(-0.3, 0.3), c.y + random.uniform(-0.3, 0.3),
                                                   c.z + random.uniform(-0.3, 0.3)});
            }
            crowd.facet({{3 * i, 3 * i + 1, 3 * i + 2}});
        }
        const ConformOptions options{.repair = true};
        const auto after = report_of(repair_complex(crowd.complex, options).complex, options);
        EXPECT_TRUE(after.ok()) << "round " << round << ": " << after.defects[0].message;
        mended += after.ok();
    }
    EXPECT_EQ(mended, 60);
}

}  // namespace
}  // namespace certa::test
