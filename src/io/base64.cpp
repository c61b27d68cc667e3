// Base64 (RFC 4648). Decoding goes group by group of four digits, so that a header and its data may be encoded one
// after the other, each with its own padding, as some writers of VTK files do.
#include "io/base64.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace certa::io {
namespace {

constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr int padding = -2, blank = -3, other = -1;

constexpr std::array<int, 256> make_values() {
    std::array<int, 256> values{};
    for (auto& value : values) value = other;
    for (std::size_t i = 0; i < digits.size(); ++i) values[static_cast<unsigned char>(digits[i])] = static_cast<int>(i);
    values['='] = padding;
    for (const char c : {' ', '\t', '\r', '\n'}) values[static_cast<unsigned char>(c)] = blank;
    return values;
}
constexpr auto values = make_values();

}  // namespace

void encode_base64(std::string_view bytes, std::string& out) {
    out.reserve(out.size() + (bytes.size() + 2) / 3 * 4);
    const auto byte = [&](std::size_t i) { return i < bytes.size() ? static_cast<unsigned char>(bytes[i]) : 0U; };
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::uint32_t group = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
        out += digits[group >> 18];
        out += digits[group >> 12 & 63];
        out += i + 1 < bytes.size() ? digits[group >> 6 & 63] : '=';
        out += i + 2 < bytes.size() ? digits[group & 63] : '=';
    }
}

std::optional<std::string> decode_base64(std::string_view text, std::size_t most) {
    std::string bytes;
    bytes.reserve(std::min(most, text.size() / 4 * 3));
    std::uint32_t group = 0;
    int filled = 0, padded = 0;
    for (const char c : text) {
        const int value = values[static_cast<unsigned char>(c)];
        if (value == blank) continue;
        if (value == other || bytes.size() >= most) break;
        if (value == padding ? filled < 2 : padded > 0) return std::nullopt;
        if (value == padding) ++padded;
        group = group << 6 | static_cast<std::uint32_t>(value == padding ? 0 : value);
        if (++filled < 4) continue;
        for (int k = 0; k < 3 - padded; ++k) bytes += static_cast<char>(group >> (16 - 8 * k) & 255);
        group = 0;
        filled = padded = 0;
    }
    if (filled != 0) return std::nullopt;
    if (bytes.size() > most) bytes.resize(most);
    return bytes;
}

}  // namespace certa::io
