#pragma once
// Room for a simplification: W grown into the leaves as near to the zero set as the mesh may be.
#include <functional>
#include <optional>
#include <vector>

#include "implicit/clusters.h"
#include "implicit/conditions.h"
#include "implicit/growth.h"
#include "implicit/refine.h"
#include "implicit/triangulation.h"

namespace certa::implicit {

/// A W for which all conditions hold.
struct ProvedW {
    Triangulation triangulation;
    Growth growth;
    Findings findings;
};

/// What a thicker W is made of: the octree of a proof, and what the engine knows on it.
struct Thickening {
    Octree& tree;
    std::vector<Triangulation::PointSign>& signs;
    const std::vector<Cluster>& clusters;
    const expression::Tape& tape;
    const Limits& limits;
    std::function<bool()> is_too_large;  ///< of the tree as it stands
    const RunControl& control;
};

/// A W that reaches about `reach` to both sides of the zero set wherever critical leaves allow it.
///
/// Result: all conditions hold for it on the tree, which may have been refined; or nothing, the tree being what it was.
std::optional<ProvedW> thicken(const Thickening& from, double reach);

}  // namespace certa::implicit
