// What the checker's enclosures in doubles rest on, one test per protection; each fails when its protection is taken
// away (tried by hand).
//   each operation moved outward     RoundingNeverDecides; where numbers are tiny: UnderflowNeverDecides
//   MPFI's bounds rounded outward    FunctionsNeverDecide, ConstantsAreTheExactDecimals
//   squares, powers: the lowest is 0 SlopesNeedADifferentiableFunction
//   poles, ends of domains           NothingIsProvedAcrossPoles; undefined steps that what follows does not use, too
//   a slope needs all derivatives    SlopesNeedADifferentiableFunction
//   so does Taylor's form            CombinationsNeedDerivatives
//   the mean value form needs slopes TheMeanValueFormNeedsSlopes
//   its centre lies in the box       TheMiddleLiesInTheBox (of the two enclosures, MPFI's is the one that can tell)
//   overflow proves nothing          Span.WithoutUseStaySo, OverflowProvesNothing, InfiniteSlopesProveNothing
//   rounding to nearest              OtherRoundingModesProveNothing
//
// How the first two work: z is the double that an operation op(x, y) rounds to, w is smaller than the error of that
// rounding and has the other sign. Then f = (op(x, y) - z) + w has in doubles, exactly, the sign of w, and in truth the
// other one, which MPFR knows. An enclosure whose bounds are not moved outward claims the wrong sign.
#include <gtest/gtest.h>
#include <mpfr.h>

#include <cfenv>
#include <cmath>
#include <functional>
#include <string>

#include "core/random.h"
#include "verify/implicit_function.h"
#include "verify/quick_enclosures.h"

namespace certa::verify {
namespace {

constexpr int value = -1;  // what `proves_directly` calls the function itself, beside its derivatives 0, 1, 2

BoxOfDoubles point(double x, double y, double z) { return {{x, y, z}, {x, y, z}}; }

/// op(x, y) - z in 400 bits, rounded to a double.
using Exact = std::function<void(mpfr_ptr result, mpfr_srcptr x, mpfr_srcptr y)>;
double error_of(const Exact& op, double x, double y, double z) {
    mpfr_t a, b, c;
    mpfr_inits2(400, a, b, c, static_cast<mpfr_ptr>(nullptr));
    mpfr_set_d(a, x, MPFR_RNDN);
    mpfr_set_d(b, y, MPFR_RNDN);
    op(c, a, b);
    mpfr_sub_d(c, c, z, MPFR_RNDN);
    const double error = mpfr_get_d(c, MPFR_RNDN);
    mpfr_clears(a, b, c, static_cast<mpfr_ptr>(nullptr));
    return error;
}
double rounded(const Exact& op, double x, double y) { return error_of(op, x, y, 0); }

struct Operation {
    const char* text;  ///< of x and y
    Exact exact;
    double low = -4, high = 4;
};

/// How often doubles, rounded to nearest, would have claimed the wrong sign; never may the enclosure.
int count_traps(const Operation& operation) {
    core::Random random(17);
    int traps = 0;
    for (int i = 0; i < 200; ++i) {
        const double x = random.uniform(operation.low, operation.high), y = random.uniform(0.5, 4);
        const double z = rounded(operation.exact, x, y), error = error_of(operation.exact, x, y, z);
        if (error == 0 || std::fabs(error) < 1e-250) continue;
        ++traps;
        const int truth = error > 0 ? 1 : -1;
        // w = -error / 2, as a constant: z, y and x are taken.
        char w[64];
        std::snprintf(w, sizeof w, "%.17e", -error / 2);
        const ImplicitFunction function("(" + std::string(operation.text) + " - z) + (" + w + ")");
        QuickEnclosures quick(function);
        EXPECT_FALSE(quick.proves_directly(point(x, y, z), value, -truth)) << operation.text << " at " << x << " " << y;
        // With a thousand times the rounding on the other side of z there is something to prove.
        const double far = z - truth * 1000 * std::fabs(z) * 0x1p-52;
        const ImplicitFunction plain(std::string(operation.text) + " - z");
        QuickEnclosures able(plain);
        EXPECT_TRUE(able.proves_directly(point(x, y, far), value, truth)) << operation.text << " at " << x << " " << y;
    }
    return traps;
}

TEST(QuickEnclosures, RoundingNeverDecides) {
    const auto operations = std::vector<Operation>{
        {"(x+y)", [](auto r, auto x, auto y) { mpfr_add(r, x, y, MPFR_RNDN); }},
        {"(x-y)", [](auto r, auto x, auto y) { mpfr_sub(r, x, y, MPFR_RNDN); }},
        {"(x*y)", [](auto r, auto x, auto y) { mpfr_mul(r, x, y, MPFR_RNDN); }},
        {"(x/y)", [](auto r, auto x, auto y) { mpfr_div(r, x, y, MPFR_RNDN); }},
        {"x^2", [](auto r, auto x, auto) { mpfr_sqr(r, x, MPFR_RNDN); }},
        {"y^-2", [](auto r, auto, auto y) { mpfr_pow_si(r, y, -2, MPFR_RNDN); }},
        {"sqrt(y)", [](auto r, auto, auto y) { mpfr_sqrt(r, y, MPFR_RNDN); }},
    };
    for (const Operation& operation : operations) EXPECT_GT(count_traps(operation), 30) << operation.text;
}

TEST(QuickEnclosures, FunctionsNeverDecide) {
    const auto operations = std::vector<Operation>{
        {"exp(x)", [](auto r, auto x, auto) { mpfr_exp(r, x, MPFR_RNDN); }},
        {"log(y)", [](auto r, auto, auto y) { mpfr_log(r, y, MPFR_RNDN); }},
        {"sin(x)", [](auto r, auto x, auto) { mpfr_sin(r, x, MPFR_RNDN); }},
        {"cos(x)", [](auto r, auto x, auto) { mpfr_cos(r, x, MPFR_RNDN); }},
        {"tan(x)", [](auto r, auto x, auto) { mpfr_tan(r, x, MPFR_RNDN); }, -1.5, 1.5},
        {"atan(x)", [](auto r, auto x, auto) { mpfr_atan(r, x, MPFR_RNDN); }},
        {"sinh(x)", [](auto r, auto x, auto) { mpfr_sinh(r, x, MPFR_RNDN); }},
        {"cosh(x)", [](auto r, auto x, auto) { mpfr_cosh(r, x, MPFR_RNDN); }},
        {"tanh(x)", [](auto r, auto x, auto) { mpfr_tanh(r, x, MPFR_RNDN); }},
        {"y^1.5",
         [](auto r, auto, auto y) {
             mpfr_sqrt(r, y, MPFR_RNDN);
             mpfr_pow_ui(r, r, 3, MPFR_RNDN);
         }},
    };
    for (const Operation& operation : operations) EXPECT_GT(count_traps(operation), 30) << operation.text;
}

TEST(QuickEnclosures, ConstantsAreTheExactDecimals) {
    // The double nearest to 0.1 is above it by 5.55e-18, the one nearest to pi below by 1.22e-16.
    const ImplicitFunction tenth("(0.1 - z) + 4e-18"), circle("(pi - z) - 1e-16");
    QuickEnclosures a(tenth), b(circle);
    EXPECT_FALSE(a.proves_directly(point(0, 0, 0.1), value, 1));
    EXPECT_FALSE(b.proves_directly(point(0, 0, 0x1.921fb54442d18p+1), value, -1));
}

// Boxes that hold a pole or leave the domain: the corners alone would say a sign.
TEST(QuickEnclosures, NothingIsProvedAcrossPoles) {
    const BoxOfDoubles box{{-1, -1, -1}, {1, 1.5, 1.25}};
    for (const char* text : {"1/x + 5", "x^-1 + 5", "x^-3 + 5", "tan(2*x) + 9", "tan(x + 1.5) + 9", "5 + log(x)",
                             "5 + sqrt(x)", "5 + z^0.5", "5 + log(y + 1)^0 + log(z)^0", "5 + sqrt(x)^0", "5 + x^-2",
                             "5 + x^0.3 - x^0.3", "5 + x^0.3", "5 + 0/x", "5 + 0*log(y)", "5 + (1/z)^0", "3 + x/x"}) {
        const ImplicitFunction function(text);
        QuickEnclosures quick(function);
        Enclosures careful(function);
        for (const int sign : {-1, 1}) {
            EXPECT_FALSE(quick.proves(box, value, sign)) << text;
            EXPECT_FALSE(careful.proves_sign(box, sign)) << text;
            for (int axis = 0; axis < 3; ++axis) {
                EXPECT_FALSE(quick.proves(box, axis, sign)) << text;
                EXPECT_FALSE(careful.proves_slope(box, axis, sign)) << text;
            }
        }
    }
}

// The derivative by y is 1 everywhere, but the function is not C1 where x is 0.
TEST(QuickEnclosures, SlopesNeedADifferentiableFunction) {
    for (const char* text : {"sqrt(x^2) + y", "sqrt(x + 1) + y", "(x^2 + z^2)^0.5 + y", "0*sqrt(x^2) + y",
                             "exp(sqrt(x^2)) + y", "sin(sqrt(x^2) + 1) + 3*y", "sqrt(x^4) + y"}) {
        const ImplicitFunction function(text);
        QuickEnclosures quick(function);
        Enclosures careful(function);
        const BoxOfDoubles across{{-1, 0, -1}, {1, 1, 1}}, beside{{0.5, 0, 0.5}, {1, 1, 1}};
        EXPECT_FALSE(quick.proves(across, 1, 1)) << text;
        EXPECT_FALSE(careful.proves_slope(across, 1, 1)) << text;
        EXPECT_TRUE(quick.proves(beside, 1, 1)) << text;
        EXPECT_TRUE(careful.proves_slope(beside, 1, 1)) << text;
    }
}

// At 0 it is -0.5, and slopes there are none.
TEST(QuickEnclosures, TheMeanValueFormNeedsSlopes) {
    const BoxOfDoubles box{{-1, -1, -1}, {1, 1, 1}};
    for (const char* text : {"sqrt(x^2) - 0.5", "sqrt(y^2) - 0.5 + x/100"}) {
        const ImplicitFunction function(text);
        QuickEnclosures quick(function);
        Enclosures careful(function);
        EXPECT_FALSE(quick.proves_directly(box, value, -1)) << text;
        EXPECT_FALSE(careful.proves_sign(box, -1)) << text;
    }
}

// m / 2 + m / 2 is 0 in doubles. From there, with the slope at m, f(m) would seem to be u^2 / 2 > 0, u being 1e300 m.
TEST(QuickEnclosures, TheMiddleLiesInTheBox) {
    const double m = 0x1p-1074;
    EXPECT_EQ(middle_of(m, m), m);
    EXPECT_EQ(middle_of(-m, -m), -m);
    EXPECT_EQ(middle_of(-0x1.fffffffffffffp1023, 0x1.fffffffffffffp1023), 0);
    const ImplicitFunction function("(1e300*x)^2 - 3.6615e-47");
    QuickEnclosures quick(function);
    Enclosures careful(function);
    EXPECT_FALSE(quick.proves_directly(point(m, 0, 0), value, 1));
    EXPECT_FALSE(careful.proves_sign(point(m, 0, 0), 1));
    EXPECT_TRUE(careful.proves_sign(point(m, 0, 0), -1));
}

// x y is 1.4 smallest numbers, 1 in doubles; exactly then 5 - 4 > 0, in truth 5 - 5.6 < 0.
TEST(QuickEnclosures, UnderflowNeverDecides) {
    const double smallest = 0x1p-1074;
    for (const char* text : {"5*z - 4*(x*y)", "5*z - 4*(x/(1/y))"}) {
        const ImplicitFunction function(text);
        QuickEnclosures quick(function);
        Enclosures careful(function);
        const BoxOfDoubles place = point(1.4 * 0x1p-537, 0x1p-537, smallest);
        EXPECT_FALSE(quick.proves_directly(place, value, 1)) << text;
        EXPECT_TRUE(careful.proves_sign(place, -1)) << text;
    }
}

TEST(Span, WithoutUseStaySo) {
    const double inf = HUGE_VAL;
    for (const Span& a :
         {Span{1, inf}, Span{-inf, -1}, Span{-inf, inf}, Span{inf, inf}, Span{NAN, NAN}, Span{1, NAN}, Span{NAN, -1}}) {
        EXPECT_FALSE(is_usable(a)) << a.low << " " << a.high;
        EXPECT_EQ(sign_of(a), 0) << a.low << " " << a.high;
        for (const Span& b : {Span{0, 1}, Span{-1, 0}, Span{0, 0}, Span{2, 3}, Span{-3, -2}, Span{-1, 1}}) {
            for (const Span& c : {a + b, b + a, a - b, b - a, a * b, b * a, a / b, b / a})
                EXPECT_FALSE(is_usable(c)) << a.low << " " << a.high << " with " << b.low << " " << b.high;
        }
        for (const Span& c : {-a, square(a), raised(a, 3), raised(a, 4), root(a)})
            EXPECT_FALSE(is_usable(c)) << a.low << " " << a.high;
    }
    for (const Span& b : {Span{0, 0}, Span{-1, 1}, Span{0, 1}, Span{-1, 0}}) EXPECT_FALSE(is_usable(Span{1, 1} / b));
    EXPECT_FALSE(is_usable(root({-1e-300, 4})));
    EXPECT_TRUE(is_usable(root({0, 4})));
}

// The slope by x of the product is somewhere infinite, times y, which may be 0: in doubles that is no number, and the
// rest would be what remains.
TEST(QuickEnclosures, InfiniteSlopesProveNothing) {
    const ImplicitFunction function("(1e150*(1e250*x^2))*y - 5*x"), turned("y*(1e150*(1e250*x^2)) - 5*x");
    for (const ImplicitFunction* f : {&function, &turned}) {
        QuickEnclosures quick(*f);
        EXPECT_FALSE(quick.proves_directly({{0, 0, 0}, {1e-50, 1, 1}}, 0, -1));
    }
}

// Of spheres at a distance of 1e-10 / 2 some hundred boxes tell what first derivatives would need 1e11 for.
TEST(QuickEnclosures, CombinationsKeepCloseSurfacesApart) {
    const ImplicitFunction near("x^2+y^2+z^2-1"), beside("x^2+y^2+z^2-1.0000000001"), touching("x^2+y^2+z^2-1+0*x");
    const BoxOfDoubles box{{0.5, 0.5, 0.5}, {0.75, 0.75, 0.75}};
    QuickEnclosures f(near), g(beside), same(touching);
    EXPECT_TRUE(f.combination_misses_zero(g, 1, box));
    EXPECT_TRUE(g.combination_misses_zero(f, 1, box));
    EXPECT_FALSE(f.combination_misses_zero(same, 1, box));
    EXPECT_FALSE(f.combination_misses_zero(g, 0, box)) << "f has zeros there";
    Enclosures careful(near), other(beside);
    EXPECT_TRUE(careful.combination_misses_zero(other, 1, box));
}

// Without derivatives, or values, at all places nothing follows from those at the centre.
TEST(QuickEnclosures, CombinationsNeedDerivatives) {
    const BoxOfDoubles box{{-1, -1, -1}, {1, 1, 1}};
    const ImplicitFunction plane("x/100 + 3 + y/100");
    for (const char* text : {"sqrt(x^2) - 0.5", "1/(x + 2/3) - 9", "log(x + 0.5) + 9", "(y^2)^0.5 - 0.5"}) {
        const ImplicitFunction function(text);
        for (const double t : {0.0, 1e-9}) {
            QuickEnclosures f(function), g(plane);
            EXPECT_FALSE(f.combination_misses_zero(g, t, box)) << text;
            f.combination_misses_zero(g, t, {{0.75, 0.75, 0.75}, {1, 1, 1}});  // smooth there, which does not stay so
            EXPECT_FALSE(f.combination_misses_zero(g, t, box)) << text;
            Enclosures careful(function), other(plane);
            EXPECT_FALSE(careful.combination_misses_zero(other, t, box)) << text;
        }
        QuickEnclosures f(function), g(plane);
        EXPECT_FALSE(g.combination_misses_zero(f, 10, box)) << text;
    }
}

TEST(QuickEnclosures, OverflowProvesNothing) {
    const BoxOfDoubles box{{1, 1, 1}, {2, 2, 2}};
    for (const char* text : {"x*1e200*1e200 - x*1e200*1e200 + 1", "exp(exp(9*y)) - exp(exp(9*y)) - 1",
                             "1e300*z*1e300/(1e300*z*1e300) - 2"}) {
        const ImplicitFunction function(text);
        QuickEnclosures quick(function);
        for (const int sign : {-1, 1}) EXPECT_FALSE(quick.proves(box, value, sign)) << text;
    }
}

TEST(QuickEnclosures, OtherRoundingModesProveNothing) {
    const ImplicitFunction function("x + 10");
    const BoxOfDoubles box{{1, 1, 1}, {2, 2, 2}};
    EXPECT_TRUE(QuickEnclosures(function).proves(box, value, 1));
    for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
        std::fesetround(mode);
        QuickEnclosures quick(function);
        const bool claimed = quick.proves(box, value, 1);
        std::fesetround(FE_TONEAREST);
        EXPECT_FALSE(claimed) << mode;
    }
}

}  // namespace
}  // namespace certa::verify
