// The language of docs/expressions.md: what texts mean, and where and how wrong ones are refused.
#include <certa/implicit.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "expression/random_expression.h"

namespace certa {
namespace {

double value_of(std::string_view text, double x = 2, double y = 3, double z = 5) {
    return evaluate(parse_expression(text), {x, y, z}).value;
}

TEST(Parse, Precedence) {
    EXPECT_EQ(value_of("x + y*z"), 17);
    EXPECT_EQ(value_of("(x + y)*z"), 25);
    EXPECT_EQ(value_of("x - y - z"), -6);
    EXPECT_EQ(value_of("60/x/y"), 10);
    EXPECT_EQ(value_of("-x^2"), -4) << "-(x^2)";
    EXPECT_EQ(value_of("(-x)^2"), 4);
    EXPECT_EQ(value_of("2^3^2"), 512) << "2^(3^2)";
    EXPECT_EQ(value_of("x^-2"), 0.25);
    EXPECT_EQ(value_of("x^-2^2"), 1.0 / 16) << "x^(-(2^2))";
    EXPECT_EQ(value_of("x*-y"), -6);
    EXPECT_EQ(value_of("--x"), 2);
    EXPECT_EQ(value_of("+x"), 2);
    EXPECT_EQ(value_of("2*-x^2"), -8);
    EXPECT_EQ(value_of("x^(1+1)"), 4);
    EXPECT_NEAR(value_of("x^0.5"), std::sqrt(2.0), 1e-15);
    EXPECT_NEAR(value_of("x^(1/3)"), std::cbrt(2.0), 1e-15);
    EXPECT_NEAR(value_of("x^pi"), std::pow(2.0, M_PI), 1e-14);
    EXPECT_EQ(value_of("x^0"), 1);
}

TEST(Parse, Numbers) {
    EXPECT_EQ(value_of("1.5e3"), 1500);
    EXPECT_EQ(value_of("2.E-1"), 0.2);
    EXPECT_EQ(value_of(".5"), 0.5);
    EXPECT_EQ(value_of("007"), 7);
    EXPECT_EQ(value_of("0.000"), 0);
    EXPECT_EQ(value_of("1e-400*x"), 0) << "too small for a double; its enclosure is not 0";
    EXPECT_EQ(value_of("123456789012345678901234567890"), 123456789012345678901234567890.0);
    EXPECT_EQ(value_of("1.7976931348623157e308"), 1.7976931348623157e308);
    EXPECT_EQ(value_of("pi"), M_PI);
}

TEST(Parse, Functions) {
    EXPECT_NEAR(value_of("exp(x) + log(y)"), std::exp(2.0) + std::log(3.0), 1e-14);
    EXPECT_NEAR(value_of("sin(x)*cos(y)*tan(z)"), std::sin(2.0) * std::cos(3.0) * std::tan(5.0), 1e-14);
    EXPECT_NEAR(value_of("atan( x ) + sinh(x) - cosh (y)"), std::atan(2.0) + std::sinh(2.0) - std::cosh(3.0), 1e-14);
    EXPECT_NEAR(value_of("tanh(sqrt(x))"), std::tanh(std::sqrt(2.0)), 1e-14);
    EXPECT_NEAR(value_of("smooth_union(x, y, 1e-6)"), 2, 1e-6);
}

TEST(Parse, FilesOfDefinitions) {
    EXPECT_EQ(value_of("# a sphere\nr2 = x^2 + y^2 + z^2   # squared radius\n\nr2 - 1\n"), 37);
    EXPECT_EQ(value_of("a = x; b = a*a; b + a"), 6);
    EXPECT_EQ(value_of("f = x*y"), 6) << "the last statement may have a name";
    EXPECT_EQ(value_of("r = (x +\n  y)\n(r\n - 1)\n"), 4) << "lines go on inside parentheses";
    EXPECT_EQ(value_of("x +\n y *\r\n z"), 17) << "and after an operator";
    EXPECT_EQ(value_of("\xef\xbb\xbfx\r\n"), 2) << "byte-order mark, CRLF";
    EXPECT_EQ(value_of("a = x\r\na + 1"), 3);
    EXPECT_EQ(value_of("  x  "), 2);
}

struct Wrong {
    const char* text;
    std::uint64_t line, column;
    const char* reason;
};

class Refusals : public testing::TestWithParam<Wrong> {};

TEST_P(Refusals, SayWhereAndWhy) {
    const Wrong& wrong = GetParam();
    try {
        parse_expression(wrong.text, "the text");
        FAIL() << wrong.text << " was accepted";
    } catch (const ExpressionError& error) {
        EXPECT_EQ(error.path(), "the text");
        EXPECT_EQ(error.line(), wrong.line) << error.what();
        EXPECT_EQ(error.column(), wrong.column) << error.what();
        EXPECT_NE(std::string(error.what()).find(wrong.reason), std::string::npos) << error.what();
    }
}

INSTANTIATE_TEST_SUITE_P(
    All, Refusals,
    testing::Values(
        Wrong{"x^2 + * y", 1, 7, "expected a number, a variable"}, Wrong{"x +", 1, 4, "the text ends here"},
        Wrong{"", 1, 1, "there is no expression"}, Wrong{"# only a comment", 1, 17, "there is no expression"},
        Wrong{"2x", 1, 2, "a product is written with *"}, Wrong{"x y", 1, 3, "expected an operator or the end"},
        Wrong{"0,5*x", 1, 2, "an operator or the end"}, Wrong{"1.2.3", 1, 4, "an operator is missing"},
        Wrong{"(x + y", 1, 7, "expected an operator or ')'"}, Wrong{"x)", 1, 2, "expected an operator or the end"},
        Wrong{"x + foo", 1, 5, "'foo' is unknown"}, Wrong{"x + e", 1, 5, "write exp(1)"},
        Wrong{"sin x", 1, 1, "its arguments are missing"}, Wrong{"sin(x, y)", 1, 1, "takes 1 argument, not 2"},
        Wrong{"sin()", 1, 5, "expected a number"}, Wrong{"foo(x)", 1, 1, "there is no function 'foo'"},
        Wrong{"x(y)", 1, 1, "a product is written with *"}, Wrong{"x + min(x, y)", 1, 5, "smooth_union(a, b, k)"},
        Wrong{"max(x, y)", 1, 1, "smooth_intersection(a, b, k)"}, Wrong{"abs(x)", 1, 1, "sqrt(a^2 + k^2)"},
        Wrong{"x^y", 1, 2, "must be a constant"}, Wrong{"x^", 1, 3, "expected an exponent"},
        Wrong{"2e", 1, 3, "digits must follow"}, Wrong{"1e999*x", 1, 1, "too large"},
        Wrong{"x/0", 1, 2, "a division by 0"}, Wrong{"x/(1-1)", 1, 2, "a division by 0"},
        Wrong{"a = x\nb = y\nb", 1, 1, "'a' is defined but not used"},
        Wrong{"a = x\na = y\na", 2, 1, "'a' is defined twice"}, Wrong{"x = y\nx", 1, 1, "has a meaning already"},
        Wrong{"sin = y\nx", 1, 1, "has a meaning already"}, Wrong{"x\ny", 2, 1, "only the last statement"},
        Wrong{"f = x^2\n - y", 1, 1, "'f' is defined but not used"}, Wrong{"a = b\nb = x\na", 1, 5, "'b' is unknown"},
        Wrong{"r = x +\n\n  ) * y\nr", 3, 3, "expected a number"},
        Wrong{"smooth_union(x, y, 0)", 1, 1, "must be a positive constant"},
        Wrong{"smooth_union(x, y, z)", 1, 1, "must be a positive constant"},
        Wrong{"x \xe2\x88\x92 y", 1, 3, "an operator"},
        Wrong{"x ** y", 1, 4, "expected a number, a variable, a function or '('; powers are written x^2"},
        Wrong{"x^2 + y^2 = 1", 1, 11, "for a = b write a - (b)"}, Wrong{"x\xc2\xb2", 1, 2, "powers are written x^2"},
        Wrong{"x = = y", 1, 5, "expected a number"}));

TEST(Refusal, ShowsTheLineAndACaret) {
    try {
        parse_expression("r2 = x^2 + y^2\nr2 + 3 $ z\n", "torus.txt");
        FAIL();
    } catch (const ExpressionError& error) {
        EXPECT_STREQ(error.what(),
                     "torus.txt:2: column 8: expected an operator or the end of the statement\n"
                     "  r2 + 3 $ z\n"
                     "         ^");
    }
}

TEST(Refusal, NestingIsBounded) {
    const auto nested = [](int depth) { return std::string(depth, '(') + "x" + std::string(depth, ')'); };
    EXPECT_EQ(value_of(nested(256)), 2);
    EXPECT_THROW(parse_expression(nested(257)), ExpressionError);
    EXPECT_THROW(parse_expression(std::string(1000000, '(')), ExpressionError);
    EXPECT_EQ(value_of(std::string(1000000, '-') + "x"), 2) << "signs do not nest";
    std::string tower = "x";
    for (int i = 0; i < 100000; ++i) tower += "^1";
    EXPECT_EQ(value_of(tower), 2) << "nor do exponents";
}

TEST(Refusal, LongLinesAreShownAroundThePlace) {
    try {
        parse_expression(std::string(5000, ' ') + "x $" + std::string(5000, ' '));
        FAIL();
    } catch (const ExpressionError& error) {
        EXPECT_EQ(error.column(), 5003u);
        EXPECT_LT(std::string(error.what()).size(), 400u);
    }
}

// What is written is read back as the same text, and as the same function.
RC_GTEST_PROP(Parse, RoundTrip, (std::uint64_t seed)) {
    core::Random random(seed);
    const Expression function = test::random_expression(random, 4 + static_cast<int>(random.below(12)));
    const std::string text = format_expression(function);
    const Expression back = parse_expression(text);
    RC_ASSERT(format_expression(back) == text);
    const Point3 place{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    const double a = evaluate(function, place).value, b = evaluate(back, place).value;
    RC_ASSERT(a == b || (std::isnan(a) && std::isnan(b)));
}

}  // namespace
}  // namespace certa
