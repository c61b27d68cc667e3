#pragma once
// Meshes as other programs make them: marching cubes on a regular grid, with no knowledge of f between its points.
#include <certa/implicit.h>

namespace certa::test {

/// The surface of sign changes on n x n x n cells, vertices by linear interpolation, faces towards f > 0. On squares
/// with alternating signs the negative corners are cut off.
TriangleMesh march_cubes(const Expression& function, const Point3& low, const Point3& high, int n);

}  // namespace certa::test
