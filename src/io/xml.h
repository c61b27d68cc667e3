#pragma once
// As much of XML as VTK's files need: tags with attributes, one after the other.
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "io/text_cursor.h"

namespace certa::io {

struct XmlTag {
    std::string name;
    std::map<std::string, std::string, std::less<>> attributes;
    bool is_closing = false;  ///< </name>
    bool is_empty = false;    ///< <name/>
    std::size_t start = 0;    ///< position of '<'
    std::size_t end = 0;      ///< position after '>'

    const std::string* find(std::string_view attribute) const {
        const auto found = attributes.find(attribute);
        return found == attributes.end() ? nullptr : &found->second;
    }
};

class XmlCursor {
public:
    XmlCursor(std::string_view text, const std::string& name)
        : text_(text), lines_(text, name, TextCursor::no_comments) {}

    /// The next tag, comments and declarations skipped; nothing at the end of the file.
    std::optional<XmlTag> next();
    std::size_t position() const { return position_; }
    [[noreturn]] void fail_at(std::size_t position, const std::string& reason) const {
        lines_.fail_at(position, reason);
    }

private:
    bool skip_past(std::string_view opening, std::string_view closing);
    void skip_blanks();
    std::string read_name();
    void read_attribute(XmlTag& tag);
    std::string unescaped(std::string_view value) const;

    std::string_view text_;
    TextCursor lines_;  // for the numbers of lines
    std::size_t position_ = 0;
};

}  // namespace certa::io
