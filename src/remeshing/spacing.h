#pragma once
// How far lines of each family should lie apart (thesis 4.2.1, equation 4.6).
#include "remeshing/field.h"

namespace certa::remeshing {

struct SpacingRule {
    double error = 0.0;     ///< epsilon of equation 4.6
    double isotropy = 0.0;  ///< rho
    double transfer = 0.5;
    double hyperbolic = 1.0;     ///< where curvatures have opposite signs, spacing is this much wider
    double largest = 0.35;       ///< in diagonals of the component: where curvature vanishes there need not be lines
    double balance = 1.0;        ///< above 1: fewer lines along k_max, more along k_min
    double near_umbilics = 1.0;  ///< there, spacing is this part of what it would be (the thesis: shorter)
    /// Cells' areas go with this power less of what one epsilon everywhere gives: 0 keeps the largest distance even,
    /// 1/3 has the least mean square for the number of cells, because many cells pay for little where curvature is
    /// high.
    double evening = 0.0;
    /// Per family and wedge: lines are wanted there and not farther apart than this; 0, or empty: no such bound.
    std::array<std::vector<double>, 2> most = {};
    double growth = 0.7;  ///< spacing grows by at most this much per length: curvature is not constant over a gap
};

/// Distance between neighbouring lines of each family, per wedge.
struct Spacing {
    std::array<std::vector<double>, 2> at;
    /// Whether curvature asks for lines at all, per wedge: in flat parts nothing is sown.
    std::array<std::vector<bool>, 2> wanted;
    std::vector<bool> curved;  ///< per wedge: not flat
};

/// Equation 4.6: the chord of a circle of curvature k with sagitta e; `largest` where it would be longer.
double chord_of(double curvature, double largest, const SpacingRule& rule);
/// `caps`: per wedge, lines are wanted there and not farther apart than this; 0: no cap.
Spacing compute_spacing(const WorkMesh& mesh, const DirectionField& field, const SpacingRule& rule,
                        const std::vector<double>& caps);
/// Number of vertices that a perfect network of this spacing has.
double expected_vertices(const WorkMesh& mesh, const Spacing& spacing);

}  // namespace certa::remeshing
