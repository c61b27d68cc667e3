#pragma once
// Surfaces with known curvatures, for tests, benchmarks and the experiments of Part II: random samples, triangulated
// as the thesis's are (Delaunay on the surface). Deterministic in their seed. Triangles face outwards.
#include <certa/mesh.h>

#include <cstdint>

namespace certa::generators {

/// Uniform random points on the torus of radii `major` > `minor` around the z axis, Delaunay in conformal coordinates.
TriangleMesh make_torus(double major, double minor, std::uint32_t points, std::uint64_t seed);

/// Uniform random points on the ellipsoid of semi-axes a, b, c: convex hull, then flips to the larger of the smallest
/// angles.
TriangleMesh make_ellipsoid(double a, double b, double c, std::uint32_t points, std::uint64_t seed);

/// Uniform random points on the side of the cylinder around the z axis, from z = 0 to `height`; open, ragged rims.
TriangleMesh make_cylinder(double radius, double height, std::uint32_t points, std::uint64_t seed);

/// The helicoid (s cos z, s sin z, z), |s| <= 1, 0 <= z <= 2 (thesis, Figure 3.2): `fibres` samples a unit along the
/// rulings, staggered, and `axial` of them along the axis; the Delaunay triangulation restricted to it where the rows
/// are much closer than the samples in them.
TriangleMesh make_helicoid(std::uint32_t fibres, std::uint32_t axial);

/// Moves every vertex by a vector that is uniform in the ball of radius `distance`.
TriangleMesh make_noisy(TriangleMesh mesh, double distance, std::uint64_t seed);

/// The torus again, as a grid of n around the axis times m around the tube, each square cut in two: 2 n m triangles.
TriangleMesh make_grid_torus(double major, double minor, std::uint32_t n, std::uint32_t m);

/// The unit sphere: an icosahedron, every triangle cut into four `levels` times. 20 * 4^levels triangles.
TriangleMesh make_icosphere(std::uint32_t levels);

/// The box from the origin to (x, y, z), 12 triangles.
TriangleMesh make_box(double x, double y, double z);

}  // namespace certa::generators
