#pragma once
// Numbers that VTK gives to cell types.
#include <cstdint>

namespace certa::io {

enum class VtkCell : std::uint8_t {
    vertex = 1,
    poly_vertex = 2,
    line = 3,
    poly_line = 4,
    triangle = 5,
    triangle_strip = 6,
    polygon = 7,
    pixel = 8,
    quad = 9,
    tetra = 10,
};

}  // namespace certa::io
