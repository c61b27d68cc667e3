// Distances with known answers, bounds that hold for every triangulation, and nothing below what brute force finds.
#include <certa/distance.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "core/triangle_tree.h"
#include "core/vector3.h"
#include "verify/surfaces.h"

namespace certa::test {
namespace {

/// The largest distance over a dense net on each triangle of `from`, by brute force over the triangles of `to`.
double dense_distance(const PolygonMesh& from, const PolygonMesh& to, int steps) {
    double largest = 0.0;
    const auto corner = [](const PolygonMesh& m, std::size_t i) { return m.positions[index_of(m.corners[i])]; };
    for (std::size_t q = 0; q + 1 < from.offsets.size(); ++q) {
        const Point3 a = corner(from, from.offsets[q]), b = corner(from, from.offsets[q] + 1),
                     c = corner(from, from.offsets[q] + 2);
        for (int i = 0; i <= steps; ++i)
            for (int j = 0; i + j <= steps; ++j) {
                const double u = i / double(steps), v = j / double(steps);
                const Point3 p = (1.0 - u - v) * a + u * b + v * c;
                double least = 1e300;
                for (std::size_t t = 0; t + 1 < to.offsets.size(); ++t) {
                    const std::size_t f = to.offsets[t];
                    least = std::min(
                        least, core::find_nearest_on_triangle(p, corner(to, f), corner(to, f + 1), corner(to, f + 2))
                                   .squared_distance);
                }
                largest = std::max(largest, std::sqrt(least));
            }
    }
    return largest;
}

/// Quads cut along one diagonal; coin by coin if `random` is given.
PolygonMesh cut_quads(const PolygonMesh& mesh, core::Random* random) {
    PolygonMesh cut;
    cut.positions = mesh.positions;
    for (std::size_t q = 0; q + 1 < mesh.offsets.size(); ++q) {
        const VertexId* c = mesh.corners.data() + mesh.offsets[q];
        if (mesh.offsets[q + 1] - mesh.offsets[q] == 3) {
            add_polygon(cut, {c[0], c[1], c[2]});
        } else if (random != nullptr && random->coin()) {
            add_polygon(cut, {c[0], c[1], c[3]});
            add_polygon(cut, {c[1], c[2], c[3]});
        } else {
            add_polygon(cut, {c[0], c[1], c[2]});
            add_polygon(cut, {c[0], c[2], c[3]});
        }
    }
    return cut;
}

TEST(Distance, ParallelPlanes) {
    const PolygonMesh low = make_grid(7, 5, [](double u, double v) { return Point3{u, v, 0.0}; });
    const PolygonMesh high = make_grid(3, 4, [](double u, double v) { return Point3{u, v, 0.125}; });
    const SurfaceDistance d = measure_distance(low, high);
    for (const OneSidedDistance& side : {d.to_first, d.to_second}) {
        EXPECT_NEAR(side.rms, 0.125, 1e-12);
        EXPECT_NEAR(side.mean, 0.125, 1e-12);
        EXPECT_NEAR(side.largest, 0.125, 1e-12);
        EXPECT_GE(side.bound, 0.125);
        EXPECT_LE(side.bound, 0.125 * 1.02 + 1e-12);
    }
    EXPECT_TRUE(d.is_tight);
    EXPECT_NEAR(d.diagonal, std::sqrt(2.0 + 0.0), 1e-12);
}

TEST(Distance, ShiftedCubes) {
    const PolygonMesh cube = make_cube(1), shifted = moved(make_cube(3), {0.25, 0.0, 0.0});
    const SurfaceDistance d = measure_distance(cube, shifted);
    EXPECT_NEAR(d.hausdorff, 0.25, 1e-9);
    EXPECT_GE(d.hausdorff_bound, 0.25);
    EXPECT_LE(d.hausdorff_bound, 0.25 * 1.02 + 1e-9);
}

TEST(Distance, SameSurfaceCutDifferently) {
    const SurfaceDistance d = measure_distance(make_cube(1), cut_quads(make_cube(7), nullptr));
    EXPECT_LE(d.hausdorff, 1e-15);
    EXPECT_LE(d.hausdorff_bound, 1e-5 * d.diagonal);
    EXPECT_TRUE(d.is_tight);
}

TEST(Distance, SphereAndLargerSphere) {
    const PolygonMesh small = make_sphere(40, 80, 1.0), large = make_sphere(60, 90, 1.1);
    const SurfaceDistance d = measure_distance(small, large);
    const double coarse = 1.0 - std::cos(3.15 / 40.0);  // how deep a facet may lie below its sphere
    EXPECT_NEAR(d.hausdorff, 0.1, 2.0 * coarse);
    EXPECT_NEAR(d.rms, 0.1, 2.0 * coarse);
    EXPECT_GE(d.hausdorff_bound, d.hausdorff);
    EXPECT_LE(d.hausdorff_bound, 1.02 * d.hausdorff + 1e-9);
}

TEST(Distance, AHoleShowsFromOneSideOnly) {
    const PolygonMesh whole = make_grid(8, 8, [](double u, double v) { return Point3{u, v, 0.0}; });
    PolygonMesh holed = whole;
    holed.corners.clear(), holed.offsets = {0};
    for (std::size_t q = 0; q < 64; ++q) {  // without the middle 2 x 2
        const bool is_middle = (q / 8 == 3 || q / 8 == 4) && (q % 8 == 3 || q % 8 == 4);
        if (is_middle) continue;
        const VertexId* c = whole.corners.data() + whole.offsets[q];
        add_polygon(holed, {c[0], c[1], c[2], c[3]});
    }
    const SurfaceDistance d = measure_distance(holed, whole);
    EXPECT_LE(d.to_second.bound, 1e-5 * d.diagonal);
    EXPECT_NEAR(d.to_first.largest, 0.125, 0.002);  // the middle of the hole, a vertex
    EXPECT_GE(d.to_first.bound, 0.125);
    EXPECT_LE(d.to_first.bound, 0.1276);
}

TEST(Distance, BoundsHoldForEveryTriangulationOfWarpedQuads) {
    const auto bump = [](double u, double v) {
        return Point3{u, v, 0.3 * std::sin(3.0 * u) * std::cos(4.0 * v) + 0.2 * u * v};
    };
    const PolygonMesh coarse = make_grid(4, 4, bump), fine = cut_quads(make_grid(16, 16, bump), nullptr);
    const SurfaceDistance d = measure_distance(coarse, fine);
    EXPECT_TRUE(d.is_tight);
    core::Random random(11);
    double largest = 0.0, largest_back = 0.0;
    for (int round = 0; round < 8; ++round) {
        const PolygonMesh cut = cut_quads(coarse, &random);
        largest = std::max(largest, dense_distance(cut, fine, 12));
        largest_back = std::max(largest_back, dense_distance(fine, cut, 4));
    }
    EXPECT_GE(d.to_second.bound, largest);
    EXPECT_GE(d.to_first.bound, largest_back);
    // The two diagonals of the worst quad differ: the measured distance, on the better one, is below.
    EXPECT_LT(d.to_second.largest, largest);
    EXPECT_LE(d.to_second.bound, 1.15 * largest);
    EXPECT_LE(d.to_first.bound, 1.15 * std::max(largest_back, d.to_first.largest));
}

TEST(Distance, BoundsAreAboveBruteForceOnRandomSoups) {
    core::Random random(23);
    for (int round = 0; round < 12; ++round) {
        PolygonMesh soups[2];
        for (PolygonMesh& soup : soups)
            for (std::uint32_t t = 0; t < 6; ++t) {
                for (int k = 0; k < 3; ++k)
                    soup.positions.push_back({random.uniform(), random.uniform(), random.uniform()});
                add_polygon(soup, {VertexId{3 * t}, VertexId{3 * t + 1}, VertexId{3 * t + 2}});
            }
        const SurfaceDistance d = measure_distance(soups[0], soups[1], {.samples = 100});
        const double dense = dense_distance(soups[0], soups[1], 25);
        EXPECT_GE(d.to_second.bound, dense);
        EXPECT_LE(d.to_second.bound, 1.1 * std::max(dense, d.to_second.largest));
        EXPECT_GE(d.to_first.bound, dense_distance(soups[1], soups[0], 25));
    }
}

TEST(FarPlaces, AreThePolygonsBeyondTheLimit) {
    // One square of an 8 x 8 grid is lifted by its four corners; limits below and above the height.
    const PolygonMesh flat = make_grid(8, 8, [](double u, double v) { return Point3{u, v, 0.0}; });
    PolygonMesh lifted = flat;
    const std::size_t square = 27;
    for (std::size_t i = lifted.offsets[square]; i < lifted.offsets[square + 1]; ++i)
        lifted.positions[index_of(lifted.corners[i])].z = 0.02;
    EXPECT_TRUE(find_far_places(lifted, flat, 0.021).empty());
    const std::vector<FarPlace> places = find_far_places(lifted, flat, 0.01);
    ASSERT_FALSE(places.empty());
    std::size_t on_first = 0, on_second = 0;
    bool has_square = false;
    for (const FarPlace& place : places) {
        ++(place.is_on_first ? on_first : on_second);
        has_square = has_square || (place.is_on_first && place.polygon == square && place.nearest == square);
        const std::size_t row = place.polygon / 8, column = place.polygon % 8;  // the lifted corners' squares
        EXPECT_TRUE(row >= 2 && row <= 4 && column >= 2 && column <= 4) << place.polygon;
        EXPECT_NEAR(place.place.z, place.is_on_first ? 0.015 : 0.0, 0.006);
    }
    EXPECT_TRUE(has_square);
    EXPECT_GT(on_first, 0U);
    EXPECT_GT(on_second, 0U);
}

TEST(FarPlaces, AreNoneExactlyWhereTheBoundHolds) {
    core::Random random(5);
    for (int round = 0; round < 6; ++round) {
        const double height = 0.1 * random.uniform();
        const auto bump = [&](double u, double v) {
            return Point3{u, v, height * std::sin(7.0 * u) * std::cos(5.0 * v) + 0.2 * u * v};
        };
        const PolygonMesh coarse = make_grid(5, 4, bump), fine = cut_quads(make_grid(20, 17, bump), nullptr);
        const SurfaceDistance d = measure_distance(coarse, fine);
        EXPECT_TRUE(find_far_places(coarse, fine, 1.021 * d.hausdorff_bound + 1e-12).empty());
        EXPECT_FALSE(find_far_places(coarse, fine, 0.95 * d.hausdorff_bound).empty());  // bounds are 2 % tight
    }
    EXPECT_THROW(find_far_places(make_cube(1), make_cube(2), 0.0), InputError);
}

TEST(Distance, DoesNotDependOnThreadsNorOnTheScale) {
    const PolygonMesh a = make_sphere(20, 30, 1.0), b = make_sphere(33, 41, 1.05);
    RunControl one_thread;
    one_thread.threads = 1;
    const SurfaceDistance d = measure_distance(a, b), one = measure_distance(a, b, {}, one_thread);
    EXPECT_EQ(d.rms, one.rms);
    EXPECT_EQ(d.hausdorff_bound, one.hausdorff_bound);
    for (const double scale : {std::ldexp(1.0, 600), std::ldexp(1.0, -600)}) {
        const SurfaceDistance other = measure_distance(scaled(a, scale), scaled(b, scale));
        EXPECT_EQ(other.hausdorff, scale * d.hausdorff);
        EXPECT_EQ(other.rms, scale * d.rms);
        EXPECT_GE(other.hausdorff_bound, scale * d.hausdorff);
    }
}

TEST(Distance, ABudgetThatEndsLeavesAValidBound) {
    const PolygonMesh a = make_sphere(20, 30, 1.0), b = make_sphere(33, 41, 1.0);
    const SurfaceDistance d = measure_distance(a, b, {.max_pieces = 1});
    EXPECT_FALSE(d.is_tight);
    EXPECT_GE(d.hausdorff_bound, d.hausdorff);
}

TEST(Distance, RefusesWhatIsNoSurface) {
    PolygonMesh good = make_cube(1), bad = good;
    EXPECT_THROW(measure_distance(good, PolygonMesh{}), InputError);
    bad.positions[3].x = std::nan("");
    EXPECT_THROW(measure_distance(good, bad), InputError);
    bad = good;
    bad.corners[2] = VertexId{99};
    EXPECT_THROW(measure_distance(bad, good), InputError);
    bad = good;
    bad.corners[1] = bad.corners[0];
    EXPECT_THROW(measure_distance(bad, good), InputError);
    EXPECT_THROW(measure_distance(good, good, {.tolerance = 0.0}), InputError);
}

TEST(Distance, CanBeCancelled) {
    const std::atomic<bool> cancel{true};
    RunControl control;
    control.cancel = &cancel;
    EXPECT_EQ(measure_distance(make_cube(2), make_cube(3), {}, control).outcome, Outcome::cancelled);
}

}  // namespace
}  // namespace certa::test
