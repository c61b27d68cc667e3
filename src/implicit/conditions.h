#pragma once
// The conditions of the theorem on T and W, and where they fail.
#include <array>
#include <cstdint>
#include <vector>

#include "implicit/clusters.h"
#include "implicit/growth.h"
#include "implicit/triangulation.h"

namespace certa::implicit {

/// A component V of W and of the surface in it.
struct ComponentOfW {
    std::uint32_t first_point = none;  ///< lowest marked point
    int euler8 = 0;       ///< of the eight reflected copies of the surface in V: 8 times its own if it misses the box
    int edge_points = 0;  ///< vertices of the surface on edges of the box
    int loops = 0;        ///< boundary loops of the surface
    int inner_sign = 0;   ///< of f just inside V
    int degree8 = 0;      ///< of grad f over the eight copies of everything that V encloses
    std::uint32_t parent = none;  ///< the component next around it
    /// Euler characteristic of the surface in V: of its copies, interior points count 8 times, those in faces 4 times,
    /// those on edges twice; a boundary has as many open arcs in faces as points on edges.
    int euler() const { return (euler8 + 2 * edge_points) / 8; }
    /// From the Euler characteristic of the surface with a disk glued to each loop.
    int genus() const { return (2 - euler() - loops) / 2; }
};

struct Findings {
    std::vector<std::uint32_t> offenders;  ///< leaves to split; empty: every condition holds
    const char* condition = nullptr;       ///< the first one that failed
    std::vector<ComponentOfW> components;
    std::vector<std::uint32_t> component_of_point;  ///< per point: position in `components`, none for unmarked ones
};

/// A face of T on which a sign of f is proved: its points, sorted, the last one repeated where there are fewer.
struct ProvedFace {
    std::array<std::uint32_t, 3> points;
    int sign;
};

/// Checks, in this order: every tetrahedron with both signs has all its points marked (conditions 3 and M^ in the
/// interior of W); f has the declared sign on the largest marked face of every tetrahedron outside W (condition 1); per
/// component of W, the degree of grad f over what it encloses is +-chi/2 (condition 4*). Of a clipped box "encloses"
/// means the side away from the corner (0, 0, 0), and the eight copies are compared (docs/implicit-theorem.md).
/// Conditions 0 and 2 hold by construction: see docs/implicit-theorem.md.
///
/// `proved` is what is known of the frontier of the round before, in the order of points, and becomes what is known of
/// this one: most faces are in both. All rounds must be of one tree and function.
Findings check_conditions(const Octree& tree, const Triangulation& triangulation, const Growth& growth,
                          const std::vector<Cluster>& clusters, const expression::Tape& tape, const RunControl& control,
                          std::vector<ProvedFace>& proved);
Findings check_conditions(const Octree& tree, const Triangulation& triangulation, const Growth& growth,
                          const std::vector<Cluster>& clusters, const expression::Tape& tape,
                          const RunControl& control);

}  // namespace certa::implicit
