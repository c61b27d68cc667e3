#pragma once
// Shield edges of a conforming mesh (thesis, Part I, 1.1.3), found from its protecting balls.
#include <certa/mesh.h>

#include <cstdint>
#include <vector>

namespace certa::page {

/// Pairs of vertices: the sides opposite the centre of a ball, both ends on the ball's boundary up to rounding, of
/// constraint triangles. Each once, in the order of the triangles.
///
/// Input: a document whose indices are in range; without the field "ball_radius" of vertices there are none.
std::vector<std::uint32_t> find_shield_edges(const MeshDocument& document);

}  // namespace certa::page
