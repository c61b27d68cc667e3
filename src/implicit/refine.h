#pragma once
// Subdivision: classification of the box into settled leaves, and what stands in its way.
#include <certa/implicit.h>

#include <chrono>
#include <optional>
#include <vector>

#include "implicit/octree.h"

namespace certa::implicit {

/// Where and why nothing can be decided.
struct Obstacle {
    ImplicitObstacle::Reason reason{};
    std::vector<std::uint32_t> leaves;
};

struct Limits {
    std::uint64_t max_cells = 0;
    int max_depth = 0;
    std::optional<std::chrono::steady_clock::time_point> deadline = std::nullopt;
    bool is_late() const { return deadline && std::chrono::steady_clock::now() > *deadline; }
};

/// Splits until every leaf is settled and every leaf that touches the box has a sign; or returns the obstacle.
///
/// Ends when 0 is a regular value of f and the surface misses the box, in exact arithmetic; in doubles and within the
/// limits an obstacle is what remains.
std::optional<Obstacle> classify(Octree& tree, const expression::Tape& tape, const Limits& limits,
                                 const RunControl& control);

/// Splits leaves and certifies the children, which inherit what was known. Empty unless a limit was met.
std::optional<Obstacle> split_all(Octree& tree, const std::vector<std::uint32_t>& leaves, const expression::Tape& tape,
                                  const Limits& limits, const RunControl& control);

}  // namespace certa::implicit
