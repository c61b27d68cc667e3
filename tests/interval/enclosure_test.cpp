// The laws of interval.h against MPFR with 200 bits: for random intervals of every magnitude and random points in them,
// the exact result of each operation lies in the interval's; on points the enclosure is a few units wide.
#include <gtest/gtest.h>
#include <mpfr.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/random.h"
#include "interval/interval.h"

namespace certa::interval {
namespace {

using core::Random;

/// A number with 200 bits that knows which way it was rounded.
class Precise {
public:
    Precise() { mpfr_init2(value, 200); }
    explicit Precise(double x) : Precise() { mpfr_set_d(value, x, MPFR_RNDN); }
    Precise(const Precise&) = delete;
    Precise& operator=(const Precise&) = delete;
    ~Precise() { mpfr_clear(value); }
    mpfr_t value;
};

using Binary = int (*)(mpfr_ptr, mpfr_srcptr, mpfr_srcptr, mpfr_rnd_t);
using Unary = int (*)(mpfr_ptr, mpfr_srcptr, mpfr_rnd_t);

/// The exact result, from below and from above, lies in `enclosure`.
template <class Operation>
bool encloses(const Interval& enclosure, Operation operation) {
    Precise low, high;
    operation(low.value, MPFR_RNDD);
    operation(high.value, MPFR_RNDU);
    if (mpfr_nan_p(low.value) || mpfr_nan_p(high.value)) return false;
    return mpfr_cmp_d(low.value, enclosure.lo) >= 0 && mpfr_cmp_d(high.value, enclosure.hi) <= 0;
}

/// Any finite double: every exponent, and often the values where things break.
double any_double(Random& random) {
    static const double special[] = {0.0,
                                     -0.0,
                                     1.0,
                                     -1.0,
                                     0.5,
                                     0x1p-1074,
                                     -0x1p-1074,
                                     0x1p-1022,
                                     largest,
                                     -largest,
                                     0x1p511,
                                     0x1p-537,
                                     1e-160,
                                     709.78,
                                     -745.13,
                                     1e16,
                                     3.0,
                                     0.1,
                                     1.5707963267948966,
                                     3.141592653589793,
                                     -1.5707963267948966};
    switch (random.below(6)) {
        case 0:
            return special[random.below(std::size(special))];
        case 1:
            for (;;) {
                const double x = std::bit_cast<double>(random.next());
                if (std::isfinite(x)) return x;
            }
        case 2:
            return std::ldexp(random.uniform(-1, 1), static_cast<int>(random.below(60)) - 30);
        default:
            return random.uniform(-4, 4);
    }
}

Interval any_interval(Random& random) {
    const double a = any_double(random);
    double b = a;
    switch (random.below(4)) {
        case 0:
            break;
        case 1:
            b = a + std::ldexp(random.uniform(), static_cast<int>(random.below(40)) - 30) * std::fabs(a);
            break;
        case 2:
            b = any_double(random);
            break;
        default:
            b = std::nextafter(a, infinity);
    }
    if (!std::isfinite(b)) b = a;
    return {std::min(a, b), std::max(a, b)};
}

double member(const Interval& a, Random& random) {
    switch (random.below(3)) {
        case 0:
            return a.lo;
        case 1:
            return a.hi;
        default: {
            const double t = random.uniform(), x = (1 - t) * a.lo + t * a.hi;
            return x < a.lo ? a.lo : x > a.hi ? a.hi : x;
        }
    }
}

template <class Operation>
void check_binary(std::uint64_t seed, Operation operation, Binary exact, bool skip_zero_divisor = false) {
    Random random(seed);
    for (int i = 0; i < 400; ++i) {
        const Interval a = any_interval(random), b = any_interval(random);
        const Interval c = operation(a, b);
        if (skip_zero_divisor && contains(b, 0.0)) {
            RC_ASSERT(!is_defined(c));
            continue;
        }
        const Precise x(member(a, random)), y(member(b, random));
        RC_ASSERT(is_defined(c));
        RC_ASSERT(encloses(c, [&](mpfr_ptr r, mpfr_rnd_t mode) { exact(r, x.value, y.value, mode); }));
    }
}

RC_GTEST_PROP(Enclosure, Sum, (std::uint64_t seed)) {
    check_binary(
        seed, [](Interval a, Interval b) { return a + b; }, mpfr_add);
}
RC_GTEST_PROP(Enclosure, Difference, (std::uint64_t seed)) {
    check_binary(
        seed, [](Interval a, Interval b) { return a - b; }, mpfr_sub);
}
RC_GTEST_PROP(Enclosure, Product, (std::uint64_t seed)) {
    check_binary(
        seed, [](Interval a, Interval b) { return a * b; }, mpfr_mul);
}
RC_GTEST_PROP(Enclosure, Quotient, (std::uint64_t seed)) {
    check_binary(
        seed, [](Interval a, Interval b) { return a / b; }, mpfr_div, true);
}

struct Function {
    const char* name;
    Interval (*enclosed)(const Interval&);
    Unary exact;
    double low, high;  ///< where it is defined
    double units;      ///< widest enclosure at a point with |x| <= 100, in units in the last place of the result
};

const Function functions[] = {
    {"sqr", [](const Interval& a) { return sqr(a); }, mpfr_sqr, -largest, largest, 4},
    {"sqrt", [](const Interval& a) { return sqrt(a); }, mpfr_sqrt, 0, largest, 4},
    {"exp", exp, mpfr_exp, -largest, largest, 24},
    {"log", log, mpfr_log, 0x1p-1074, largest, 24},
    {"sin", sin, mpfr_sin, -largest, largest, 24},
    {"cos", cos, mpfr_cos, -largest, largest, 24},
    {"atan", atan, mpfr_atan, -largest, largest, 48},
    {"sinh", sinh, mpfr_sinh, -largest, largest, 40},
    {"cosh", cosh, mpfr_cosh, -largest, largest, 40},
    {"tanh", tanh, mpfr_tanh, -largest, largest, 90},
};

RC_GTEST_PROP(Enclosure, Functions, (std::uint64_t seed)) {
    Random random(seed);
    for (const Function& f : functions) {
        for (int i = 0; i < 60; ++i) {
            const Interval a = any_interval(random);
            const Interval value = f.enclosed(a);
            if (a.lo < f.low || a.hi > f.high) {
                RC_ASSERT(!is_defined(value));
                continue;
            }
            const Precise x(member(a, random));
            RC_ASSERT(is_defined(value));
            if (!encloses(value, [&](mpfr_ptr r, mpfr_rnd_t mode) { f.exact(r, x.value, mode); })) {
                RC_FAIL(std::string(f.name) + " misses a value on [" + std::to_string(a.lo) + ", " +
                        std::to_string(a.hi) + "]");
            }
        }
    }
}

RC_GTEST_PROP(Enclosure, TangentAwayFromItsPoles, (std::uint64_t seed)) {
    Random random(seed);
    for (int i = 0; i < 300; ++i) {
        const double low = random.uniform(-30, 30);
        const Interval a{low, low + random.uniform(0, 2) * random.uniform()};
        const Interval value = tan(a);
        const double turns = std::floor(a.hi / 3.14159265358979 + 0.5) - std::floor(a.lo / 3.14159265358979 + 0.5);
        if (turns != 0) RC_ASSERT(!is_defined(value));
        if (!is_defined(value)) continue;
        const Precise x(member(a, random));
        RC_ASSERT(encloses(value, [&](mpfr_ptr r, mpfr_rnd_t mode) { mpfr_tan(r, x.value, mode); }));
    }
}

RC_GTEST_PROP(Enclosure, IntegerPowers, (std::uint64_t seed)) {
    Random random(seed);
    for (int i = 0; i < 300; ++i) {
        const Interval a = any_interval(random);
        const int n = static_cast<int>(random.below(25)) - 8;
        const Interval value = power(a, n);
        if (n < 0 && contains(a, 0.0)) {
            RC_ASSERT(!is_defined(value));
            continue;
        }
        // Undefined is allowed only where a negative power underflows its denominator.
        if (!is_defined(value)) RC_ASSERT(n < 0);
        if (!is_defined(value)) continue;
        const Precise x(member(a, random));
        RC_ASSERT(encloses(value, [&](mpfr_ptr r, mpfr_rnd_t mode) { mpfr_pow_si(r, x.value, n, mode); }));
    }
}

RC_GTEST_PROP(Enclosure, RealPowers, (std::uint64_t seed)) {
    Random random(seed);
    for (int i = 0; i < 200; ++i) {
        const Interval a = any_interval(random);
        const double exponent = random.uniform(-3, 3);
        const Interval value = power(a, Interval(exponent));
        if (!(a.lo > 0)) {
            RC_ASSERT(!is_defined(value));
            continue;
        }
        const Precise x(member(a, random)), y(exponent);
        RC_ASSERT(encloses(value, [&](mpfr_ptr r, mpfr_rnd_t mode) { mpfr_pow(r, x.value, y.value, mode); }));
    }
}

TEST(Enclosure, IsTightOnPoints) {
    Random random(11);
    for (const Function& f : functions) {
        double widest = 0;
        for (int i = 0; i < 4000; ++i) {
            const double x = random.uniform(std::max(f.low, -100.0), 100);
            const Interval value = f.enclosed(Interval(x));
            const double size = std::max(std::fabs(value.lo), std::fabs(value.hi));
            const double unit = std::nextafter(size, infinity) - size;
            // sin and cos near their zeros are as accurate as the reduced argument, not as their own value.
            const bool wave = f.exact == mpfr_sin || f.exact == mpfr_cos;
            widest = std::max(widest, (value.hi - value.lo) / (wave && size < 0.01 ? 0x1p-59 : unit));
        }
        EXPECT_LE(widest, f.units) << f.name;
        EXPECT_GT(widest, 0) << f.name;
    }
}

TEST(Enclosure, ValuesAtInfinity) {
    EXPECT_EQ(exp(entire()).lo, 0.0);
    EXPECT_EQ(exp(entire()).hi, infinity);
    EXPECT_EQ(tanh(entire()).lo, -1.0);
    EXPECT_EQ(tanh(entire()).hi, 1.0);
    EXPECT_GE(atan(entire()).hi, 1.5707963267948966);
    EXPECT_EQ(cosh(entire()).lo, 1.0);
    EXPECT_EQ(log(Interval(1.0, infinity)).hi, infinity);
    EXPECT_LE(exp(Interval(1e9, infinity)).lo, largest);
    EXPECT_EQ(sin(Interval(0, 1e300)).hi, 1.0);
    EXPECT_TRUE(contains(entire() * Interval(0.0), 0.0));
    EXPECT_TRUE(contains(sqr(Interval(-infinity, 2)), 0.0));
}

// What sin does between the ends of an interval: maxima and minima are met exactly when they lie within.
TEST(Enclosure, ExtremaOfWaves) {
    EXPECT_EQ(sin(Interval(1.5, 1.6)).hi, 1.0);
    EXPECT_LT(sin(Interval(1.5, 1.57)).hi, 1.0);
    EXPECT_EQ(sin(Interval(4.7, 4.8)).lo, -1.0);
    EXPECT_EQ(cos(Interval(-0.1, 0.1)).hi, 1.0);
    EXPECT_EQ(cos(Interval(3.1, 3.2)).lo, -1.0);
    EXPECT_GT(cos(Interval(-0.1, 0.1)).lo, 0.99);
    EXPECT_EQ(cos(Interval(6.2, 6.3)).hi, 1.0);
    EXPECT_LT(cos(Interval(6.2, 6.28)).hi, 1.0);
}

TEST(Enclosure, PiIsPi) {
    EXPECT_TRUE(encloses(pi, [](mpfr_ptr r, mpfr_rnd_t mode) { mpfr_const_pi(r, mode); }));
    EXPECT_EQ(std::nextafter(pi.lo, 4.0), pi.hi);
}

}  // namespace
}  // namespace certa::interval
