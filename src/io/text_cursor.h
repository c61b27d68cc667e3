#pragma once
// A strict, locale-independent scanner over the text of a file: words, numbers, lines, and errors with their line.
#include <certa/error.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace certa::io {

/// Walks over a text that lives longer than the cursor. Lines end with "\n", "\r\n" or "\r"; a byte-order mark is
/// skipped. The number of a line is only counted when an error needs it.
class TextCursor {
public:
    static constexpr int no_comments = -1;

    /// `comment` starts a comment that runs to the end of its line.
    TextCursor(std::string_view text, const std::string& name, int comment);

    bool at_end();       ///< skips blanks, line ends and comments; nothing else left?
    bool at_line_end();  ///< skips blanks and a comment; is the line over?
    void skip_line();    ///< moves to the start of the next line

    /// Fails if something is left on the line, else moves to the next one.
    void end_line(const char* what);

    // Each of these takes the next word, on this or a later line; `what` names it in the error when there is none.
    std::string_view word(const char* what);
    double number(const char* what);  ///< finite; the nearest double
    std::int64_t integer(const char* what);
    std::int32_t marker(const char* what);
    /// A number of things that take at least `bytes_each` bytes of the rest of the text.
    std::uint32_t count(const char* what, std::size_t bytes_each);
    /// A reference to one of `size` things counted from `base`; 0-based result.
    std::uint32_t index(const char* what, std::uint32_t size, std::uint32_t base);

    std::string_view rest_of_line();  ///< up to the line end, comment included; stays on the line

    std::string_view text() const { return {begin_, static_cast<std::size_t>(end_ - begin_)}; }
    std::size_t position() const { return static_cast<std::size_t>(here_ - begin_); }
    void move_to(std::size_t position) { word_ = here_ = begin_ + position; }
    std::size_t left() const { return static_cast<std::size_t>(end_ - here_); }
    const std::string& name() const { return name_; }
    std::uint64_t line_at(std::size_t position) const;

    [[noreturn]] void fail(const std::string& reason) const;  ///< at the line of the last word
    [[noreturn]] void fail_at(std::size_t position, const std::string& reason) const;

private:
    bool is_stop(const char* place) const;
    bool is_line_end(const char* place) const { return place == end_ || *place == '\n' || *place == '\r'; }
    void start_word(const char* what);
    double number_by_word(const char* what);
    [[noreturn]] void fail_word(const char* what, std::string_view word) const;

    const char* begin_;
    const char* end_;
    const char* here_;
    const char* word_;
    int comment_;
    std::string name_;
};

/// Words of a message: `word` in quotes, shortened, with unprintable bytes replaced.
std::string quoted(std::string_view word);

bool equal_ignoring_case(std::string_view left, std::string_view right);

/// The nearest double to a decimal literal; false if `word` is none or overflows. Accepts a leading plus.
bool parse_number(std::string_view word, double& value);
bool parse_integer(std::string_view word, std::int64_t& value);

}  // namespace certa::io
