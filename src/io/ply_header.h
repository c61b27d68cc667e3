#pragma once
// The header of a PLY file: which elements follow, with which properties, in which encoding.
#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "io/text_cursor.h"

namespace certa::io {

enum class PlyType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
std::size_t size_of(PlyType type);
inline bool is_float(PlyType type) { return type == PlyType::float32 || type == PlyType::float64; }

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::float32;
    bool is_list = false;
    PlyType count_type = PlyType::uint8;
};

struct PlyElement {
    std::string name;
    std::uint32_t count = 0;
    std::vector<PlyProperty> properties;
    std::size_t least_bytes() const;  ///< of a row in binary encoding
};

struct PlyHeader {
    bool is_text = true;
    std::endian order = std::endian::little;
    std::vector<PlyElement> elements;
};

/// Reads up to and including the line "end_header".
PlyHeader read_ply_header(TextCursor& cursor);

}  // namespace certa::io
