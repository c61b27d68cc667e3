// Triangle against triangle: what doubles decide beforehand agrees with the exact tests, wherever the numbers lie.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "verify/surface_contacts.h"

namespace certa::verify {
namespace {

struct Pair {
    std::vector<Point3> positions;
    std::array<std::uint32_t, 3> s, t;
};

/// Corners on a small grid, so that contacts are frequent; tilted by rounding errors, shrunk or blown up.
Pair make_pair(std::mt19937_64& random, std::uint32_t shared) {
    const auto below = [&](std::uint64_t n) { return static_cast<double>(random() % n); };
    const double height = below(2) > 0 ? 1.0 : std::ldexp(1.0, -static_cast<int>(random() % 60));
    const double tilt = below(2) > 0 ? 0.0 : std::ldexp(below(16), -static_cast<int>(random() % 60));
    const int exponents[] = {0, 0, 0, -340, -500, 300, 340, 500};
    const int exponent = exponents[random() % 8];
    const std::uint64_t layers = 1 + random() % 4;
    Pair pair;
    for (int i = 0; i < 6; ++i) {
        Point3 p{below(5), below(5), 0.0};
        p.z = tilt * p.x / 3.0 + height * below(layers);
        pair.positions.push_back({std::ldexp(p.x, exponent), std::ldexp(p.y, exponent), std::ldexp(p.z, exponent)});
    }
    pair.s = {0, 1, 2}, pair.t = {shared > 0 ? 0u : 3u, 4, 5};
    return pair;
}

Corners corners_of(const Pair& pair, const std::array<std::uint32_t, 3>& face) {
    return {pair.positions[face[0]], pair.positions[face[1]], pair.positions[face[2]]};
}

TEST(Contacts, DoublesAgreeWithExactSigns) {
    std::mt19937_64 random(20260101);
    std::size_t met = 0, apart = 0;
    for (int i = 0; i < 60'000; ++i) {
        const std::uint32_t shared = i % 2;
        const Pair pair = make_pair(random, shared);
        const Corners s = corners_of(pair, pair.s), t = corners_of(pair, pair.t);
        if (is_degenerate(s) || is_degenerate(t)) continue;
        const bool meet = shared > 0 ? meet_beyond_corner(s, t) : triangles_meet(s, t);
        ASSERT_EQ(meet_beyond_shared(pair.positions, pair.s, pair.t), meet) << "pair " << i;
        ++(meet ? met : apart);
    }
    EXPECT_GT(met, 5'000u);
    EXPECT_GT(apart, 5'000u);
}

// Overflow must not look like a plane between them.
TEST(Contacts, CrossingTrianglesMeetAtAnySize) {
    for (int exponent = -1000; exponent <= 1000; exponent += 25) {
        const double u = std::ldexp(1.0, exponent);
        const std::vector<Point3> positions{{-u, -u, 0}, {u, -u, 0}, {0, u, 0}, {0, 0, -u}, {0, 0, u}, {0, u, u}};
        EXPECT_TRUE(meet_beyond_shared(positions, {0, 1, 2}, {3, 4, 5})) << exponent;
        EXPECT_TRUE(meet_beyond_shared({{0, 0, 0}, {u, 0, 0}, {0, u, 0}, {u, u, 0}, {u, u, u}}, {0, 1, 2}, {0, 3, 4}))
            << exponent;
    }
}

}  // namespace
}  // namespace certa::verify
