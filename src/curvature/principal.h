#pragma once
// From tensors to principal curvatures and directions.
#include "curvature/cells.h"

namespace certa::curvature {

/// Eigenvalues in increasing order with unit eigenvectors.
struct EigenSystem {
    std::array<double, 3> values{};
    std::array<Point3, 3> vectors{};
};
/// By Jacobi's rotations: deterministic, exact under scaling by powers of two, accurate for nearly equal eigenvalues.
EigenSystem compute_eigensystem(const SymmetricTensor3& tensor);

struct Principal {
    double k_min = 0.0, k_max = 0.0, confidence = 0.0;
    Point3 dir_min, dir_max, normal;
};

/// A frame from the curvature along `first`, a unit vector at a right angle to the unit normal, and across it.
Principal make_principal(double k_first, double k_second, const Point3& first, const Point3& normal);
/// Any unit vector at a right angle to the unit vector n.
Point3 perpendicular_to(const Point3& n);
/// From a tensor whose value along a tangent direction is area times the curvature along it.
Principal compute_principal_along(const SymmetricTensor3& tensor, double area, const Point3& normal);
/// The normal as the remedy chooses it; vertex_normal where the tensors say nothing.
Point3 choose_normal(const Sums& sums, const Point3& vertex_normal);

/// The remedy of thesis 2.5: which eigenvector is the normal is decided with both tensors and the faces' normal.
Principal compute_principal(const Sums& sums, const Point3& vertex_normal);

}  // namespace certa::curvature
