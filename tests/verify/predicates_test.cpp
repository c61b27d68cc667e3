// The checker's predicates against rational arithmetic, on random, degenerate, huge and denormal coordinates. The
// oracle uses other formulas: circumcentres by Cramer's rule in rationals, distances to them compared.
#include "verify/predicates.h"

#include <gmpxx.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <limits>

#include "core/random.h"
#include "verify/vertex_tree.h"

namespace certa::test {
namespace {

using namespace verify;
using Rational = std::array<mpq_class, 3>;

Rational rational(const Point3& p) { return {mpq_class(p.x), mpq_class(p.y), mpq_class(p.z)}; }
Rational operator-(const Rational& a, const Rational& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
mpq_class dot(const Rational& a, const Rational& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
mpq_class det(const Rational& a, const Rational& b, const Rational& c) {
    return a[0] * b[1] * c[2] + b[0] * c[1] * a[2] + c[0] * a[1] * b[2] - a[2] * b[1] * c[0] - b[2] * c[1] * a[0] -
           c[2] * a[1] * b[0];
}
Rational cross(const Rational& a, const Rational& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// The point with 2 c . r_i = s_i for three rows, or nothing when they are dependent.
bool solve(const std::array<Rational, 3>& rows, const Rational& right, Rational& c) {
    const mpq_class d = det(rows[0], rows[1], rows[2]);
    if (d == 0) return false;
    for (std::size_t k = 0; k < 3; ++k) {
        std::array<Rational, 3> replaced = rows;
        for (std::size_t i = 0; i < 3; ++i) replaced[i][k] = right[i];
        c[k] = det(replaced[0], replaced[1], replaced[2]) / d / 2;
    }
    return true;
}

int in_ball(const Rational& center, const Rational& p) {
    return sgn(dot(center, center) - dot(p - center, p - center));
}

int oracle_circumball(const Point3& a, const Point3& b, const Point3& c, const Point3& d, const Point3& p) {
    const Rational o = rational(a), u = rational(b) - o, v = rational(c) - o, w = rational(d) - o;
    Rational center;
    if (!solve({u, v, w}, {dot(u, u), dot(v, v), dot(w, w)}, center)) return 2;
    return in_ball(center, rational(p) - o);
}
int oracle_diametral(const Point3& a, const Point3& b, const Point3& c, const Point3& p) {
    const Rational o = rational(a), u = rational(b) - o, v = rational(c) - o;
    Rational center;
    if (!solve({u, v, cross(u, v)}, {dot(u, u), dot(v, v), 0}, center)) return 2;
    return in_ball(center, rational(p) - o);
}
int oracle_orientation(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
    const Rational o = rational(a);
    return sgn(det(rational(b) - o, rational(c) - o, rational(d) - o));
}
int oracle_side(const std::vector<Point3>& ring, const Point3& p, const Point3& q, const Point3& v) {
    Rational n;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const Rational part = cross(rational(ring[i]), rational(ring[(i + 1) % ring.size()]));
        for (std::size_t k = 0; k < 3; ++k) n[k] += part[k];
    }
    return sgn(dot(n, cross(rational(q) - rational(p), rational(v) - rational(p))));
}

enum Scale {
    small_integers,
    unit,
    huge,
    tiny,
    denormal,
    mixed,
    shifted,
    near_lattice,
    brink,
    uneven,
    sphere,
    scale_count
};

double coordinate(core::Random& random, int scale) {
    switch (scale) {
        case small_integers:
            return static_cast<double>(random.below(5));
        case unit:
            return random.uniform(-1.0, 1.0);
        case huge:
            return random.uniform(-1.0, 1.0) * std::numeric_limits<double>::max();
        case tiny:
            return random.uniform(-1.0, 1.0) * 1e-150;
        case denormal:
            return static_cast<double>(static_cast<int>(random.below(7)) - 3) *
                   std::numeric_limits<double>::denorm_min();
        case mixed:
            return std::ldexp(random.uniform(-1.0, 1.0), static_cast<int>(random.below(2000)) - 1020);
        case shifted:
            return 1e6 + std::ldexp(static_cast<double>(random.below(9)), -30);
        default: {  // a lattice point, off by an ulp at times
            const double c = 0.1 * static_cast<double>(1 + random.below(4));
            return random.below(4) != 0 ? c : std::nextafter(c, random.coin() ? 0.0 : 1.0);
        }
    }
}
Point3 point(core::Random& random, int scale) {
    const auto small = [&] { return static_cast<double>(random.below(9)) - 4.0; };
    if (scale == brink) {
        // Products of as many factors as the forms have are denormal: 2^-1074 is the least number.
        static thread_local int exponent = 0;
        if (random.below(8) == 0)
            exponent = -1074 / static_cast<int>(2 + random.below(5)) + static_cast<int>(random.below(6)) - 4;
        return {std::ldexp(small(), exponent), std::ldexp(small(), exponent), std::ldexp(small(), exponent)};
    }
    // A product of two underflows, the third makes it large again.
    if (scale == uneven) return {std::ldexp(small(), -540), std::ldexp(small(), -540), std::ldexp(small(), 560)};
    if (scale == sphere) {
        // Integers of 49 bits on one sphere about the origin, at times off by one.
        std::array<double, 3> c{561850441793531.0, 307445734561825.0, 448181855392003.0};
        for (double& x : c) x = (random.coin() ? x : -x) + (random.below(6) == 0 ? 1.0 : 0.0);
        for (std::size_t i = 3; i > 1; --i) std::swap(c[i - 1], c[random.below(i)]);
        return {c[0], c[1], c[2]};
    }
    return {coordinate(random, scale), coordinate(random, scale), coordinate(random, scale)};
}

class Predicates : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Scales, Predicates, testing::Range(0, static_cast<int>(scale_count)));

TEST_P(Predicates, agree_with_rationals) {
    ASSERT_TRUE(rc::check([&](std::uint64_t seed) {
        core::Random random(seed);
        std::array<Point3, 6> p;
        for (Point3& q : p) q = point(random, GetParam());
        const int orient = orientation(p[0], p[1], p[2], p[3]);
        RC_ASSERT(orient == oracle_orientation(p[0], p[1], p[2], p[3]));
        if (orient < 0) std::swap(p[0], p[1]);
        if (orient != 0) {
            const int expected = oracle_circumball(p[0], p[1], p[2], p[3], p[4]);
            RC_ASSERT(in_circumball(p[0], p[1], p[2], p[3], p[4]) == expected);
            RC_ASSERT(QuadricRegion::circumball(p[0], p[1], p[2], p[3]).side(p[4]) == expected);
            RC_ASSERT(in_circumball(p[0], p[1], p[2], p[3], p[2]) == 0);
        }
        const int diametral = oracle_diametral(p[0], p[1], p[2], p[4]);
        if (diametral != 2) {
            RC_ASSERT(in_diametral_ball(p[0], p[1], p[2], p[4]) == diametral);
            RC_ASSERT(QuadricRegion::diametral_ball(p[0], p[1], p[2]).side(p[4]) == diametral);
        }
        RC_ASSERT(QuadricRegion::beyond(p[0], p[1], p[2]).side(p[4]) == oracle_orientation(p[0], p[1], p[2], p[4]));
        RC_ASSERT(dot_sign(p[0], p[1], p[2], p[3]) ==
                  sgn(dot(rational(p[1]) - rational(p[0]), rational(p[3]) - rational(p[2]))));
        RC_ASSERT(determinant_sign({&p[0], &p[1]}, {&p[2], &p[3]}, {&p[4], &p[5]}) ==
                  sgn(det(rational(p[1]) - rational(p[0]), rational(p[3]) - rational(p[2]),
                          rational(p[5]) - rational(p[4]))));
        const Rational o = rational(p[0]);
        Rational sum = rational(p[3]) - o;
        for (const std::size_t i : {4u, 5u}) {
            for (std::size_t k = 0; k < 3; ++k) sum[k] += (rational(p[i]) - o)[k];
        }
        RC_ASSERT(middle_side(p[0], p[1], p[2], p[3], p[4], p[5]) ==
                  sgn(det(rational(p[1]) - o, rational(p[2]) - o, sum)));
        RC_ASSERT(orientation_xy(p[0], p[1], p[2]) == sgn(cross(rational(p[1]) - o, rational(p[2]) - o)[2]));
    }));
}

TEST_P(Predicates, normals_agree_with_rationals) {
    ASSERT_TRUE(rc::check([&](std::uint64_t seed) {
        core::Random random(seed);
        std::vector<Point3> ring(3 + random.below(6)), other(3 + random.below(4));
        for (Point3& q : ring) q = point(random, GetParam());
        for (Point3& q : other) q = point(random, GetParam());
        // Flat rings are the rule: bring everything near one plane half of the time.
        if (random.coin()) {
            for (Point3& q : ring) q.z = ring[0].z;
        }
        const NewellNormal normal(ring);
        const Point3 p = point(random, GetParam()), q = point(random, GetParam()), v = point(random, GetParam());
        RC_ASSERT(normal.side(p, q, v) == oracle_side(ring, p, q, v));
        RC_ASSERT(normal.side(ring[0], ring[1], ring[2]) == oracle_side(ring, ring[0], ring[1], ring[2]));
        const auto area = [&](const std::vector<Point3>& polygon) {
            Rational n, m;
            for (std::size_t i = 0; i < ring.size(); ++i) {
                const Rational part = cross(rational(ring[i]), rational(ring[(i + 1) % ring.size()]));
                for (std::size_t k = 0; k < 3; ++k) n[k] += part[k];
            }
            for (std::size_t i = 0; i < polygon.size(); ++i) {
                const Rational part = cross(rational(polygon[i]), rational(polygon[(i + 1) % polygon.size()]));
                for (std::size_t k = 0; k < 3; ++k) m[k] += part[k];
            }
            return dot(n, m);
        };
        RC_ASSERT(normal.turn(other) == sgn(area(other)));
        RC_ASSERT(normal.compare_areas(ring, other) == sgn(area(ring) - area(other)));
    }));
}

TEST_P(Predicates, no_box_with_a_point_inside_is_missed) {
    ASSERT_TRUE(rc::check([&](std::uint64_t seed) {
        core::Random random(seed);
        std::array<Point3, 4> p;
        for (Point3& q : p) q = point(random, GetParam());
        if (orientation(p[0], p[1], p[2], p[3]) < 0) std::swap(p[0], p[1]);
        std::vector<Point3> points(40);
        for (Point3& q : points) q = point(random, GetParam());
        points.insert(points.end(), p.begin(), p.end());
        const VertexTree tree(points);
        std::vector<QuadricRegion> regions{QuadricRegion::beyond(p[0], p[1], p[2])};
        if (orientation(p[0], p[1], p[2], p[3]) != 0) {
            regions.push_back(QuadricRegion::circumball(p[0], p[1], p[2], p[3]));
            regions.push_back(QuadricRegion::diametral_ball(p[0], p[1], p[2]));
        }
        for (const QuadricRegion& region : regions) {
            for (const bool closed : {false, true}) {
                std::vector<std::uint32_t> found, expected;
                tree.visit(region, std::array<std::uint32_t, 1>{3}, closed, [&](std::uint32_t v, int side) {
                    RC_ASSERT(side == region.side(points[v]));
                    found.push_back(v);
                    return true;
                });
                for (std::uint32_t v = 0; v < points.size(); ++v) {
                    const int side = region.side(points[v]);
                    if (v != 3 && (side > 0 || (closed && side == 0))) expected.push_back(v);
                }
                std::sort(found.begin(), found.end());
                RC_ASSERT(found == expected);
            }
        }
    }));
}

TEST(PredicatesOnes, count_roundings_as_derived) {
    // (b - a) x (c - a) . (d - a): leaf 1, product 3, difference 4, product 6, two sums 8.
    EXPECT_EQ(census_of<DeterminantForm>().roundings, 8);
    EXPECT_EQ(census_of<DeterminantForm>().monomials, 6.0);
    EXPECT_EQ(census_of<DotForm>().roundings, 5);
}

TEST(PredicatesOnes, one_ulp_decides) {
    const Point3 a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0}, d{0, 0, 1};
    const double up = std::nextafter(1.0, 2.0), down = std::nextafter(1.0, 0.0);
    EXPECT_EQ(in_circumball(a, b, c, d, {1, 1, 1}), 0);
    EXPECT_EQ(in_circumball(a, b, c, d, {1, 1, down}), 1);
    EXPECT_EQ(in_circumball(a, b, c, d, {1, 1, up}), -1);
    EXPECT_EQ(in_diametral_ball(a, b, c, {1, 1, 0}), 0);
    EXPECT_EQ(in_diametral_ball(a, b, c, {1, down, 0}), 1);
    EXPECT_EQ(in_diametral_ball(a, b, c, {1, 1, std::numeric_limits<double>::denorm_min()}), -1);
    EXPECT_EQ(orientation(a, b, c, {0.3, 0.3, std::numeric_limits<double>::denorm_min()}), 1);
    EXPECT_EQ(orientation({1e308, 0, 0}, {-1e308, 0, 0}, {0, 1e308, 0}, {0, 0, -1e308}), 1);
    EXPECT_EQ(orientation({-1e308, 0, 0}, {1e308, 0, 0}, {0, 1e308, 0}, {0, 0, 5e-324}), 1);
}

}  // namespace
}  // namespace certa::test
