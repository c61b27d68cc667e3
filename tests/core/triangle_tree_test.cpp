// Nearest points: against every triangle in turn, on triangles of every shape; weights make the point.
#include "core/triangle_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "core/vector3.h"

namespace certa::core {
namespace {

Point3 random_point(Random& random) {
    return {random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)};
}

/// The least distance over a fine net of the triangle.
double sampled_distance(const Point3& p, const Point3& a, const Point3& b, const Point3& c) {
    constexpr int steps = 200;
    double least = 1e300;
    for (int i = 0; i <= steps; ++i)
        for (int j = 0; i + j <= steps; ++j) {
            const double u = i / double(steps), v = j / double(steps);
            least = std::min(least, distance(p, (1.0 - u - v) * a + u * b + v * c));
        }
    return least;
}

void expect_weights_make_the_point(const NearestPoint& n, const Point3& p, const Point3& a, const Point3& b,
                                   const Point3& c) {
    for (const double w : n.weights) EXPECT_GE(w, 0.0);
    EXPECT_NEAR(n.weights[0] + n.weights[1] + n.weights[2], 1.0, 1e-15);
    EXPECT_LE(distance(n.point, n.weights[0] * a + n.weights[1] * b + n.weights[2] * c), 1e-15);
    EXPECT_NEAR(std::sqrt(n.squared_distance), distance(p, n.point), 1e-15);
}

TEST(NearestOnTriangle, AgreesWithSamplingAlsoForSlivers) {
    Random random(7);
    for (int round = 0; round < 60; ++round) {
        Point3 a = random_point(random), b = random_point(random), c = random_point(random);
        if (round % 4 == 1) c = a + 0.3 * (b - a);                                // no area
        if (round % 4 == 2) c = a + 0.3 * (b - a) + 1e-9 * random_point(random);  // next to none
        if (round % 8 == 3) b = a;                                                // two corners in one
        if (round % 8 == 7) b = c = a;                                            // a point
        const Point3 p = random_point(random);
        const NearestPoint nearest = find_nearest_on_triangle(p, a, b, c);
        expect_weights_make_the_point(nearest, p, a, b, c);
        EXPECT_NEAR(std::sqrt(nearest.squared_distance), sampled_distance(p, a, b, c), 1.5e-2);
        EXPECT_LE(std::sqrt(nearest.squared_distance), sampled_distance(p, a, b, c) + 1e-12);
    }
}

/// Points on a needle, and above it, are as far away as they are, to nearly the last digit.
TEST(NearestOnTriangle, IsExactOnNeedles) {
    Random random(11);
    for (int round = 0; round < 400; ++round) {
        const double height = std::pow(10.0, -3.0 - round % 10);
        const Point3 a = random_point(random), along = random_point(random);
        const Point3 normal = (1.0 / norm(cross(along, {0.3, -0.5, 0.8}))) * cross(along, {0.3, -0.5, 0.8});
        const Point3 b = a + along, c = a + (round % 3 == 0 ? 10.0 * height : 0.4) * along + height * normal;
        const double u = random.uniform(), v = random.uniform() * (1.0 - u);
        const Point3 p = (1.0 - u - v) * a + u * b + v * c;
        EXPECT_LE(std::sqrt(find_nearest_on_triangle(p, a, b, c).squared_distance), 1e-12);
        EXPECT_LE(std::sqrt(find_nearest_on_triangle(p, b, c, a).squared_distance), 1e-12);
        EXPECT_LE(std::sqrt(find_nearest_on_triangle(p, c, a, b).squared_distance), 1e-12);
        const Point3 up = (1e-3 / norm(along)) * cross(along, normal);
        EXPECT_NEAR(std::sqrt(find_nearest_on_triangle(p + up, a, b, c).squared_distance), 1e-3, 1e-12);
    }
}

TEST(TriangleTree, FindsTheNearestOfAll) {
    Random random(3);
    std::vector<Point3> positions;
    std::vector<Triangle> triangles;
    for (std::uint32_t i = 0; i < 500; ++i) {
        const Point3 corner = random_point(random);
        for (int k = 0; k < 3; ++k) positions.push_back(corner + 0.1 * random_point(random));
        triangles.push_back({VertexId{3 * i}, VertexId{3 * i + 1}, VertexId{3 * i + 2}});
    }
    const TriangleTree tree(positions, triangles);
    for (int round = 0; round < 200; ++round) {
        const Point3 p = random_point(random);
        double least = 1e300;
        for (std::uint32_t i = 0; i < 500; ++i) {
            const Point3* t = positions.data() + 3 * i;
            least = std::min(least, find_nearest_on_triangle(p, t[0], t[1], t[2]).squared_distance);
        }
        const auto hint = static_cast<std::uint32_t>(random.below(500));
        EXPECT_EQ(tree.find_nearest(p).squared_distance, least);
        EXPECT_EQ(tree.find_nearest(p, hint).squared_distance, least);
        EXPECT_EQ(tree.find_nearest(p, hint).triangle, tree.find_nearest(p).triangle);
        EXPECT_EQ(tree.find_nearest(p, no_index, 0.99 * std::sqrt(least)).triangle, no_index);
    }
}

TEST(TriangleTree, FindsTheNearestAtAnyScaleAndFromFarAway) {
    Random random(9);
    for (const double size : {1e-120, 1e-9, 1.0, 3e5, 1e60})
        for (const double offset : {0.0, 1.0, 1e7})
            for (const std::uint32_t count : {1u, 2u, 5u, 17u, 300u}) {
                std::vector<Point3> positions;
                std::vector<Triangle> triangles;
                const Point3 middle = (size * offset) * Point3{1.0, -2.0, 0.5};
                for (std::uint32_t i = 0; i < count; ++i) {
                    const Point3 corner = random_point(random);
                    for (int k = 0; k < 3; ++k)
                        positions.push_back(size * (corner + 0.1 * random_point(random)) + middle);
                    triangles.push_back({VertexId{3 * i}, VertexId{3 * i + 1}, VertexId{3 * i + 2}});
                }
                const TriangleTree tree(positions, triangles);
                for (int round = 0; round < 20; ++round) {
                    const double reach = round < 10 ? 1.0 : round < 15 ? 6.0 : 1e5;
                    const Point3 p = (size * reach) * random_point(random) + middle;
                    double least = 1e300;
                    for (std::uint32_t i = 0; i < count; ++i) {
                        const Point3* t = positions.data() + 3 * i;
                        least = std::min(least, find_nearest_on_triangle(p, t[0], t[1], t[2]).squared_distance);
                    }
                    EXPECT_EQ(tree.find_nearest(p).squared_distance, least);
                    // Within a box around the point that just reaches, something is visited.
                    const double half = 1.000001 * std::sqrt(least);
                    std::uint32_t visited = 0;
                    tree.visit_box(p - Point3{half, half, half}, p + Point3{half, half, half},
                                   [&](std::uint32_t) { ++visited; });
                    EXPECT_GT(visited, 0U);
                }
            }
}

TEST(TriangleTree, AsksForNothingButTheNearestWhereManyAreEqual) {
    // A point with a hundred triangles in one place, and one at a distance.
    std::vector<Point3> positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 5}, {1, 0, 5}, {0, 1, 5}};
    std::vector<Triangle> triangles(100, {VertexId{0}, VertexId{1}, VertexId{2}});
    triangles.push_back({VertexId{3}, VertexId{4}, VertexId{5}});
    const TriangleTree tree(positions, triangles);
    EXPECT_EQ(tree.find_nearest({0.2, 0.2, 4.0}).triangle, 100U);
    EXPECT_EQ(tree.find_nearest({0.2, 0.2, 2.0}).squared_distance, 4.0);
}

TEST(TriangleTree, VisitsAllThatMeetABox) {
    Random random(5);
    std::vector<Point3> positions;
    std::vector<Triangle> triangles;
    for (std::uint32_t i = 0; i < 300; ++i) {
        for (int k = 0; k < 3; ++k) positions.push_back(random_point(random));
        triangles.push_back({VertexId{3 * i}, VertexId{3 * i + 1}, VertexId{3 * i + 2}});
    }
    const TriangleTree tree(positions, triangles);
    const Point3 low{-0.9, -0.9, -0.9}, high{-0.6, -0.5, -0.4};
    std::vector<std::uint32_t> visited;
    tree.visit_box(low, high, [&](std::uint32_t t) { visited.push_back(t); });
    std::sort(visited.begin(), visited.end());
    for (std::uint32_t i = 0; i < 300; ++i) {
        const Point3* t = positions.data() + 3 * i;
        const bool is_inside = std::any_of(t, t + 3, [&](const Point3& p) {
            return p.x >= low.x && p.x <= high.x && p.y >= low.y && p.y <= high.y && p.z >= low.z && p.z <= high.z;
        });
        EXPECT_TRUE(!is_inside || std::binary_search(visited.begin(), visited.end(), i));
    }
    EXPECT_TRUE(TriangleTree({}, {}).empty());
    EXPECT_EQ(TriangleTree({}, {}).find_nearest(low).triangle, no_index);
}

}  // namespace
}  // namespace certa::core
