// Value and gradient of a function over boxes with MPFI, whose rounding is that of MPFR: correct in both directions,
// whatever the processor's mode. Domains are asked before MPFI is: what it answers beyond them does not matter.
//
// The mesher proves signs with second derivatives; here the box is cut into eight instead, a few times, where value and
// mean value do not suffice. Slower, but another argument.
#include "verify/implicit_function.h"

#include <algorithm>
#include <cmath>

#include "verify/quick_enclosures.h"

namespace certa::verify {
namespace {

using Kind = ImplicitFunction::Kind;
constexpr mpfr_prec_t precision = 100;
constexpr int deepest = 10;

int sign_of(mpfi_srcptr a) {
    return mpfi_nan_p(a) ? 0 : mpfi_is_strictly_pos(a) ? 1 : mpfi_is_strictly_neg(a) ? -1 : 0;
}

}  // namespace

Enclosures::Enclosures(const ImplicitFunction& function)
    : function_(function), quick_(std::make_unique<QuickEnclosures>(function)), values_(function.steps().size()) {
    for (Values& v : values_) {
        mpfi_init2(v.value, precision);
        for (auto& slope : v.slope) {
            mpfi_init2(slope, precision);
            mpfi_set_ui(slope, 0);
        }
    }
    for (auto& p : place_) mpfi_init2(p, precision);
    for (std::size_t i = 0; i < values_.size(); ++i) set_constant(function.steps()[i], values_[i]);
    mpfi_init2(outer_, precision);
    mpfi_init2(t_, precision);
    mpfi_init2(u_, precision);
    mpfi_init2(sum_, precision);
}

Enclosures::~Enclosures() {
    for (Values& v : values_) {
        mpfi_clear(v.value);
        for (auto& slope : v.slope) mpfi_clear(slope);
    }
    for (auto& p : place_) mpfi_clear(p);
    mpfi_clear(outer_);
    mpfi_clear(t_);
    mpfi_clear(u_);
    mpfi_clear(sum_);
}

void Enclosures::evaluate(const std::array<mpfi_t, 3>& place, bool with_slopes) {
    const auto& steps = function_.steps();
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const auto& step = steps[i];
        Values& r = values_[i];
        r.defined = r.smooth = true;
        switch (step.kind) {
            case Kind::number:
            case Kind::pi:
                r.defined = r.constant_read;
                break;
            case Kind::variable:
                mpfi_set(r.value, place[static_cast<std::size_t>(step.n)]);
                mpfi_set_ui(r.slope[static_cast<std::size_t>(step.n)], 1);
                break;
            case Kind::sum:
            case Kind::difference:
            case Kind::product:
            case Kind::quotient:
            case Kind::real_power:
                binary(step, values_[step.a], values_[step.b], r, with_slopes);
                break;
            default:
                unary(step, values_[step.a], r, with_slopes);
        }
        if (mpfi_nan_p(r.value)) r.defined = false;
        if (!r.defined) r.smooth = false;
    }
}

/// Numbers are enclosed once, by MPFR's correctly rounded reading of their digits.
void Enclosures::set_constant(const ImplicitFunction::Step& step, Values& r) {
    if (step.kind == Kind::number) r.constant_read = mpfi_set_str(r.value, step.text.c_str(), 10) == 0;
    if (step.kind == Kind::pi) r.constant_read = mpfi_const_pi(r.value) >= 0;
}

/// base^n: monotone for odd n and on the sizes for even n, so the ends give the ends.
void Enclosures::raise(mpfi_ptr result, mpfi_srcptr base, long n) {
    const auto size = static_cast<unsigned long>(n < 0 ? -n : n);
    if (size % 2 == 0)
        mpfi_abs(result, base);
    else
        mpfi_set(result, base);
    mpfr_pow_ui(&result->left, &result->left, size, MPFR_RNDD);
    mpfr_pow_ui(&result->right, &result->right, size, MPFR_RNDU);
    if (n < 0) mpfi_inv(result, result);
}

void Enclosures::unary(const ImplicitFunction::Step& step, const Values& a, Values& r, bool with_slopes) {
    r.defined = a.defined;
    r.smooth = a.smooth;
    if (!r.defined) return;
    mpfi_set_ui(outer_, 1);  // the outer derivative
    switch (step.kind) {
        case Kind::negative:
            mpfi_neg(r.value, a.value);
            mpfi_set_si(outer_, -1);
            break;
        case Kind::power:
            if (step.n < 0 && mpfi_has_zero(a.value)) {
                r.defined = false;
                return;
            }
            raise(r.value, a.value, step.n);
            if (with_slopes && step.n != 0) {
                if (step.n - 1 < 0 && mpfi_has_zero(a.value))
                    r.smooth = false;
                else
                    raise(outer_, a.value, step.n - 1);
                mpfi_mul_si(outer_, outer_, step.n);
            } else {
                mpfi_set_ui(outer_, 0);
            }
            break;
        case Kind::root:
            r.defined = mpfi_is_nonneg(a.value) != 0;
            if (!r.defined) return;
            mpfi_sqrt(r.value, a.value);
            if (!mpfi_is_strictly_pos(a.value)) {
                r.smooth = false;
            } else {
                mpfi_mul_ui(outer_, r.value, 2);
                mpfi_inv(outer_, outer_);
            }
            break;
        case Kind::exponential:
            mpfi_exp(r.value, a.value);
            mpfi_set(outer_, r.value);
            break;
        case Kind::logarithm:
            r.defined = mpfi_is_strictly_pos(a.value) != 0;
            if (!r.defined) return;
            mpfi_log(r.value, a.value);
            mpfi_inv(outer_, a.value);
            break;
        case Kind::sine:
            mpfi_sin(r.value, a.value);
            mpfi_cos(outer_, a.value);
            break;
        case Kind::cosine:
            mpfi_cos(r.value, a.value);
            mpfi_sin(outer_, a.value);
            mpfi_neg(outer_, outer_);
            break;
        case Kind::tangent:
            mpfi_cos(t_, a.value);
            r.defined = sign_of(t_) != 0;
            if (!r.defined) return;
            mpfi_tan(r.value, a.value);
            mpfi_sqr(outer_, r.value);
            mpfi_add_ui(outer_, outer_, 1);
            break;
        case Kind::arctangent:
            mpfi_atan(r.value, a.value);
            mpfi_sqr(outer_, a.value);
            mpfi_add_ui(outer_, outer_, 1);
            mpfi_inv(outer_, outer_);
            break;
        case Kind::hyperbolic_sine:
            mpfi_sinh(r.value, a.value);
            mpfi_cosh(outer_, a.value);
            break;
        case Kind::hyperbolic_cosine:
            mpfi_cosh(r.value, a.value);
            mpfi_sinh(outer_, a.value);
            break;
        default:  // hyperbolic_tangent
            mpfi_tanh(r.value, a.value);
            mpfi_sqr(outer_, r.value);
            mpfi_ui_sub(outer_, 1, outer_);
    }
    for (std::size_t i = 0; with_slopes && i < 3; ++i) {
        if ((step.depends >> i) & 1u) mpfi_mul(r.slope[i], outer_, a.slope[i]);
    }
}

void Enclosures::binary(const ImplicitFunction::Step& step, const Values& a, const Values& b, Values& r,
                        bool with_slopes) {
    r.defined = a.defined && b.defined;
    r.smooth = a.smooth && b.smooth;
    if (!r.defined) return;
    switch (step.kind) {
        case Kind::sum:
            mpfi_add(r.value, a.value, b.value);
            break;
        case Kind::difference:
            mpfi_sub(r.value, a.value, b.value);
            break;
        case Kind::product:
            mpfi_mul(r.value, a.value, b.value);
            break;
        case Kind::quotient:
            r.defined = sign_of(b.value) != 0;
            if (r.defined) mpfi_div(r.value, a.value, b.value);
            break;
        default:  // real_power: exp(b log a), or the root for the exponent one half
            if (mpfr_cmp_d(&b.value->left, 0.5) == 0 && mpfr_cmp_d(&b.value->right, 0.5) == 0 &&
                mpfi_is_nonneg(a.value)) {
                mpfi_sqrt(r.value, a.value);
                r.smooth = r.smooth && mpfi_is_strictly_pos(a.value);
            } else {
                r.defined = sign_of(a.value) > 0;
                if (!r.defined) return;
                mpfi_log(t_, a.value);
                mpfi_mul(t_, t_, b.value);
                mpfi_exp(r.value, t_);
            }
            if (r.smooth) {  // b a^b / a
                mpfi_div(outer_, r.value, a.value);
                mpfi_mul(outer_, outer_, b.value);
            }
    }
    for (std::size_t i = 0; with_slopes && r.defined && r.smooth && i < 3; ++i) {
        if (((step.depends >> i) & 1u) == 0) continue;
        switch (step.kind) {
            case Kind::sum:
                mpfi_add(r.slope[i], a.slope[i], b.slope[i]);
                break;
            case Kind::difference:
                mpfi_sub(r.slope[i], a.slope[i], b.slope[i]);
                break;
            case Kind::product:
                mpfi_mul(t_, a.slope[i], b.value);
                mpfi_mul(u_, a.value, b.slope[i]);
                mpfi_add(r.slope[i], t_, u_);
                break;
            case Kind::quotient:
                mpfi_mul(t_, r.value, b.slope[i]);
                mpfi_sub(t_, a.slope[i], t_);
                mpfi_div(r.slope[i], t_, b.value);
                break;
            default:
                mpfi_mul(r.slope[i], outer_, a.slope[i]);
        }
    }
}

bool Enclosures::directly(const BoxOfDoubles& box, int axis, int sign) {
    for (std::size_t i = 0; i < 3; ++i) mpfi_interv_d(place_[i], box.low[i], box.high[i]);
    evaluate(place_, true);
    const Values& whole = values_[function_.result()];
    if (!whole.defined) return false;
    if (axis >= 0) return whole.smooth && sign_of(whole.slope[static_cast<std::size_t>(axis)]) == sign;
    if (sign_of(whole.value) == sign) return true;
    if (!whole.smooth) return false;
    // f(c) + G(box) (box - c)
    mpfi_set_ui(sum_, 0);
    std::array<double, 3> center;
    for (std::size_t i = 0; i < 3; ++i) {
        center[i] = middle_of(box.low[i], box.high[i]);
        mpfi_sub_d(t_, place_[i], center[i]);
        mpfi_mul(t_, t_, whole.slope[i]);
        mpfi_add(sum_, sum_, t_);
    }
    for (std::size_t i = 0; i < 3; ++i) mpfi_set_d(place_[i], center[i]);
    evaluate(place_, false);
    if (!values_[function_.result()].defined) return false;
    mpfi_add(sum_, sum_, values_[function_.result()].value);
    return sign_of(sum_) == sign;
}

bool Enclosures::proves(const BoxOfDoubles& box, int axis, int sign) {
    return quick_->proves(box, axis, sign) || on_parts(box, axis, sign, 0);
}

bool Enclosures::misses_zero(const BoxOfDoubles& box) {
    for (const int sign : {1, -1}) {
        if (quick_->proves_directly(box, -1, sign)) return true;
    }
    return directly(box, -1, 1) || directly(box, -1, -1);
}

bool Enclosures::on_parts(const BoxOfDoubles& box, int axis, int sign, int depth) {
    if (directly(box, axis, sign)) return true;
    if (depth == deepest) return false;
    return holds_on_parts(box, [&](const BoxOfDoubles& part) { return on_parts(part, axis, sign, depth + 1); });
}

bool Enclosures::proves_sign_on_triangle(const TriangleOfBoxes& t, int sign,
                                         BoxOfDoubles (*middle)(const BoxOfDoubles&, const BoxOfDoubles&), int depth) {
    BoxOfDoubles hull = t[0];
    std::array<double, 3> center{};
    for (std::size_t i = 0; i < 3; ++i) {
        for (const BoxOfDoubles& corner : t) {
            hull.low[i] = std::min(hull.low[i], corner.low[i]);
            hull.high[i] = std::max(hull.high[i], corner.high[i]);
        }
        // Any point of the hull will do.
        center[i] = std::clamp((t[0].low[i] + t[1].low[i] + t[2].low[i]) / 3, hull.low[i], hull.high[i]);
        mpfi_interv_d(place_[i], hull.low[i], hull.high[i]);
    }
    evaluate(place_, true);
    const Values& whole = values_[function_.result()];
    if (whole.defined && sign_of(whole.value) == sign) return true;
    if (whole.defined && whole.smooth) {
        std::array<mpfi_t, 3> at_corner;
        for (std::size_t k = 0; k < 3; ++k) {
            mpfi_init2(at_corner[k], mpfi_get_prec(sum_));
            mpfi_set_ui(at_corner[k], 0);
            for (std::size_t i = 0; i < 3; ++i) {
                mpfi_interv_d(t_, t[k].low[i], t[k].high[i]);
                mpfi_sub_d(t_, t_, center[i]);
                mpfi_mul(t_, t_, whole.slope[i]);
                mpfi_add(at_corner[k], at_corner[k], t_);
            }
        }
        for (std::size_t i = 0; i < 3; ++i) mpfi_set_d(place_[i], center[i]);
        evaluate(place_, false);
        const Values& middle_value = values_[function_.result()];
        bool all = middle_value.defined;
        for (mpfi_t& value : at_corner) {
            mpfi_add(value, value, middle_value.value);
            all = all && sign_of(value) == sign;
            mpfi_clear(value);
        }
        if (all) return true;
    }
    if (depth == 6) return false;
    const BoxOfDoubles a = middle(t[1], t[2]), b = middle(t[2], t[0]), c = middle(t[0], t[1]);
    return proves_sign_on_triangle({t[0], c, b}, sign, middle, depth + 1) &&
           proves_sign_on_triangle({c, t[1], a}, sign, middle, depth + 1) &&
           proves_sign_on_triangle({b, a, t[2]}, sign, middle, depth + 1) &&
           proves_sign_on_triangle({a, b, c}, sign, middle, depth + 1);
}

std::array<double, 4> Enclosures::guess(const std::array<double, 3>& place) {
    for (std::size_t i = 0; i < 3; ++i) mpfi_set_d(place_[i], place[i]);
    evaluate(place_, true);
    const Values& at = values_[function_.result()];
    if (!at.defined || !at.smooth) return {NAN, NAN, NAN, NAN};
    return {mpfi_get_d(at.value), mpfi_get_d(at.slope[0]), mpfi_get_d(at.slope[1]), mpfi_get_d(at.slope[2])};
}

/// q = f - t g: q(c) + Q(box) (box - c), where Q is the enclosure of the gradient of q.
bool Enclosures::combination_misses_zero(Enclosures& other, double t, const BoxOfDoubles& box) {
    if (quick_->combination_misses_zero(*other.quick_, t, box)) return true;
    std::array<double, 3> center;
    mpfi_set_ui(sum_, 0);
    for (Enclosures* e : {this, &other}) {
        for (std::size_t i = 0; i < 3; ++i) mpfi_interv_d(e->place_[i], box.low[i], box.high[i]);
        e->evaluate(e->place_, true);
        const Values& whole = e->values_[e->function_.result()];
        if (!whole.defined || !whole.smooth) return false;
    }
    const Values &f = values_[function_.result()], &g = other.values_[other.function_.result()];
    for (std::size_t i = 0; i < 3; ++i) {
        center[i] = middle_of(box.low[i], box.high[i]);
        mpfi_mul_d(t_, g.slope[i], t);
        mpfi_sub(t_, f.slope[i], t_);
        mpfi_sub_d(u_, place_[i], center[i]);
        mpfi_mul(t_, t_, u_);
        mpfi_add(sum_, sum_, t_);
    }
    for (Enclosures* e : {this, &other}) {
        for (std::size_t i = 0; i < 3; ++i) mpfi_set_d(e->place_[i], center[i]);
        e->evaluate(e->place_, false);
        if (!e->values_[e->function_.result()].defined) return false;
    }
    mpfi_mul_d(t_, g.value, t);
    mpfi_sub(t_, f.value, t_);
    mpfi_add(sum_, sum_, t_);
    return sign_of(sum_) != 0;
}

ImplicitFunction::Factors ImplicitFunction::factors() const {
    Factors factors;
    std::vector<std::uint32_t> work{result_};
    while (!work.empty()) {
        const std::uint32_t at = work.back();
        work.pop_back();
        const Step& step = steps_[at];
        if (step.depends == 0) {
            factors.constant.push_back(at);
        } else if (step.kind == Kind::product) {
            work.push_back(step.b);
            work.push_back(step.a);
        } else if (step.kind == Kind::negative) {
            work.push_back(step.a);
        } else {
            factors.variable.push_back(at);
        }
        if (factors.variable.size() + factors.constant.size() > 1000) return {};
    }
    return factors;
}

ImplicitFunction ImplicitFunction::ending_at(std::uint32_t step) const {
    ImplicitFunction function;
    function.steps_.assign(steps_.begin(), steps_.begin() + step + 1);
    function.result_ = step;
    return function;
}

}  // namespace certa::verify
