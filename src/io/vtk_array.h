#pragma once
// Data arrays of VTK's XML files: text, base64 or raw bytes, plain or compressed by zlib.
#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "io/xml.h"

namespace certa::io {

/// What the root element of the file says about all arrays.
struct VtkEncoding {
    std::endian order = std::endian::little;
    bool wide_headers = false;  // UInt64 instead of UInt32
    bool compressed = false;
    std::size_t appended_start = 0;  // position after the underscore of the appended data; 0: none
    bool appended_base64 = false;
};

enum class VtkFormat : std::uint8_t { text, binary, appended };

/// An array as its tag declares it. `start` and `end` delimit inline content.
struct VtkArray {
    std::string name, type;
    std::uint32_t components = 1;
    VtkFormat format = VtkFormat::text;
    std::uint64_t offset = 0;
    std::size_t tag = 0, start = 0, end = 0;
};

using VtkValues = std::variant<std::vector<double>, std::vector<std::int64_t>>;

inline bool is_number_type(std::string_view type) {
    for (const std::string_view known :
         {"Int8", "UInt8", "Int16", "UInt16", "Int32", "UInt32", "Int64", "UInt64", "Float32", "Float64", "vtkIdType"})
        if (type == known) return true;
    return false;
}

/// The numbers of an array; fails unless there are exactly `count` times its components.
VtkValues decode_array(const VtkArray& array, const VtkEncoding& encoding, std::string_view text,
                       const std::string& name, std::uint64_t count);

}  // namespace certa::io
