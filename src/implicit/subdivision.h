#pragma once
// The second engine: Plantinga and Vegter, "Isotopic approximation of implicit curves and surfaces", SGP 2004.
#include <certa/implicit.h>

#include "implicit/grid.h"

namespace certa::implicit {

/// Meshes {f = 0} by subdivision until f is proved non-zero or to have small normal variation on every leaf, together
/// with its interpolation on the triangulation of the octree.
///
/// Result:    as mesh_implicit without certificate, degrees and nesting.
/// Guarantee: the mesh, as its doubles stand, is isotopic to the zero set (docs/implicit-theorem.md, "the second
/// engine").
ImplicitResult mesh_by_subdivision(const Expression& function, const Grid& grid, const ImplicitOptions& options,
                                   const RunControl& control);

}  // namespace certa::implicit
