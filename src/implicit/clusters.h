#pragma once
// Clusters of critical leaves, and the degree of the gradient around each.
#include <cstdint>
#include <vector>

#include "implicit/octree.h"

namespace certa::implicit {

/// Critical leaves that are connected through shared points.
struct Cluster {
    std::vector<std::uint32_t> leaves;
    int sign = 0;              ///< of f on all of them
    bool touches_box = false;  ///< a box that the surface may not meet: it lies outside, its degree is not needed
    /// Of grad f / |grad f| on the boundary of its eight copies, f being continued by reflection across the faces of
    /// the box: 8 times the degree around a cluster that misses the box.
    int degree8 = 0;
};

/// Finds the clusters of an octree whose leaves are all settled, and their degrees.
///
/// Guarantee: the degree is a sum over labels that are proved on whole squares (docs/implicit-theorem.md, "degree"); it
/// is
///            computed three times with the roles of the axes exchanged, and InternalError says when they disagree.
std::vector<Cluster> find_clusters(const Octree& tree);

}  // namespace certa::implicit
