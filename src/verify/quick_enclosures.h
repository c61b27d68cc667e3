#pragma once
// Enclosures in doubles, tried before those by MPFI: most leaves are decided here, some thirty times faster.
#include <mpfi.h>

#include <array>
#include <vector>

#include "verify/implicit_function.h"
#include "verify/span.h"

namespace certa::verify {

/// One thread's enclosures of one function, with the interface of Enclosures as far as it is needed. Shares nothing
/// with src/interval and src/expression; functions other than roots are MPFI's, rounded outward.
class QuickEnclosures {
public:
    explicit QuickEnclosures(const ImplicitFunction& function);
    QuickEnclosures(const QuickEnclosures&) = delete;
    QuickEnclosures& operator=(const QuickEnclosures&) = delete;
    ~QuickEnclosures();

    /// As Enclosures::proves_sign (axis -1) and proves_slope. False where doubles do not suffice, or rounding is not to
    /// nearest.
    bool proves(const BoxOfDoubles& box, int axis, int sign) { return is_sound_ && on_parts(box, axis, sign, 0); }
    /// Without parts: by the enclosure, the mean value form or Taylor's with second derivatives.
    bool proves_directly(const BoxOfDoubles& box, int axis, int sign) { return is_sound_ && directly(box, axis, sign); }

    /// As Enclosures::combination_misses_zero, by Taylor's form with second derivatives.
    bool combination_misses_zero(QuickEnclosures& other, double t, const BoxOfDoubles& box);

private:
    using Kind = ImplicitFunction::Kind;
    struct Values {
        Span value;
        std::array<Span, 3> slope{};
        std::array<Span, 6> bend{};            ///< second derivatives xx, xy, xz, yy, yz, zz
        bool defined = false, smooth = false;  ///< smooth, where defined: differentiable, as often as one likes
    };
    /// A function of one number: value and two derivatives.
    struct Outer {
        Span value, slope, bend;
    };
    /// order 0: values; 1: with slopes; 2: with second derivatives.
    void evaluate(const std::array<Span, 3>& place, int order);
    void unary(const ImplicitFunction::Step& step, const Values& a, Values& r, int order);
    void binary(const ImplicitFunction::Step& step, const Values& a, const Values& b, Values& r, int order);
    static void chain(const ImplicitFunction::Step& step, const Values& a, const Outer& f, Values& r, int order);
    bool outer(const ImplicitFunction::Step& step, const Span& a, Outer& f);
    bool by_second_order(std::array<Span, 3> place, const std::array<double, 3>& center, int axis, int sign);
    Span by_mpfi(int (*function)(mpfi_ptr, mpfi_srcptr), const Span& a);
    bool on_parts(const BoxOfDoubles& box, int axis, int sign, int depth);
    bool directly(const BoxOfDoubles& box, int axis, int sign);

    const ImplicitFunction& function_;
    std::vector<Values> values_;
    mpfi_t exact_, argument_;
    bool is_sound_;
};

}  // namespace certa::verify
