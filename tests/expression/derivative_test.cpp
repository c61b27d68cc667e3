// Values, gradients and Hessians of random expressions against 400-bit arithmetic: intervals enclose them at every
// point of the box, doubles come near them.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "expression/jet.h"
#include "expression/precise.h"
#include "expression/random_expression.h"

namespace certa::expression {
namespace {

using core::Random;
using interval::Interval;
using test::Precise;
using test::PrecisePlace;

/// What differences cannot tell: far below a unit in the last place of results of ordinary size.
double slack_of(const Precise& exact) { return 0x1p-80 * (1.0 + exact.size()); }

void check_enclosures(const Expression& function, const Place<Interval>& box, Random& random) {
    const Tape tape(function);
    Workspace<Interval> workspace(tape);
    const Jet<Interval> jet = workspace.evaluate<2>(box);
    if (!interval::is_defined(jet.value)) return;
    for (int sample = 0; sample < 2; ++sample) {
        PrecisePlace place;
        for (int i = 0; i < 3; ++i) place[i] = Precise(box[i].lo + random.uniform() * (box[i].hi - box[i].lo));
        const Precise value = test::evaluate_precisely(function, place);
        RC_ASSERT(value.is_number());
        RC_ASSERT(value.within(jet.value.lo, jet.value.hi, 0.0));
        for (int i = 0; i < 3; ++i) {
            const Precise slope = test::differentiate(function, place, i);
            if (interval::is_defined(jet.gradient[i]))
                RC_ASSERT(slope.within(jet.gradient[i].lo, jet.gradient[i].hi, slack_of(slope)));
            for (int j = i; j < 3; ++j) {
                const Precise bend = test::differentiate(function, place, i, j);
                const Interval& enclosure = jet.hessian[hessian_index[i][j]];
                if (interval::is_defined(enclosure)) RC_ASSERT(bend.within(enclosure.lo, enclosure.hi, slack_of(bend)));
            }
        }
    }
}

RC_GTEST_PROP(Derivatives, AreEnclosedOnBoxes, (std::uint64_t seed)) {
    Random random(seed);
    for (int i = 0; i < 10; ++i) {
        const Expression function = test::random_expression(random, 3 + static_cast<int>(random.below(12)));
        Place<Interval> box;
        for (Interval& side : box) {
            const double low = random.uniform(-1.5, 1.5);
            side = {low, low + std::ldexp(random.uniform(), -static_cast<int>(random.below(30)))};
        }
        check_enclosures(function, box, random);
    }
}

RC_GTEST_PROP(Derivatives, InDoublesComeNear, (std::uint64_t seed)) {
    Random random(seed);
    for (int i = 0; i < 10; ++i) {
        const Expression function = test::random_expression(random, 6);
        const Point3 place{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
        const PointValue found = evaluate(function, place);
        const PrecisePlace exact_place{Precise(place.x), Precise(place.y), Precise(place.z)};
        // The enclosure at the point says how well conditioned the function is there.
        const Tape tape(function);
        Workspace<Interval> workspace(tape);
        const auto& jet = workspace.evaluate<1>({Interval(place.x), Interval(place.y), Interval(place.z)});
        if (!interval::is_defined(jet.value)) continue;
        const double spread = interval::width(jet.value);
        RC_ASSERT(
            test::evaluate_precisely(function, exact_place).within(found.value - spread, found.value + spread, 1e-300));
        const double slopes[3] = {found.gradient.x, found.gradient.y, found.gradient.z};
        for (int k = 0; k < 3; ++k) {
            if (!interval::is_defined(jet.gradient[k])) continue;
            const double room = interval::width(jet.gradient[k]) + 1e-15 * std::fabs(slopes[k]);
            RC_ASSERT(test::differentiate(function, exact_place, k).within(slopes[k] - room, slopes[k] + room, 1e-20));
        }
    }
}

// The gradient of x^2 y + sin z at (1, 2, 0) is (4, 1, 1), its Hessian (4, 2, 0; 2, 0, 0; 0, 0, 0).
TEST(Derivatives, ByHand) {
    const Tape tape(parse_expression("x^2*y + sin(z)"));
    Workspace<Interval> workspace(tape);
    const auto& jet = workspace.evaluate<2>({Interval(1), Interval(2), Interval(0)});
    EXPECT_TRUE(contains(jet.value, 2.0));
    EXPECT_TRUE(contains(jet.gradient[0], 4.0) && contains(jet.gradient[1], 1.0) && contains(jet.gradient[2], 1.0));
    const double hessian[6] = {4, 2, 0, 0, 0, 0};
    for (int i = 0; i < 6; ++i) {
        EXPECT_TRUE(contains(jet.hessian[i], hessian[i])) << i;
        EXPECT_LT(width(jet.hessian[i]), 1e-14) << i;
    }
    EXPECT_EQ(tape.instructions().back().hessian, 0b100011) << "xx, xy and zz may differ from 0";
}

TEST(Derivatives, UndefinedOnBoxesThatLeaveTheDomain) {
    const Place<Interval> around_zero{Interval(-1, 1), Interval(-1, 1), Interval(-1, 1)};
    for (const char* text : {"log(x)", "1/x", "sqrt(x)", "x^-1", "tan(2*x)", "x^1.5", "log(x)*0", "0*log(x) + y",
                             "(1/x)^0", "log(x) - log(x)", "1/(y - y)"}) {
        const Tape tape(parse_expression(text));
        Workspace<Interval> workspace(tape);
        EXPECT_FALSE(is_defined(workspace.evaluate<0>(around_zero).value)) << text;
    }
    // At the tip of a cone the value exists, the gradient does not.
    const Tape cone(parse_expression("sqrt(x^2 + y^2 + z^2) - 2"));
    Workspace<Interval> workspace(cone);
    const auto& jet = workspace.evaluate<1>(around_zero);
    EXPECT_TRUE(is_defined(jet.value));
    EXPECT_EQ(sign_of(jet.value), -1);
    for (const Interval& slope : jet.gradient) EXPECT_EQ(sign_of(slope), 0);
}

}  // namespace
}  // namespace certa::expression
