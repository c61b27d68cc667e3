// Scanning of text files. Numbers go through std::from_chars: correctly rounded, independent of the locale, and nine
// times faster than streams. Fast path first (number right at the cursor, followed by a separator); everything odd
// (overflow, underflow, decimal commas, words) is looked at again as a whole word to say what is wrong with it.
#include "io/text_cursor.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace certa::io {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

/// Decimal exponent of the first non-zero digit of a literal that from_chars found out of range.
/// Its sign tells an overflow from an underflow.
bool is_tiny(std::string_view literal) {
    const std::size_t exponent_at = literal.find_first_of("eE");
    const std::string_view digits = literal.substr(0, exponent_at);
    const std::size_t dot = std::min(digits.find('.'), digits.size());
    const std::size_t first = digits.find_first_of("123456789");
    if (first == std::string_view::npos) return true;
    std::int64_t exponent = static_cast<std::int64_t>(dot) - static_cast<std::int64_t>(first);
    if (exponent_at != std::string_view::npos) {
        std::string_view tail = literal.substr(exponent_at + 1);
        if (!tail.empty() && tail.front() == '+') tail.remove_prefix(1);
        std::int64_t given = 0;
        const auto [last, error] = std::from_chars(tail.data(), tail.data() + tail.size(), given);
        if (error == std::errc::result_out_of_range) return tail.front() == '-';
        exponent += std::clamp<std::int64_t>(given, -1'000'000'000'000, 1'000'000'000'000);
    }
    return exponent < 0;
}

}  // namespace

std::string quoted(std::string_view word) {
    constexpr std::size_t longest = 40;
    std::string text = "'";
    for (const char c : word.substr(0, longest)) text += (c >= ' ' && c <= '~') ? c : '?';
    if (word.size() > longest) text += "...";
    return text + "'";
}

bool equal_ignoring_case(std::string_view left, std::string_view right) {
    return std::equal(left.begin(), left.end(), right.begin(), right.end(),
                      [](char a, char b) { return lower(a) == lower(b); });
}

bool parse_number(std::string_view word, double& value) {
    if (!word.empty() && word.front() == '+') {
        word.remove_prefix(1);
        if (!word.empty() && word.front() == '-') return false;
    }
    const char* const end = word.data() + word.size();
    const auto [last, error] = std::from_chars(word.data(), end, value);
    if (last != end || word.empty() || error == std::errc::invalid_argument) return false;
    if (error == std::errc::result_out_of_range) {
        if (!is_tiny(word)) return false;
        value = word.front() == '-' ? -0.0 : 0.0;
    }
    return true;
}

bool parse_integer(std::string_view word, std::int64_t& value) {
    if (!word.empty() && word.front() == '+') {
        word.remove_prefix(1);
        if (!word.empty() && word.front() == '-') return false;
    }
    const char* const end = word.data() + word.size();
    const auto [last, error] = std::from_chars(word.data(), end, value);
    return !word.empty() && last == end && error == std::errc();
}

TextCursor::TextCursor(std::string_view text, const std::string& name, int comment)
    : begin_(text.data()),
      end_(text.data() + text.size()),
      here_(begin_),
      word_(begin_),
      comment_(comment),
      name_(name) {
    if (text.starts_with("\xEF\xBB\xBF")) here_ = word_ = begin_ + 3;
    if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
        fail("the file is UTF-16 text; save it as plain text (UTF-8)");
}

bool TextCursor::is_stop(const char* place) const {
    return is_line_end(place) || is_blank(*place) || static_cast<unsigned char>(*place) == comment_;
}

bool TextCursor::at_line_end() {
    while (here_ != end_ && is_blank(*here_)) ++here_;
    if (here_ != end_ && static_cast<unsigned char>(*here_) == comment_)
        while (!is_line_end(here_)) ++here_;
    return is_line_end(here_);
}

bool TextCursor::at_end() {
    while (at_line_end()) {
        if (here_ == end_) return true;
        ++here_;
    }
    return false;
}

void TextCursor::skip_line() {
    while (!is_line_end(here_)) ++here_;
    if (here_ == end_) return;
    if (*here_ == '\r' && here_ + 1 != end_ && here_[1] == '\n') ++here_;
    ++here_;
}

void TextCursor::end_line(const char* what) {
    if (!at_line_end()) {
        const std::string_view extra = word(what);
        fail("unexpected " + quoted(extra) + " after " + what);
    }
    skip_line();
}

std::string_view TextCursor::rest_of_line() {
    const char* const first = here_;
    while (!is_line_end(here_)) ++here_;
    return {first, static_cast<std::size_t>(here_ - first)};
}

void TextCursor::start_word(const char* what) {
    if (at_end()) {
        word_ = end_;
        fail(std::string("the file ends where ") + what + " was expected");
    }
    word_ = here_;
}

std::string_view TextCursor::word(const char* what) {
    start_word(what);
    while (!is_stop(here_)) ++here_;
    return {word_, static_cast<std::size_t>(here_ - word_)};
}

void TextCursor::fail_word(const char* what, std::string_view word) const {
    std::string reason = quoted(word) + " where " + what + " was expected";
    double value = 0.0;
    if (word.find(',') != std::string_view::npos)
        reason += " (numbers have a decimal point and are separated by blanks)";
    else if (parse_number(word, value) && !std::isfinite(value))
        reason += " (numbers must be finite)";
    fail(reason);
}

double TextCursor::number_by_word(const char* what) {
    const std::string_view literal = word(what);
    double value = 0.0;
    if (!parse_number(literal, value)) {
        const bool digits_only = literal.find_first_not_of("+-.0123456789eE") == std::string_view::npos;
        std::int64_t whole = 0;
        const auto [last, error] = std::from_chars(literal.data(), literal.data() + literal.size(), value);
        if (digits_only && error == std::errc::result_out_of_range && !parse_integer(literal, whole))
            fail(quoted(literal) + " is beyond the range of double-precision numbers");
        fail_word(what, literal);
    }
    if (!std::isfinite(value)) fail_word(what, literal);
    return value;
}

double TextCursor::number(const char* what) {
    start_word(what);
    double value = 0.0;
    const auto [last, error] = std::from_chars(here_, end_, value);
    if (error == std::errc() && is_stop(last) && std::isfinite(value)) {
        here_ = last;
        return value;
    }
    return number_by_word(what);
}

std::int64_t TextCursor::integer(const char* what) {
    start_word(what);
    std::int64_t value = 0;
    const auto [last, error] = std::from_chars(here_, end_, value);
    if (error == std::errc() && is_stop(last)) {
        here_ = last;
        return value;
    }
    const std::string_view literal = word(what);
    if (!parse_integer(literal, value)) fail_word(what, literal);
    return value;
}

std::int32_t TextCursor::marker(const char* what) {
    const std::int64_t value = integer(what);
    if (value < std::numeric_limits<std::int32_t>::min() || value > std::numeric_limits<std::int32_t>::max())
        fail(std::string(what) + " " + std::to_string(value) + " does not fit into 32 bits");
    return static_cast<std::int32_t>(value);
}

std::uint32_t TextCursor::count(const char* what, std::size_t bytes_each) {
    const std::int64_t value = integer(what);
    if (value < 0) fail(std::string(what) + " is negative: " + std::to_string(value));
    if (value >= std::int64_t{std::numeric_limits<std::uint32_t>::max()})
        fail(std::string(what) + " " + std::to_string(value) + " is beyond the limit of 4294967294");
    // The last one may lack its line end.
    if (static_cast<std::uint64_t>(value) * bytes_each > left() + 1)
        fail(std::string(what) + " is " + std::to_string(value) + ", but only " + std::to_string(left()) +
             " bytes follow: the file is truncated or the count is wrong");
    return static_cast<std::uint32_t>(value);
}

std::uint32_t TextCursor::index(const char* what, std::uint32_t size, std::uint32_t base) {
    const std::int64_t value = integer(what);
    if (value < base || value - base >= size) {
        std::string range = "there is none";
        if (size > 0) range = "the range is " + std::to_string(base) + " to " + std::to_string(base + size - 1ULL);
        fail(std::string(what) + " " + std::to_string(value) + " is out of range: " + range);
    }
    return static_cast<std::uint32_t>(value - base);
}

std::uint64_t TextCursor::line_at(std::size_t position) const {
    std::uint64_t line = 1;
    const char* const stop = begin_ + std::min(position, static_cast<std::size_t>(end_ - begin_));
    for (const char* p = begin_; p != stop; ++p)
        if (*p == '\n' || (*p == '\r' && (p + 1 == end_ || p[1] != '\n'))) ++line;
    return line;
}

void TextCursor::fail(const std::string& reason) const { fail_at(static_cast<std::size_t>(word_ - begin_), reason); }

void TextCursor::fail_at(std::size_t position, const std::string& reason) const {
    throw IoError(name_, line_at(position), reason);
}

}  // namespace certa::io
