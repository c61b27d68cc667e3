// Nearest points found from triangle to triangle, beside those of a tree.
#include "remeshing/walker.h"

#include <gtest/gtest.h>

#include "core/random.h"
#include "core/vector3.h"
#include "mesh/generators_surfaces.h"

namespace certa::remeshing {
namespace {

TEST(Walker, FindsWhatATreeFindsWhereTheStartIsNear) {
    const TriangleMesh torus = generators::make_torus(2.0, 0.7, 4000, 3);
    const core::TriangleTree tree(torus.positions, torus.triangles);
    const Walker walker(torus.positions, torus.triangles);
    core::Random random(5);
    std::size_t found = 0, same = 0;
    constexpr std::size_t count = 4000;
    for (std::size_t k = 0; k < count; ++k) {
        const auto t = static_cast<Index>(random.uniform() * static_cast<double>(torus.triangles.size()));
        const Triangle& c = torus.triangles[t];
        const auto shift = [&] { return 0.04 * (random.uniform() - 0.5); };
        const Point3 p = torus.positions[index_of(c[0])] + Point3{shift(), shift(), shift()};
        const core::NearestPoint exact = tree.find_nearest(p);
        const auto walked = walker.find(p, t);
        if (!walked) continue;
        ++found;
        EXPECT_GE(walked->squared_distance, exact.squared_distance * (1.0 - 1e-9));
        EXPECT_NEAR(dot(walked->point - p, walked->point - p), walked->squared_distance, 1e-15);
        same += walked->squared_distance <= exact.squared_distance * (1.0 + 1e-9) + 1e-18 ? 1 : 0;
    }
    EXPECT_GT(found, count / 2);
    EXPECT_GT(static_cast<double>(same), 0.95 * static_cast<double>(found));
}

TEST(Walker, GivesUpWhereItIsFar) {
    const TriangleMesh torus = generators::make_torus(2.0, 0.7, 4000, 3);
    const Walker walker(torus.positions, torus.triangles);
    const core::TriangleTree tree(torus.positions, torus.triangles);
    const Index start = tree.find_nearest({2.7, 0.0, 0.0}).triangle;
    EXPECT_FALSE(walker.find({0.0, 2.72, 0.0}, start).has_value());
}

}  // namespace
}  // namespace certa::remeshing
