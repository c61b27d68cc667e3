#pragma once
// Words for defects: elements are named 1-based, as files count.
#include <certa/error.h>

#include <initializer_list>
#include <string>

namespace certa::conforming {

/// "vertex 5" for index 4.
std::string name_element(ElementKind kind, std::uint32_t index);
inline std::string vertex_name(std::uint32_t v) { return name_element(ElementKind::vertex, v); }
inline std::string segment_name(std::uint32_t s) { return name_element(ElementKind::segment, s); }
inline std::string facet_name(std::uint32_t f) { return name_element(ElementKind::facet, f); }

/// "(1, 2, 0.5)" with the digits that read back to the same doubles.
std::string name_place(const Point3& place);
std::string name_number(double number);

}  // namespace certa::conforming
