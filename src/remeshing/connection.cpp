// Connection Laplacian of order two and its solver (thesis 4.1.3; remesh, stage 3).
//
// Squares of directions are compared across an edge by turning the neighbour's frame into the own one; weights are
// cotangents, by cosine over sine. Features have one side here: a wedge's neighbours lie on its own side.
#include "remeshing/connection.h"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCholesky>

namespace certa::remeshing {
namespace {

std::array<double, 3> cotangents(const WorkMesh& mesh, Index f, double& area) {
    std::array<double, 3> cot{};
    const Complex b = mesh.local(f, 1), c = mesh.local(f, 2);
    area = 0.5 * b.real() * c.imag();
    const std::array<Complex, 3> p{Complex(0.0), b, c};
    for (std::size_t i = 0; i < 3; ++i) {  // of the angle opposite half-edge i
        const Complex u = p[i] - p[(i + 2) % 3], v = p[(i + 1) % 3] - p[(i + 2) % 3];
        const Complex turn = v * std::conj(u);
        cot[i] = turn.real() / turn.imag();
    }
    return cot;
}

}  // namespace

Laplacian build_laplacian(const WorkMesh& mesh) {
    Laplacian laplacian;
    const Index wedges = mesh.wedge_count();
    std::vector<double> cot(mesh.edges.size());
    laplacian.mass.assign(wedges, 0.0);
    laplacian.diagonal.assign(wedges, 0.0);
    for (Index f = 0; f < mesh.face_count(); ++f) {
        double area = 0.0;
        const auto values = cotangents(mesh, f, area);
        for (Index i = 0; i < 3; ++i) {
            cot[3 * f + i] = values[i];
            laplacian.mass[mesh.wedges[3 * f + i]] += area / 3.0;
        }
    }
    const auto weight_of = [&](Index h) {
        const double sum = mesh.is_feature(h) ? cot[h] : cot[h] + cot[mesh.opposites[h]];
        return std::clamp(0.5 * sum, 1e-3, 1e3);
    };
    laplacian.offsets.assign(1, 0);
    const auto add = [&](Index w, Index other, double weight, double turn) {
        laplacian.columns.push_back(other);
        laplacian.weights.push_back(weight);
        laplacian.transports.push_back(std::polar(1.0, 2.0 * turn));
        laplacian.diagonal[w] += weight;
    };
    for (Index w = 0; w < wedges; ++w) {
        Index c = mesh.wedge_first[w];
        const Index first = c;
        do {
            const Index n = next_of(c), p = previous_of(c);
            add(w, mesh.wedges[n], weight_of(c), mesh.corner_start[c] - mesh.corner_start[n] - mesh.corner_angle[n]);
            const Index next = mesh.next_corner(c);
            if (next == no_index)
                add(w, mesh.wedges[p], weight_of(p),
                    mesh.corner_start[c] + mesh.corner_angle[c] - mesh.corner_start[p]);
            c = next;
        } while (c != no_index && c != first);
        laplacian.offsets.push_back(laplacian.columns.size());
    }
    return laplacian;
}

void solve(const Laplacian& laplacian, const std::vector<double>& screen, const std::vector<Complex>& right,
           std::vector<Complex>& u, const RunControl& control) {
    using Matrix = Eigen::SparseMatrix<Complex>;
    using Vector = Eigen::Matrix<Complex, Eigen::Dynamic, 1>;
    constexpr double tolerance = 1e-6;
    constexpr int iterations = 250, most_rounds = 4;
    const auto n = static_cast<Eigen::Index>(u.size());
    std::vector<Eigen::Triplet<Complex, Eigen::Index>> entries;
    entries.reserve(u.size() + laplacian.columns.size());
    for (std::size_t i = 0; i < u.size(); ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        entries.emplace_back(row, row, laplacian.diagonal[i] + screen[i] + 1e-300);
        for (std::uint64_t k = laplacian.offsets[i]; k < laplacian.offsets[i + 1]; ++k)
            entries.emplace_back(row, laplacian.columns[k], -laplacian.weights[k] * laplacian.transports[k]);
    }
    Matrix matrix(n, n);
    matrix.setFromTriplets(entries.begin(), entries.end());
    entries = {};
    const Eigen::Map<const Vector> wanted(right.data(), n);
    Eigen::Map<Vector> found(u.data(), n);
    Eigen::ConjugateGradient<Matrix, Eigen::Lower | Eigen::Upper> gradients(matrix);
    gradients.setTolerance(tolerance);
    gradients.setMaxIterations(iterations);
    for (int round = 0; round < most_rounds; ++round) {
        if (control.cancelled()) return;
        found = gradients.solveWithGuess(wanted, found).eval();
        if (gradients.info() == Eigen::Success) return;
    }
    const Eigen::SimplicialLDLT<Matrix> exact(matrix);
    if (exact.info() == Eigen::Success) found = exact.solve(wanted);
}

}  // namespace certa::remeshing
