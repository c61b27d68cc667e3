#pragma once
// Is the zero set within a length of a mesh, and the mesh of it?
#include <certa/run_control.h>

#include "implicit/surface.h"

namespace certa::implicit {

/// The triangles for which it is not proved; empty: proved, the mesh being in W (docs/implicit-theorem.md, "distance").
/// A rehearsal of what the checker will ask: f has its sign on the triangles moved to both sides by the length.
std::vector<std::uint32_t> find_far_triangles(const TriangleMesh& mesh, double length, const expression::Tape& tape,
                                              const RunControl& control);

}  // namespace certa::implicit
