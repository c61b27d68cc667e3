// A reader of expressions by recursive descent, character by character: written from docs/expressions.md, not from the
// other reader. It accepts what the language allows and refuses the rest without finesse; good messages are the other
// reader's business.
#include <algorithm>
#include <map>
#include <optional>

#include "verify/implicit_function.h"

namespace certa::verify {

namespace {

using Kind = ImplicitFunction::Kind;
using Step = ImplicitFunction::Step;

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

const std::map<std::string, Kind, std::less<>>& functions() {
    static const std::map<std::string, Kind, std::less<>> table{{"sqrt", Kind::root},
                                                                {"exp", Kind::exponential},
                                                                {"log", Kind::logarithm},
                                                                {"sin", Kind::sine},
                                                                {"cos", Kind::cosine},
                                                                {"tan", Kind::tangent},
                                                                {"atan", Kind::arctangent},
                                                                {"sinh", Kind::hyperbolic_sine},
                                                                {"cosh", Kind::hyperbolic_cosine},
                                                                {"tanh", Kind::hyperbolic_tangent}};
    return table;
}

}  // namespace

class FunctionReader {
public:
    FunctionReader(std::string_view text, ImplicitFunction& out) : text_(text), out_(out) {}

    void read() {
        if (text_.substr(0, 3) == "\xef\xbb\xbf") at_ = 3;
        std::optional<std::uint32_t> function, last;
        for (skip_separators(); at_ < text_.size(); skip_separators()) {
            if (function) fail("text after the function");
            const std::size_t start = at_;
            const std::string name = is_letter(peek()) ? word() : "";
            skip_blanks(false);
            if (!name.empty() && peek() == '=') {
                ++at_;
                last = sum();
                if (is_taken(name) || !names_.emplace(name, *last).second) fail("a name is defined twice");
            } else {
                at_ = start;
                function = sum();
            }
            skip_blanks(false);
            if (at_ < text_.size() && !is_end(peek())) fail("an operator is missing");
        }
        if (!function) function = last;
        if (!function) fail("no function");
        out_.result_ = *function;
    }

private:
    [[noreturn]] void fail(const std::string& reason) const {
        throw UnreadableFunction(reason + " (at byte " + std::to_string(at_ + 1) + ")");
    }
    char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }
    static bool is_end(char c) { return c == '\n' || c == '\r' || c == ';'; }
    static bool is_taken(const std::string& name) {
        static constexpr std::string_view others[] = {
            "x", "y", "z", "pi", "min", "max", "abs", "smooth_union", "smooth_intersection", "smooth_difference"};
        return functions().count(name) != 0 ||
               std::find(std::begin(others), std::end(others), name) != std::end(others);
    }

    /// Blanks and comments; also line ends where a statement cannot end.
    void skip_blanks(bool over_lines) {
        for (; at_ < text_.size(); ++at_) {
            const char c = text_[at_];
            if (c == '#') {
                while (at_ < text_.size() && text_[at_] != '\n' && text_[at_] != '\r') ++at_;
                --at_;
            } else if (c != ' ' && c != '\t' && !((over_lines || depth_ > 0) && (c == '\n' || c == '\r'))) {
                return;
            }
        }
    }
    void skip_separators() {
        for (skip_blanks(false); at_ < text_.size() && is_end(peek()); skip_blanks(false)) ++at_;
    }

    std::string word() {
        std::string result;
        while (is_letter(peek()) || is_digit(peek())) result += text_[at_++];
        return result;
    }

    std::uint32_t add(Step step) {
        if (step.kind == Kind::variable) {
            step.depends = 1u << step.n;
        } else if (step.kind > Kind::variable) {
            step.depends = out_.steps_[step.a].depends | (has_two(step.kind) ? out_.steps_[step.b].depends : 0u);
        }
        const auto found = known_.find(key_of(step));
        if (found != known_.end()) return found->second;
        const auto id = static_cast<std::uint32_t>(out_.steps_.size());
        known_.emplace(key_of(step), id);
        out_.steps_.push_back(std::move(step));
        return id;
    }
    static bool has_two(Kind kind) {
        return kind == Kind::sum || kind == Kind::difference || kind == Kind::product || kind == Kind::quotient ||
               kind == Kind::real_power;
    }
    using Key = std::tuple<Kind, std::uint32_t, std::uint32_t, long, std::string>;
    static Key key_of(const Step& s) { return {s.kind, s.a, s.b, s.n, s.text}; }

    std::uint32_t make(Kind kind, std::uint32_t a, std::uint32_t b = 0, long n = 0) {
        Step step;
        step.kind = kind;
        step.a = a;
        step.b = b;
        step.n = n;
        return add(step);
    }
    /// A product of powers of one base is a power: its enclosure knows that the factors are equal.
    std::uint32_t multiply(std::uint32_t a, std::uint32_t b) {
        const auto [base_a, n] = as_power(a);
        const auto [base_b, m] = as_power(b);
        if (base_a == base_b && n > 0 && m > 0 && n + m < 1000000) return make(Kind::power, base_a, 0, n + m);
        return make(Kind::product, a, b);
    }
    std::pair<std::uint32_t, long> as_power(std::uint32_t a) const {
        const Step& step = out_.steps_[a];
        return step.kind == Kind::power ? std::pair{step.a, step.n} : std::pair{a, 1L};
    }
    std::uint32_t number(const std::string& text) {
        Step step;
        step.text = text;
        return add(step);
    }

    std::uint32_t sum() {
        std::uint32_t left = term();
        for (;;) {
            skip_blanks(false);
            const char c = peek();
            if (c != '+' && c != '-') return left;
            ++at_;
            left = make(c == '+' ? Kind::sum : Kind::difference, left, term());
        }
    }

    std::uint32_t term() {
        std::uint32_t left = factor();
        for (;;) {
            skip_blanks(false);
            const char c = peek();
            if (c != '*' && c != '/') return left;
            ++at_;
            const std::uint32_t right = factor();
            left = c == '*' ? multiply(left, right) : make(Kind::quotient, left, right);
        }
    }

    bool signs() {
        bool negative = false;
        for (skip_blanks(true); peek() == '+' || peek() == '-'; skip_blanks(true)) {
            if (peek() == '-') negative = !negative;
            ++at_;
        }
        return negative;
    }

    std::uint32_t factor() {
        const bool negative = signs();
        const std::uint32_t value = power();
        return negative ? make(Kind::negative, value) : value;
    }

    std::uint32_t power() {
        const std::uint32_t base = atom();
        skip_blanks(false);
        if (peek() != '^') return base;
        ++at_;
        if (++depth_of_powers_ > 1000) fail("too many exponents");
        const bool negative = signs();
        const std::uint32_t exponent = power();
        --depth_of_powers_;
        return raise(base, negative ? make(Kind::negative, exponent) : exponent);
    }

    std::uint32_t raise(std::uint32_t base, std::uint32_t exponent) {
        if (out_.steps_[exponent].depends != 0) fail("the exponent is not constant");
        const std::optional<long> n = integer(exponent);
        if (n == 1) return base;
        if (n) {
            const auto [inner, m] = as_power(base);
            if (*n > 0 && m > 0 && *n * m < 1000000) return make(Kind::power, inner, 0, *n * m);
            return make(Kind::power, base, 0, *n);
        }
        return make(Kind::real_power, base, exponent);
    }

    /// The value of an integer constant, written as one or computed from such by + - * ^ and signs.
    std::optional<long> integer(std::uint32_t id) const {
        const Step& s = out_.steps_[id];
        if (s.kind == Kind::number) {
            if (s.text.size() > 6 || s.text.find_first_not_of("0123456789") != std::string::npos) return std::nullopt;
            return std::stol(s.text);
        }
        if (s.kind != Kind::negative && s.kind != Kind::sum && s.kind != Kind::difference && s.kind != Kind::product)
            return std::nullopt;
        const std::optional<long> a = integer(s.a), b = s.kind == Kind::negative ? a : integer(s.b);
        if (!a || !b) return std::nullopt;
        const long value = s.kind == Kind::negative     ? -*a
                           : s.kind == Kind::sum        ? *a + *b
                           : s.kind == Kind::difference ? *a - *b
                                                        : *a * *b;
        return std::abs(value) <= 1000000 ? std::optional<long>(value) : std::nullopt;
    }

    std::uint32_t atom() {
        skip_blanks(true);
        const char c = peek();
        if (is_digit(c) || c == '.') return decimal();
        if (c == '(') return parenthesis();
        if (!is_letter(c)) fail("something is missing");
        const std::string name = word();
        skip_blanks(false);
        if (peek() == '(') return call(name);
        if (name == "x" || name == "y" || name == "z") return make(Kind::variable, 0, 0, name[0] - 'x');
        if (name == "pi") return make(Kind::pi, 0);
        const auto found = names_.find(name);
        if (found == names_.end()) fail("unknown name " + name);
        return found->second;
    }

    std::uint32_t decimal() {
        std::string text;
        std::size_t digits = 0;
        for (bool point = false; is_digit(peek()) || (peek() == '.' && !point); ++at_) {
            if (peek() == '.')
                point = true;
            else
                ++digits;
            text += peek();
        }
        if (digits == 0) fail("a number without digits");
        if (peek() == 'e' || peek() == 'E') {
            text += text_[at_++];
            if (peek() == '+' || peek() == '-') text += text_[at_++];
            if (!is_digit(peek())) fail("an exponent without digits");
            while (is_digit(peek())) text += text_[at_++];
        }
        if (is_letter(peek()) || peek() == '.') fail("an operator is missing after a number");
        return number(text);
    }

    std::uint32_t parenthesis() {
        ++at_;
        if (++depth_ > 300) fail("too many parentheses");
        const std::uint32_t value = sum();
        skip_blanks(false);
        if (peek() != ')') fail("a parenthesis is not closed");
        ++at_;
        --depth_;
        return value;
    }

    std::uint32_t call(const std::string& name) {
        ++at_;
        if (++depth_ > 300) fail("too many parentheses");
        std::vector<std::uint32_t> arguments{sum()};
        for (skip_blanks(false); peek() == ','; skip_blanks(false)) {
            ++at_;
            arguments.push_back(sum());
        }
        if (peek() != ')') fail("a call is not closed");
        ++at_;
        --depth_;
        const auto found = functions().find(name);
        if (found != functions().end() && arguments.size() == 1) return make(found->second, arguments[0]);
        if (arguments.size() != 3 || name.rfind("smooth_", 0) != 0) fail("there is no such function: " + name);
        return blend(name, arguments[0], arguments[1], arguments[2]);
    }

    /// (a + b -+ sqrt((a - b)^2 + k^2)) / 2. Whether k > 0 is asked by the other reader; the formula holds for any k.
    std::uint32_t blend(const std::string& name, std::uint32_t a, std::uint32_t b, std::uint32_t k) {
        if (out_.steps_[k].depends != 0) fail("the width of a blend is not constant");
        if (name == "smooth_difference")
            b = make(Kind::negative, b);
        else if (name != "smooth_union" && name != "smooth_intersection")
            fail("there is no such function: " + name);
        const std::uint32_t squares =
            make(Kind::sum, make(Kind::power, make(Kind::difference, a, b), 0, 2), make(Kind::power, k, 0, 2));
        const std::uint32_t both = make(Kind::sum, a, b), root = make(Kind::root, squares);
        return make(Kind::quotient, make(name == "smooth_union" ? Kind::difference : Kind::sum, both, root),
                    number("2"));
    }

    std::string_view text_;
    ImplicitFunction& out_;
    std::size_t at_ = 0;
    int depth_ = 0, depth_of_powers_ = 0;
    std::map<std::string, std::uint32_t> names_;
    std::map<Key, std::uint32_t> known_;
};

ImplicitFunction::ImplicitFunction(std::string_view text) { FunctionReader(text, *this).read(); }

}  // namespace certa::verify
