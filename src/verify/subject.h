#pragma once
// What is being checked, and what the stages of the check hand on to each other.
#include <certa/conforming.h>

#include <cstdint>
#include <vector>

#include "verify/plc.h"
#include "verify/predicates.h"
#include "verify/report.h"
#include "verify/tet_faces.h"
#include "verify/vertex_tree.h"

namespace certa::verify {

/// The polylines of mesh vertices that stand for the segments; empty where there is none.
struct Chains {
    std::vector<std::uint64_t> offsets{0};
    std::vector<std::uint32_t> vertices;
    /// Per mesh vertex: the segment that has it in its inside, or no_index.
    std::vector<std::uint32_t> segment_of;

    std::size_t size(std::uint32_t segment) const { return offsets[segment + 1] - offsets[segment]; }
    const std::uint32_t* begin(std::uint32_t segment) const { return vertices.data() + offsets[segment]; }
};

/// Indices are valid and coordinates finite; everything else is open.
struct Subject {
    const TetMesh& mesh;
    const PiecewiseLinearComplex& complex;
    const ConformingCheckOptions& options;
    const RunControl& control;
    const Plc& plc;
    const TetFaces& faces;
    const VertexTree& tree;
    double deviation = 0.0;  ///< lengths, resolved
    double planarity = 0.0;
    bool tetrahedron_labels = false, triangle_labels = false, edge_labels = false, sources = false;

    std::vector<std::uint8_t> used{};      ///< per vertex: a corner of a tetrahedron
    std::vector<std::uint8_t> spare{};     ///< per vertex: an isolated input point in the place of a corner
    std::vector<std::uint8_t> walls{};     ///< per half-face: a constraint triangle
    std::vector<std::uint8_t> positive{};  ///< per tetrahedron

    const Point3& at(std::uint32_t vertex) const { return mesh.positions[vertex]; }
    const Point3& at(VertexId vertex) const { return mesh.positions[index_of(vertex)]; }
    std::size_t input_count() const { return complex.positions.size(); }
};

/// A closed piece of the boundary of the mesh, faces being joined across the unmeshed side of their common edges.
struct Shell {
    std::vector<std::uint32_t> faces;  ///< positions in Domain::boundary
    int sign = 0;                      ///< of its volume: -1 where the mesh is around it
    Point3 low, high;
};

/// What is known about the space that the tetrahedra fill.
struct Domain {
    bool matched = false;            ///< faces are shared by at most two tetrahedra, from both sides; all are positive
    bool full_hull = false;          ///< they fill the convex hull of all vertices exactly once: proved
    bool embedded = false;           ///< they overlap nowhere, and every vertex is a corner of one: proved
    bool keeps_outside = false;      ///< some boundary face is no constraint
    std::vector<HalfFace> boundary;  ///< ascending
    std::vector<std::uint8_t> on_hull;  ///< per entry of `boundary`: no vertex lies beyond its plane
    /// Pairs of entries of `boundary` that share an edge and are neighbours across the unmeshed side of it.
    std::vector<std::array<std::uint32_t, 2>> joints;
    std::vector<Shell> shells;  ///< unless full_hull
};

// The stages, in the order in which they run.
bool check_arrays(const TetMesh& mesh, Findings& findings);
void check_tetrahedra(Subject& subject, Findings& findings);
/// Marks the half-faces on constraint triangles.
void mark_walls(Subject& subject, Findings& findings);
Domain check_domain(const Subject& subject, Findings& findings);
/// Whether tetrahedra with matched faces overlap nowhere; false: not proved.
bool is_embedded(const Subject& subject, const Domain& domain);
void check_delaunay(const Subject& subject, const Domain& domain, Findings& findings);
Chains check_segments(const Subject& subject, Findings& findings);
/// Returns the largest distance of an added vertex from what carries it.
double check_facets(const Subject& subject, const Chains& chains, Findings& findings);
void check_regions(const Subject& subject, const Domain& domain, Findings& findings);
void check_gabriel(const Subject& subject, Findings& findings);

}  // namespace certa::verify
