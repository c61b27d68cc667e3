#pragma once
// Appending numbers to a text: the shortest form that reads back to the same double, whatever the locale.
#include <certa/types.h>

#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>

namespace certa::io {

class TextOutput {
public:
    TextOutput& operator<<(std::string_view words) {
        text_ += words;
        return *this;
    }
    TextOutput& operator<<(const char* words) { return *this << std::string_view(words); }
    TextOutput& operator<<(char c) {
        text_ += c;
        return *this;
    }
    template <class Number>
    requires(std::is_arithmetic_v<Number> && !std::is_same_v<Number, char> && !std::is_same_v<Number, bool>) TextOutput&
    operator<<(Number value) {
        char digits[32];
        text_.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
        return *this;
    }
    TextOutput& operator<<(const Point3& p) { return *this << p.x << ' ' << p.y << ' ' << p.z; }

    void reserve(std::size_t bytes) { text_.reserve(bytes); }
    std::string& text() { return text_; }
    std::string take() { return std::move(text_); }

private:
    std::string text_;
};

}  // namespace certa::io
