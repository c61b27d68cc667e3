// The measures of definitions 5 and 7 on whole surfaces: closed forms, Gauss-Bonnet, Steiner, additivity of the normal
// cycle, rigid motions, scaling. Seeds are fixed; failures name them.
#include <gtest/gtest.h>

#include <bit>

#include "curvature/meshes.h"

using namespace certa;
using namespace certa::testing;

namespace {

CurvatureMeasures total_of(const TriangleMesh& mesh) { return compute_curvature(mesh).total; }

TEST(Measures, BoxInClosedForm) {
    const double x = 2.0, y = 3.0, z = 0.5;
    const CurvatureMeasures m = total_of(generators::make_box(x, y, z));
    EXPECT_NEAR(m.area, 2 * (x * y + y * z + z * x), 1e-13);
    EXPECT_NEAR(m.gaussian, 4 * pi, 1e-13);
    EXPECT_NEAR(m.mean, 2 * pi * (x + y + z), 1e-13);
    EXPECT_NEAR(difference(m.swapped_tensor, {2 * pi * x, 0, 0, 2 * pi * y, 0, 2 * pi * z}), 0.0, 1e-13);
    EXPECT_NEAR(difference(m.tensor, {pi * (y + z), 0, 0, pi * (x + z), 0, pi * (x + y)}), 0.0, 1e-13);
    EXPECT_NEAR(m.edge_mass, m.mean, 1e-13);
    EXPECT_NEAR(m.vertex_mass, 4 * pi, 1e-12);
}

TEST(Measures, InsideOutChangesTheSignOfTheMeanOnly) {
    TriangleMesh mesh = generators::make_box(1, 1, 1);
    for (Triangle& t : mesh.triangles) std::swap(t[0], t[1]);
    const CurvatureMeasures m = total_of(mesh);
    EXPECT_NEAR(m.mean, -6 * pi, 1e-13);
    EXPECT_NEAR(m.gaussian, 4 * pi, 1e-13);
}

TEST(Measures, UnitSphereConvergesToOne) {
    const CurvatureResult r = compute_curvature(generators::make_icosphere(5));
    EXPECT_NEAR(r.total.area, 4 * pi, 0.01);
    EXPECT_NEAR(r.total.mean, 8 * pi, 0.02);
    for (std::size_t v = 0; v < r.k_min.size(); ++v) {
        EXPECT_NEAR(r.k_min[v], 1.0, 0.06);
        EXPECT_NEAR(r.k_max[v], 1.0, 0.06);
        EXPECT_NEAR(r.gaussian[v], 1.0, 0.06);
    }
}

TEST(Measures, GaussBonnetOnClosedMeshesWithSlivers) {
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        core::Random random(seed);
        const bool flatten = seed % 2 == 0;
        const TriangleMesh base =
            seed % 3 == 0 ? generators::make_grid_torus(2.0, 0.7, 12, 9) : generators::make_icosphere(2);
        const CurvatureResult r = compute_curvature(shaken(base, random.coin() ? 0.05 : 3.0, flatten, random));
        EXPECT_NEAR(r.total.gaussian, 2 * pi * static_cast<double>(r.euler_characteristic), 1e-9) << "seed " << seed;
        EXPECT_EQ(r.euler_characteristic, seed % 3 == 0 ? 0 : 2);
        if (flatten) {
            EXPECT_GT(r.statistics.flat_triangles, 0U) << "seed " << seed;
        }
    }
}

TEST(Measures, TracesAreTheMeanMeasure) {
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
        core::Random random(seed);
        const CurvatureOptions options{.measures = true, .tensors = true};
        const CurvatureResult r =
            compute_curvature(shaken(generators::make_icosphere(2), 0.3, seed % 2 == 0, random), options);
        EXPECT_NEAR(r.total.tensor.trace(), r.total.mean, 1e-11) << "seed " << seed;
        EXPECT_NEAR(r.total.swapped_tensor.trace(), r.total.mean, 1e-11) << "seed " << seed;
        for (std::size_t v = 0; v < r.tensor.size(); ++v) {
            EXPECT_NEAR(r.tensor[v].trace(), r.mean_measure[v], 1e-12);
            EXPECT_NEAR(r.swapped_tensor[v].trace(), r.mean_measure[v], 1e-12);
        }
    }
}

TEST(Measures, SteinersFormulaOnBoxes) {
    const double x = 2.0, y = 3.0, z = 0.5, e = 0.3;
    const TubeFormula tube = compute_tube_formula(total_of(generators::make_box(x, y, z)));
    const double exact = 2 * (x * y + y * z + z * x) * e + pi * (x + y + z) * e * e + 4.0 / 3.0 * pi * e * e * e;
    EXPECT_NEAR(tube.volume(e), exact, 1e-13);
}

/// Volume between a convex body and its offset, by counting lattice cells: independent of everything in the room.
double counted_offset(const TriangleMesh& mesh, double offset, int cells) {
    std::vector<std::array<Point3, 2>> planes;
    for (const auto& [a, b, c] : mesh.triangles) {
        const Point3& p = mesh.positions[index_of(a)];
        const Point3 n = cross(mesh.positions[index_of(b)] - p, mesh.positions[index_of(c)] - p);
        planes.push_back({p, (1.0 / norm(n)) * n});
    }
    const auto distance_to = [&](const Point3& q) {
        double nearest = 1e30;
        bool inside = true;
        for (std::size_t k = 0; k < planes.size(); ++k) {
            const auto& t = mesh.triangles[k];
            const double height = dot(q - planes[k][0], planes[k][1]);
            inside = inside && height <= 0.0;
            bool above = true;
            for (std::size_t i = 0; i < 3; ++i) {
                const Point3 &a = mesh.positions[index_of(t[i])], &b = mesh.positions[index_of(t[(i + 1) % 3])];
                const double s = std::clamp(dot(q - a, b - a) / dot(b - a, b - a), 0.0, 1.0);
                nearest = std::min(nearest, distance(q, a + s * (b - a)));
                above = above && dot(cross(b - a, q - a), planes[k][1]) >= 0.0;
            }
            if (above) nearest = std::min(nearest, std::abs(height));
        }
        return inside ? 0.0 : nearest;
    };
    const double low = -2.0, step = 4.0 / cells;
    long count = 0;
    for (int i = 0; i < cells; ++i)
        for (int j = 0; j < cells; ++j)
            for (int k = 0; k < cells; ++k) {
                const double d = distance_to({low + (i + 0.5) * step, low + (j + 0.5) * step, low + (k + 0.5) * step});
                count += d > 0.0 && d < offset;
            }
    return static_cast<double>(count) * step * step * step;
}

TEST(Measures, SteinersFormulaOnSimplices) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        core::Random random(seed);
        const TriangleMesh mesh =
            tetrahedron(random_point(random), random_point(random), random_point(random), random_point(random));
        const double exact = compute_tube_formula(total_of(mesh)).volume(0.6);
        EXPECT_NEAR(counted_offset(mesh, 0.6, 80), exact, 0.01 * exact) << "seed " << seed;
    }
}

/// A tetrahedron cut in two: N(A) + N(B) = N(A or B) + N(A and B), the last being a flat triangle seen from both sides.
TEST(Measures, NormalCyclesAreAdditive) {
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
        core::Random random(seed);
        const Point3 a = random_point(random), b = random_point(random), c = random_point(random),
                     d = random_point(random);
        const Point3 m = 0.25 * a + 0.75 * b;
        const CurvatureMeasures whole = total_of(tetrahedron(a, b, c, d)), first = total_of(tetrahedron(a, m, c, d));
        const CurvatureMeasures second = total_of(tetrahedron(m, b, c, d));
        const TriangleMesh both{{m, c, d}, {triangle(0, 1, 2), triangle(0, 2, 1)}};
        const CurvatureMeasures common = total_of(both);
        EXPECT_NEAR(first.mean + second.mean, whole.mean + common.mean, 1e-11) << "seed " << seed;
        EXPECT_NEAR(first.gaussian + second.gaussian, whole.gaussian + common.gaussian, 1e-11);
        EXPECT_NEAR(first.area + second.area, whole.area + common.area, 1e-12);
        SymmetricTensor3 left = first.tensor, right = whole.tensor;
        left.xx += second.tensor.xx, left.xy += second.tensor.xy, left.xz += second.tensor.xz;
        left.yy += second.tensor.yy, left.yz += second.tensor.yz, left.zz += second.tensor.zz;
        right.xx += common.tensor.xx, right.xy += common.tensor.xy, right.xz += common.tensor.xz;
        right.yy += common.tensor.yy, right.yz += common.tensor.yz, right.zz += common.tensor.zz;
        EXPECT_NEAR(difference(left, right), 0.0, 1e-10) << "seed " << seed;
    }
}

/// Solids that touch in an edge or a vertex: the measures of the union by inclusion and exclusion.
TEST(Measures, SolidsThatTouch) {
    const Point3 o{0, 0, 0}, x{1, 0, 0};
    const TriangleMesh first = tetrahedron(o, x, {0.2, 1, 0.1}, {0.3, 0.9, 1}),
                       second = tetrahedron(o, x, {0.1, -1, 0}, {0.4, -1, -1});
    const CurvatureMeasures a = total_of(first), b = total_of(second), edge = total_of(joined(first, second, true));
    // The normal cycle of the common segment: a full turn around it, and a sphere at its ends.
    EXPECT_NEAR(edge.mean, a.mean + b.mean - 2 * pi, 1e-12);
    EXPECT_NEAR(edge.gaussian, 4 * pi, 1e-12);
    EXPECT_NEAR(edge.tensor.trace(), edge.mean, 1e-12);
    const TriangleMesh third = tetrahedron(o, {-1, 0.1, 0}, {-1, 1, 0}, {-1, 0.5, 1});
    const CurvatureResult touching = compute_curvature(joined(first, third, true));
    EXPECT_NEAR(touching.total.mean, a.mean + total_of(third).mean, 1e-12);
    EXPECT_NEAR(touching.total.gaussian, 4 * pi, 1e-12);
    EXPECT_EQ(touching.statistics.non_manifold_vertices, 1U);
}

TEST(Measures, RigidMotions) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        core::Random random(seed);
        const TriangleMesh mesh = shaken(generators::make_icosphere(2), 0.1, false, random);
        const Rotation turn(random);
        const Point3 shift = 3.0 * random_point(random);
        TriangleMesh moved = mesh;
        for (Point3& p : moved.positions) p = turn(p) + shift;
        const CurvatureResult a = compute_curvature(mesh), b = compute_curvature(moved);
        EXPECT_NEAR(a.total.mean, b.total.mean, 1e-11);
        for (std::size_t v = 0; v < a.k_min.size(); ++v) {
            EXPECT_NEAR(a.k_min[v], b.k_min[v], 1e-9) << "seed " << seed;
            EXPECT_NEAR(a.k_max[v], b.k_max[v], 1e-9);
            EXPECT_NEAR(a.area[v], b.area[v], 1e-11);
            if (a.confidence[v] > 0.05) {
                EXPECT_NEAR(std::abs(dot(turn(a.dir_min[v]), b.dir_min[v])), 1.0, 1e-8);
            }
        }
    }
}

TEST(Measures, ScalingByPowersOfTwoChangesNoBit) {
    core::Random random(7);
    const TriangleMesh mesh = shaken(generators::make_grid_torus(2.0, 0.7, 24, 12), 0.05, true, random);
    const auto options_with = [&](Neighborhood neighborhood, Weight weight, double unit) {
        CurvatureOptions options;
        options.neighborhood = neighborhood, options.weight = weight, options.radius.value = 0.7 * unit;
        options.tensors = options.measures = true;
        return options;
    };
    for (const auto& [neighborhood, weight] :
         {std::pair{Neighborhood::rings, Weight::indicator}, std::pair{Neighborhood::ball, Weight::indicator},
          std::pair{Neighborhood::ball, Weight::kernel2}, std::pair{Neighborhood::ball, Weight::kernel4},
          std::pair{Neighborhood::automatic_ball, Weight::kernel2},
          std::pair{Neighborhood::geodesic, Weight::indicator}}) {
        const CurvatureResult base = compute_curvature(mesh, options_with(neighborhood, weight, 1.0));
        for (const int k : {-40, -17, 23, 40}) {
            TriangleMesh scaled = mesh;
            for (Point3& p : scaled.positions) p = {std::ldexp(p.x, k), std::ldexp(p.y, k), std::ldexp(p.z, k)};
            const CurvatureResult r = compute_curvature(scaled, options_with(neighborhood, weight, std::ldexp(1.0, k)));
            for (std::size_t v = 0; v < base.k_min.size(); ++v) {
                ASSERT_EQ(r.k_min[v], std::ldexp(base.k_min[v], -k)) << "k " << k;
                ASSERT_EQ(r.k_max[v], std::ldexp(base.k_max[v], -k));
                ASSERT_EQ(r.area[v], std::ldexp(base.area[v], 2 * k));
                ASSERT_EQ(r.mean[v], std::ldexp(base.mean[v], -k));
                ASSERT_EQ(r.gaussian[v], std::ldexp(base.gaussian[v], -2 * k));
                ASSERT_EQ(r.dir_min[v], base.dir_min[v]);
                ASSERT_EQ(r.normal[v], base.normal[v]);
                ASSERT_EQ(r.confidence[v], base.confidence[v]);
                ASSERT_EQ(r.swapped_tensor[v].xy, std::ldexp(base.swapped_tensor[v].xy, k));
            }
            ASSERT_EQ(r.total.mean, std::ldexp(base.total.mean, k));
            ASSERT_EQ(r.total.gaussian, base.total.gaussian);
        }
    }
}

RunControl with_threads(unsigned threads) {
    RunControl control;
    control.threads = threads;
    return control;
}

TEST(Measures, SameBitsForAnyNumberOfThreads) {
    const TriangleMesh mesh = generators::make_torus(2.0, 0.7, 1500, 3);
    for (const Neighborhood neighborhood : {Neighborhood::rings, Neighborhood::ball, Neighborhood::automatic_ball}) {
        CurvatureOptions options;
        options.neighborhood = neighborhood, options.radius.value = 0.25;
        const CurvatureResult one = compute_curvature(mesh, options, with_threads(1));
        for (const unsigned threads : {2U, 0U}) {
            const CurvatureResult many = compute_curvature(mesh, options, with_threads(threads));
            EXPECT_EQ(one.k_min, many.k_min);
            EXPECT_EQ(one.dir_max, many.dir_max);
            EXPECT_EQ(one.area, many.area);
            EXPECT_EQ(one.total.mean, many.total.mean);
        }
    }
}

/// Figure 3.2: triangulations with the helicoid's normals in the limit, but with unbounded mass.
TEST(Measures, HelicoidHasUnboundedMass) {
    std::vector<double> masses;
    for (const std::uint32_t n : {4U, 8U, 16U}) {
        const CurvatureMeasures m = total_of(generators::make_helicoid(n, n * n));
        masses.push_back(m.edge_mass);
        const CurvatureMeasures tame = total_of(generators::make_helicoid(n, n));
        EXPECT_LT(tame.edge_mass, 12.0);
    }
    EXPECT_GT(masses[1], 1.5 * masses[0]);
    EXPECT_GT(masses[2], 1.8 * masses[1]);
}

}  // namespace
