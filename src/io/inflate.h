#pragma once
// Decompression of zlib streams (RFC 1950, 1951), which compressed VTK files consist of.
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace certa::io {

/// The `size` bytes that a zlib stream stands for; nothing if it is damaged or stands for another number of bytes.
std::optional<std::string> inflate_zlib(std::string_view stream, std::size_t size);

}  // namespace certa::io
