#pragma once
// Few, well-shaped triangles near the zero set, within W.
#include <certa/run_control.h>

#include <optional>

#include "implicit/frontier.h"
#include "implicit/surface.h"

namespace certa::implicit {

struct Simplification {
    double error = 0;                        ///< wanted distance to the zero set, by sampled estimates
    std::size_t most_triangles = 8'000'000;  ///< while it is refined
};

/// Definition: triangles that are farther than `error` from the zero set are refined, others merged while they stay
///             within it; vertices lie on the zero set to rounding where that keeps the mesh in W.
/// Result:     nothing where it takes more than `most_triangles`.
/// Guarantee:  the result is embedded, in W and of the same topology, every step being filtered with a margin
///             (reshape.h). The error is sampled, not proved. `frontier` may be null: then nothing keeps the mesh in W.
std::optional<Surface> simplify(const Surface& surface, const Frontier* frontier, const expression::Tape& tape,
                                const Simplification& wanted, const RunControl& control);

/// About the smallest error that so many triangles suffice for: the error of a triangle is in proportion to its area.
double smallest_error(const Surface& surface, const expression::Tape& tape, std::size_t most_triangles);

/// Simplifies to as large an error as allows to prove that mesh and zero set are within a length of each other.
///
/// Result: the length, or nothing where that was not possible; `surface` is simplified in both cases.
std::optional<double> simplify_to_distance(Surface& surface, const Frontier& frontier, const expression::Tape& tape,
                                           double length, const RunControl& control);

}  // namespace certa::implicit
