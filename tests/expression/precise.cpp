// The oracle shares nothing with the tape: no simplification, no masks, constants from their decimal digits by MPFR.
#include "expression/precise.h"

#include <unordered_map>

#include "expression/node.h"

namespace certa::test {
namespace {

using expression::Node;
using expression::Op;

void set_constant(mpfr_ptr r, const expression::Constant& c) {
    if (!c.is_rational()) {
        mpfr_set_str(r, c.digits.c_str(), 10, MPFR_RNDN);
        return;
    }
    mpfr_set_sj(r, c.numerator, MPFR_RNDN);
    mpfr_div_si(r, r, c.denominator, MPFR_RNDN);
}

void apply(mpfr_ptr r, const Node& node, mpfr_srcptr a, mpfr_srcptr b) {
    switch (node.op) {
        case Op::negate:
            mpfr_neg(r, a, MPFR_RNDN);
            break;
        case Op::add:
            mpfr_add(r, a, b, MPFR_RNDN);
            break;
        case Op::subtract:
            mpfr_sub(r, a, b, MPFR_RNDN);
            break;
        case Op::multiply:
            mpfr_mul(r, a, b, MPFR_RNDN);
            break;
        case Op::divide:
            mpfr_div(r, a, b, MPFR_RNDN);
            break;
        case Op::power:
            mpfr_pow_si(r, a, node.exponent, MPFR_RNDN);
            break;
        case Op::real_power:
            if (mpfr_sgn(a) > 0)
                mpfr_pow(r, a, b, MPFR_RNDN);
            else
                mpfr_set_nan(r);
            break;
        case Op::square_root:
            mpfr_sqrt(r, a, MPFR_RNDN);
            break;
        case Op::exp:
            mpfr_exp(r, a, MPFR_RNDN);
            break;
        case Op::log:
            mpfr_log(r, a, MPFR_RNDN);
            break;
        case Op::sin:
            mpfr_sin(r, a, MPFR_RNDN);
            break;
        case Op::cos:
            mpfr_cos(r, a, MPFR_RNDN);
            break;
        case Op::tan:
            mpfr_tan(r, a, MPFR_RNDN);
            break;
        case Op::atan:
            mpfr_atan(r, a, MPFR_RNDN);
            break;
        case Op::sinh:
            mpfr_sinh(r, a, MPFR_RNDN);
            break;
        case Op::cosh:
            mpfr_cosh(r, a, MPFR_RNDN);
            break;
        case Op::tanh:
            mpfr_tanh(r, a, MPFR_RNDN);
            break;
        default:
            mpfr_set_nan(r);
    }
}

}  // namespace

bool Precise::within(double low, double high, double slack) const {
    Precise below(low), above(high);
    mpfr_sub_d(below.value, below.value, slack, MPFR_RNDD);
    mpfr_add_d(above.value, above.value, slack, MPFR_RNDU);
    return mpfr_cmp(value, below.value) >= 0 && mpfr_cmp(value, above.value) <= 0;
}

Precise evaluate_precisely(const Expression& function, const PrecisePlace& place) {
    std::unordered_map<const Node*, Precise> values;
    for (const Node* node : expression::in_order(function.node())) {
        Precise& r = values[node];
        switch (node->op) {
            case Op::constant:
                set_constant(r.value, node->constant);
                break;
            case Op::pi:
                mpfr_const_pi(r.value, MPFR_RNDN);
                break;
            case Op::x:
                r = place[0];
                break;
            case Op::y:
                r = place[1];
                break;
            case Op::z:
                r = place[2];
                break;
            default: {
                const Precise& a = values.at(node->first.get());
                apply(r.value, *node, a.value, node->second ? values.at(node->second.get()).value : a.value);
            }
        }
    }
    return values.at(function.node().get());
}

namespace {

PrecisePlace moved(PrecisePlace place, int axis, double step) {
    mpfr_add_d(place[static_cast<std::size_t>(axis)].value, place[static_cast<std::size_t>(axis)].value, step,
               MPFR_RNDN);
    return place;
}

Precise difference(const Precise& above, const Precise& below) {
    Precise result;
    mpfr_sub(result.value, above.value, below.value, MPFR_RNDN);
    mpfr_mul_2si(result.value, result.value, 69, MPFR_RNDN);  // over 2 steps of 2^-70
    return result;
}

}  // namespace

Precise differentiate(const Expression& function, const PrecisePlace& place, int axis) {
    return difference(evaluate_precisely(function, moved(place, axis, 0x1p-70)),
                      evaluate_precisely(function, moved(place, axis, -0x1p-70)));
}

Precise differentiate(const Expression& function, const PrecisePlace& place, int first, int second) {
    return difference(differentiate(function, moved(place, first, 0x1p-70), second),
                      differentiate(function, moved(place, first, -0x1p-70), second));
}

}  // namespace certa::test
