#pragma once
// Clusters of critical leaves, and the degree of the gradient around each.
#include <cstdint>
#include <vector>

#include "implicit/octree.h"

namespace certa::implicit {

/// Critical leaves that are connected through shared points.
struct Cluster {
    std::vector<std::uint32_t> leaves;
    int sign = 0;            ///< of f on all of them
    bool outermost = false;  ///< touches the box: lies in the unbounded component, its degree is not needed
    int degree = 0;          ///< of grad f / |grad f| on its boundary
};

/// Finds the clusters of an octree whose leaves are all settled, and their degrees.
///
/// Guarantee: the degree is a sum over labels that are proved on whole squares (docs/implicit-theorem.md, "degree"); it
/// is
///            computed three times with the roles of the axes exchanged, and InternalError says when they disagree.
std::vector<Cluster> find_clusters(const Octree& tree);

}  // namespace certa::implicit
