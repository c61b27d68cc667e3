// Arithmetic on spans: each bound is computed with rounding to nearest and moved outward. A result r that is not
// infinite differs from the exact one by at most |r| 2^-53 + 2^-1022, even where tiny numbers are flushed to 0; |r|
// 2^-51 + 2^-1000, subtracted with one more rounding, is more. A bound that is NaN or infinite makes the span useless:
// no sign is ever read off it.
//
// Plan: spans; one step of the function at a time, value and gradient; the enclosure or the mean value form on a box;
// its eight parts.
#include "verify/quick_enclosures.h"

#include <algorithm>
#include <cfenv>
#include <cmath>
#include <cstdlib>

namespace certa::verify {
namespace {

Span widened(double low, double high) {
    return {low - (std::fabs(low) * 0x1p-51 + 0x1p-1000), high + (std::fabs(high) * 0x1p-51 + 0x1p-1000)};
}
bool is_usable(const Span& a) { return std::isfinite(a.low) && std::isfinite(a.high) && a.low <= a.high; }
int sign_of(const Span& a) { return !is_usable(a) ? 0 : a.low > 0 ? 1 : a.high < 0 ? -1 : 0; }

Span operator+(const Span& a, const Span& b) { return widened(a.low + b.low, a.high + b.high); }
Span operator-(const Span& a, const Span& b) { return widened(a.low - b.high, a.high - b.low); }
Span operator-(const Span& a) { return {-a.high, -a.low}; }
Span operator*(const Span& a, const Span& b) {
    const double p = a.low * b.low, q = a.low * b.high, r = a.high * b.low, s = a.high * b.high;
    // Not minmax of a list: a NaN has to reach the result.
    if (!std::isfinite(p + q + r + s)) return {NAN, NAN};
    return widened(std::min(std::min(p, q), std::min(r, s)), std::max(std::max(p, q), std::max(r, s)));
}
Span operator/(const Span& a, const Span& b) {
    if (sign_of(b) == 0) return {NAN, NAN};
    const double p = a.low / b.low, q = a.low / b.high, r = a.high / b.low, s = a.high / b.high;
    if (!std::isfinite(p + q + r + s)) return {NAN, NAN};
    return widened(std::min(std::min(p, q), std::min(r, s)), std::max(std::max(p, q), std::max(r, s)));
}
Span square(const Span& a) {
    const double p = a.low * a.low, q = a.high * a.high;
    if (!std::isfinite(p + q)) return {NAN, NAN};
    const Span wide = widened(std::min(p, q), std::max(p, q));
    return {a.low <= 0 && a.high >= 0 ? 0.0 : std::max(wide.low, 0.0), wide.high};
}
/// a^n for n >= 1, by squaring: powers of even exponents are squares, never negative.
Span raised(const Span& a, long n) {
    if (n == 1) return a;
    const Span half = raised(a, n / 2);
    return n % 2 == 0 ? square(half) : square(half) * a;
}

}  // namespace

QuickEnclosures::QuickEnclosures(const ImplicitFunction& function)
    : function_(function), values_(function.steps().size()), is_sound_(std::fegetround() == FE_TONEAREST) {
    mpfi_init2(exact_, 64);
    mpfi_init2(argument_, 64);
    for (std::size_t i = 0; i < values_.size(); ++i) {
        const ImplicitFunction::Step& step = function.steps()[i];
        if (step.kind != Kind::number && step.kind != Kind::pi) continue;
        const bool read =
            step.kind == Kind::pi ? mpfi_const_pi(exact_) >= 0 : mpfi_set_str(exact_, step.text.c_str(), 10) == 0;
        values_[i].value = {mpfr_get_d(&exact_->left, MPFR_RNDD), mpfr_get_d(&exact_->right, MPFR_RNDU)};
        values_[i].defined = values_[i].smooth = read && is_usable(values_[i].value);
    }
}

Span QuickEnclosures::by_mpfi(int (*function)(mpfi_ptr, mpfi_srcptr), const Span& a) {
    mpfi_interv_d(argument_, a.low, a.high);
    function(exact_, argument_);
    return {mpfr_get_d(&exact_->left, MPFR_RNDD), mpfr_get_d(&exact_->right, MPFR_RNDU)};
}

void QuickEnclosures::evaluate(const std::array<Span, 3>& place, bool with_slopes) {
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
                binary(step, values_[step.a], values_[step.b], r, with_slopes);
                break;
            default:
                unary(step, values_[step.a], r, with_slopes);
        }
        r.defined = r.defined && is_usable(r.value);
        r.smooth = r.smooth && r.defined;
    }
}

/// Value and derivative of a function of one number; false where it is not defined. A derivative that is not defined is
/// NaN.
bool QuickEnclosures::outer(const ImplicitFunction::Step& step, const Span& a, Span& value, Span& slope) {
    const Span one{1, 1};
    switch (step.kind) {
        case Kind::negative:
            value = -a;
            slope = {-1, -1};
            return true;
        case Kind::power: {
            if (std::labs(step.n) > 1'000'000) return false;  // left to MPFI
            const long n = std::labs(step.n);
            if (n == 0) {
                value = one;
                slope = {0, 0};
                return true;
            }
            if (step.n < 0 && sign_of(a) == 0) return false;
            const auto count = static_cast<double>(step.n);
            value = step.n < 0 ? one / raised(a, n) : raised(a, n);
            slope = Span{count, count} * (step.n < 0 ? one / raised(a, n + 1) : n == 1 ? one : raised(a, n - 1));
            return true;
        }
        case Kind::root: {
            if (!(a.low >= 0)) return false;
            const Span wide = widened(std::sqrt(a.low), std::sqrt(a.high));
            value = {std::max(wide.low, 0.0), wide.high};
            slope = value.low > 0 ? Span{0.5, 0.5} / value : Span{NAN, NAN};
            return true;
        }
        case Kind::exponential:
            value = slope = by_mpfi(mpfi_exp, a);
            return true;
        case Kind::logarithm:
            if (sign_of(a) <= 0) return false;
            value = by_mpfi(mpfi_log, a);
            slope = one / a;
            return true;
        case Kind::sine:
            value = by_mpfi(mpfi_sin, a);
            slope = by_mpfi(mpfi_cos, a);
            return true;
        case Kind::cosine:
            value = by_mpfi(mpfi_cos, a);
            slope = -by_mpfi(mpfi_sin, a);
            return true;
        case Kind::tangent:
            if (sign_of(by_mpfi(mpfi_cos, a)) == 0) return false;
            value = by_mpfi(mpfi_tan, a);
            slope = one + square(value);
            return true;
        case Kind::arctangent:
            value = by_mpfi(mpfi_atan, a);
            slope = one / (one + square(a));
            return true;
        case Kind::hyperbolic_sine:
            value = by_mpfi(mpfi_sinh, a);
            slope = by_mpfi(mpfi_cosh, a);
            return true;
        case Kind::hyperbolic_cosine:
            value = by_mpfi(mpfi_cosh, a);
            slope = by_mpfi(mpfi_sinh, a);
            return true;
        default:  // hyperbolic_tangent
            value = by_mpfi(mpfi_tanh, a);
            slope = one - square(value);
            return true;
    }
}

void QuickEnclosures::unary(const ImplicitFunction::Step& step, const Values& a, Values& r, bool with_slopes) {
    Span slope;
    r.defined = a.defined && outer(step, a.value, r.value, slope);
    r.smooth = r.defined && a.smooth && is_usable(slope);
    for (std::size_t i = 0; with_slopes && r.smooth && i < 3; ++i) {
        if ((step.depends >> i) & 1u) r.slope[i] = slope * a.slope[i];
    }
}

void QuickEnclosures::binary(const ImplicitFunction::Step& step, const Values& a, const Values& b, Values& r,
                             bool with_slopes) {
    r.defined = a.defined && b.defined;
    r.smooth = a.smooth && b.smooth;
    if (!r.defined) return;
    Span outer_slope;  // of a power
    switch (step.kind) {
        case Kind::sum:
            r.value = a.value + b.value;
            break;
        case Kind::difference:
            r.value = a.value - b.value;
            break;
        case Kind::product:
            r.value = a.value * b.value;
            break;
        case Kind::quotient:
            r.defined = sign_of(b.value) != 0;
            if (r.defined) r.value = a.value / b.value;
            break;
        default:  // exp(b log a); roots are left to MPFI where a may be 0
            r.defined = sign_of(a.value) > 0;
            if (!r.defined) return;
            r.value = by_mpfi(mpfi_exp, by_mpfi(mpfi_log, a.value) * b.value);
            outer_slope = b.value * (r.value / a.value);
    }
    for (std::size_t i = 0; with_slopes && r.defined && r.smooth && i < 3; ++i) {
        if (((step.depends >> i) & 1u) == 0) continue;
        switch (step.kind) {
            case Kind::sum:
                r.slope[i] = a.slope[i] + b.slope[i];
                break;
            case Kind::difference:
                r.slope[i] = a.slope[i] - b.slope[i];
                break;
            case Kind::product:
                r.slope[i] = a.slope[i] * b.value + a.value * b.slope[i];
                break;
            case Kind::quotient:
                r.slope[i] = (a.slope[i] - r.value * b.slope[i]) / b.value;
                break;
            default:
                r.slope[i] = outer_slope * a.slope[i];
        }
    }
}

QuickEnclosures::~QuickEnclosures() {
    mpfi_clear(exact_);
    mpfi_clear(argument_);
}

bool QuickEnclosures::directly(const BoxOfDoubles& box, int axis, int sign) {
    std::array<Span, 3> place;
    for (std::size_t i = 0; i < 3; ++i) place[i] = {box.low[i], box.high[i]};
    evaluate(place, true);
    const Values& whole = values_[function_.result()];
    if (!whole.defined) return false;
    if (axis >= 0) return whole.smooth && sign_of(whole.slope[static_cast<std::size_t>(axis)]) == sign;
    if (sign_of(whole.value) == sign) return true;
    if (!whole.smooth) return false;
    // f(c) + G(box) (box - c)
    Span sum;
    for (std::size_t i = 0; i < 3; ++i) {
        const double center = box.low[i] / 2 + box.high[i] / 2;
        sum = sum + whole.slope[i] * (place[i] - Span{center, center});
        place[i] = {center, center};
    }
    evaluate(place, false);
    const Values& middle = values_[function_.result()];
    return middle.defined && sign_of(sum + middle.value) == sign;
}

/// Fewer levels than with MPFI, and the first part that fails ends it: what needs more digits costs little here.
bool QuickEnclosures::on_parts(const BoxOfDoubles& box, int axis, int sign, int depth) {
    if (directly(box, axis, sign)) return true;
    if (depth == 6) return false;
    for (unsigned part = 0; part < 8; ++part) {
        BoxOfDoubles child = box;
        bool repeated = false;
        for (std::size_t i = 0; i < 3; ++i) {
            const double middle = box.low[i] / 2 + box.high[i] / 2;
            // A side without inside is not cut.
            if (!(box.low[i] < middle && middle < box.high[i])) {
                repeated = repeated || ((part >> i) & 1u) != 0;
                continue;
            }
            ((part >> i) & 1u ? child.low : child.high)[i] = middle;
        }
        if (!repeated && !on_parts(child, axis, sign, depth + 1)) return false;
    }
    return true;
}

}  // namespace certa::verify
