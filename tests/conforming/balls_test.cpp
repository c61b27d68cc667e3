// Local feature size, protecting balls and protected area (thesis, Part I, 1.1.2-1.1.4, 1.3, 1.4.2) on analytic cases,
// on generated and hostile complexes, and on real models, against the oracles of tests/oracle.
#include <certa/conforming.h>
#include <certa/io.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>

#include "conforming/build_complex.h"
#include "conforming/local_feature_size.h"
#include "conforming/protected_area.h"
#include "conforming/protecting_balls.h"
#include "core/random.h"
#include "mesh/generators.h"
#include "oracle/feature_size_oracle.h"
#include "oracle/protection_oracle.h"

namespace certa::conforming {
namespace {

using core::Random;
namespace gen = generators;

constexpr double degree = std::numbers::pi / 180.0;

struct Case {
    std::string name;
    PiecewiseLinearComplex input;
};

PiecewiseLinearComplex isolated_pieces() {
    PiecewiseLinearComplex c;
    c.positions = {{0, 0, 0}, {1, 0, 0}, {0.5, 0.2, 0.1}, {0.5, 0.9, 0.3}, {3, 3, 3}};
    c.segments = {{VertexId{0}, VertexId{1}}, {VertexId{2}, VertexId{3}}};
    return c;
}

/// A facet with a reflex corner, a slit (two isolated segments in a chain), and two holes that touch in a vertex.
PiecewiseLinearComplex reflex_facet() {
    PiecewiseLinearComplex c;
    c.positions = {{0, 0, 0}, {8, 0, 0}, {8, 8, 0}, {4, 1, 0}, {0, 8, 0},   {1, 1, 0},   {2, 1.5, 0},
                   {3, 1, 0}, {5, 1, 0}, {6, 1, 0}, {6, 2, 0}, {6.5, 1, 0}, {6.5, 2, 0}, {7, 3, 0}};
    const auto v = [](std::uint32_t i) { return VertexId{i}; };
    add_facet(c,
              {{v(0), v(1), v(2), v(3), v(4)},
               {v(5), v(6)},
               {v(6), v(7)},
               {v(8), v(9), v(10)},
               {v(9), v(11), v(12)},
               {v(13)}},
              {{5.8, 1.3, 0}, {6.4, 1.3, 0}});
    return c;
}

std::vector<Case> cases() {
    std::vector<Case> all;
    const auto add = [&](const std::string& name, PiecewiseLinearComplex input) {
        all.push_back({name, std::move(input)});
    };
    add("cube", gen::make_cube(1, false));
    add("cube in triangles", gen::make_cube(3, true));
    add("moved cube", gen::make_moved(gen::make_cube(2, false), 5, {1e3, -2e3, 5e2}));
    add("nested cubes", gen::make_nested_cubes(3));
    add("isolated pieces", isolated_pieces());
    add("reflex facet", reflex_facet());
    for (const double angle : {90.0, 60.0, 10.0, 2.0}) {
        add("open wedge " + std::to_string(angle), gen::make_wedge(angle * degree, false));
        add("closed wedge " + std::to_string(angle), gen::make_wedge(angle * degree, true));
        add("fan " + std::to_string(angle), gen::make_fan(3, angle * degree, 7));
        add("book " + std::to_string(angle), gen::make_book(4, angle * degree));
        add("cone " + std::to_string(angle), gen::make_cone(4, angle * degree, 3));
    }
    add("star", gen::make_star(12, 2.0, 9));
    add("umbrella", gen::make_umbrella(8, 2));
    add("plate", gen::make_plate(6, 5, 4, 11));
    add("moved plate", gen::make_moved(gen::make_plate(3, 3, 3, 12), 4, {10, 20, 30}));
    add("coplanar", gen::make_coplanar_facets(3, 8));
    add("near facets", gen::make_near_facets(0.02, 6));
    add("soup", gen::make_soup(12, 1));
    add("flat cloud", gen::make_flat_cloud(10, 0.3, 2));
    for (const std::uint64_t seed : {1, 2, 3}) {
        add("glued " + std::to_string(seed), gen::make_glued_tetrahedra(8, seed));
        add("mixture " + std::to_string(seed), gen::make_mixture(seed));
    }
    add("geology", gen::make_geology(3, 3, 4));
    add("mixture far away", gen::make_moved(gen::make_mixture(4), 8, {1e6, 1e6, -1e6}));
    return all;
}

ProtectedSet random_set(const Complex& c, Random& random, double share) {
    ProtectedSet set = protect_nothing(c);
    for (auto& flag : set.vertices) flag = random.coin(share);
    for (auto& flag : set.segments) flag = random.coin(share);
    return set;
}

/// Builds everything for one set and runs every oracle on it.
ProtectedArea expect_protection(const Complex& complex, const FacetInterior& interior, const LocalFeatureSize& size,
                                ProtectedSet set, double alpha) {
    const ProtectingBalls balls = build_protecting_balls(complex, size, set, {.alpha = alpha, .max_balls = 200000});
    EXPECT_EQ(balls.outcome, Outcome::done);
    if (balls.outcome != Outcome::done) return {};
    close_under_ends(set, complex);
    const bool small = balls.balls.size() * (complex.facet_sides.size() + complex.segments.size()) < 300000;
    const auto found = oracle::check_balls(complex, balls, set, small);
    EXPECT_EQ(found.count, 0u) << found.text();
    ProtectedArea area = build_protected_area(complex, interior, balls);
    const auto wrong = oracle::check_area(complex, balls, area);
    EXPECT_EQ(wrong.count, 0u) << wrong.text();
    if (area.points.size() * area.right_angled.values.size() < 20000000) {
        const auto encroached = oracle::check_right_triangles_gabriel(complex, area);
        EXPECT_EQ(encroached.count, 0u) << encroached.text();
    }
    return area;
}

// --- local feature size ---

TEST(LocalFeatureSize, AnalyticOnTheCube) {
    const Complex c = build_complex(gen::make_cube(1, false));
    const FacetInterior interior = build_facet_interior(c);
    const LocalFeatureSize size(c, interior);
    for (std::uint32_t v = 0; v < 8; ++v) EXPECT_NEAR(size.at_vertex(v).value, 1.0, 1e-7);
    for (std::uint32_t s = 0; s < c.segments.size(); ++s) {
        const Point3 &a = c.points[c.segments[s][0]], &b = c.points[c.segments[s][1]];
        const Point3 p{0.75 * a.x + 0.25 * b.x, 0.75 * a.y + 0.25 * b.y, 0.75 * a.z + 0.25 * b.z};
        EXPECT_NEAR(size.on_segment(s, p).value, 0.25, 1e-7);  // its own end: the facets at the end contain p or not
        EXPECT_EQ(size.on_segment(s, p, 0.1).value, 0.1);
        EXPECT_EQ(size.on_segment(s, p, 0.1).nearest.index, no_index);
    }
}

TEST(LocalFeatureSize, OppositeEdgeOfAnIncidentTriangleCounts) {
    PiecewiseLinearComplex input;
    input.positions = {{0, 0, 0}, {1, -1, 0}, {1, 1, 0}};
    add_facet(input, {{VertexId{0}, VertexId{1}, VertexId{2}}});
    const Complex c = build_complex(input);
    const FacetInterior interior = build_facet_interior(c);
    const LocalFeatureSize size(c, interior);
    EXPECT_NEAR(size.at_vertex(0).value, 1.0, 1e-7);
    EXPECT_EQ(size.at_vertex(0).nearest.kind, ElementKind::segment);
}

TEST(LocalFeatureSize, AgreesWithBruteForce) {
    Random random(20);
    for (const Case& example : cases()) {
        SCOPED_TRACE(example.name);
        const Complex c = build_complex(example.input);
        const FacetInterior interior = build_facet_interior(c);
        const LocalFeatureSize size(c, interior);
        double largest = 0;
        for (const Point3& p : c.points) largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
        const double noise = 1e-15 * largest;  // the oracle measures from a facet's rounded normal
        const auto expect = [&](double got, oracle::Real exact) {
            EXPECT_LE(got, exact + noise);
            EXPECT_GE(got, exact * (1 - 1e-7L) - noise);
        };
        for (std::uint32_t v = 0; v < c.points.size(); ++v) {
            expect(size.at_vertex(v).value, oracle::feature_size(c, {true, v}, oracle::vec(c.points[v])));
        }
        for (std::uint32_t s = 0; s < c.segments.size(); ++s) {
            const Point3 &a = c.points[c.segments[s][0]], &b = c.points[c.segments[s][1]];
            const double t = random.coin() ? random.uniform() : std::pow(10.0, -random.uniform(1, 6));
            const Point3 p{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z)};
            expect(size.on_segment(s, p).value, oracle::feature_size(c, {false, s}, oracle::vec(p)));
        }
    }
}

TEST(LocalFeatureSize, KeepsItsBoundOnNeedlesAndCaps) {
    Random random(4);
    for (int round = 0; round < 200; ++round) {
        // A sliver with an angle down to 1e-9 and a point just above it, far from the origin.
        const double thin = std::pow(10.0, -random.uniform(1, 9)), height = std::pow(10.0, -random.uniform(1, 9));
        PiecewiseLinearComplex input;
        const double t = random.uniform();
        input.positions = {{0, 0, 0}, {1, 0, 0}, {t, thin, 0}, {0.5 * t + 0.25, 0.3 * thin, height}};
        add_facet(input, {{VertexId{0}, VertexId{1}, VertexId{2}}});
        const Complex c = build_complex(gen::make_moved(input, static_cast<std::uint64_t>(round), {100, -30, 7}));
        const FacetInterior interior = build_facet_interior(c);
        const double got = LocalFeatureSize(c, interior).at_vertex(3).value;
        const oracle::Real exact = oracle::feature_size(c, {true, 3}, oracle::vec(c.points[3]));
        // The frame that the oracle uses is a rounded one: compare up to the coordinates' rounding.
        EXPECT_LE(got, exact * (1 + 1e-7L) + 1e-13L) << thin << " " << height;
        EXPECT_GT(got, 0.0) << thin << " " << height;
    }
}

// --- what is sharp ---

TEST(SharpSegments, RightAnglesAreNotSharpHoweverTheCubeIsTurned) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        for (const double shift : {0.0, 1e6}) {
            const Complex c =
                build_complex(gen::make_moved(gen::make_cube(2, seed % 2 == 0), seed, {shift, -shift, shift}));
            const FacetInterior interior = build_facet_interior(c);
            const ProtectedSet set = protect_sharp(c, interior);
            EXPECT_EQ(std::count(set.segments.begin(), set.segments.end(), 1), 0);
            EXPECT_EQ(std::count(set.vertices.begin(), set.vertices.end(), 1), std::ptrdiff_t(c.points.size()));
        }
    }
}

TEST(SharpSegments, TheThresholdIsNinetyDegrees) {
    const auto is_sharp = [](double angle) {
        const Complex c = build_complex(gen::make_wedge(angle, false));
        const FacetInterior interior = build_facet_interior(c);
        for (std::uint32_t s = 0; s < c.segments.size(); ++s) {
            if (interior.sheets[s].size() == 2) return is_sharp_segment(c, interior, s);
        }
        ADD_FAILURE() << "no common segment";
        return false;
    };
    EXPECT_TRUE(is_sharp(1e-3 * degree));
    EXPECT_TRUE(is_sharp(45 * degree));
    EXPECT_TRUE(is_sharp(90 * degree - 1e-12));
    EXPECT_FALSE(is_sharp(90 * degree));
    EXPECT_FALSE(is_sharp(90 * degree + 1e-12));
    EXPECT_FALSE(is_sharp(180 * degree));
}

TEST(SharpSegments, AFacetThatReachesFartherOnItsOtherSide) {
    // An L whose widest part is across the line of its inner side; a fin there, leaning towards the L or away from it.
    for (const double angle : {60.0, 89.0, 91.0, 120.0}) {
        PiecewiseLinearComplex input;
        input.positions = {{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}};
        input.positions.push_back({2, 1 - std::cos(angle * degree), std::sin(angle * degree)});
        const auto v = [](std::uint32_t i) { return VertexId{i}; };
        add_facet(input, {{v(0), v(1), v(2), v(3), v(4), v(5)}});
        add_facet(input, {{v(2), v(3), v(6)}});
        const Complex c = build_complex(input);
        const FacetInterior interior = build_facet_interior(c);
        std::size_t sharp = 0;
        for (std::uint32_t s = 0; s < c.segments.size(); ++s) sharp += is_sharp_segment(c, interior, s);
        EXPECT_EQ(sharp, angle < 90.0 ? 1u : 0u) << angle;
    }
}

TEST(SharpSegments, AFacetOnBothSidesCountsTwice) {
    // A fin on an isolated segment of a square: sharp unless it stands upright.
    for (const double lean : {0.0, 0.1}) {
        PiecewiseLinearComplex input;
        input.positions = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {1, 2, 0}, {3, 2, 0}, {2, 2 + lean, 1}};
        const auto v = [](std::uint32_t i) { return VertexId{i}; };
        add_facet(input, {{v(0), v(1), v(2), v(3)}, {v(4), v(5)}});
        add_facet(input, {{v(4), v(5), v(6)}});
        const Complex c = build_complex(input);
        const FacetInterior interior = build_facet_interior(c);
        std::size_t sharp = 0;
        for (std::uint32_t s = 0; s < c.segments.size(); ++s) sharp += is_sharp_segment(c, interior, s);
        EXPECT_EQ(sharp, lean == 0.0 ? 0u : 1u);
    }
}

// --- balls and area ---

TEST(ProtectedArea, CubeUnderSharpHasOneSosPointPerCornerOfAFace) {
    const Complex c = build_complex(gen::make_cube(1, false));
    const FacetInterior interior = build_facet_interior(c);
    const LocalFeatureSize size(c, interior);
    const ProtectedArea area = expect_protection(c, interior, size, protect_sharp(c, interior), 0.4);
    EXPECT_EQ(area.balls.size(), 8u);
    EXPECT_EQ(area.points.size(), 24u + 24u);  // two leaving points per edge, one SOS-point per right angle
    EXPECT_EQ(area.shields.values.size(), 48u);
    EXPECT_TRUE(area.right_angled.values.empty());
    for (const Ball& b : area.balls) EXPECT_NEAR(b.radius, 0.4, 1e-7);
}

TEST(ProtectedArea, CubeUnderAllHasOneBallInEachEdge) {
    const Complex c = build_complex(gen::make_cube(1, false));
    const FacetInterior interior = build_facet_interior(c);
    const LocalFeatureSize size(c, interior);
    const ProtectedArea area = expect_protection(c, interior, size, protect_all(c), 0.4);
    // The gap between the balls of radius 0.4 has length 0.2; half of it and half the radius of a neighbour cover it.
    EXPECT_EQ(area.balls.size(), 8u + 12u);
    for (const Ball& b : area.balls) {
        EXPECT_NEAR(b.radius, b.kind == BallKind::vertex ? 0.4 : std::min(0.4 * 0.5, 0.1 + 0.2), 1e-7);
    }
}

TEST(ProtectedArea, HoldsOnEveryCaseForEveryScheme) {
    Random random(31);
    for (const Case& example : cases()) {
        const Complex c = build_complex(example.input);
        const FacetInterior interior = build_facet_interior(c);
        const LocalFeatureSize size(c, interior);
        for (const double alpha : {0.4, 0.25, 0.49}) {
            SCOPED_TRACE(example.name + ", alpha " + std::to_string(alpha));
            expect_protection(c, interior, size, protect_sharp(c, interior), alpha);
            if (alpha == 0.4 || c.points.size() < 12) expect_protection(c, interior, size, protect_all(c), alpha);
            expect_protection(c, interior, size, random_set(c, random, 0.2), alpha);
        }
    }
}

/// Many more seeds; each is printed when it fails.
TEST(ProtectedAreaLong, HoldsOnRandomComplexes) {
    for (std::uint64_t seed = 1; seed <= 400; ++seed) {
        Random random(seed);
        const auto any = static_cast<std::uint32_t>(random.below(9));
        const double angle = std::pow(10.0, random.uniform(-1, 1.95)) * degree;
        PiecewiseLinearComplex input = any == 0   ? gen::make_mixture(seed)
                                       : any == 1 ? gen::make_glued_tetrahedra(10, seed)
                                       : any == 2 ? gen::make_fan(4, angle, seed)
                                       : any == 3 ? gen::make_cone(4, angle, seed)
                                       : any == 4 ? gen::make_plate(5, 4, 3, seed)
                                       : any == 5 ? gen::make_soup(10, seed)
                                       : any == 6 ? gen::make_flat_cloud(9, random.uniform(0.05, 1), seed)
                                       : any == 7 ? gen::make_geology(3, 4, seed)
                                                  : gen::make_umbrella(9, seed);
        const double far = random.coin() ? 0.0 : std::pow(10.0, random.uniform(0, 5));
        if (random.coin()) input = gen::make_moved(std::move(input), seed, {far, -far, far});
        const Complex c = build_complex(input);
        const FacetInterior interior = build_facet_interior(c);
        const LocalFeatureSize size(c, interior);
        for (const bool sharp : {true, false}) {
            SCOPED_TRACE("seed " + std::to_string(seed) + (sharp ? " sharp" : " partial"));
            const ProtectedSet set = sharp ? protect_sharp(c, interior) : random_set(c, random, random.uniform());
            const double alpha = random.uniform(0.2, 0.49);
            const BallOptions options{.alpha = alpha, .max_balls = 3000};
            if (build_protecting_balls(c, size, set, options).outcome != Outcome::done) continue;
            expect_protection(c, interior, size, set, alpha);
        }
    }
}

TEST(ProtectedArea, SharpFansAndConesDownToAThousandthOfADegree) {
    for (const double angle : {90.0, 1.0, 0.1, 0.01, 0.001}) {
        for (const auto& input : {gen::make_fan(5, angle * degree, 3), gen::make_book(5, angle * degree),
                                  gen::make_cone(5, angle * degree, 3)}) {
            SCOPED_TRACE(angle);
            const Complex c = build_complex(input);
            const FacetInterior interior = build_facet_interior(c);
            const LocalFeatureSize size(c, interior);
            expect_protection(c, interior, size, protect_sharp(c, interior), 0.4);
        }
    }
}

TEST(ProtectedArea, EqualPagesGetEqualPoints) {
    // All pages of a book are images of one another by rotation about the axis: so are their p- and SOS-points.
    const std::uint32_t pages = 5;
    const Complex c = build_complex(gen::make_book(pages, 20 * degree));
    const FacetInterior interior = build_facet_interior(c);
    const LocalFeatureSize size(c, interior);
    const ProtectedArea area = expect_protection(c, interior, size, protect_sharp(c, interior), 0.4);
    const auto profile = [&](std::uint32_t f) {
        std::vector<std::pair<double, double>> rz;
        for (const ShieldEdge& e : area.shields[f]) {
            const Ball& ball = area.balls[e.ball];
            if (ball.kind == BallKind::vertex && ball.index > 1) continue;  // outer corners see different neighbours
            const Point3& p = area.new_point(e.a).position;
            rz.emplace_back(p.z, std::hypot(p.x, p.y));
        }
        std::sort(rz.begin(), rz.end());
        return rz;
    };
    const auto first = profile(0);
    EXPECT_EQ(first.size(), 3u);  // one per ball on the axis
    for (std::uint32_t f = 1; f < pages; ++f) {
        const auto other = profile(f);
        ASSERT_EQ(first.size(), other.size());
        for (std::size_t i = 0; i < first.size(); ++i) {
            EXPECT_NEAR(first[i].first, other[i].first, 1e-14);
            EXPECT_NEAR(first[i].second, other[i].second, 1e-14);
        }
    }
}

TEST(ProtectingBalls, TangentBallsAreKeptApart) {
    // A strip beside a segment makes alpha lfs equal to half the gap: 1 - 2 * 0.4 = 0.2, half of it 0.1 = 0.4 * 0.25.
    PiecewiseLinearComplex input;
    input.positions = {{0, 0, 0}, {1, 0, 0}, {0.5, 0.25, 0}, {0.5, 5, 0}};
    input.segments = {{VertexId{0}, VertexId{1}}, {VertexId{2}, VertexId{3}}};
    const Complex c = build_complex(input);
    const FacetInterior interior = build_facet_interior(c);
    const LocalFeatureSize size(c, interior);
    ProtectedSet set = protect_nothing(c);
    set.segments[0] = 1;
    // The ends see the strip at hypot(0.5, 0.25) = 0.559.
    const double alpha = 0.4, end = alpha * std::hypot(0.5, 0.25), gap = 1 - 2 * end;
    input.positions[2].y = gap / 2 / alpha;
    const ProtectingBalls balls = build_protecting_balls(c, size, set, {.alpha = alpha});
    const auto found = oracle::check_balls(
        c, balls,
        [&] {
            auto s = set;
            close_under_ends(s, c);
            return s;
        }(),
        true);
    EXPECT_EQ(found.count, 0u) << found.text();
    for (double y = 0.1; y < 0.6; y += 0.001) {  // some of these come near tangency
        input.positions[2].y = y;
        const Complex d = build_complex(input);
        const FacetInterior parts = build_facet_interior(d);
        const LocalFeatureSize sizes(d, parts);
        auto closed = set;
        close_under_ends(closed, d);
        const auto found_here =
            oracle::check_balls(d, build_protecting_balls(d, sizes, set, {.alpha = alpha}), closed, true);
        EXPECT_EQ(found_here.count, 0u) << y << found_here.text();
    }
}

TEST(ProtectingBalls, LimitsNameTheFacesAndThePlace) {
    const Complex c = build_complex(gen::make_book(4, 0.01 * degree));
    const FacetInterior interior = build_facet_interior(c);
    const LocalFeatureSize size(c, interior);
    const ProtectingBalls many = build_protecting_balls(c, size, protect_all(c), {.max_balls = 1000});
    ASSERT_EQ(many.outcome, Outcome::over_budget);
    EXPECT_EQ(many.balls.size(), 1000u);
    ASSERT_TRUE(many.obstacle.has_value());
    EXPECT_EQ(many.obstacle->protected_face.kind, ElementKind::segment);
    const ProtectingBalls small = build_protecting_balls(c, size, protect_all(c), {.min_radius = 1e-3});
    ASSERT_EQ(small.outcome, Outcome::below_min_feature);
    ASSERT_TRUE(small.obstacle.has_value());
    EXPECT_LT(small.obstacle->radius, 1e-3);
    EXPECT_NE(small.obstacle->near_face.index, no_index);
    std::atomic<bool> cancel = true;
    RunControl control;
    control.cancel = &cancel;
    EXPECT_EQ(build_protecting_balls(c, size, protect_all(c), {}, control).outcome, Outcome::cancelled);
}

// --- split on a sphere ---

TEST(SplitOnSphere, StaysOnTheArcAndOnShells) {
    Random random(8);
    for (int round = 0; round < 2000; ++round) {
        const double radius = std::pow(10.0, random.uniform(-6, 3));
        const Point3 o{random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2)};
        const double tilt = random.uniform(0, 3), width = std::pow(10.0, random.uniform(-4, 0)) * 89.9 * degree;
        const auto on_circle = [&](double t) {
            return Point3{o.x + radius * std::cos(t), o.y + radius * std::sin(t) * std::cos(tilt),
                          o.z + radius * std::sin(t) * std::sin(tilt)};
        };
        const Point3 a = on_circle(0.3), b = on_circle(0.3 + width);
        const auto dist = [](const Point3& p, const Point3& q) {
            return static_cast<double>(oracle::distance(oracle::vec(p), oracle::vec(q)));
        };
        const double noise = 2e-15 + 1e-12 * radius, chord = dist(a, b);
        const Point3 m = split_on_sphere(o, radius, a, b, SplitFrom::middle);
        EXPECT_NEAR(dist(m, o), radius, noise);
        EXPECT_NEAR(dist(m, a), dist(m, b), 4 * noise);
        const Point3 s = split_on_sphere(o, radius, a, b, SplitFrom::first);
        EXPECT_EQ(s, split_on_sphere(o, radius, b, a, SplitFrom::second));
        EXPECT_NEAR(dist(s, o), radius, noise);
        const double d = dist(a, s), shell = std::exp2(std::round(std::log2(d)));
        EXPECT_NEAR(d, shell, 4 * noise + 1e-10 * d);
        EXPECT_LE(d, 2.0 / 3 * chord * 1.0000001 + 4 * noise);
        EXPECT_GE(d, 1.0 / 3 * chord * 0.9999999 - 4 * noise);
        const auto normal =
            oracle::cross(oracle::sub(oracle::vec(a), oracle::vec(o)), oracle::sub(oracle::vec(b), oracle::vec(o)));
        for (const Point3& c : {m, s}) {
            const auto height = oracle::dot(normal, oracle::sub(oracle::vec(c), oracle::vec(o))) / oracle::norm(normal);
            EXPECT_LE(std::abs(height), 10 * noise / width);
        }
    }
}

TEST(SplitOnSphere, ChoosesPPointsFirstAndTheSameEndOnEveryPage) {
    const Complex c = build_complex(gen::make_book(3, 20 * degree));
    const FacetInterior interior = build_facet_interior(c);
    const LocalFeatureSize size(c, interior);
    const ProtectedArea area =
        build_protected_area(c, interior, build_protecting_balls(c, size, protect_sharp(c, interior)));
    const auto role = [&](std::uint32_t id) { return area.new_point(id).role; };
    std::size_t shells = 0;
    for (std::uint32_t f = 0; f < 3; ++f) {
        for (const ShieldEdge& e : area.shields[f]) {
            const SplitFrom from = choose_split(area, e.a, e.b, e.ball);
            const SplitFrom turned = choose_split(area, e.b, e.a, e.ball);
            EXPECT_EQ(from == SplitFrom::middle, turned == SplitFrom::middle);
            if (from == SplitFrom::middle) {
                EXPECT_TRUE(role(e.a) == PointRole::sos && role(e.b) == PointRole::sos);
                continue;
            }
            ++shells;
            EXPECT_NE(from, turned);
            const std::uint32_t chosen = from == SplitFrom::first ? e.a : e.b,
                                other = from == SplitFrom::first ? e.b : e.a;
            EXPECT_TRUE(role(other) != PointRole::p || role(chosen) == PointRole::p);
            EXPECT_NE(role(chosen), PointRole::sos);
        }
    }
    EXPECT_GT(shells, 0u);
}

// --- real models ---

class RealModel : public testing::TestWithParam<const char*> {};

TEST_P(RealModel, IsProtected) {
    const char* models = std::getenv("CERTA_MODELS");
    const auto file = std::filesystem::path(models != nullptr ? models : ".") / "plc" / GetParam();
    if (models == nullptr || !std::filesystem::exists(file)) GTEST_SKIP() << GetParam() << " needs CERTA_MODELS";
    const Complex c = build_complex(read_document(file.string()).complex);
    const FacetInterior interior = build_facet_interior(c);
    const LocalFeatureSize size(c, interior);
    for (const bool all : {false, true}) {
        const ProtectedSet set = all ? protect_all(c) : protect_sharp(c, interior);
        const ProtectingBalls balls = build_protecting_balls(c, size, set, {.max_balls = 500000});
        if (all && balls.outcome == Outcome::over_budget) {  // triceratops: a cap of 0.0002 degrees
            EXPECT_TRUE(balls.obstacle.has_value());
            continue;
        }
        ASSERT_EQ(balls.outcome, Outcome::done);
        if (balls.balls.size() > 40000) continue;  // the oracles would take long
        const auto found = oracle::check_balls(c, balls, set, balls.balls.size() < 1000);
        EXPECT_EQ(found.count, 0u) << found.text();
        const auto wrong = oracle::check_area(c, balls, build_protected_area(c, interior, balls));
        EXPECT_EQ(wrong.count, 0u) << wrong.text();
    }
}

INSTANTIATE_TEST_SUITE_P(Plc, RealModel,
                         testing::Values("cgal_fandisk.off", "cgal_anchor.off", "geo_pinch_1k.off",
                                         "cgal_triceratops.off", "book7.off", "umbrella14.off", "fan7_16v_10deg.off"),
                         [](const auto& info) {
                             std::string name = info.param;
                             std::replace_if(
                                 name.begin(), name.end(), [](char ch) { return !std::isalnum(ch); }, '_');
                             return name;
                         });

}  // namespace
}  // namespace certa::conforming
