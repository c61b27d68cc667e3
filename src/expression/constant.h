#pragma once
// Exact constants: rationals of 64-bit integers, and decimal numbers that need more digits.
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "interval/interval.h"

namespace certa::expression {

/// A rational number. `digits` is empty for numerator / denominator in lowest terms (denominator > 0), else the number
/// is the decimal that it spells: sign, digits, `e`, exponent.
struct Constant {
    std::int64_t numerator = 0;
    std::int64_t denominator = 1;
    std::string digits;

    bool is_rational() const { return digits.empty(); }
    bool is(std::int64_t n) const { return is_rational() && denominator == 1 && numerator == n; }
    friend bool operator==(const Constant&, const Constant&) = default;
};

/// The number that a decimal text stands for: digits with at most one point and an optional exponent, no sign. Empty
/// when it is beyond 10^309, or its exponent has more than 9 digits.
std::optional<Constant> read_decimal(std::string_view text);
/// The exact value of a finite double.
Constant constant_of(double value);

Constant negated(const Constant& a);
/// Exact results, or empty where they need more than 64 bits (or divide by 0).
std::optional<Constant> sum(const Constant& a, const Constant& b);
std::optional<Constant> product(const Constant& a, const Constant& b);
std::optional<Constant> quotient(const Constant& a, const Constant& b);
std::optional<Constant> power(const Constant& a, int n);

/// The nearest double, but for rounding twice where the terms exceed 2^53.
double nearest(const Constant& a);
/// A few units in the last place around the exact value; exact doubles have width 0.
interval::Interval enclosure(const Constant& a);
/// A text that parse_expression reads as this constant, in parentheses unless it is a plain number.
std::string text_of(const Constant& a);

}  // namespace certa::expression
