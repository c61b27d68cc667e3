// Degrees of gradients around isolated and other critical sets whose index is known.
#include "implicit/clusters.h"

#include <gtest/gtest.h>

#include "implicit/refine.h"

namespace certa::implicit {
namespace {

struct Index {
    const char* text;
    int degree;
};

class ClusterDegree : public testing::TestWithParam<Index> {};

/// The sum of the degrees of all inner clusters, on a box that no leaf structure is aligned with.
TEST_P(ClusterDegree, IsTheIndex) {
    const expression::Tape tape(parse_expression(GetParam().text));
    Octree tree(*Grid::around({-1.03, -0.97, -1.11}, {1.01, 1.07, 0.93}));
    const Limits limits{2'000'000, 12};
    // f has no zero, so the classification would stop at once: small leaves come from splitting everything.
    for (int depth = 0; depth < 5; ++depth) ASSERT_FALSE(split_all(tree, tree.leaves(), tape, limits, {}));
    int degree = 0, inner = 0;
    for (const Cluster& cluster : find_clusters(tree)) {
        if (cluster.touches_box) continue;
        degree += cluster.degree8 / 8;
        ++inner;
    }
    EXPECT_EQ(degree, GetParam().degree) << inner << " inner clusters";
}

// A constant beyond the range keeps f from vanishing; it does not change the gradient.
INSTANTIATE_TEST_SUITE_P(All, ClusterDegree,
                         testing::Values(Index{"9+x^2+y^2+z^2", 1}, Index{"9-x^2-y^2-z^2", -1},
                                         Index{"9+x^2+y^2-z^2", -1}, Index{"9+x^2-y^2-z^2", 1}, Index{"9+x*y+z^2", -1},
                                         Index{"9+x^3-3*x*y^2+z^2", -2}, Index{"9+x^3-3*x*y^2-z^2", 2},
                                         Index{"9+x^4-6*x^2*y^2+y^4+z^2", -3}, Index{"9+x^3+y^2+z^2", 0},
                                         Index{"9+x+y^2", 0}, Index{"9+(x^2+y^2-0.25)^2+z^2", 1},
                                         Index{"9+(x^2+y^2+z^2-0.25)^2", 1}, Index{"9+sqrt(x^2+y^2+z^2)", 1},
                                         Index{"9+x*y*z", 0}, Index{"9+cos(4*x)+cos(4*y)+cos(4*z)", 1}));

}  // namespace
}  // namespace certa::implicit
