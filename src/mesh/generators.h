#pragma once
// Piecewise linear complexes made on purpose, for tests and benchmarks: valid by construction (facets meet only in
// common vertices and segments), deterministic in their seed. Lengths are about 1 unless said otherwise; angles in
// radians.
#include <certa/mesh.h>

#include <cstdint>

namespace certa::generators {

/// Rotates about a random axis and then translates; planes stay planes up to rounding.
PiecewiseLinearComplex make_moved(PiecewiseLinearComplex complex, std::uint64_t rotation_seed,
                                  const Point3& translation = {});

// --- sharp contacts ---

/// `pages` uneven planar quads around one axis, at random angles within `width`. For a seed, pages differ in outline
/// and not in number or relative angle when `width` changes. The axis is one segment; 2 + 2 pages vertices.
PiecewiseLinearComplex make_fan(std::uint32_t pages, double width, std::uint64_t seed);

/// Equal rectangles around one axis at equal angles, from 0 to `width` (below a full turn).
PiecewiseLinearComplex make_book(std::uint32_t pages, double width);

/// Sliver triangles that share one apex and nothing else, all within a cone of opening angle `width` (below 2).
PiecewiseLinearComplex make_cone(std::uint32_t slivers, double width, std::uint64_t seed);

/// Segments from one point in random directions, of lengths from 1 to `longest`. With longest = 1 every Delaunay
/// triangulation of the points contains them.
PiecewiseLinearComplex make_star(std::uint32_t segments, double longest, std::uint64_t seed);

/// Triangles from an apex to an uneven rim, a stick (a segment) hanging from the apex, and three fins at its lower end.
/// gores + 6 vertices.
PiecewiseLinearComplex make_umbrella(std::uint32_t gores, std::uint64_t seed);

/// Two triangles with a common edge at angle `angle`, or, with `closed`, the prism over the wedge between them.
PiecewiseLinearComplex make_wedge(double angle, bool closed);

// --- boxes, plates, plain facets ---

/// The cube [0, 1]^3 with n x n squares per face, each one facet, or two triangles when `triangles`.
PiecewiseLinearComplex make_cube(std::uint32_t n, bool triangles);

/// `count` boxes, each inside the one before, all sharing the corner at the origin and nothing else.
PiecewiseLinearComplex make_nested_cubes(std::uint32_t count);

/// A square facet with `holes` holes of 3 to 6 sides, `segments` isolated segments and `points` isolated points.
PiecewiseLinearComplex make_plate(std::uint32_t holes, std::uint32_t segments, std::uint32_t points,
                                  std::uint64_t seed);

/// Two irregular polygons in parallel planes at the given distance, facing each other.
PiecewiseLinearComplex make_near_facets(double distance, std::uint64_t seed);

/// n x n rectangles of uneven sizes in one plane, sharing their sides.
PiecewiseLinearComplex make_coplanar_facets(std::uint32_t n, std::uint64_t seed);

// --- crowds ---

/// `count` tetrahedra out of a jittered lattice, so that they meet by faces, edges, vertices or not at all; the facets
/// are their faces, each once.
PiecewiseLinearComplex make_glued_tetrahedra(std::uint32_t count, std::uint64_t seed);

/// A surface over n random points of the unit square, triangulated in sweep order (mostly slivers), with random heights
/// up to `height`.
PiecewiseLinearComplex make_flat_cloud(std::uint32_t n, double height, std::uint64_t seed);

/// Disjoint random triangles and quadrilaterals, each in its own cell of a lattice that they nearly fill.
PiecewiseLinearComplex make_soup(std::uint32_t count, std::uint64_t seed);

/// Everything else in one place: a cube with an inner wall, a dangling facet, a hanging segment, isolated points in
/// space and on a facet, a hole, and a tetrahedron glued on by an edge.
PiecewiseLinearComplex make_mixture(std::uint64_t seed);

// --- geology ---

/// Stacked horizons over one irregular grid of `grid` x `grid` cells, in a box with walls. Where a layer pinches out
/// its two horizons share vertices, edges and triangles. Non-manifold; about (2 grid^2 - pinched) (layers + 1)
/// triangles and 4 grid layers wall facets (triangles and quads).
PiecewiseLinearComplex make_geology(std::uint32_t grid, std::uint32_t layers, std::uint64_t seed);

}  // namespace certa::generators
