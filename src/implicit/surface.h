#pragma once
// The surface of sign changes as a triangle mesh whose vertices lie exactly on edges of T.
#include <certa/mesh.h>

#include <array>
#include <vector>

#include "implicit/conditions.h"

namespace certa::implicit {

struct Surface {
    TriangleMesh mesh;                                       ///< faces towards f > 0
    std::vector<std::uint32_t> component_of_triangle;        ///< position in Findings::components
    std::vector<std::array<std::uint32_t, 2>> vertex_edges;  ///< per vertex: the points of T whose edge carries it
};

/// Definition: marching tetrahedra. The vertex of an edge with both signs is a + (b - a) k / 2^m with 0 < k < 2^m near
/// the zero
///             of f, exactly a point of the edge in doubles; quadrilaterals are cut along the shorter diagonal.
/// Guarantee:  the mesh is a piecewise linear surface in W, isotopic there to that of the linear interpolation of any
///             values with these signs: within each tetrahedron both are one disk with the same boundary edges.
Surface build_surface(const Octree& tree, const Triangulation& triangulation, const Findings& findings, Field& field);

}  // namespace certa::implicit
