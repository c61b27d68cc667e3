// Derivatives up to the second order on spans (span.h), tried before MPFI.
//
// Each danger is met once, and has its test. What is computed from a span that is of no use is of no use either, so
// poles and the ends of domains need nothing but what division, roots and MPFI say there. A function that is not
// differentiable everywhere is found from the derivative of one of its steps; all steps have second derivatives where
// they have first ones. The middle of a box lies in it, so that everything is defined there that is so on the box.
//
// Plan: one step of the function at a time, value and derivatives; the enclosure, the mean value form or Taylor's form
// on a box; its eight parts.
#include "verify/quick_enclosures.h"

#include <cfenv>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "core/assert.h"

namespace certa::verify {
namespace {

/// Second derivative k is by these two variables.
constexpr std::array<std::pair<std::size_t, std::size_t>, 6> pair_of{{{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}}};

}  // namespace

QuickEnclosures::QuickEnclosures(const ImplicitFunction& function)
    : function_(function), values_(function.steps().size()), is_sound_(std::fegetround() == FE_TONEAREST) {
    mpfi_init2(exact_, 64);
    mpfi_init2(argument_, 64);
    for (std::size_t i = 0; i < values_.size(); ++i) {
        const ImplicitFunction::Step& step = function.steps()[i];
        if (step.kind != Kind::number && step.kind != Kind::pi) continue;
        if (step.kind == Kind::pi)
            mpfi_const_pi(exact_);
        else
            CERTA_ASSERT(mpfi_set_str(exact_, step.text.c_str(), 10) == 0);
        values_[i].value = {mpfr_get_d(&exact_->left, MPFR_RNDD), mpfr_get_d(&exact_->right, MPFR_RNDU)};
        values_[i].defined = values_[i].smooth = true;
    }
}

Span QuickEnclosures::by_mpfi(int (*function)(mpfi_ptr, mpfi_srcptr), const Span& a) {
    mpfi_interv_d(argument_, a.low, a.high);
    function(exact_, argument_);
    return {mpfr_get_d(&exact_->left, MPFR_RNDD), mpfr_get_d(&exact_->right, MPFR_RNDU)};
}

void QuickEnclosures::evaluate(const std::array<Span, 3>& place, int order) {
    const auto& steps = function_.steps();
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const ImplicitFunction::Step& step = steps[i];
        Values& r = values_[i];
        switch (step.kind) {
            case Kind::number:
            case Kind::pi:
                continue;
            case Kind::variable:
                r.value = place[static_cast<std::size_t>(step.n)];
                r.slope[static_cast<std::size_t>(step.n)] = {1, 1};
                r.defined = r.smooth = true;
                continue;
            case Kind::sum:
            case Kind::difference:
            case Kind::product:
            case Kind::quotient:
            case Kind::real_power:
                binary(step, values_[step.a], values_[step.b], r, order);
                break;
            default:
                unary(step, values_[step.a], r, order);
        }
        r.defined = r.defined && is_usable(r.value);
    }
}

/// False where it is not defined. Derivatives that are not defined are NaN.
bool QuickEnclosures::outer(const ImplicitFunction::Step& step, const Span& a, Outer& f) {
    const Span one{1, 1}, two{2, 2};
    switch (step.kind) {
        case Kind::negative:
            f = {-a, {-1, -1}, {0, 0}};
            return true;
        case Kind::power: {
            if (std::labs(step.n) > 1'000'000) return false;  // left to MPFI
            const auto n = static_cast<double>(step.n);
            const auto to = [&](long k) { return k == 0 ? one : k < 0 ? one / raised(a, -k) : raised(a, k); };
            f.value = to(step.n);
            f.slope = step.n == 0 ? Span{0, 0} : Span{n, n} * to(step.n - 1);
            f.bend = step.n == 0 || step.n == 1 ? Span{0, 0} : Span{n * (n - 1), n * (n - 1)} * to(step.n - 2);
            return true;
        }
        case Kind::root:
            f.value = root(a);
            f.slope = Span{0.5, 0.5} / f.value;
            f.bend = -(f.slope / (two * a));
            return true;
        case Kind::exponential:
            f.value = f.slope = f.bend = by_mpfi(mpfi_exp, a);
            return true;
        case Kind::logarithm:
            f = {by_mpfi(mpfi_log, a), one / a, -(one / square(a))};
            return true;
        case Kind::sine:
            f.value = by_mpfi(mpfi_sin, a);
            f.slope = by_mpfi(mpfi_cos, a);
            f.bend = -f.value;
            return true;
        case Kind::cosine:
            f.value = by_mpfi(mpfi_cos, a);
            f.slope = -by_mpfi(mpfi_sin, a);
            f.bend = -f.value;
            return true;
        case Kind::tangent:
            f.value = by_mpfi(mpfi_tan, a);
            f.slope = one + square(f.value);
            f.bend = two * f.value * f.slope;
            return true;
        case Kind::arctangent:
            f.value = by_mpfi(mpfi_atan, a);
            f.slope = one / (one + square(a));
            f.bend = -(two * a * square(f.slope));
            return true;
        case Kind::hyperbolic_sine:
            f.value = f.bend = by_mpfi(mpfi_sinh, a);
            f.slope = by_mpfi(mpfi_cosh, a);
            return true;
        case Kind::hyperbolic_cosine:
            f.value = f.bend = by_mpfi(mpfi_cosh, a);
            f.slope = by_mpfi(mpfi_sinh, a);
            return true;
        default:  // hyperbolic_tangent
            f.value = by_mpfi(mpfi_tanh, a);
            f.slope = one - square(f.value);
            f.bend = -(two * f.value * f.slope);
            return true;
    }
}

void QuickEnclosures::unary(const ImplicitFunction::Step& step, const Values& a, Values& r, int order) {
    Outer f;
    r.defined = a.defined && outer(step, a.value, f);
    if (!r.defined) return;
    r.value = f.value;
    r.smooth = a.smooth && is_usable(f.slope);
    chain(step, a, f, r, order);
}

/// Derivatives of f(a): f' a' and f'' a' a' + f' a''.
void QuickEnclosures::chain(const ImplicitFunction::Step& step, const Values& a, const Outer& f, Values& r, int order) {
    if (order < 1 || !r.smooth) return;
    for (std::size_t i = 0; i < 3; ++i) {
        if ((step.depends >> i) & 1u) r.slope[i] = f.slope * a.slope[i];
    }
    if (order < 2) return;
    for (std::size_t k = 0; k < 6; ++k) {
        const auto [i, j] = pair_of[k];
        if (((step.depends >> i) & (step.depends >> j) & 1u) == 0) continue;
        r.bend[k] = f.bend * (i == j ? square(a.slope[i]) : a.slope[i] * a.slope[j]) + f.slope * a.bend[k];
    }
}

void QuickEnclosures::binary(const ImplicitFunction::Step& step, const Values& a, const Values& b, Values& r,
                             int order) {
    r.defined = a.defined && b.defined;
    if (!r.defined) return;
    r.smooth = a.smooth && b.smooth;
    if (step.kind == Kind::real_power) {  // exp(b log a); roots are left to MPFI where a may be 0
        Outer f;
        f.value = by_mpfi(mpfi_exp, by_mpfi(mpfi_log, a.value) * b.value);
        f.slope = b.value * (f.value / a.value);
        f.bend = (b.value - Span{1, 1}) * (f.slope / a.value);
        r.value = f.value;
        return chain(step, a, f, r, order);
    }
    const bool quotient = step.kind == Kind::quotient;
    const auto linear = [&](const Span& of_a, const Span& of_b) {
        return step.kind == Kind::sum ? of_a + of_b : of_a - of_b;
    };
    r.value = quotient ? a.value / b.value : step.kind == Kind::product ? a.value * b.value : linear(a.value, b.value);
    const bool is_linear = step.kind == Kind::sum || step.kind == Kind::difference;
    for (std::size_t i = 0; order >= 1 && r.smooth && i < 3; ++i) {
        if (((step.depends >> i) & 1u) == 0) continue;
        r.slope[i] = is_linear  ? linear(a.slope[i], b.slope[i])
                     : quotient ? (a.slope[i] - r.value * b.slope[i]) / b.value
                                : a.slope[i] * b.value + a.value * b.slope[i];
    }
    for (std::size_t k = 0; order >= 2 && r.smooth && k < 6; ++k) {
        const auto [i, j] = pair_of[k];
        if (((step.depends >> i) & (step.depends >> j) & 1u) == 0) continue;
        r.bend[k] =
            is_linear  ? linear(a.bend[k], b.bend[k])
            : quotient ? (a.bend[k] - r.slope[i] * b.slope[j] - r.slope[j] * b.slope[i] - r.value * b.bend[k]) / b.value
                       : a.bend[k] * b.value + a.value * b.bend[k] + a.slope[i] * b.slope[j] + a.slope[j] * b.slope[i];
    }
}

QuickEnclosures::~QuickEnclosures() {
    mpfi_clear(exact_);
    mpfi_clear(argument_);
}

bool QuickEnclosures::directly(const BoxOfDoubles& box, int axis, int sign) {
    std::array<Span, 3> place;
    std::array<double, 3> center;
    for (std::size_t i = 0; i < 3; ++i) {
        place[i] = {box.low[i], box.high[i]};
        center[i] = middle_of(box.low[i], box.high[i]);
    }
    evaluate(place, 1);
    const Values& whole = values_[function_.result()];
    if (!whole.defined) return false;
    if (axis >= 0) {
        if (!whole.smooth) return false;
        if (sign_of(whole.slope[static_cast<std::size_t>(axis)]) == sign) return true;
        return by_second_order(place, center, axis, sign);
    }
    if (sign_of(whole.value) == sign) return true;
    if (!whole.smooth) return false;
    // f(c) + G(box) (box - c)
    Span sum;
    for (std::size_t i = 0; i < 3; ++i) sum = sum + whole.slope[i] * (place[i] - Span{center[i], center[i]});
    evaluate({Span{center[0], center[0]}, Span{center[1], center[1]}, Span{center[2], center[2]}}, 0);
    const Values& middle = values_[function_.result()];
    return sign_of(sum + middle.value) == sign || by_second_order(place, center, axis, sign);
}

/// With d = box - c: g_i(c) + H_i(box) d for a derivative, f(c) + g(c) d + d H(box) d / 2 for the value.
bool QuickEnclosures::by_second_order(std::array<Span, 3> place, const std::array<double, 3>& center, int axis,
                                      int sign) {
    evaluate(place, 2);
    const Values& whole = values_[function_.result()];
    std::array<Span, 3> d;
    for (std::size_t i = 0; i < 3; ++i) {
        d[i] = place[i] - Span{center[i], center[i]};
        place[i] = {center[i], center[i]};
    }
    Span sum;
    for (std::size_t k = 0; k < 6; ++k) {
        const auto [i, j] = pair_of[k];
        if (axis < 0) {
            sum = sum + whole.bend[k] * (i == j ? Span{0.5, 0.5} * square(d[i]) : d[i] * d[j]);
        } else {
            if (static_cast<int>(i) == axis) sum = sum + whole.bend[k] * d[j];
            if (static_cast<int>(j) == axis && i != j) sum = sum + whole.bend[k] * d[i];
        }
    }
    evaluate(place, 1);
    const Values& middle = values_[function_.result()];
    if (axis >= 0) return sign_of(sum + middle.slope[static_cast<std::size_t>(axis)]) == sign;
    for (std::size_t i = 0; i < 3; ++i) sum = sum + middle.slope[i] * d[i];
    return sign_of(sum + middle.value) == sign;
}

/// With d = box - c: (f - t g)(c) + (f - t g)'(c) d + d (f - t g)''(box) d / 2. Where the two are nearly parallel most
/// of it cancels.
bool QuickEnclosures::combination_misses_zero(QuickEnclosures& other, double t, const BoxOfDoubles& box) {
    if (!is_sound_ || !other.is_sound_) return false;
    const Span factor{t, t};
    std::array<Span, 3> place, center, d;
    for (std::size_t i = 0; i < 3; ++i) {
        const double middle = middle_of(box.low[i], box.high[i]);
        place[i] = {box.low[i], box.high[i]};
        center[i] = {middle, middle};
        d[i] = place[i] - center[i];
    }
    for (QuickEnclosures* e : {this, &other}) {
        e->evaluate(place, 2);
        const Values& whole = e->values_[e->function_.result()];
        if (!whole.defined || !whole.smooth) return false;
    }
    const Values &f = values_[function_.result()], &g = other.values_[other.function_.result()];
    Span sum;
    for (std::size_t k = 0; k < 6; ++k) {
        const auto [i, j] = pair_of[k];
        sum = sum + (f.bend[k] - factor * g.bend[k]) * (i == j ? Span{0.5, 0.5} * square(d[i]) : d[i] * d[j]);
    }
    evaluate(center, 1);
    other.evaluate(center, 1);
    for (std::size_t i = 0; i < 3; ++i) sum = sum + (f.slope[i] - factor * g.slope[i]) * d[i];
    return sign_of(sum + (f.value - factor * g.value)) != 0;
}

/// Fewer levels than with MPFI, and the first part that fails ends it: what needs more digits costs little here.
bool QuickEnclosures::on_parts(const BoxOfDoubles& box, int axis, int sign, int depth) {
    if (directly(box, axis, sign)) return true;
    if (depth == 6) return false;
    return holds_on_parts(box, [&](const BoxOfDoubles& part) { return on_parts(part, axis, sign, depth + 1); });
}

}  // namespace certa::verify
