#pragma once
// Theorem A of docs/implicit-theorem.md: is a triangle mesh, as its doubles stand, isotopic to the surface that W
// holds?
#include <certa/implicit.h>

#include <string>
#include <vector>

#include "verify/implicit_complex.h"
#include "verify/surface_contacts.h"

namespace certa::verify {

/// A component V of a W that was verified for f.
struct VerifiedComponent {
    std::uint32_t id = 0;                ///< the part of its points
    int genus = 0;                       ///< of the surface in it
    int inner_sign = 0;                  ///< of f just inside
    std::uint32_t inner = 0, outer = 0;  ///< a point of T in the component of the complement inside and outside of it
    std::uint32_t parent = 0;            ///< id of the component next around it; ImplicitComplex::no_point: none
};

struct VerifiedW {
    std::vector<char> marked;                  ///< per point of T
    std::vector<std::uint32_t> part_of_point;  ///< per point: component of W, or of its complement
    std::vector<VerifiedComponent> components;
};

/// A closed surface of triangles, each turned so that neighbours agree.
struct ClosedSurface {
    std::vector<Triangle> triangles;
    std::vector<std::uint32_t> component_of_triangle;
    std::vector<std::uint32_t> first_triangle;  ///< per component
    std::vector<int> genera;                    ///< per component
    bool turned = false;                        ///< some triangle was turned over
};

/// What decides, or hinders.
struct MeshFindings {
    std::vector<std::string> refuting, hindering;  ///< reasons; a mesh without either is isotopic
    std::vector<std::uint32_t> triangles;          ///< named by the reasons, sorted
    std::vector<int> genera;                       ///< of the mesh, sorted; empty where it is no closed surface
    std::vector<std::uint32_t> component_of_triangle;
    std::vector<Corners> frontier;  ///< of W; filled where the mesh was compared with it
    bool faces_positive = false;    ///< isotopic, and every triangle faces f > 0
};

/// Decides in this order: closed surface with the form of a manifold; no contact with itself; components, genera and
/// nesting those of W (each failure refutes); no contact with the frontier of W, one component in each component
/// of W, separating its sides (each failure hinders).
///
/// Guarantee: exact; f is not evaluated.
MeshFindings judge_mesh(const TriangleMesh& mesh, const ImplicitComplex& complex, const VerifiedW& w,
                        const RunControl& control);

}  // namespace certa::verify
