#pragma once
// Least-squares polynomials over the tangent plane: an estimator beside the thesis's, and the judge of noise.
#include "curvature/cells.h"
#include "curvature/principal.h"

namespace certa::curvature {

struct JetFit {
    bool ok = false;  ///< false where there are too few points for degree 2
    Principal principal;
    double residual = 0.0;  ///< root mean square of what is left, corrected for the number of coefficients
    std::size_t points = 0;
};

/// Scratch memory for fits; one per thread.
class JetFitter {
public:
    JetFitter(const Surface& surface) : surface_(surface) {}
    /// Fits heights over the plane at a right angle to the vertex's normal through the given vertices; lowers the
    /// degree where there are fewer points than two more than coefficients.
    /// `tapered`: points count less towards the end of the window where there are twice as many as coefficients, which
    /// lets wide windows average noise with less bias; the residual is then no estimate of the noise.
    JetFit fit(Index vertex, std::span<const Index> points, std::uint64_t degree, bool tapered);

private:
    /// Solves the least-squares problem in place; false if it is singular.
    bool solve(std::size_t rows, std::size_t columns);

    const Surface& surface_;
    std::vector<double> matrix_, values_;  ///< column by column
};

}  // namespace certa::curvature
