#pragma once
// The mesher with its inner limits open: what tests need to force the guarantee path.
#include <certa/conforming.h>

namespace certa::conforming {

/// Limits of the first attempt of the default protection; every restart doubles the budgets.
struct AttemptLimits {
    std::size_t owner_budget = 1'000;        ///< Steiner points on one segment or facet, plus 16 per side of a facet
    std::size_t total_budget = 20'000;       ///< all Steiner points, plus 50 per input point
    std::size_t restarts_before_all = 2;     ///< then everything is protected: the thesis's algorithm
    std::size_t doublings_at_last = 4;       ///< of the budgets, where not even that ends well: once more without balls
    std::size_t facets_for_trials = 10'000;  ///< up to here the split rule is chosen by trying all
    std::size_t added_for_trials = 20;       ///< from here on it is worth trying
};

/// What `conform` does for an input without repairs.
ConformResult mesh_complex(const PiecewiseLinearComplex& input, const ConformOptions& options,
                           const AttemptLimits& limits, const RunControl& control);

}  // namespace certa::conforming
