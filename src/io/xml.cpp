// Tags of an XML text. No namespaces, no entities beyond the five predefined ones: VTK writes none.
#include "io/xml.h"

#include <array>
#include <utility>

namespace certa::io {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
bool ends_name(char c) { return is_blank(c) || c == '=' || c == '>' || c == '/' || c == '<' || c == '"' || c == '\''; }

}  // namespace

bool XmlCursor::skip_past(std::string_view opening, std::string_view closing) {
    if (!text_.substr(position_).starts_with(opening)) return false;
    const std::size_t end = text_.find(closing, position_ + opening.size());
    if (end == std::string_view::npos) fail_at(position_, "'" + std::string(opening) + "' is never closed");
    position_ = end + closing.size();
    return true;
}

void XmlCursor::skip_blanks() {
    while (position_ < text_.size() && is_blank(text_[position_])) ++position_;
}

std::string XmlCursor::read_name() {
    const std::size_t start = position_;
    while (position_ < text_.size() && !ends_name(text_[position_])) ++position_;
    if (position_ == start) fail_at(start, "a name was expected in a tag");
    return std::string(text_.substr(start, position_ - start));
}

std::string XmlCursor::unescaped(std::string_view value) const {
    constexpr std::array<std::pair<std::string_view, char>, 5> entities{
        {{"&lt;", '<'}, {"&gt;", '>'}, {"&amp;", '&'}, {"&quot;", '"'}, {"&apos;", '\''}}};
    std::string out;
    while (!value.empty()) {
        bool found = false;
        for (const auto& [entity, c] : entities) {
            if (!value.starts_with(entity)) continue;
            out += c;
            value.remove_prefix(entity.size());
            found = true;
            break;
        }
        if (found) continue;
        out += value.front();
        value.remove_prefix(1);
    }
    return out;
}

void XmlCursor::read_attribute(XmlTag& tag) {
    const std::size_t start = position_;
    std::string name = read_name();
    skip_blanks();
    if (position_ >= text_.size() || text_[position_] != '=')
        fail_at(start, "the attribute '" + name + "' has no value");
    ++position_;
    skip_blanks();
    const char quote = position_ < text_.size() ? text_[position_] : '\0';
    if (quote != '"' && quote != '\'') fail_at(start, "the value of the attribute '" + name + "' is not quoted");
    const std::size_t end = text_.find(quote, position_ + 1);
    if (end == std::string_view::npos) fail_at(start, "the value of the attribute '" + name + "' is never closed");
    tag.attributes[std::move(name)] = unescaped(text_.substr(position_ + 1, end - position_ - 1));
    position_ = end + 1;
}

std::optional<XmlTag> XmlCursor::next() {
    for (;;) {
        position_ = text_.find('<', position_);
        if (position_ == std::string_view::npos) {
            position_ = text_.size();
            return std::nullopt;
        }
        if (!skip_past("<!--", "-->") && !skip_past("<?", "?>") && !skip_past("<!", ">")) break;
    }
    XmlTag tag;
    tag.start = position_++;
    if (position_ < text_.size() && text_[position_] == '/') tag.is_closing = true, ++position_;
    tag.name = read_name();
    for (;;) {
        skip_blanks();
        if (position_ >= text_.size()) fail_at(tag.start, "the tag '" + tag.name + "' is never closed");
        if (text_[position_] == '>') break;
        if (text_.substr(position_).starts_with("/>")) {
            tag.is_empty = true;
            ++position_;
            break;
        }
        read_attribute(tag);
    }
    tag.end = ++position_;
    return tag;
}

}  // namespace certa::io
