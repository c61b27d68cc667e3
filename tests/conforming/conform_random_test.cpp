// `conform` on random complexes that nobody made to be meshed: facets and segments among the points of a small lattice,
// where everything is cospherical, coplanar and collinear; networks of segments with any angles; and families put next
// to and into each other. Properties restate the promises; RapidCheck shrinks what breaks them.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <set>

#include "conforming/conform_support.h"
#include "core/random.h"
#include "mesh/generators.h"

namespace certa::test {
namespace {

using core::Random;

bool is_valid(const PiecewiseLinearComplex& complex) { return find_defects(complex).defect_count == 0; }

/// Points of {0, 1, .., size - 1}^3, some of them, and triangles, quadrilaterals and segments among them, each kept if
/// the complex stays valid. Points on facets and segments in facets are adopted.
PiecewiseLinearComplex make_lattice_complex(std::uint32_t size, std::uint32_t tries, std::uint64_t seed) {
    Random random(seed);
    PiecewiseLinearComplex complex;
    const double keep = random.uniform(0.3, 1.0);
    for (std::uint32_t i = 0; i < size * size * size; ++i) {
        if (random.coin(keep)) put_point(complex, {double(i % size), double(i / size % size), double(i / size / size)});
    }
    for (const Point3& p : {Point3{0, 0, -1}, {1, 0, -1}, {0, 1, -1}}) put_point(complex, p);
    const auto count = static_cast<std::uint32_t>(complex.positions.size());
    for (std::uint32_t i = 0; i < tries; ++i) {
        PiecewiseLinearComplex more = complex;
        std::set<std::uint32_t> chosen;
        while (chosen.size() < std::min(count, 2 + static_cast<std::uint32_t>(random.below(3))))
            chosen.insert(static_cast<std::uint32_t>(random.below(count)));
        Ids ring(chosen.begin(), chosen.end());
        if (random.coin()) std::swap(ring[0], ring[1]);
        if (ring.size() == 2) {
            put_segment(more, ring[0], ring[1]);
        } else {
            put_facet(more, {ring});
        }
        if (is_valid(more)) complex = std::move(more);
    }
    put_point(complex, {0.5, 0.25, size + 0.5});  // never all in one plane
    return complex;
}

/// Points of the lattice all in one plane but one: facets with everything cocircular, and an apex.
PiecewiseLinearComplex make_pavement(std::uint32_t n, std::uint64_t seed) {
    Random random(seed);
    PiecewiseLinearComplex complex;
    for (std::uint32_t i = 0; i <= n; ++i) {
        for (std::uint32_t j = 0; j <= n; ++j) put_point(complex, {double(i), double(j), 0.0});
    }
    for (std::uint32_t i = 0; i < n; ++i) {
        for (std::uint32_t j = 0; j < n; ++j) {
            const std::uint32_t a = i * (n + 1) + j, b = a + n + 1;
            if (random.coin(0.2)) continue;
            if (random.coin(0.3)) {
                put_facet(complex, {{a, b, b + 1, a + 1}});
            } else if (random.coin()) {
                put_facet(complex, {{a, b, b + 1}});
                put_facet(complex, {{a, b + 1, a + 1}});
            } else {
                put_facet(complex, {{a, b, a + 1}});
                put_facet(complex, {{b, b + 1, a + 1}});
            }
        }
    }
    put_point(complex, {0.5 * n, 0.5 * n, random.coin() ? 0.5 * n : double(n)});
    return complex;
}

/// Random points and segments among them; no two cross, by chance.
PiecewiseLinearComplex make_network(std::uint32_t points, std::uint32_t segments, std::uint64_t seed) {
    Random random(seed);
    PiecewiseLinearComplex complex;
    const double flat = random.coin(0.3) ? 1e-2 : 1.0;
    for (std::uint32_t i = 0; i < points; ++i)
        put_point(complex, {random.uniform(), random.uniform(), flat * random.uniform()});
    std::set<std::array<std::uint32_t, 2>> known;
    for (std::uint32_t i = 0; i < segments; ++i) {
        const auto a = static_cast<std::uint32_t>(random.below(points)),
                   b = static_cast<std::uint32_t>(random.below(points));
        if (a != b && known.insert({std::min(a, b), std::max(a, b)}).second) put_segment(complex, a, b);
    }
    return complex;
}

/// Triangles among random points, each kept if the complex stays valid: fans, cones and contacts of every kind.
PiecewiseLinearComplex make_tangle(std::uint32_t points, std::uint32_t tries, std::uint64_t seed) {
    Random random(seed);
    PiecewiseLinearComplex complex;
    for (std::uint32_t i = 0; i < points; ++i)
        put_point(complex, {random.uniform(), random.uniform(), random.uniform()});
    for (std::uint32_t i = 0; i < tries; ++i) {
        std::set<std::uint32_t> chosen;
        while (chosen.size() < 3) chosen.insert(static_cast<std::uint32_t>(random.below(points)));
        PiecewiseLinearComplex more = complex;
        put_facet(more, {Ids(chosen.begin(), chosen.end())});
        if (is_valid(more)) complex = std::move(more);
    }
    return complex;
}

/// Three members of the families side by side at different sizes, turned, in a box.
PiecewiseLinearComplex make_company(std::uint64_t seed) {
    Random random(seed);
    PiecewiseLinearComplex complex;
    const auto& families = small_families();
    for (int i = 0; i < 3; ++i) {
        const Family* family = nullptr;
        do {
            family = &families[random.below(families.size())];
        } while (family->hard);
        PiecewiseLinearComplex member = generators::make_moved(family->make(random.below(1000)), random.next());
        Point3 low = member.positions[0], high = low;
        for (const Point3& p : member.positions) {
            low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
        }
        const double scale = random.uniform(0.05, 0.8) / std::max({high.x - low.x, high.y - low.y, high.z - low.z});
        put_complex(complex, member, scale, {i + 0.1 - scale * low.x, 0.1 - scale * low.y, 0.1 - scale * low.z});
    }
    put_box(complex, {0, 0, 0}, {3, 1, 1});
    return complex;
}

// --- the runs ---

void run_lattices(std::uint64_t first, std::uint64_t last, const ConformOptions& options = {}) {
    for (std::uint64_t seed = first; seed < last; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const std::uint32_t size = 2 + static_cast<std::uint32_t>(seed % 3);
        expect_conforms(make_lattice_complex(size, 4 + static_cast<std::uint32_t>(seed % 20), seed), options);
    }
}

TEST(ConformRandom, Lattices) { run_lattices(1, 300); }
TEST(ConformRandom, LatticesMerged) { run_lattices(1001, 1060, {.merge_coplanar = true}); }
TEST(ConformRandom, LatticesGabriel) { run_lattices(2001, 2060, {.gabriel = true}); }
TEST(ConformRandomLong, Lattices) { run_lattices(10'000, 14'000); }
TEST(ConformRandomLong, LatticesMerged) { run_lattices(20'000, 20'800, {.merge_coplanar = true}); }
TEST(ConformRandomLong, LatticesGabriel) { run_lattices(30'000, 30'800, {.gabriel = true}); }

void run_pavements(std::uint64_t first, std::uint64_t last) {
    for (std::uint64_t seed = first; seed < last; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const auto n = static_cast<std::uint32_t>(1 + seed % 7);
        const PiecewiseLinearComplex pavement = make_pavement(n, seed);
        // A tie that falls the other way costs points, but not without end.
        EXPECT_LE(steiner_points(expect_conforms(pavement)), 4 * n * n + 4);
        expect_conforms(pavement, {.merge_coplanar = true});
        expect_conforms(generators::make_moved(pavement, seed));
    }
}

TEST(ConformRandom, Pavements) { run_pavements(1, 60); }
TEST(ConformRandomLong, Pavements) { run_pavements(1000, 1500); }

void run_networks(std::uint64_t first, std::uint64_t last) {
    for (std::uint64_t seed = first; seed < last; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const auto points = static_cast<std::uint32_t>(4 + seed % 29);
        expect_conforms(make_network(points, 1 + points * (seed % 5) / 2, seed));
    }
}

TEST(ConformRandom, Networks) { run_networks(1, 250); }
TEST(ConformRandomLong, Networks) { run_networks(1000, 4000); }

void run_tangles(std::uint64_t first, std::uint64_t last) {
    std::size_t done = 0;
    for (std::uint64_t seed = first; seed < last; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const auto points = static_cast<std::uint32_t>(5 + seed % 12);
        const ConformResult result = expect_conforms_or_says_where(make_tangle(points, 30, seed));
        done += result.outcome == Outcome::done ? 1 : 0;
    }
    EXPECT_GE(50 * done, 49 * (last - first)) << done << " of " << last - first;
}

TEST(ConformRandom, Tangles) { run_tangles(1, 120); }
TEST(ConformRandomLong, Tangles) { run_tangles(1000, 3000); }

// A narrow fan in a box may end with a place: its pages and the walls disturb each other.
void run_companies(std::uint64_t first, std::uint64_t last) {
    std::size_t done = 0;
    for (std::uint64_t seed = first; seed < last; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const ConformResult result = expect_conforms_or_says_where(make_company(seed));
        done += result.outcome == Outcome::done ? 1 : 0;
    }
    EXPECT_GE(20 * done, 19 * (last - first)) << done << " of " << last - first;
}

TEST(ConformRandom, Companies) { run_companies(1, 13); }
TEST(ConformRandomLong, Companies) { run_companies(1000, 2000); }

TEST(ConformRandom, AnyBoxOfAnySizeAnywhere) {
    EXPECT_TRUE(rc::check("a box needs no point, whatever its size and place", [] {
        const auto exponent = *rc::gen::inRange(-30, 30);
        const auto place = *rc::gen::arbitrary<std::array<std::int16_t, 3>>();
        const auto size = *rc::gen::container<std::vector<int>>(3, rc::gen::inRange(1, 1000));
        const double unit = std::ldexp(1.0, exponent);
        const Point3 low{unit * place[0], unit * place[1], unit * place[2]};
        const PiecewiseLinearComplex box =
            make_box(low, {low.x + unit * size[0], low.y + unit * size[1], low.z + unit * size[2]});
        const ConformResult result = conform(box);
        RC_ASSERT(result.outcome == Outcome::done);
        RC_ASSERT(result.mesh.positions == box.positions);
        RC_ASSERT(check_conforming(result.mesh, box).ok());
    }));
}

TEST(ConformRandom, ScalingByPowersOfTwoScalesTheMesh) {
    EXPECT_TRUE(rc::check("2^k times the input gives 2^k times the mesh", [] {
        const auto seed = *rc::gen::inRange<std::uint64_t>(0, 1'000'000);
        const auto exponent = *rc::gen::inRange(-20, 20);
        const auto family = *rc::gen::inRange<std::size_t>(0, small_families().size());
        const PiecewiseLinearComplex complex = small_families()[family].make(seed);
        PiecewiseLinearComplex scaled = complex;
        const double factor = std::ldexp(1.0, exponent);
        const auto scale = [&](Point3& p) { p = {factor * p.x, factor * p.y, factor * p.z}; };
        for (Point3& p : scaled.positions) scale(p);
        for (Point3& p : scaled.facet_holes) scale(p);
        const ConformResult one = conform(complex, {.max_points = 5000}), two = conform(scaled, {.max_points = 5000});
        RC_ASSERT(one.outcome == two.outcome);
        std::vector<Point3> expected = one.mesh.positions;
        for (Point3& p : expected) scale(p);
        RC_ASSERT(two.mesh.positions == expected);
        RC_ASSERT(two.mesh.tetrahedra == one.mesh.tetrahedra);
    }));
}

}  // namespace
}  // namespace certa::test
