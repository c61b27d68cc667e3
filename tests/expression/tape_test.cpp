// What simplification may and may not do; constants are enclosed; deep and widely shared expressions cost what they
// should.
#include "expression/tape.h"

#include <gtest/gtest.h>
#include <mpfr.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <cmath>

#include "core/random.h"
#include "expression/constant.h"
#include "expression/jet.h"

namespace certa::expression {
namespace {

using core::Random;
using interval::Interval;

std::size_t length_of(const char* text) { return Tape(parse_expression(text)).size(); }

TEST(Tape, SharesAndSimplifies) {
    EXPECT_EQ(length_of("x*x"), 2u);                    // x, x^2
    EXPECT_EQ(length_of("x*x*x"), 2u);                  // x, x^3
    EXPECT_EQ(length_of("(x^2)^3"), 2u);                // x, x^6
    EXPECT_EQ(length_of("x + 0*y"), 1u);                // x
    EXPECT_EQ(length_of("(x+y)^2 - (y+x)^2 + z"), 1u);  // z: both squares are one, and defined everywhere
    EXPECT_EQ(length_of("(x+y)^2 + 3*(y+x)^2"), 7u);    // x, y, x+y, square, 3, product, sum
    EXPECT_EQ(length_of("exp(2)*x"), 3u);               // x, the number exp(2), product
    EXPECT_EQ(length_of("x - -y"), 3u);                 // x, y, x + y
    EXPECT_EQ(length_of("log(x)*0"), 4u);               // kept: undefined for x <= 0
    EXPECT_EQ(length_of("2*3*x/6"), 5u);                // 6 x (1/6): products of the user are not reordered
}

TEST(Tape, DecimalsAreEnclosed) {
    const Tape tape(parse_expression("0.1"));
    const Interval tenth = tape.instructions().back().enclosure;
    // 3602879701896397 / 2^55 is above 1/10, its predecessor below.
    EXPECT_LT(tenth.lo, 0.1);
    EXPECT_GE(tenth.hi, 0.1);
    EXPECT_LE(tenth.hi - tenth.lo, 4 * 0x1p-56);
    const Tape quarter(parse_expression("0.25"));
    EXPECT_EQ(quarter.instructions().back().enclosure.lo, 0.25);
    EXPECT_EQ(quarter.instructions().back().enclosure.hi, 0.25);
    // The same decimal as a sum of others is exact: 0.1 + 0.2 - 0.3 is 0, not 5.6e-17.
    const Interval zero = Tape(parse_expression("0.1 + 0.2 - 0.3")).instructions().back().enclosure;
    EXPECT_EQ(zero.lo, 0.0);
    EXPECT_EQ(zero.hi, 0.0);
}

std::string random_decimal(Random& random) {
    std::string text;
    const std::size_t whole = random.below(25), part = random.below(40);
    for (std::size_t i = 0; i < whole; ++i) text += static_cast<char>('0' + random.below(10));
    if (part > 0) text += '.';
    for (std::size_t i = 0; i < part; ++i) text += static_cast<char>('0' + random.below(10));
    if (whole + part == 0) text = "7";
    if (random.coin()) text += "e" + std::to_string(static_cast<int>(random.below(600)) - 330);
    return text;
}

RC_GTEST_PROP(Tape, AnyDecimalIsEnclosed, (std::uint64_t seed)) {
    Random random(seed);
    for (int i = 0; i < 50; ++i) {
        const std::string text = random_decimal(random);
        const std::optional<Constant> value = read_decimal(text);
        if (!value) continue;
        const Interval enclosed = enclosure(*value);
        mpfr_t low, high;
        mpfr_inits2(2000, low, high, nullptr);
        mpfr_set_str(low, text.c_str(), 10, MPFR_RNDD);
        mpfr_set_str(high, text.c_str(), 10, MPFR_RNDU);
        const bool inside = mpfr_cmp_d(low, enclosed.lo) >= 0 && mpfr_cmp_d(high, enclosed.hi) <= 0;
        const bool near =
            mpfr_get_d(low, MPFR_RNDN) == nearest(*value) ||
            std::fabs(mpfr_get_d(low, MPFR_RNDN) - nearest(*value)) <= 0x1p-52 * std::fabs(nearest(*value));
        mpfr_clears(low, high, nullptr);
        RC_ASSERT(inside);
        RC_ASSERT(near);
        // Its own text is read as the same constant.
        RC_ASSERT(nearest(parse_expression(text_of(*value)).node()->constant) == nearest(*value));
    }
}

RC_GTEST_PROP(Tape, DoublesStayThemselves, (std::uint64_t bits)) {
    const auto value = std::bit_cast<double>(bits);
    if (!std::isfinite(value)) return;
    const Constant constant = constant_of(value);
    RC_ASSERT(enclosure(constant).lo == value);
    RC_ASSERT(enclosure(constant).hi == value);
    RC_ASSERT(nearest(constant) == value);
    const Tape again(parse_expression(format_expression(Expression(value))));
    RC_ASSERT(again.instructions().back().enclosure.lo == value);
}

// x doubled 200 times by sharing: the tree has 2^200 paths, the tape 200 steps.
TEST(Tape, SharingIsNotUnfolded) {
    Expression doubled = Expression::x();
    for (int i = 0; i < 200; ++i) doubled = sin(doubled) + doubled;
    EXPECT_EQ(Tape(doubled).size(), 401u);
    EXPECT_LT(format_expression(doubled).size(), 20000u);
    EXPECT_EQ(Tape(parse_expression(format_expression(doubled))).size(), 401u);
}

TEST(Tape, LongChainsNeedNoStack) {
    Expression chain = Expression::x();
    for (int i = 0; i < 60000; ++i) chain = chain + Expression::y() * static_cast<double>(i);
    EXPECT_GT(Tape(chain).size(), 120000u);
    std::string text = "x";
    for (int i = 0; i < 30000; ++i) text += " + y";
    text += "\n";
    EXPECT_EQ(evaluate(parse_expression(text), {1, 1, 0}).value, 30001.0);
}

TEST(Tape, CallablesTrace) {
    const Expression torus = make_expression([](auto x, auto y, auto z) {
        auto q = x * x + y * y;
        return pow(q + z * z + 0.84, 2) - 4.0 * q;
    });
    EXPECT_NEAR(evaluate(torus, {1.4, 0, 0}).value, 0.0, 1e-14);
    EXPECT_EQ(Tape(torus).size(), Tape(parse_expression("q = x*x + y*y\n(q + z*z + 0.84)^2 - 4*q")).size());
    EXPECT_THROW(Expression(NAN), InputError);
    EXPECT_THROW(pow(Expression::x(), Expression::y()), InputError);
    EXPECT_THROW(smooth_union(Expression::x(), Expression::y(), -1.0), InputError);
}

// At most k/2 below the minimum, and smooth where the minimum has its edge.
TEST(Tape, SmoothBlends) {
    const Expression united = parse_expression("smooth_union(x, y, 0.1)");
    EXPECT_NEAR(evaluate(united, {0, 0, 0}).value, -0.05, 1e-15);
    EXPECT_NEAR(evaluate(united, {0, 0, 0}).gradient.x, 0.5, 1e-15);
    EXPECT_NEAR(evaluate(united, {-3, 5, 0}).value, -3, 2e-3);
    EXPECT_NEAR(evaluate(parse_expression("smooth_intersection(x, y, 0.1)"), {-3, 5, 0}).value, 5, 2e-3);
    EXPECT_NEAR(evaluate(parse_expression("smooth_difference(x, y, 0.1)"), {-3, 5, 0}).value, -3, 2e-3);
    EXPECT_NEAR(evaluate(parse_expression("smooth_difference(x, y, 0.1)"), {-3, -5, 0}).value, 5, 2e-3);
}

}  // namespace
}  // namespace certa::expression
