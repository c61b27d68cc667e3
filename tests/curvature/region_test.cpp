// Measures of regions with exact clipping: closed forms, inclusion and exclusion, rims, predicates, refusals.
#include <gtest/gtest.h>

#include "curvature/meshes.h"

using namespace certa;
using namespace certa::testing;

namespace {

CurvatureMeasures measure(const TriangleMesh& mesh, const Region& region, Rim rim = Rim::half) {
    return compute_region_measures(mesh, region, {.rim = rim}).measures;
}

void expect_equal(const CurvatureMeasures& a, const CurvatureMeasures& b, double tolerance, std::uint64_t seed) {
    EXPECT_NEAR(a.area, b.area, tolerance) << "seed " << seed;
    EXPECT_NEAR(a.gaussian, b.gaussian, tolerance) << "seed " << seed;
    EXPECT_NEAR(a.mean, b.mean, tolerance) << "seed " << seed;
    EXPECT_NEAR(difference(a.tensor, b.tensor), 0.0, tolerance) << "seed " << seed;
    EXPECT_NEAR(difference(a.swapped_tensor, b.swapped_tensor), 0.0, tolerance) << "seed " << seed;
}

CurvatureMeasures sum(const CurvatureMeasures& a, const CurvatureMeasures& b) {
    const auto plus = [](const SymmetricTensor3& s, const SymmetricTensor3& t) {
        return SymmetricTensor3{s.xx + t.xx, s.xy + t.xy, s.xz + t.xz, s.yy + t.yy, s.yz + t.yz, s.zz + t.zz};
    };
    return {a.area + b.area,
            a.gaussian + b.gaussian,
            a.mean + b.mean,
            plus(a.tensor, b.tensor),
            plus(a.swapped_tensor, b.swapped_tensor),
            a.edge_mass + b.edge_mass,
            a.vertex_mass + b.vertex_mass};
}

Region random_region(core::Random& random, std::size_t faces, int depth) {
    switch (random.below(depth > 0 ? 7 : 4)) {
        case 0:
            return make_ball_region(random_point(random), random.uniform(0.2, 1.2));
        case 1:
            return make_half_space_region(0.5 * random_point(random), random_point(random));
        case 2: {
            const Point3 a = random_point(random), b = random_point(random);
            return make_box_region({std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)},
                                   {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)});
        }
        case 3: {
            std::vector<std::uint32_t> some;
            for (std::uint32_t f = 0; f < faces; ++f)
                if (random.coin(0.4)) some.push_back(f);
            return make_face_region(some);
        }
        case 4:
            return make_complement(random_region(random, faces, depth - 1));
        case 5:
            return make_intersection(
                {random_region(random, faces, depth - 1), random_region(random, faces, depth - 1)});
        default:
            return make_union({random_region(random, faces, depth - 1), random_region(random, faces, depth - 1)});
    }
}

TEST(Region, BallOnACubeInClosedForm) {
    const TriangleMesh cube = generators::make_box(2, 2, 2);
    // Around a corner: a quarter of a disc on three faces, three pieces of edges, one vertex.
    const double r = 0.75;
    const CurvatureMeasures corner = measure(cube, make_ball_region({0, 0, 0}, r));
    EXPECT_NEAR(corner.area, 3 * pi * r * r / 4, 1e-13);
    EXPECT_NEAR(corner.mean, 3 * r * pi / 2, 1e-13);
    EXPECT_NEAR(corner.gaussian, pi / 2, 1e-13);
    // Above a face's middle: a disc that crosses the face's diagonal.
    EXPECT_NEAR(measure(cube, make_ball_region({1, 1, 2.3}, 0.5)).area, pi * (0.25 - 0.09), 1e-13);
    EXPECT_EQ(measure(cube, make_ball_region({1, 1, 1}, 0.9)).area, 0.0);
    EXPECT_NEAR(measure(cube, make_ball_region({1, 1, 1}, 2.0)).area, 24.0, 1e-13);
    // Six caps inside the faces.
    EXPECT_NEAR(measure(cube, make_ball_region({1, 1, 1}, 1.2)).area, 6 * pi * 0.44, 1e-12);
    // A lens of two balls on one face: symmetric, of known area.
    const double d = 0.3, radius = 0.5;
    const double lens = 2 * radius * radius * std::acos(d / radius) - 2 * d * std::sqrt(radius * radius - d * d);
    EXPECT_NEAR(measure(cube, make_intersection(
                                  {make_ball_region({1 - d, 1, 2}, radius), make_ball_region({1 + d, 1, 2}, radius)}))
                    .area,
                lens, 1e-13);
}

TEST(Region, HalfSpacesAndBoxesInClosedForm) {
    const TriangleMesh cube = generators::make_box(2, 2, 2);
    const CurvatureMeasures half = measure(cube, make_half_space_region({0, 0, 0.5}, {0, 0, 3}));
    EXPECT_NEAR(half.area, 4 + 4 * 2 * 0.5, 1e-13);
    EXPECT_NEAR(half.mean, (4 * 2 + 4 * 0.5) * pi / 2, 1e-13);
    EXPECT_NEAR(half.gaussian, 2 * pi, 1e-13);
    const CurvatureMeasures box = measure(cube, make_box_region({-1, -1, -1}, {1, 0.5, 0.25}));
    EXPECT_NEAR(box.area, 1 * 0.5 + 0.5 * 0.25 + 1 * 0.25, 1e-13);
    EXPECT_NEAR(box.mean, (1 + 0.5 + 0.25) * pi / 2, 1e-13);
    // The plane of a face: all of it belongs to the closed half-space, none of it to the complement.
    const Region plane = make_half_space_region({0, 0, 0}, {0, 0, 1});
    EXPECT_NEAR(measure(cube, plane).area, 4, 1e-13);
    EXPECT_NEAR(measure(cube, make_complement(plane)).area, 20, 1e-13);
}

TEST(Region, InclusionAndExclusion) {
    for (std::uint64_t seed = 1; seed <= 400; ++seed) {
        core::Random random(seed);
        const TriangleMesh mesh = shaken(generators::make_icosphere(1), 0.2, seed % 5 == 0, random);
        const Region a = random_region(random, mesh.triangles.size(), 2),
                     b = random_region(random, mesh.triangles.size(), 2);
        expect_equal(sum(measure(mesh, a), measure(mesh, b)),
                     sum(measure(mesh, make_union({a, b})), measure(mesh, make_intersection({a, b}))), 1e-10, seed);
        expect_equal(sum(measure(mesh, a), measure(mesh, make_complement(a))), measure(mesh, Region{}), 1e-10, seed);
    }
}

/// Regions that share borders: what one leaves the other takes.
TEST(Region, SharedBordersAreCountedOnce) {
    core::Random random(3);
    const TriangleMesh mesh = shaken(generators::make_icosphere(2), 0.05, false, random);
    const Region ball = make_ball_region({0.5, 0.5, 0.5}, 0.6),
                 plane = make_half_space_region({0.1, 0.2, 0.3}, {1, 2, -1});
    const Region other = make_half_space_region({0.1, 0.2, 0.3}, {-2, -4, 2});
    EXPECT_EQ(measure(mesh, make_intersection({ball, make_complement(ball)})).area, 0.0);
    EXPECT_NEAR(measure(mesh, make_intersection({plane, other})).area, 0.0, 1e-14);
    expect_equal(measure(mesh, make_union({plane, other})), measure(mesh, Region{}), 1e-12, 3);
    expect_equal(measure(mesh, make_union({ball, ball})), measure(mesh, ball), 1e-14, 3);
    expect_equal(measure(mesh, Region{}), compute_curvature(mesh).total, 1e-12, 3);
}

TEST(Region, DisjointBoxesAddUp) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        core::Random random(seed);
        const TriangleMesh mesh = shaken(generators::make_icosphere(2), 0.1, false, random);
        CurvatureMeasures total;
        const double x = random.uniform(-0.5, 0.5), y = random.uniform(-0.5, 0.5);
        for (const double lx : {-3.0, x})
            for (const double ly : {-3.0, y})
                total =
                    sum(total, measure(mesh, make_box_region({lx, ly, -3}, {lx < x ? x : 3.0, ly < y ? y : 3.0, 3})));
        expect_equal(total, compute_curvature(mesh).total, 1e-10, seed);
    }
}

TEST(Region, RimsOfFaceSets) {
    const TriangleMesh cube = generators::make_box(1, 1, 1);
    const Region top = make_face_region({2, 3});  // z = 1
    const CurvatureMeasures open = measure(cube, top, Rim::open), half = measure(cube, top, Rim::half);
    const CurvatureMeasures closed = measure(cube, top, Rim::closed);
    EXPECT_NEAR(open.area, 1.0, 1e-14);
    EXPECT_NEAR(open.mean, 0.0, 1e-14);
    EXPECT_NEAR(half.mean, 4 * pi / 4, 1e-14);
    EXPECT_NEAR(closed.mean, 4 * pi / 2, 1e-14);
    EXPECT_NEAR(open.gaussian, 0.0, 1e-14);
    EXPECT_NEAR(half.gaussian, 4 * pi / 6, 1e-13);  // a third of the angles of four corners of pi / 2
    EXPECT_NEAR(closed.gaussian, 2 * pi, 1e-13);
}

TEST(Region, PredicatesComeWithinTheirTolerance) {
    const TriangleMesh mesh = generators::make_icosphere(2);
    Region predicate;
    predicate.kind = Region::Kind::predicate;
    predicate.predicate = [](const Point3& p) { return distance(p, {1, 0, 0}) <= 0.8; };
    const RegionResult approximate = compute_region_measures(mesh, predicate, {.tolerance = {2e-3, true}});
    const CurvatureMeasures exact = measure(mesh, make_ball_region({1, 0, 0}, 0.8));
    EXPECT_GT(approximate.undecided_area, 0.0);
    EXPECT_NEAR(approximate.measures.area, exact.area, approximate.undecided_area);
    EXPECT_NEAR(approximate.measures.mean, exact.mean, 0.02);
    EXPECT_EQ(approximate.measures.gaussian, exact.gaussian);
}

TEST(Region, BoundOfTheoremThirteen) {
    // A sphere's caps: the smooth measures of the projection are known, the bound must hold.
    const TriangleMesh sphere = generators::make_icosphere(5);
    std::vector<std::uint32_t> cap;
    double projected = 0.0;
    for (std::uint32_t f = 0; f < sphere.triangles.size(); ++f) {
        const auto& t = sphere.triangles[f];
        const Point3 &a = sphere.positions[index_of(t[0])], &b = sphere.positions[index_of(t[1])];
        const Point3& c = sphere.positions[index_of(t[2])];
        if (a.z < 0.5 || b.z < 0.5 || c.z < 0.5) continue;
        cap.push_back(f);
        projected += 2.0 * std::atan2(dot(a, cross(b, c)), 1.0 + dot(a, b) + dot(b, c) + dot(c, a));
    }
    const RegionOptions options{.rim = Rim::open, .bounds = true, .max_curvature = 1.0};
    const RegionResult r = compute_region_measures(sphere, make_face_region(cap), options);
    ASSERT_TRUE(r.bound && r.bound->hypothesis_holds && r.bound->mean && r.bound->gaussian);
    EXPECT_FALSE(r.bound->curvature_estimated);
    EXPECT_LE(std::abs(r.measures.gaussian - projected), *r.bound->gaussian);
    EXPECT_LE(std::abs(r.measures.mean - 2 * projected), *r.bound->mean);
    EXPECT_LE(std::abs(r.measures.mean - 2 * projected), r.bound->calibrated);
    EXPECT_LT(r.bound->calibrated, *r.bound->mean);
    // Too coarse to be closely inscribed: no number is invented.
    const RegionResult coarse =
        compute_region_measures(generators::make_box(1, 1, 1), Region{}, {.bounds = true, .max_curvature = 1.0});
    ASSERT_TRUE(coarse.bound);
    EXPECT_FALSE(coarse.bound->hypothesis_holds);
    EXPECT_FALSE(coarse.bound->mean);
}

TEST(Region, WhatMakesNoSenseIsRefused) {
    const TriangleMesh mesh = generators::make_box(1, 1, 1);
    EXPECT_THROW(measure(mesh, make_ball_region({0, 0, 0}, -1)), InputError);
    EXPECT_THROW(measure(mesh, make_ball_region({0, 0, NAN}, 1)), InputError);
    EXPECT_THROW(measure(mesh, make_box_region({1, 0, 0}, {0, 1, 1})), InputError);
    EXPECT_THROW(measure(mesh, make_half_space_region({0, 0, 0}, {0, 0, 0})), InputError);
    EXPECT_THROW(measure(mesh, make_face_region({12})), InputError);
    EXPECT_THROW(measure(mesh, Region{}, Rim::dual), InputError);
    Region empty;
    empty.kind = Region::Kind::predicate;
    EXPECT_THROW(measure(mesh, empty), InputError);
}

}  // namespace
