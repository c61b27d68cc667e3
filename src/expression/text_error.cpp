// Messages about texts: name, line, column, reason, and the line with a caret under the place. Long lines are shown
// around the place only; control characters do not reach the terminal.
#include <certa/implicit.h>

namespace certa {
namespace {

constexpr std::size_t shown = 100;

std::string reason_with_line(std::uint64_t column, std::string reason, std::string_view line) {
    std::size_t place = static_cast<std::size_t>(column - 1);
    std::string_view window = line;
    if (window.size() > shown) {
        const std::size_t first = place > shown / 2 ? place - shown / 2 : 0;
        window = window.substr(std::min(first, window.size()), shown);
        place -= std::min(first, line.size());
    }
    std::string text = "column " + std::to_string(column) + ": " + std::move(reason) + "\n  ", caret = "\n  ";
    for (const char c : window) text += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
    // A caret per character, not per byte: continuation bytes of UTF-8 take no room.
    for (std::size_t i = 0; i < place; ++i) {
        if (i >= window.size() || (static_cast<unsigned char>(window[i]) & 0xc0) != 0x80) caret += ' ';
    }
    return text + caret + "^";
}

}  // namespace

ExpressionError::ExpressionError(std::string name, std::uint64_t line, std::uint64_t column, std::string reason,
                                 std::string_view line_text)
    : IoError(std::move(name), line, reason_with_line(column, std::move(reason), line_text)), column_(column) {}

}  // namespace certa
