#pragma once
// The connection Laplacian of order two on the wedges, and its solver (thesis 4.1.3; remesh, stage 3).
#include "remeshing/work_mesh.h"

namespace certa::remeshing {

/// Symmetric matrix by rows, as the connection Laplacian has it: neighbours, weights and transports.
struct Laplacian {
    std::vector<std::uint64_t> offsets;
    std::vector<Index> columns;
    std::vector<double> weights;
    std::vector<Complex> transports;  ///< brings the neighbour's square into this wedge's frame
    std::vector<double> diagonal, mass;
};

Laplacian build_laplacian(const WorkMesh& mesh);
/// (L + screen) u = right: conjugate gradients from `u` on; where needles keep those from converging, a factorization.
void solve(const Laplacian& laplacian, const std::vector<double>& screen, const std::vector<Complex>& right,
           std::vector<Complex>& u, const RunControl& control);

}  // namespace certa::remeshing
