#pragma once
// The surface as the curvature code sees it: vertices and faces along a space-filling curve, hinges between faces.
#include <certa/curvature.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "core/vector3.h"

namespace certa::curvature {

using Index = std::uint32_t;

/// Where two faces meet along the edge from a to b: `left` walks a -> b, `right` walks b -> a.
/// At an edge of more than two faces there is one hinge per wedge of the solid. right = no_index: a border.
struct Hinge {
    Index a = 0, b = 0;
    Index left = no_index, right = no_index;
    double angle = 0.0;   ///< signed angle between the normals, positive where convex; 0 at borders and excluded edges
    double length = 0.0;  ///< of the edge
};

struct FaceGeometry {
    Point3 normal;  ///< unit, outwards; 0 for a face without area
    double area = 0.0;
};

/// Compressed lists: list i is items[offsets[i]] ... items[offsets[i + 1] - 1].
struct Lists {
    std::vector<std::uint64_t> offsets{0};
    std::vector<Index> items;
    std::span<const Index> operator[](std::size_t i) const {
        return {items.data() + offsets[i], static_cast<std::size_t>(offsets[i + 1] - offsets[i])};
    }
};

/// Lengths are in units of 2^exponent, which makes the largest extent of the box 0.5 to 1: scaling the input by a power
/// of two changes nothing but the exponent, and squares neither overflow nor vanish.
struct Surface {
    int exponent = 0;
    // Vertices, sorted; unused ones come last.
    std::vector<Point3> positions;
    std::vector<Index> vertex_sources;   ///< sorted -> input
    std::vector<Index> sorted_vertices;  ///< input -> sorted
    std::vector<Point3> normals;         ///< unit, area-weighted; 0 where undefined
    std::vector<double> defects;         ///< integral of mu over directions: the angle defect
    std::vector<double> angle_sums;
    std::vector<std::uint8_t> flags;  ///< vertex_flags
    std::size_t used_vertices = 0;
    // Faces, sorted by their lowest vertex.
    std::vector<std::array<Index, 3>> faces;
    std::vector<Index> face_sources;                ///< sorted -> input
    std::vector<std::array<Index, 3>> face_hinges;  ///< hinge of the edge opposite corner i
    std::vector<FaceGeometry> face_geometry;
    std::vector<std::array<double, 3>> face_angles;
    std::vector<Hinge> hinges;
    Lists vertex_faces, vertex_neighbors;
    CurvatureStatistics statistics;
    std::int64_t euler_characteristic = 0;
    double diagonal = 0.0;

    Index across(Index face, Index hinge) const {
        return hinges[hinge].left == face ? hinges[hinge].right : hinges[hinge].left;
    }
};

/// Sorts, connects and measures a mesh. Errors: InputError.
Surface build_surface(const TriangleMesh& mesh, const RunControl& control);

/// The contributions of one edge: length times ...
struct EdgeTensors {
    SymmetricTensor3 plain, swapped;
};
/// Both tensors of a hinge per unit of length inside B (thesis, definition 7).
EdgeTensors hinge_tensors(const Surface& surface, const Hinge& hinge);
/// The swapped one only.
SymmetricTensor3 swapped_tensor(const Surface& surface, const Hinge& hinge);

/// Upper bound of the mass above a vertex: the triangles between its normal and the normals of consecutive faces.
double vertex_mass(const Surface& surface, Index vertex);

inline void add(SymmetricTensor3& sum, double factor, const SymmetricTensor3& t) {
    sum.xx += factor * t.xx, sum.xy += factor * t.xy, sum.xz += factor * t.xz;
    sum.yy += factor * t.yy, sum.yz += factor * t.yz, sum.zz += factor * t.zz;
}
/// factor * (u u^T)
inline void add_outer(SymmetricTensor3& sum, double factor, const Point3& u) {
    sum.xx += factor * u.x * u.x, sum.xy += factor * u.x * u.y, sum.xz += factor * u.x * u.z;
    sum.yy += factor * u.y * u.y, sum.yz += factor * u.y * u.z, sum.zz += factor * u.z * u.z;
}
/// The direction of v. Coordinates are of the order of 1 or below (see Surface::exponent): nothing overflows.
inline Point3 unit_or_zero(const Point3& v) {
    double length = norm(v);
    if (length > 1e-100) return (1.0 / length) * v;
    const Point3 w = 0x1p300 * (0x1p300 * v);  // squares of tiny lengths vanish
    length = norm(w);
    return length > 0.0 ? (1.0 / length) * w : Point3{};
}

}  // namespace certa::curvature
