#pragma once
// Numbers that Gmsh gives to element types.
#include <cstdint>

namespace certa::io {

enum class MshElement : std::int32_t { line = 1, triangle = 2, quad = 3, tetrahedron = 4, point = 15 };

/// Fields that hold whole numbers though .msh files hold only doubles.
inline constexpr const char* msh_integer_names[] = {"region", "facet",       "segment",
                                                    "marker", "source_kind", "source_index"};

}  // namespace certa::io
