#pragma once
// The value of an expression in 400-bit arithmetic, straight from the tree: the oracle of these tests.
#include <certa/implicit.h>
#include <mpfr.h>

#include <array>

namespace certa::test {

/// A number of 400 bits, rounded to nearest at every step.
class Precise {
public:
    Precise(double x = 0.0) {  // NOLINT: doubles are numbers
        mpfr_init2(value, 400);
        mpfr_set_d(value, x, MPFR_RNDN);
    }
    Precise(const Precise& other) {
        mpfr_init2(value, 400);
        mpfr_set(value, other.value, MPFR_RNDN);
    }
    Precise& operator=(const Precise& other) {
        mpfr_set(value, other.value, MPFR_RNDN);
        return *this;
    }
    ~Precise() { mpfr_clear(value); }

    bool is_number() const { return mpfr_number_p(value) != 0; }
    double size() const { return std::abs(mpfr_get_d(value, MPFR_RNDA)); }
    /// Whether it lies within `slack` of [low, high].
    bool within(double low, double high, double slack) const;

    mpfr_t value;
};

using PrecisePlace = std::array<Precise, 3>;

/// NaN where the function is undefined.
Precise evaluate_precisely(const Expression& function, const PrecisePlace& place);

/// Derivatives by central differences with step 2^-70 (orders 1 and 2): exact to about 2^-130 of the third derivative.
Precise differentiate(const Expression& function, const PrecisePlace& place, int axis);
Precise differentiate(const Expression& function, const PrecisePlace& place, int first, int second);

}  // namespace certa::test
