#pragma once
// Base64 (RFC 4648), as VTK's XML files use it.
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace certa::io {

/// Appends the encoded bytes to `out`.
void encode_base64(std::string_view bytes, std::string& out);

/// Decodes up to the first character that is neither a digit of base64, padding nor white space, but no more than
/// `most` bytes; encoded pieces, each with its own padding, may follow one another. Nothing if a piece is cut short.
std::optional<std::string> decode_base64(std::string_view text, std::size_t most);

}  // namespace certa::io
