#pragma once
// A number for a mesh that no other mesh is likely to have.
#include <certa/mesh.h>

#include <string>
#include <string_view>

namespace certa::core {

/// SHA-256 (FIPS 180-4), as 64 hexadecimal digits.
std::string sha256(std::string_view bytes);

/// Of the numbers of vertices and triangles, all coordinates (-0 as 0) and the corners of all triangles, each
/// triangle's in rising order: how triangles are turned makes no difference.
std::string digest_of(const TriangleMesh& mesh);

}  // namespace certa::core
