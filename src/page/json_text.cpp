// JSON written by hand: the library links no JSON library, and the manifest must be safe inside an HTML script element.
// File names need not be UTF-8: a byte that is not part of a well-formed sequence becomes U+FFFD.
#include "page/json_text.h"

#include <array>
#include <charconv>

namespace certa::page {
namespace {

/// Length of the well-formed UTF-8 sequence at the start of `text`; 0 if there is none (RFC 3629).
std::size_t sequence_length(std::string_view text) {
    const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
    const auto is_continuation = [&](std::size_t i, unsigned low = 0x80, unsigned high = 0xBF) {
        return byte(i) >= low && byte(i) <= high;
    };
    const unsigned first = byte(0);
    if (first < 0x80) return 1;
    if (first >= 0xC2 && first <= 0xDF) return is_continuation(1) ? 2 : 0;
    if (first >= 0xE0 && first <= 0xEF) {
        const bool second = is_continuation(1, first == 0xE0 ? 0xA0 : 0x80, first == 0xED ? 0x9F : 0xBF);
        return second && is_continuation(2) ? 3 : 0;
    }
    if (first >= 0xF0 && first <= 0xF4) {
        const bool second = is_continuation(1, first == 0xF0 ? 0x90 : 0x80, first == 0xF4 ? 0x8F : 0xBF);
        return second && is_continuation(2) && is_continuation(3) ? 4 : 0;
    }
    return 0;
}

void append_escape(std::string& out, unsigned char c) {
    constexpr std::string_view digits = "0123456789abcdef";
    out.append("\\u00").append(1, digits[c >> 4U]).append(1, digits[c & 15U]);
}

template <class Number>
std::string digits_of(Number value) {
    std::array<char, 32> buffer;
    return {buffer.data(), std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr};
}

}  // namespace

std::string json_string(std::string_view text) {
    std::string out = "\"";
    while (!text.empty()) {
        const std::size_t length = sequence_length(text);
        const char c = text.front();
        if (length == 0)
            out += "\\ufffd";
        else if (c == '"' || c == '\\')
            out.append(1, '\\').append(1, c);
        else if (c == '<' || c == '>' || c == '&' || static_cast<unsigned char>(c) < 0x20)
            append_escape(out, static_cast<unsigned char>(c));
        else
            out += text.substr(0, length);
        text.remove_prefix(length == 0 ? 1 : length);
    }
    return out + "\"";
}

std::string json_number(double value) { return digits_of(value); }
std::string json_number(std::uint64_t value) { return digits_of(value); }

std::string json_point(const Point3& point) {
    return json_list(std::array{json_number(point.x), json_number(point.y), json_number(point.z)});
}

std::string json_list(std::span<const std::string> items) {
    std::string out = "[";
    for (const std::string& item : items) out.append(out.size() > 1 ? "," : "").append(item);
    return out + "]";
}

JsonObject& JsonObject::set(std::string_view name, std::string_view json) {
    members_.append(members_.empty() ? "" : ",").append(json_string(name)).append(":").append(json);
    return *this;
}

}  // namespace certa::page
