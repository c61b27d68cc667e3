// `conform` on every family of generators.h: finished, verified by the independent checker, and with as few points as
// the families' geometry allows. Fans and books are the hard ones for others: here the angle must not matter.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "conforming/conform_support.h"
#include "mesh/generators.h"

namespace certa::test {
namespace {

using namespace generators;
constexpr double degree = std::numbers::pi / 180.0;

struct Tally {
    std::size_t cases = 0, done = 0;
};

/// Runs each family with the seeds in [first, last).
Tally run_families(std::uint64_t first, std::uint64_t last, const ConformOptions& options,
                   const std::function<PiecewiseLinearComplex(PiecewiseLinearComplex, std::uint64_t)>& change = {}) {
    Tally tally;
    for (const Family& family : small_families()) {
        // What lies near to a facet enters its triangles' diametral balls, until these are as small as the gap.
        const bool near = family.name.starts_with("near") || family.name.starts_with("cone");
        if (options.gabriel && near) continue;
        for (std::uint64_t seed = first; seed < last; ++seed) {
            SCOPED_TRACE(family.name + ", seed " + std::to_string(seed));
            PiecewiseLinearComplex complex = family.make(seed);
            if (change) complex = change(std::move(complex), seed);
            const bool may_stop = family.hard || (family.sharp && options.protection != Protection::needed);
            const ConformResult result =
                may_stop ? expect_conforms_or_says_where(complex, options) : expect_conforms(complex, options);
            if (may_stop && !family.hard) continue;
            ++tally.cases;
            tally.done += result.outcome == Outcome::done ? 1 : 0;
            if (::testing::Test::HasFatalFailure()) return tally;
        }
    }
    return tally;
}

/// Few enough of the hard ones may stop with a place.
void expect_mostly_done(const Tally& tally, double share = 0.98) {
    EXPECT_GE(static_cast<double>(tally.done), share * static_cast<double>(tally.cases))
        << tally.done << " of " << tally.cases;
}
const ConformOptions gabriel{.gabriel = true, .max_points = 30'000};

TEST(ConformFamilies, AreMeshed) { expect_mostly_done(run_families(1, 9, {})); }

TEST(ConformFamilies, AreMeshedWhereverTheyLie) {
    expect_mostly_done(run_families(101, 105, {}, [](PiecewiseLinearComplex c, std::uint64_t seed) {
        return make_moved(std::move(c), seed, {10.0, -20.0, 30.0});
    }));
}

TEST(ConformFamilies, AreMeshedWithFacetsMerged) {
    expect_mostly_done(run_families(201, 204, {.merge_coplanar = true}));
}

TEST(ConformFamilies, GetEmptyDiametralBalls) { expect_mostly_done(run_families(301, 303, gabriel), 0.85); }

TEST(ConformFamilies, KeepTheOutside) { expect_mostly_done(run_families(401, 403, {.keep_outside = true})); }

TEST(ConformFamiliesLong, AreMeshed) { expect_mostly_done(run_families(1000, 1300, {})); }

TEST(ConformFamiliesLong, AreMeshedWhereverTheyLie) {
    expect_mostly_done(run_families(2000, 2100, {}, [](PiecewiseLinearComplex c, std::uint64_t seed) {
        return make_moved(std::move(c), seed, {10.0, -20.0, 30.0});
    }));
}

TEST(ConformFamiliesLong, AreMeshedWithFacetsMerged) {
    expect_mostly_done(run_families(3000, 3060, {.merge_coplanar = true}));
    expect_mostly_done(
        run_families(3100, 3130, {.merge_coplanar = true},
                     [](PiecewiseLinearComplex c, std::uint64_t s) { return make_moved(std::move(c), s); }));
}

TEST(ConformFamiliesLong, GetEmptyDiametralBalls) {
    ConformOptions options = gabriel;
    expect_mostly_done(run_families(4000, 4060, options), 0.85);
    options.merge_coplanar = true;
    expect_mostly_done(run_families(4100, 4120, options), 0.85);
}

// Far from the origin coordinates are rounded to 1e-10: facets that are 1e-6 apart or at 0.001 degrees are no longer
// what they were, and their validity is not this test's business.
TEST(ConformFamilies, FarFromTheOrigin) {
    const Point3 far{1e6, -1e6, 1e6};
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        for (const bool triangles : {false, true}) expect_conforms(make_moved(make_cube(3, triangles), seed, far));
        expect_conforms(make_moved(make_fan(7, 10 * degree, seed), seed, far));
        expect_conforms(make_moved(make_book(5, 10 * degree), seed, far));
        expect_conforms(make_moved(make_mixture(seed), seed, far), {.planarity = {1e-8, false}});
        expect_conforms(make_moved(make_glued_tetrahedra(20, seed), seed, far));
        expect_conforms(make_moved(make_geology(5, 3, seed), seed, far));
        expect_conforms(make_moved(make_soup(20, seed), seed, far));
    }
}

// --- complexes that conform already: no point may be added ---

void expect_no_point(const PiecewiseLinearComplex& complex, const ConformOptions& options = {}) {
    const ConformResult result = expect_conforms(complex, options);
    EXPECT_EQ(steiner_points(result), 0u);
}

TEST(ConformCounts, BooksGetNoPoint) {
    for (const double angle : {350.0, 180.0, 90.0, 30.0, 10.0, 1.0, 0.1, 0.01, 0.001}) {
        for (const std::uint32_t pages : {2u, 3u, 4u, 7u, 15u, 40u}) {
            SCOPED_TRACE(std::to_string(pages) + " pages, " + std::to_string(angle) + " degrees");
            expect_no_point(make_book(pages, angle * degree));
            expect_no_point(make_moved(make_book(pages, angle * degree), pages));
        }
    }
}

TEST(ConformCounts, StarsGetNoPoint) {
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        expect_no_point(make_star(3 + seed, 1.0, seed));
    }
}

TEST(ConformCounts, WedgesGetNoPoint) {
    for (const double angle : {90.0, 45.0, 10.0, 5.0, 2.0, 1.0, 0.1, 0.01, 0.001}) {
        for (const bool closed : {false, true}) {
            SCOPED_TRACE(std::to_string(angle) + (closed ? " degrees, closed" : " degrees"));
            expect_no_point(make_wedge(angle * degree, closed));
        }
    }
}

TEST(ConformCounts, NestedCubesGetFewPoints) {
    // Each box has one of its faces' diagonals to choose; nothing is in the way of the outermost.
    for (std::uint32_t count = 1; count <= 10; ++count) {
        SCOPED_TRACE(std::to_string(count) + " boxes");
        const ConformResult result = expect_conforms(make_nested_cubes(count));
        EXPECT_LE(steiner_points(result), 12 * count * count);
    }
}

TEST(ConformCounts, CubesOfSquaresGetNoPoint) {
    for (std::uint32_t n = 1; n <= 12; ++n) {
        SCOPED_TRACE(std::to_string(n) + " x " + std::to_string(n));
        expect_no_point(make_cube(n, false));
        expect_no_point(make_moved(make_cube(n, false), n));
        expect_no_point(make_moved(make_cube(n, false), n, {1e6, 1e6, 1e6}));
        expect_no_point(make_cube(n, false), {.merge_coplanar = true});
    }
}

TEST(ConformCounts, CubesOfTrianglesDoNotBlowUp) {
    for (std::uint32_t n = 1; n <= 12; ++n) {
        SCOPED_TRACE(std::to_string(n) + " x " + std::to_string(n));
        // Every square may have the diagonal that the triangulation does not choose: about one point for each.
        for (const PiecewiseLinearComplex& cube : {make_cube(n, true), make_moved(make_cube(n, true), n)}) {
            const ConformResult result = expect_conforms(cube);
            EXPECT_LE(steiner_points(result), 8 * n * n);
        }
        expect_no_point(make_cube(n, true), {.merge_coplanar = true});
    }
}

TEST(ConformCounts, BoxesOfAnyShapeGetNoPoint) {
    for (const double x : {1e-3, 0.1, 1.0, 7.0, 1e3}) {
        for (const double y : {1e-3, 0.3, 1.0, 1e2}) expect_no_point(make_box({0, 0, 0}, {x, y, 1.0}));
    }
}

// --- fans: the count does not depend on the angle ---

std::size_t fan_points(std::uint32_t pages, double angle, std::uint64_t seed) {
    SCOPED_TRACE(std::to_string(angle) + " degrees");
    return steiner_points(expect_conforms(make_fan(pages, angle * degree, seed), {.max_points = 300'000}));
}

// Narrowing a fan makes ever more of its pages see each other, until all do: from there on the count stays.
// Circumcentres instead of mirror images would make it grow like the inverse square of the angle.
// `slack` is for chance: seeds differ by this share.
void expect_no_dependence_on_the_angle(std::uint32_t pages, std::uint64_t seed, double slack = 0.1) {
    SCOPED_TRACE(std::to_string(pages) + " pages, seed " + std::to_string(seed));
    const auto at_most = [&](double other_angle, double share) {
        return static_cast<std::size_t>(static_cast<double>(fan_points(pages, other_angle, seed)) * (1.0 + share)) + 8;
    };
    const std::size_t wide_limit = at_most(1.0, slack), narrow_limit = at_most(0.01, slack / 2);
    for (const double angle : {90.0, 10.0, 0.1, 0.001, 0.0001}) {
        const std::size_t count = fan_points(pages, angle, seed);
        EXPECT_LE(count, wide_limit) << angle << " degrees";
        if (angle < 0.01) {
            EXPECT_LE(count, narrow_limit) << angle << " degrees";
        }
    }
}

TEST(ConformFans, CountDoesNotDependOnTheAngle) {
    for (std::uint64_t seed = 1; seed <= 24; ++seed)
        expect_no_dependence_on_the_angle(static_cast<std::uint32_t>(2 + seed % 8), seed);
}

// The overlay is crowded where outlines cross: this saturates later.
TEST(ConformFans, EmptyDiametralBallsAtAnyAngle) {
    const auto points = [](std::uint32_t pages, double angle, std::uint64_t seed) {
        SCOPED_TRACE(std::to_string(pages) + " pages in " + std::to_string(angle) + " degrees, seed " +
                     std::to_string(seed));
        const ConformOptions options{.gabriel = true, .max_points = 300'000};
        return steiner_points(expect_conforms(make_fan(pages, angle * degree, seed), options));
    };
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        const auto pages = static_cast<std::uint32_t>(2 + seed % 8);
        const std::size_t at_one = points(pages, 1.0, seed);
        for (const double angle : {0.01, 0.0001}) EXPECT_LE(points(pages, angle, seed), at_one + at_one / 2 + 8);
    }
}

TEST(ConformFansLong, CountDoesNotDependOnTheAngle) {
    for (std::uint64_t seed = 1000; seed < 1200; ++seed)
        expect_no_dependence_on_the_angle(static_cast<std::uint32_t>(2 + seed % 14), seed, 0.2);
    const std::size_t at_one = fan_points(30, 1.0, 77);
    for (const double angle : {90.0, 10.0, 0.1, 0.001}) EXPECT_LE(fan_points(30, angle, 77), at_one + at_one / 5);
}

TEST(ConformFansLong, ManyPages) {
    for (const std::uint32_t pages : {60u, 100u}) {
        SCOPED_TRACE(std::to_string(pages) + " pages");
        expect_conforms(make_fan(pages, 300 * degree, pages));
    }
    // Every page carries a trace of every crossing of two others.
    expect_conforms(make_fan(40, 10 * degree, 40));
}

// --- cones and clouds: hard for everybody ---

TEST(ConformCones, OfTenSliversEnd) {
    for (const double width : {1.0, 0.1, 0.01, 0.001}) {
        for (std::uint64_t seed = 1; seed <= 4; ++seed) {
            SCOPED_TRACE("width " + std::to_string(width) + ", seed " + std::to_string(seed));
            expect_conforms(make_cone(10, width, seed));
        }
    }
}

TEST(ConformConesLong, OfManySliversEnd) {
    for (const double width : {1.0, 0.1, 0.01}) {
        for (const std::uint32_t slivers : {20u, 40u, 79u}) {
            for (std::uint64_t seed = 1; seed <= 3; ++seed) {
                SCOPED_TRACE(std::to_string(slivers) + " slivers, width " + std::to_string(width) + ", seed " +
                             std::to_string(seed));
                expect_conforms_or_says_where(make_cone(slivers, width, seed), {.max_points = 300'000});
            }
        }
    }
}

TEST(ConformPlates, WithFiftyHoles) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        PiecewiseLinearComplex plate = make_plate(50, 20, 20, seed);
        EXPECT_EQ(expect_refused(plate), std::vector{DefectKind::empty_input});  // flat: no volume
        put_point(plate, {0.3, 0.4, 0.6});
        expect_conforms(plate);
        expect_conforms(make_moved(plate, seed));
        expect_conforms(plate, {.gabriel = true});
    }
}

TEST(ConformBigLong, Geology) {
    for (const std::uint32_t grid : {30u, 60u, 100u}) {
        SCOPED_TRACE(std::to_string(grid));
        const ConformResult result = expect_conforms(make_geology(grid, 8, grid), {.max_points = 3'000'000});
        EXPECT_LT(result.mesh.positions.size(), 5 * result.statistics.input_points);
    }
}

TEST(ConformBigLong, Cubes) {
    for (const std::uint32_t n : {40u, 100u}) {
        expect_no_point(make_cube(n, false));
        expect_no_point(make_moved(make_cube(n, false), n));
    }
}

TEST(ConformBigLong, Crowds) {
    expect_conforms(make_soup(3000, 5), {.max_points = 3'000'000});
    expect_conforms(make_glued_tetrahedra(5000, 6), {.max_points = 3'000'000});
    expect_conforms_or_says_where(make_flat_cloud(1000, 0.5, 7), {.max_points = 1'000'000});
}

// --- the thesis's schemes ---

TEST(ConformProtection, SharpMeshesSmallComplexes) {
    for (const Protection protection : {Protection::sharp, Protection::all}) {
        SCOPED_TRACE(protection == Protection::sharp ? "sharp" : "all");
        const ConformOptions options{.protection = protection};
        expect_conforms(make_cube(2, false), options);
        expect_conforms(make_wedge(20 * degree, true), options);
        expect_conforms(make_fan(5, 90 * degree, 3), options);
        expect_conforms(make_book(4, 30 * degree), options);
        expect_conforms(make_umbrella(6, 1), options);
        expect_conforms(make_nested_cubes(2), options);
        expect_conforms(make_mixture(1), options);
        expect_conforms(make_glued_tetrahedra(6, 1), options);
        expect_conforms(make_star(6, 1.0, 1), options);
    }
}

TEST(ConformProtectionLong, FamiliesSharpAndAll) {
    // What is hard (cones of slivers, flat clouds, facets a millionth apart) may need more balls than the budget.
    expect_mostly_done(run_families(1, 3, {.protection = Protection::sharp, .max_points = 100'000}), 0.9);
    expect_mostly_done(run_families(1, 3, {.protection = Protection::all, .max_points = 100'000}), 0.8);
    expect_mostly_done(run_families(7, 8, {.protection = Protection::sharp, .gabriel = true, .max_points = 100'000}));
}

}  // namespace
}  // namespace certa::test
