#pragma once
// The second engine: Plantinga and Vegter, "Isotopic approximation of implicit curves and surfaces", SGP 2004.
#include <certa/implicit.h>

#include "implicit/grid.h"

namespace certa::implicit {

/// Meshes {f = 0} by subdivision until f is proved non-zero or to have small normal variation on every leaf, balance,
/// and marching on the corners.
///
/// Result:    as mesh_implicit without certificate, degrees and nesting.
/// Guarantee: components and genera by the theorem of the paper; enclosures are sound. The mesh is a closed surface;
/// that
///            its triangles do not touch within a leaf is not checked.
ImplicitResult mesh_by_subdivision(const Expression& function, const Grid& grid, const ImplicitOptions& options,
                                   const RunControl& control);

}  // namespace certa::implicit
