// One test per protection of interval arithmetic; each fails when its protection is taken away (tried by hand).
//   the outward step      StepsOutward, AccumulatesOutward
//   the rest of a series  SeriesHaveTheirRests (where they are used, outward steps hide it)
//   no mode switching     IsIndependentOfOptimisation (constant folding and the processor agree)
//   rounding mode         RefusesOtherRoundingModes
//   denormals             RefusesFlushedDenormals
//   NaN means not proved  UndefinedNeverCertifies
//   overflow              OverflowKeepsTheLargestDouble
#include <certa/error.h>
#include <gtest/gtest.h>
#include <mpfr.h>

#include <cfenv>
#include <cmath>

#include "core/random.h"
#include "interval/environment.h"
#include "interval/interval.h"
#include "interval/series.h"
#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace certa::interval {
namespace {

TEST(Protection, StepsOutward) {
    core::Random random(5);
    for (int i = 0; i < 200000; ++i) {
        const double x = std::ldexp(random.uniform(-1, 1), static_cast<int>(random.below(2110)) - 1090);
        ASSERT_GE(above(x), std::nextafter(x, infinity)) << x;
        ASSERT_LE(below(x), std::nextafter(x, -infinity)) << x;
        ASSERT_LE(above(x), std::nextafter(std::nextafter(x, infinity), infinity)) << x;
    }
    EXPECT_GT(above(0.0), 0.0);
    EXPECT_GT(above(-0x1p-1074), -0x1p-1074);
    EXPECT_EQ(above(largest), infinity);
}

// 0.1 + 0.2 is not 0.3: the sum of the doubles needs 54 bits.
TEST(Protection, AccumulatesOutward) {
    Interval sum(0.0);
    for (int i = 0; i < 1000; ++i) sum += Interval(0.1);
    // 1000 times the double 0.1 is 100.00000000000000555...
    EXPECT_LT(sum.lo, 100.0);
    EXPECT_GT(sum.hi, 100.00000000000001);
    EXPECT_LT((Interval(1.0) / Interval(3.0)).lo * 3, 1.0);
    EXPECT_GT(width(Interval(1.0) / Interval(3.0)), 0.0);
}

struct Series {
    const char* name;
    Interval (*enclosed)(const Interval&);
    int (*exact)(mpfr_ptr, mpfr_srcptr, mpfr_rnd_t);
    double furthest, factor;  ///< of the exact function
};

// Far out, where the terms alone, even with all their outward steps, miss the function.
TEST(Protection, SeriesHaveTheirRests) {
    const Series all[] = {
        {"exp", exp_series, mpfr_exp, 3, 1},
        {"sinh", [](const Interval& x) { return sinh_series(x.lo); }, mpfr_sinh, 4, 1},
        {"2 atanh", twice_atanh_series, mpfr_atanh, 0.5, 2},
        {"sin", sin_series, mpfr_sin, 4, 1},
        {"cos", cos_series, mpfr_cos, 4, 1},
        {"atan", atan_series, mpfr_atan, 1, 1},
    };
    mpfr_t x, value;
    mpfr_inits2(400, x, value, static_cast<mpfr_ptr>(nullptr));
    for (const Series& series : all) {
        for (int i = -200; i <= 200; ++i) {
            const double r = series.furthest * i / 200;
            mpfr_set_d(x, r, MPFR_RNDN);
            series.exact(value, x, MPFR_RNDN);
            mpfr_mul_d(value, value, series.factor, MPFR_RNDN);
            const Interval found = series.enclosed(Interval(r));
            EXPECT_LE(mpfr_cmp_d(value, found.hi), 0) << series.name << " at " << r;
            EXPECT_GE(mpfr_cmp_d(value, found.lo), 0) << series.name << " at " << r;
            EXPECT_LE(width(found), 0.2) << series.name << " at " << r;
        }
    }
    mpfr_clears(x, value, static_cast<mpfr_ptr>(nullptr));
}

// Computed by the compiler and by the processor, with operands that it can and cannot see.
TEST(Protection, IsIndependentOfOptimisation) {
    constexpr Interval folded = (Interval(0.1) + Interval(0.2)) * Interval(0.3) / Interval(0.7) - sqr(Interval(1e-200));
    volatile double a = 0.1, b = 0.2, c = 0.3, d = 0.7, e = 1e-200;
    const Interval seen = (Interval(a) + Interval(b)) * Interval(c) / Interval(d) - sqr(Interval(e));
    EXPECT_EQ(folded.lo, seen.lo);
    EXPECT_EQ(folded.hi, seen.hi);
    EXPECT_LT(folded.lo, folded.hi);
}

TEST(Protection, RefusesOtherRoundingModes) {
    EXPECT_TRUE(is_environment_sound());
    for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
        std::fesetround(mode);
        const bool sound = is_environment_sound();
        std::fesetround(FE_TONEAREST);
        EXPECT_FALSE(sound) << mode;
    }
    EXPECT_NO_THROW(require_sound_environment());
}

#if defined(__SSE2__)
TEST(Protection, RefusesFlushedDenormals) {
    const unsigned before = _mm_getcsr();
    for (const unsigned flag : {0x8000u, 0x0040u}) {  // flush-to-zero, denormals-are-zero
        _mm_setcsr(before | flag);
        const bool sound = is_environment_sound();
        bool refused = false;
        try {
            require_sound_environment();
        } catch (const InternalError&) {
            refused = true;
        }
        _mm_setcsr(before);
        EXPECT_FALSE(sound) << flag;
        EXPECT_TRUE(refused) << flag;
    }
}
#endif

TEST(Protection, UndefinedNeverCertifies) {
    const Interval bad = undefined(), half_bad{1.0, undefined().hi}, other_half{undefined().lo, 1.0};
    for (const Interval& a : {bad, half_bad, other_half}) {
        EXPECT_EQ(sign_of(a), 0);
        for (const Interval& b : {a + Interval(5.0),
                                  Interval(5.0) - a,
                                  a * Interval(2.0),
                                  Interval(2.0) * a,
                                  a * Interval(0.0),
                                  a / Interval(2.0),
                                  Interval(1.0) / a,
                                  sqr(a),
                                  sqrt(a),
                                  power(a, 3),
                                  power(a, 4),
                                  power(a, -1),
                                  power(a, Interval(0.5)),
                                  exp(a),
                                  log(a),
                                  sin(a),
                                  cos(a),
                                  tan(a),
                                  atan(a),
                                  sinh(a),
                                  cosh(a),
                                  tanh(a),
                                  -a}) {
            EXPECT_FALSE(is_defined(b));
            EXPECT_EQ(sign_of(b), 0);
        }
    }
    EXPECT_FALSE(is_defined(Interval(1.0) / Interval(-1, 1)));
    EXPECT_FALSE(is_defined(Interval(1.0) / Interval(0.0)));
    EXPECT_FALSE(is_defined(log(Interval(0, 1))));
    EXPECT_FALSE(is_defined(sqrt(Interval(-1e-300, 1))));
    EXPECT_FALSE(is_defined(tan(Interval(1, 2))));
    EXPECT_FALSE(is_defined(intersect(Interval(0, 1), Interval(2, 3)))) << "a contradiction proves nothing";
}

TEST(Protection, OverflowKeepsTheLargestDouble) {
    const Interval big(1e200);
    EXPECT_LE((big * big).lo, largest);
    EXPECT_EQ((big * big).hi, infinity);
    EXPECT_EQ((-big * big).lo, -infinity);
    EXPECT_GE((-big * big).hi, -largest);
    EXPECT_LE(sqr(big).lo, largest);
    EXPECT_LE(power(big, 3).lo, largest);
    EXPECT_LE(exp(Interval(1000.0)).lo, largest);
    EXPECT_EQ(exp(Interval(1000.0)).hi, infinity);
    EXPECT_GT(exp(Interval(-1000.0)).hi, 0.0);
    EXPECT_EQ(sign_of(Interval(largest) + Interval(largest)), 1) << "beyond the largest double is still positive";
}

}  // namespace
}  // namespace certa::interval
