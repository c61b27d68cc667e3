#pragma once
// One function certified as a whole, by one octree and one W.
#include <certa/implicit.h>

#include "implicit/grid.h"

namespace certa::implicit {

/// mesh_implicit without the taking apart of products, on a grid that is given.
ImplicitResult certify_whole(const Expression& function, const Grid& grid, const ImplicitOptions& options,
                             const RunControl& control);

/// The grid of a box. Errors: InputError for a box that makes no sense.
Grid checked_grid(const Point3& low, const Point3& high);

}  // namespace certa::implicit
