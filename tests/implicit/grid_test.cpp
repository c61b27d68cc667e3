// The grid: boxes grow by at most 2^-20 of their size, and every point that is claimed to be exact is.
#include "implicit/grid.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "core/random.h"

namespace certa::implicit {
namespace {

RC_GTEST_PROP(Grid, EnlargesLittleAndIsExact, (std::uint64_t seed)) {
    core::Random random(seed);
    const double scale = std::ldexp(1.0, static_cast<int>(random.below(400)) - 200);
    double low[3], high[3];
    for (int a = 0; a < 3; ++a) {
        low[a] = scale * random.uniform(-100, 100);
        high[a] = low[a] + scale * random.uniform(0.1, 10);
    }
    const auto grid = Grid::around({low[0], low[1], low[2]}, {high[0], high[1], high[2]});
    RC_ASSERT(grid.has_value());
    RC_ASSERT(grid->resolution() >= 8);
    for (int a = 0; a < 3; ++a) {
        const double size = high[a] - low[a];
        RC_ASSERT(grid->place(a, 0) <= low[a]);
        RC_ASSERT(grid->place(a, grid->side()) >= high[a]);
        RC_ASSERT(low[a] - grid->place(a, 0) <= size * 0x1p-20);
        RC_ASSERT(grid->place(a, grid->side()) - high[a] <= size * 0x1p-20);
        for (int i = 0; i < 50; ++i) {
            const auto p = static_cast<Coordinate>(2 * random.below(grid->side() / 2));
            const auto q = static_cast<Coordinate>(2 * random.below(grid->side() / 2));
            // The middle of two points is the average of their places, exactly: long double has the bits to see it.
            const long double left = grid->place(a, p), right = grid->place(a, q);
            RC_ASSERT(static_cast<long double>(grid->place(a, p / 2 + q / 2)) == left / 2 + right / 2);
            RC_ASSERT(grid->is_exact(1, 1));
            RC_ASSERT(static_cast<long double>(grid->between(a, p, q, 1, 1)) == left / 2 + right / 2);
        }
    }
}

TEST(Grid, RefusesBoxesThatDoublesCannotDivide) {
    EXPECT_FALSE(Grid::around({1e16, 0, 0}, {1e16 + 4, 1, 1}));
    EXPECT_FALSE(Grid::around({0, 0, 0}, {1e-300, 1, 1}));
    EXPECT_TRUE(Grid::around({1e6, 0, 0}, {1e6 + 1, 1, 1}));
}

}  // namespace
}  // namespace certa::implicit
