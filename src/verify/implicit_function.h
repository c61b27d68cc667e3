#pragma once
// The checker's own reading of expressions and its own enclosures, by MPFI: shares nothing with src/expression.
#include <mpfi.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace certa::verify {

/// A text that this reader does not accept.
class UnreadableFunction : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A function of x, y, z as steps that use earlier ones, equal steps once. The language is docs/expressions.md.
class ImplicitFunction {
public:
    enum class Kind : unsigned char {
        number,
        pi,
        variable,
        negative,
        sum,
        difference,
        product,
        quotient,
        power,
        root,
        exponential,
        logarithm,
        sine,
        cosine,
        tangent,
        arctangent,
        hyperbolic_sine,
        hyperbolic_cosine,
        hyperbolic_tangent,
        real_power,
    };
    struct Step {
        Kind kind = Kind::number;
        std::uint32_t a = 0, b = 0;
        long n = 0;            ///< exponent, or which variable
        std::string text;      ///< of a number
        unsigned depends = 0;  ///< bit i: on variable i
        friend bool operator==(const Step&, const Step&) = default;
    };

    /// Errors: UnreadableFunction.
    explicit ImplicitFunction(std::string_view text);
    const std::vector<Step>& steps() const { return steps_; }
    std::uint32_t result() const { return result_; }
    /// The factors of a product, from left to right, as steps: those that depend on a variable, and the others.
    struct Factors {
        std::vector<std::uint32_t> variable, constant;
    };
    Factors factors() const;
    /// The function that ends with a step.
    ImplicitFunction ending_at(std::uint32_t step) const;

private:
    friend class FunctionReader;
    ImplicitFunction() = default;
    std::vector<Step> steps_;
    std::uint32_t result_ = 0;
};

struct BoxOfDoubles {
    std::array<double, 3> low, high;
};

/// Between two finite numbers, about halfway: in the interval, also where halves of tiny numbers are rounded to 0.
inline double middle_of(double low, double high) { return std::clamp(low / 2 + high / 2, low, high); }

/// Whether visit(part) holds for each of the eight parts of a box (fewer where a side without inside is not cut), up to
/// the first for which it does not.
template <class Visit>
bool holds_on_parts(const BoxOfDoubles& box, const Visit& visit) {
    for (unsigned part = 0; part < 8; ++part) {
        BoxOfDoubles child = box;
        bool repeated = false;
        for (std::size_t i = 0; i < 3; ++i) {
            const double middle = middle_of(box.low[i], box.high[i]);
            if (!(box.low[i] < middle && middle < box.high[i])) {
                repeated = repeated || ((part >> i) & 1u) != 0;
                continue;
            }
            ((part >> i) & 1u ? child.low : child.high)[i] = middle;
        }
        if (!repeated && !visit(child)) return false;
    }
    return true;
}

class QuickEnclosures;

/// One thread's enclosures of one function: value and gradient over boxes, with 100 bits; in doubles where these
/// suffice.
class Enclosures {
public:
    explicit Enclosures(const ImplicitFunction& function);
    Enclosures(const Enclosures&) = delete;
    Enclosures& operator=(const Enclosures&) = delete;
    ~Enclosures();

    /// Whether f has this sign on the whole box: by its enclosure, the mean value form, or both on parts of the box.
    bool proves_sign(const BoxOfDoubles& box, int sign) { return proves(box, -1, sign); }
    /// Whether the derivative by this variable exists and has this sign on the whole box.
    bool proves_slope(const BoxOfDoubles& box, int axis, int sign) { return proves(box, axis, sign); }

    /// Value and gradient, NaN where undefined, of the middle of two enclosures in doubles: a guess.
    std::array<double, 4> guess(const std::array<double, 3>& place);
    /// Whether f has no zero on the box, by its enclosure or the mean value form.
    bool misses_zero(const BoxOfDoubles& box);
    /// Whether f - t g has no zero on the box, by the mean value form. `other` encloses g.
    bool combination_misses_zero(Enclosures& other, double t, const BoxOfDoubles& box);

    /// Whether f has this sign on the convex hull of three points, each known to lie in a box: by the mean value form,
    /// whose linear part is largest and smallest at corners; else on the four pieces that the middles of edges make.
    using TriangleOfBoxes = std::array<BoxOfDoubles, 3>;
    bool proves_sign_on_triangle(const TriangleOfBoxes& t, int sign,
                                 BoxOfDoubles (*middle)(const BoxOfDoubles&, const BoxOfDoubles&), int depth = 0);

private:
    struct Values {
        mpfi_t value;
        std::array<mpfi_t, 3> slope;
        bool defined = false, smooth = false, constant_read = false;
    };
    void evaluate(const std::array<mpfi_t, 3>& place, bool with_slopes);
    static void set_constant(const ImplicitFunction::Step& step, Values& r);
    void unary(const ImplicitFunction::Step& step, const Values& a, Values& r, bool with_slopes);
    void binary(const ImplicitFunction::Step& step, const Values& a, const Values& b, Values& r, bool with_slopes);
    void raise(mpfi_ptr result, mpfi_srcptr base, long n);
    bool proves(const BoxOfDoubles& box, int axis, int sign);
    bool on_parts(const BoxOfDoubles& box, int axis, int sign, int depth);
    bool directly(const BoxOfDoubles& box, int axis, int sign);

    const ImplicitFunction& function_;
    std::unique_ptr<QuickEnclosures> quick_;
    std::vector<Values> values_;
    std::array<mpfi_t, 3> place_;
    mpfi_t outer_, t_, u_, sum_;
};

}  // namespace certa::verify
