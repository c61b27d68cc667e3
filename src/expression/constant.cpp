// Exact constants. A decimal becomes a rational of two 64-bit integers where it fits, else it keeps its digits. Doubles
// enter as the decimal expansion that is exactly theirs, at most 767 digits.
// The enclosure of digits compares them with the exact expansion of the nearest double: no arithmetic, no rounding.
#include "expression/constant.h"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <numeric>

namespace certa::expression {
namespace {

using Wide = __int128;

std::optional<Constant> make(Wide numerator, Wide denominator) {
    if (denominator == 0) return std::nullopt;
    if (denominator < 0) {
        numerator = -numerator;
        denominator = -denominator;
    }
    Wide a = numerator < 0 ? -numerator : numerator, b = denominator;
    while (b != 0) {
        const Wide rest = a % b;
        a = b;
        b = rest;
    }
    if (a > 1) {
        numerator /= a;
        denominator /= a;
    }
    // The smallest integer is left out: its negation does not fit.
    constexpr Wide limit = std::numeric_limits<std::int64_t>::max();
    if (numerator > limit || numerator < -limit || denominator > limit) return std::nullopt;
    return Constant{static_cast<std::int64_t>(numerator), static_cast<std::int64_t>(denominator), {}};
}

/// sign * 0.d1 d2 d3 ... * 10^exponent with d1 and the last digit not 0; no digits for 0.
struct Decimal {
    bool negative = false;
    std::string digits;
    std::int64_t exponent = 0;
};

/// Digits with at most one point, an optional exponent and an optional sign; empty when the exponent is absurd.
std::optional<Decimal> read(std::string_view text) {
    Decimal result;
    if (!text.empty() && text.front() == '-') {
        result.negative = true;
        text.remove_prefix(1);
    }
    std::int64_t exponent = 0;
    const std::size_t e = text.find_first_of("eE");
    if (e != std::string_view::npos) {
        std::string_view tail = text.substr(e + 1);
        if (!tail.empty() && tail.front() == '+') tail.remove_prefix(1);
        const auto [end, error] = std::from_chars(tail.data(), tail.data() + tail.size(), exponent);
        if (error != std::errc() || end != tail.data() + tail.size() || std::abs(exponent) > 999'999'999) return {};
        text = text.substr(0, e);
    }
    bool point = false;
    for (const char c : text) {
        if (c == '.') {
            point = true;
            continue;
        }
        if (!result.digits.empty() || c != '0') {
            result.digits.push_back(c);
            if (!point) ++exponent;
        } else if (point) {
            --exponent;
        }
    }
    while (!result.digits.empty() && result.digits.back() == '0') result.digits.pop_back();
    result.exponent = result.digits.empty() ? 0 : exponent;
    if (result.digits.empty()) result.negative = false;
    return result;
}

Decimal exact_decimal(double value) {
    std::array<char, 1200> text;
    const auto end = std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::scientific, 1100);
    return *read({text.data(), end.ptr});
}

/// -1, 0 or 1 as a is below, equal to or above b; both not negative.
int compare_sizes(const Decimal& a, const Decimal& b) {
    if (a.digits.empty() || b.digits.empty())
        return static_cast<int>(!a.digits.empty()) - static_cast<int>(!b.digits.empty());
    if (a.exponent != b.exponent) return a.exponent < b.exponent ? -1 : 1;
    const int order = a.digits.compare(b.digits);  // digits that go on are larger: trailing zeros are gone
    return order < 0 ? -1 : order > 0 ? 1 : 0;
}

std::optional<Constant> as_rational(const Decimal& number) {
    // Everything below stays under 10^38 < 2^127.
    if (number.digits.size() > 37) return std::nullopt;
    Wide mantissa = 0;
    for (const char c : number.digits) mantissa = 10 * mantissa + (c - '0');
    std::int64_t shift = number.exponent - static_cast<std::int64_t>(number.digits.size());
    if (shift < -37 || static_cast<std::int64_t>(number.digits.size()) + shift > 37) return std::nullopt;
    Wide denominator = 1;
    for (; shift > 0; --shift) mantissa *= 10;
    for (; shift < 0; ++shift) denominator *= 10;
    return make(number.negative ? -mantissa : mantissa, denominator);
}

Constant as_constant(const Decimal& number) {
    if (std::optional<Constant> rational = as_rational(number)) return *rational;
    Constant result;
    result.digits = (number.negative ? "-0." : "0.") + number.digits + "e" + std::to_string(number.exponent);
    return result;
}

/// The nearest double of a number that is not negative; 0 where it is too small.
double nearest_size(const Decimal& number) {
    if (number.exponent < -400) return 0.0;
    const std::string text = "0." + number.digits + "e" + std::to_string(number.exponent);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error == std::errc::result_out_of_range) return number.exponent > 0 ? interval::infinity : 0.0;
    return value;
}

interval::Interval enclosure_of(const Decimal& number) {
    const double value = nearest_size(number);
    interval::Interval result{value};
    if (value == interval::infinity) {
        result.lo = interval::largest;
    } else {
        const int order = compare_sizes(exact_decimal(value), number);
        if (order < 0) result.hi = std::nextafter(value, interval::infinity);
        if (order > 0) result.lo = std::nextafter(value, 0.0);
    }
    return number.negative ? -result : result;
}

interval::Interval enclosure_of(std::int64_t n) {
    const auto value = static_cast<double>(n);
    return static_cast<Wide>(value) == static_cast<Wide>(n)
               ? interval::Interval(value)
               : interval::Interval(interval::below(value), interval::above(value));
}

}  // namespace

std::optional<Constant> read_decimal(std::string_view text) {
    const std::optional<Decimal> number = read(text);
    if (!number || number->exponent > 309) return std::nullopt;
    return as_constant(*number);
}

Constant constant_of(double value) {
    int exponent = 0;
    const double mantissa = std::frexp(value, &exponent);
    if (value == 0 || (exponent > -9 && exponent <= 62)) {
        // mantissa * 2^53 is an integer; make() finds out whether the fraction in lowest terms fits.
        const Wide numerator = static_cast<Wide>(mantissa * 0x1p53), one = 1;
        const int shift = exponent - 53;
        if (const auto rational =
                make(shift > 0 ? numerator * (one << shift) : numerator, one << (shift < 0 ? -shift : 0)))
            return *rational;
    }
    return as_constant(exact_decimal(value));
}

Constant negated(const Constant& a) {
    if (a.is_rational()) return {-a.numerator, a.denominator, {}};
    Constant result;
    result.digits = a.digits.front() == '-' ? a.digits.substr(1) : "-" + a.digits;
    return result;
}

std::optional<Constant> sum(const Constant& a, const Constant& b) {
    if (!a.is_rational() || !b.is_rational()) return std::nullopt;
    const Wide left = Wide{a.numerator} * b.denominator, right = Wide{b.numerator} * a.denominator;
    return make(left + right, Wide{a.denominator} * b.denominator);
}

std::optional<Constant> product(const Constant& a, const Constant& b) {
    if (!a.is_rational() || !b.is_rational()) return std::nullopt;
    return make(Wide{a.numerator} * b.numerator, Wide{a.denominator} * b.denominator);
}

std::optional<Constant> quotient(const Constant& a, const Constant& b) {
    if (!a.is_rational() || !b.is_rational()) return std::nullopt;
    return make(Wide{a.numerator} * b.denominator, Wide{a.denominator} * b.numerator);
}

std::optional<Constant> power(const Constant& a, int n) {
    if (std::abs(n) > 64) return std::nullopt;
    std::optional<Constant> result = Constant{1, 1, {}};
    for (int i = 0; i < std::abs(n) && result; ++i) result = product(*result, a);
    return result && n < 0 ? quotient({1, 1, {}}, *result) : result;
}

double nearest(const Constant& a) {
    if (a.is_rational()) return static_cast<double>(a.numerator) / static_cast<double>(a.denominator);
    const Decimal number = *read(a.digits);
    const double value = nearest_size(number);
    return number.negative ? -value : value;
}

interval::Interval enclosure(const Constant& a) {
    if (!a.is_rational()) return enclosure_of(*read(a.digits));
    const interval::Interval numerator = enclosure_of(a.numerator);
    if (a.denominator == 1) return numerator;
    const interval::Interval denominator = enclosure_of(a.denominator);
    const bool power_of_two = (a.denominator & (a.denominator - 1)) == 0;
    if (power_of_two && numerator.lo == numerator.hi) return interval::Interval(numerator.lo / denominator.lo);
    return numerator / denominator;
}

std::string text_of(const Constant& a) {
    std::string text = a.is_rational() ? std::to_string(a.numerator) : a.digits;
    if (a.is_rational() && a.denominator != 1) text += "/" + std::to_string(a.denominator);
    const bool plain = text.front() != '-' && text.find('/') == std::string::npos;
    return plain ? text : "(" + text + ")";
}

}  // namespace certa::expression
