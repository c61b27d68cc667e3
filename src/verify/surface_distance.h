#pragma once
// A proved bound on the distance between a mesh and the zero set, both ways.
#include <certa/mesh.h>
#include <certa/run_control.h>

#include <string>
#include <vector>

#include "verify/implicit_complex.h"
#include "verify/surface_contacts.h"

namespace certa::verify {

struct DistanceQuestion {
    const TriangleMesh& mesh;  ///< isotopic to the zero set in W, facing f > 0
    double bound;
    const ImplicitFunction& function;
    const ImplicitComplex& complex;
    const std::vector<Corners>& frontier;  ///< of W
    const std::vector<std::uint32_t>& component_of_triangle;
};

/// Why the bound is not proved; empty: each point of the mesh is within it of a zero, each zero in the box within it of
/// the mesh.
///
/// Definition: docs/implicit-theorem.md, "distance": vertices are moved by at most the bound to both sides; f has its
///             sign on the triangles between the moved vertices; what lies between turns nowhere over; each component
///             has a vertex whose way to both sides stays in W.
std::vector<std::string> check_distance(const DistanceQuestion& question, const RunControl& control);

}  // namespace certa::verify
