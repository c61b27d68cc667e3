#pragma once
// The surface of sign changes as a triangle mesh whose vertices lie exactly on edges of T.
#include <certa/mesh.h>

#include <array>
#include <vector>

#include "core/index_map.h"
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
class SurfaceBuilder {
public:
    SurfaceBuilder(const Octree& tree, Field& field) : tree_(tree), field_(field) {}
    /// The triangles in a positively oriented tetrahedron whose points have these signs, each -1 or +1.
    void add(const std::array<std::uint32_t, 4>& tetrahedron, const std::array<int, 4>& signs, std::uint32_t component);
    Surface take() { return std::move(surface_); }

private:
    void add_quadrilateral(const std::array<std::uint32_t, 4>& corners, std::uint32_t component);
    void emit(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t component);
    std::uint32_t vertex(std::uint32_t negative, std::uint32_t positive);
    Point3 place(const GridPoint& a, const GridPoint& b, int sign_at_a);
    const Octree& tree_;
    Field& field_;
    core::PairMap vertices_;
    Surface surface_;
};

/// The surface in all tetrahedra of T.
Surface build_surface(const Octree& tree, const Triangulation& triangulation, const Findings& findings, Field& field);

}  // namespace certa::implicit
