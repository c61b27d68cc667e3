// Multiplicities in the normal cycle (thesis, Lemma 16).
#include <gtest/gtest.h>

#include <algorithm>

#include "curvature/meshes.h"
#include "curvature/surface.h"

using namespace certa;
using namespace certa::testing;

namespace {

/// Directions spread evenly over the sphere (a spiral), turned at random.
std::vector<Point3> sphere_points(std::size_t count, core::Random& random) {
    const Rotation turn(random);
    std::vector<Point3> points;
    for (std::size_t i = 0; i < count; ++i) {
        const double z = 1.0 - (2.0 * static_cast<double>(i) + 1.0) / static_cast<double>(count);
        const double angle = static_cast<double>(i) * pi * (3.0 - std::sqrt(5.0)), r = std::sqrt(1.0 - z * z);
        points.push_back(turn({r * std::cos(angle), r * std::sin(angle), z}));
    }
    return points;
}

double integral(const std::vector<int>& multiplicities) {
    double sum = 0.0;
    for (const int mu : multiplicities) sum += mu;
    return 4.0 * pi * sum / static_cast<double>(multiplicities.size());
}

/// A double pyramid over a closed polygon around the z axis whose heights are given: every kind of vertex at its apex.
TriangleMesh double_pyramid(const std::vector<double>& heights, double bottom) {
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {0, 0, bottom}};
    const auto n = static_cast<std::uint32_t>(heights.size());
    for (std::uint32_t i = 0; i < n; ++i) {
        const double angle = 2.0 * pi * i / n;
        mesh.positions.push_back({std::cos(angle), std::sin(angle), heights[i]});
    }
    for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t a = 2 + i, b = 2 + (i + 1) % n;
        mesh.triangles.push_back(triangle(0, a, b));
        mesh.triangles.push_back(triangle(1, b, a));
    }
    return mesh;
}

TEST(Multiplicity, IntegratesToTheAngleDefect) {
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        core::Random random(seed);
        std::vector<double> heights(3 + random.below(8));
        for (double& h : heights) h = random.uniform(-1.5, 1.5);
        const TriangleMesh mesh = double_pyramid(heights, -5.0);
        const curvature::Surface surface = curvature::build_surface(mesh, {});
        const std::vector<Point3> directions = sphere_points(8000, random);
        for (const std::uint32_t v : {0U, 2U}) {
            const std::vector<int> mu = compute_multiplicities(mesh, VertexId{v}, directions);
            const auto at = std::find(surface.vertex_sources.begin(), surface.vertex_sources.end(), v) -
                            surface.vertex_sources.begin();
            EXPECT_NEAR(integral(mu), surface.defects[static_cast<std::size_t>(at)], 0.04) << "seed " << seed;
            EXPECT_LE(*std::max_element(mu.begin(), mu.end()), 1) << "mu <= 1 at regular vertices";
        }
    }
}

TEST(Multiplicity, ConvexSaddleAndMonkey) {
    const Point3 up{0.01, 0.02, 1.0}, down{-0.01, -0.02, -1.0};
    const auto at = [&](const std::vector<double>& heights) {
        return compute_multiplicities(double_pyramid(heights, -5.0), VertexId{0}, {up, down});
    };
    EXPECT_EQ(at({-1, -1, -1, -1}), (std::vector<int>{1, 0}));
    EXPECT_EQ(at({1, 1, 1, 1}), (std::vector<int>{1, 0}));  // a pit: positive too, its normals point up and in
    EXPECT_EQ(at({1, -1, 1, -1})[0], -1);
    EXPECT_EQ(at({1, -1, 1, -1, 1, -1})[0], -2);
}

/// The index that sees the surface only, 1 - crossings / 2 with the plane at a right angle to h, is mu(h) + mu(-h).
TEST(Multiplicity, BothSidesMakeTheIndexOfTheSurface) {
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
        core::Random random(seed);
        std::vector<double> heights(4 + random.below(6));
        for (double& h : heights) h = random.uniform(-1.0, 1.0);
        const TriangleMesh mesh = double_pyramid(heights, -5.0);
        for (int k = 0; k < 20; ++k) {
            const Point3 h = random_point(random);
            int crossings = 0;
            for (std::size_t i = 0; i < heights.size(); ++i)
                crossings += (dot(mesh.positions[2 + i], h) > 0.0) !=
                             (dot(mesh.positions[2 + (i + 1) % heights.size()], h) > 0.0);
            const std::vector<int> mu = compute_multiplicities(mesh, VertexId{0}, {h, -1.0 * h});
            EXPECT_EQ(mu[0] + mu[1], 1 - crossings / 2) << "seed " << seed;
        }
    }
}

/// Where solids touch, the integral is what the measures say too.
TEST(Multiplicity, WhereSolidsTouch) {
    core::Random random(5);
    const Point3 o{0, 0, 0}, x{1, 0, 0};
    const TriangleMesh first = tetrahedron(o, x, {0.2, 1, 0.1}, {0.3, 0.9, 1});
    for (const TriangleMesh& second :
         {tetrahedron(o, x, {0.1, -1, 0}, {0.4, -1, -1}), tetrahedron(o, {-1, 0.1, 0}, {-1, 1, 0}, {-1, 0.5, 1})}) {
        const TriangleMesh mesh = joined(first, second, true);
        const curvature::Surface surface = curvature::build_surface(mesh, {});
        const auto v = std::find(mesh.positions.begin(), mesh.positions.end(), o) - mesh.positions.begin();
        const auto at =
            std::find(surface.vertex_sources.begin(), surface.vertex_sources.end(), v) - surface.vertex_sources.begin();
        const std::vector<int> mu =
            compute_multiplicities(mesh, VertexId{static_cast<std::uint32_t>(v)}, sphere_points(50000, random));
        EXPECT_NEAR(integral(mu), surface.defects[static_cast<std::size_t>(at)], 0.02);
    }
}

TEST(Multiplicity, OpenSurfacesAreRefused) {
    const TriangleMesh open{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {triangle(0, 1, 2)}};
    EXPECT_THROW(compute_multiplicities(open, VertexId{0}, {{0, 0, 1}}), InputError);
    EXPECT_THROW(compute_multiplicities(open, VertexId{7}, {{0, 0, 1}}), InputError);
}

}  // namespace
