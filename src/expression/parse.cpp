// Reading expressions: a PEGTL grammar whose actions build nodes on a stack. The language is docs/expressions.md.
//
// Plan: a first pass over the bytes settles what lines are (comments, line ends inside parentheses and after operators
// become blanks of the same length, so that offsets stay) and bounds the nesting, which is all that the grammar
// recurses on; the grammar is written so that no action is ever undone by backtracking: a choice is made by one token.
// Errors carry an offset; line and column come from the original text.
#include <certa/implicit.h>

#include <algorithm>
#include <map>
#include <optional>
#include <tao/pegtl.hpp>
#include <vector>

#include "expression/node.h"

namespace certa::expression {
namespace {

namespace pegtl = tao::pegtl;

constexpr int deepest_nesting = 256;

/// What is wrong at which byte.
struct Refusal {
    std::size_t offset;
    std::string reason;
};

[[noreturn]] void refuse(std::size_t offset, std::string reason) { throw Refusal{offset, std::move(reason)}; }

// ---- Lines ----------------------------------------------------------------------------------------------------------

bool continues(char last) { return std::string_view("+-*/^,(=").find(last) != std::string_view::npos; }

/// Comments and line ends that end no statement replaced by blanks.
std::string settle_lines(std::string_view text) {
    std::string settled(text);
    if (text.substr(0, 3) == "\xef\xbb\xbf") settled.replace(0, 3, 3, ' ');
    int depth = 0;
    char last = '=';  // the last character that is no blank; nothing is to be continued at the start
    bool in_comment = false;
    for (std::size_t i = 0; i < settled.size(); ++i) {
        char& c = settled[i];
        if (c == '\r') c = i + 1 < settled.size() && settled[i + 1] == '\n' ? ' ' : '\n';
        if (c == '\n') {
            in_comment = false;
            if (depth > 0 || continues(last))
                c = ' ';
            else
                last = '\n';
            continue;
        }
        if (c == '#') in_comment = true;
        if (in_comment) {
            c = ' ';
            continue;
        }
        if (c == '(' && ++depth > deepest_nesting) refuse(i, "more than 256 parentheses are open");
        if (c == ')' && depth > 0) --depth;
        if (c != ' ' && c != '\t') last = c;
    }
    return settled;
}

// ---- Names ----------------------------------------------------------------------------------------------------------

struct NamedFunction {
    std::string_view name;
    Op op;
};
constexpr NamedFunction functions[] = {
    {"sqrt", Op::square_root}, {"exp", Op::exp},   {"log", Op::log},   {"sin", Op::sin},   {"cos", Op::cos},
    {"tan", Op::tan},          {"atan", Op::atan}, {"sinh", Op::sinh}, {"cosh", Op::cosh}, {"tanh", Op::tanh}};
struct NamedBlend {
    std::string_view name;
    Expression (*make)(const Expression&, const Expression&, const Expression&);
};
constexpr NamedBlend blends[] = {{"smooth_union", smooth_union},
                                 {"smooth_intersection", smooth_intersection},
                                 {"smooth_difference", smooth_difference}};
struct Unsmooth {
    std::string_view name, instead;
};
constexpr Unsmooth unsmooth[] = {
    {"min", "smooth_union(a, b, k)"}, {"max", "smooth_intersection(a, b, k)"}, {"abs", "sqrt(a^2 + k^2)"}};
constexpr std::string_view known_functions =
    "sqrt exp log sin cos tan atan sinh cosh tanh smooth_union smooth_intersection smooth_difference";

template <class Table>
auto find_named(const Table& table, std::string_view name) {
    return std::find_if(std::begin(table), std::end(table), [&](const auto& entry) { return entry.name == name; });
}

bool is_reserved(std::string_view name) {
    return name == "x" || name == "y" || name == "z" || name == "pi" ||
           find_named(functions, name) != std::end(functions) || find_named(blends, name) != std::end(blends) ||
           find_named(unsmooth, name) != std::end(unsmooth);
}

struct Word {
    std::string text;
    std::size_t offset = 0;
};

struct Definition {
    NodePointer node;
    std::size_t offset = 0;
    bool used = false;
};

// ---- Building -------------------------------------------------------------------------------------------------------

/// What the actions work on.
class Builder {
public:
    void number(std::string_view text, std::size_t offset) {
        std::optional<Constant> value = read_decimal(text);
        if (!value) refuse(offset, "this number is too large: its size must be below 10^308");
        stack_.push_back(make_constant(std::move(*value)));
    }
    void word(std::string text, std::size_t offset) { words_.push_back({std::move(text), offset}); }

    void reference() {
        const Word word = take_word();
        const NodePointer* leaf = word.text == "x"    ? &x_
                                  : word.text == "y"  ? &y_
                                  : word.text == "z"  ? &z_
                                  : word.text == "pi" ? &pi_
                                                      : nullptr;
        if (leaf != nullptr) {
            stack_.push_back(*leaf);
            return;
        }
        const auto found = definitions_.find(word.text);
        if (found != definitions_.end()) {
            found->second.used = true;
            stack_.push_back(found->second.node);
            return;
        }
        if (word.text == "e") refuse(word.offset, "e is not a name here: write exp(1)");
        if (is_reserved(word.text)) refuse(word.offset, "'" + word.text + "' is a function: its arguments are missing");
        refuse(word.offset, "'" + word.text +
                                "' is unknown: the variables are x, y and z, the constant is pi; other names are " +
                                "defined before they are used, as in  r2 = x^2 + y^2");
    }

    void open_call() { calls_.push_back(stack_.size()); }

    void close_call() {
        const Word word = take_word();
        const std::size_t count = stack_.size() - calls_.back();
        calls_.pop_back();
        if (const auto f = find_named(functions, word.text); f != std::end(functions)) {
            expect_arguments(word, count, 1);
            stack_.back() = make_unary(f->op, stack_.back());
        } else if (const auto b = find_named(blends, word.text); b != std::end(blends)) {
            expect_arguments(word, count, 3);
            blend(*b, word);
        } else if (const auto u = find_named(unsmooth, word.text); u != std::end(unsmooth)) {
            refuse(word.offset, "'" + word.text + "' is not smooth, so nothing could be certified; use " +
                                    std::string(u->instead) + " with a small k > 0");
        } else if (is_reserved(word.text) || definitions_.count(word.text) != 0) {
            refuse(word.offset, "'" + word.text + "' is no function; a product is written with *");
        } else {
            refuse(word.offset, "there is no function '" + word.text + "'; there are " + std::string(known_functions));
        }
    }

    void binary(Op op, std::size_t offset) {
        const NodePointer b = take();
        if (op == Op::divide && b->op == Op::constant && b->constant.is(0)) refuse(offset, "a division by 0");
        stack_.back() = make_binary(op, stack_.back(), b);
    }

    void open_signs() { signs_.push_back(false); }
    void minus() { signs_.back() = !signs_.back(); }
    void close_signs() {
        if (signs_.back()) stack_.back() = make_unary(Op::negate, stack_.back());
        signs_.pop_back();
    }

    void open_powers() { powers_.push_back({stack_.size() - 1, {}}); }
    void caret(std::size_t offset) { powers_.back().carets.push_back({offset, false}); }
    void exponent_minus() {
        auto& caret = powers_.back().carets.back();
        caret.second = !caret.second;
    }
    /// a ^ b ^ c is a ^ (b ^ c), and a sign before an exponent is that of all that follows.
    void close_powers() {
        const auto carets = std::move(powers_.back().carets);
        powers_.pop_back();
        for (std::size_t i = carets.size(); i-- > 0;) {
            NodePointer exponent = take();
            if (carets[i].second) exponent = make_unary(Op::negate, exponent);
            NodePointer power = make_constant_power(stack_.back(), exponent);
            if (!power)
                refuse(carets[i].first,
                       "the exponent must be a constant; for a positive base a write exp(b * log(a)) instead of a^b");
            stack_.back() = std::move(power);
        }
    }

    void define(std::size_t offset) {
        const Word word = take_word();
        if (is_reserved(word.text))
            refuse(word.offset, "'" + word.text + "' has a meaning already and cannot be defined");
        refuse_after_the_function(offset);
        if (!definitions_.emplace(word.text, Definition{take(), word.offset, false}).second)
            refuse(word.offset, "'" + word.text + "' is defined twice");
        last_ = word.text;
    }

    void conclude(std::size_t offset) {
        refuse_after_the_function(offset);
        function_ = take();
        last_.clear();
    }

    /// The function: the last statement.
    NodePointer finish(std::size_t end) {
        if (!function_) {
            if (last_.empty()) refuse(end, "there is no expression");
            Definition& definition = definitions_.at(last_);
            definition.used = true;
            function_ = definition.node;
        }
        for (const auto& [name, definition] : definitions_) {
            if (!definition.used) refuse(definition.offset, "'" + name + "' is defined but not used");
        }
        return function_;
    }

private:
    NodePointer take() {
        NodePointer top = std::move(stack_.back());
        stack_.pop_back();
        return top;
    }
    Word take_word() {
        Word word = std::move(words_.back());
        words_.pop_back();
        return word;
    }
    static void expect_arguments(const Word& word, std::size_t count, std::size_t expected) {
        if (count != expected)
            refuse(word.offset, "'" + word.text + "' takes " + std::to_string(expected) +
                                    (expected == 1 ? " argument, not " : " arguments, not ") + std::to_string(count));
    }
    void blend(const NamedBlend& blend, const Word& word) {
        const Expression k(take()), b(take()), a(take());
        if (k.node()->depends_on_place || interval::sign_of(enclosure_of_constant(k.node())) <= 0)
            refuse(word.offset, "the third argument of '" + word.text + "' must be a positive constant");
        stack_.push_back(blend.make(a, b, k).node());
    }
    void refuse_after_the_function(std::size_t offset) const {
        if (function_) refuse(offset, "the function was given above: only the last statement may be without a name");
    }

    struct Powers {
        std::size_t first;
        std::vector<std::pair<std::size_t, bool>> carets;  ///< where, and whether a minus follows
    };
    NodePointer x_ = make_leaf(Op::x), y_ = make_leaf(Op::y), z_ = make_leaf(Op::z), pi_ = make_leaf(Op::pi);
    std::vector<NodePointer> stack_;
    std::vector<Word> words_;
    std::vector<std::size_t> calls_;
    std::vector<bool> signs_;
    std::vector<Powers> powers_;
    std::map<std::string, Definition> definitions_;
    std::string last_;
    NodePointer function_;
};

// ---- Grammar --------------------------------------------------------------------------------------------------------

// NOLINTBEGIN(readability-identifier-naming): rules are named as PEGTL's own
namespace grammar {

using namespace pegtl;  // NOLINT: the grammar reads as one

struct blanks : star<one<' ', '\t'>> {};
struct digits : plus<digit> {};
struct exponent_digits : plus<digit> {};
struct exponent : seq<one<'e', 'E'>, opt<one<'+', '-'>>, exponent_digits> {};
struct number : seq<sor<seq<digits, opt<one<'.'>, star<digit>>>, seq<one<'.'>, digits>>, opt<exponent>> {};
struct number_end : not_at<sor<identifier_first, one<'.'>, digit>> {};
struct sum;
struct word : identifier {};
struct open_call : one<'('> {};
struct close_call : one<')'> {};
struct call : seq<open_call, list<seq<blanks, sum, blanks>, one<','>>, close_call> {};
struct reference : success {};
struct named : seq<word, blanks, sor<call, reference>> {};
struct close_parenthesis : one<')'> {};
struct parentheses : seq<one<'('>, blanks, sum, blanks, close_parenthesis> {};
struct atom : sor<seq<number, number_end>, named, parentheses> {};
struct exponent_minus : one<'-'> {};
struct caret : one<'^'> {};
struct exponent_atom : atom {};
struct open_powers : success {};
struct close_powers : success {};
struct powers
    : seq<open_powers, star<blanks, caret, blanks, star<sor<exponent_minus, one<'+'>>, blanks>, exponent_atom>,
          close_powers> {};
struct operand : atom {};
struct minus : one<'-'> {};
struct open_signs : success {};
struct close_signs : success {};
struct signed_operand : seq<open_signs, star<sor<minus, one<'+'>>, blanks>, operand, powers, close_signs> {};
struct times : seq<one<'*'>, blanks, signed_operand> {};
struct over : seq<one<'/'>, blanks, signed_operand> {};
struct term : seq<signed_operand, star<blanks, sor<times, over>>> {};
struct plus_term : seq<one<'+'>, blanks, term> {};
struct minus_term : seq<one<'-'>, blanks, term> {};
struct sum : seq<term, star<blanks, sor<plus_term, minus_term>>> {};
struct separator : one<'\n', ';'> {};
struct statement_end : sor<at<eof>, separator> {};
struct definition : seq<at<identifier, blanks, one<'='>>, word, blanks, one<'='>, blanks, sum> {};
struct conclusion : sum {};
struct statement : seq<sor<definition, conclusion>, blanks, statement_end> {};
struct skipped : star<sor<one<' ', '\t'>, separator>> {};
struct text : seq<skipped, star<not_at<eof>, statement, skipped>, eof> {};

template <class Rule>
inline constexpr const char* message = nullptr;
template <>
inline constexpr auto message<exponent_digits> = "digits must follow the e of an exponent";
template <>
inline constexpr auto message<number_end> = "an operator is missing after this number (a product is written with *)";
template <>
inline constexpr auto message<close_call> = "expected an operator, ',' or ')'";
template <>
inline constexpr auto message<close_parenthesis> = "expected an operator or ')'";
template <>
inline constexpr auto message<exponent_atom> = "expected an exponent: a number, or a constant in parentheses";
template <>
inline constexpr auto message<operand> = "expected a number, a variable, a function or '('";
template <>
inline constexpr auto message<statement_end> = "expected an operator or the end of the statement";

struct Messages {
    template <class Rule>
    static constexpr auto message = grammar::message<Rule>;
};
template <class Rule>
using control = must_if<Messages, normal, false>::control<Rule>;

}  // namespace grammar
// NOLINTEND(readability-identifier-naming)

// ---- Actions --------------------------------------------------------------------------------------------------------

template <class Rule>
struct Action : pegtl::nothing<Rule> {};

#define CERTA_ACTION(rule, call)                                          \
    template <>                                                           \
    struct Action<grammar::rule> {                                        \
        template <class Input>                                            \
        static void apply([[maybe_unused]] const Input& in, Builder& b) { \
            call;                                                         \
        }                                                                 \
    }
CERTA_ACTION(number, b.number(in.string_view(), in.position().byte));
CERTA_ACTION(word, b.word(in.string(), in.position().byte));
CERTA_ACTION(reference, b.reference());
CERTA_ACTION(open_call, b.open_call());
CERTA_ACTION(call, b.close_call());
CERTA_ACTION(caret, b.caret(in.position().byte));
CERTA_ACTION(exponent_minus, b.exponent_minus());
CERTA_ACTION(open_powers, b.open_powers());
CERTA_ACTION(close_powers, b.close_powers());
CERTA_ACTION(minus, b.minus());
CERTA_ACTION(open_signs, b.open_signs());
CERTA_ACTION(close_signs, b.close_signs());
CERTA_ACTION(times, b.binary(Op::multiply, in.position().byte));
CERTA_ACTION(over, b.binary(Op::divide, in.position().byte));
CERTA_ACTION(plus_term, b.binary(Op::add, in.position().byte));
CERTA_ACTION(minus_term, b.binary(Op::subtract, in.position().byte));
CERTA_ACTION(definition, b.define(in.position().byte));
CERTA_ACTION(conclusion, b.conclude(in.position().byte));
#undef CERTA_ACTION

/// The refusal with line, column and text of the line.
ExpressionError located(const Refusal& refusal, std::string_view text, const std::string& name) {
    const std::size_t offset = std::min(refusal.offset, text.size());
    const std::size_t before = offset == 0 ? std::string_view::npos : text.rfind('\n', offset - 1);
    const std::size_t first = before == std::string_view::npos ? 0 : before + 1;
    const std::size_t last = std::min(text.find('\n', offset), text.size());
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(first), '\n');
    return ExpressionError(name, static_cast<std::uint64_t>(line), offset - first + 1, refusal.reason,
                           text.substr(first, last - first));
}

/// What somebody probably meant who wrote another language's or a textbook's signs.
const char* way_out(std::string_view text, std::size_t offset) {
    const char at = offset < text.size() ? text[offset] : ' ', before = offset > 0 ? text[offset - 1] : ' ';
    if (at == '*' && before == '*') return "; powers are written x^2";
    if (at == '=') return "; the surface is where the expression is 0: for a = b write a - (b)";
    if (static_cast<unsigned char>(at) >= 0x80) return "; signs beyond ASCII are not read: powers are written x^2";
    return "";
}

}  // namespace
}  // namespace certa::expression

namespace certa {

Expression parse_expression(std::string_view text, const std::string& name) {
    using namespace expression;
    try {
        const std::string settled = settle_lines(text);
        Builder builder;
        pegtl::memory_input<pegtl::tracking_mode::eager> input(settled.data(), settled.size(), "");
        try {
            pegtl::parse<grammar::text, Action, grammar::control>(input, builder);
        } catch (const pegtl::parse_error& error) {
            const std::size_t offset = error.positions().front().byte;
            const std::string reason = std::string(error.message()) + way_out(settled, offset);
            if (offset >= settled.size()) refuse(offset, reason + "; the text ends here");
            refuse(offset, reason);
        }
        return Expression(builder.finish(settled.size()));
    } catch (const Refusal& refusal) {
        throw located(refusal, text, name);
    }
}

}  // namespace certa
