#pragma once
// Where W ends: what a mesh in W has to keep away from.
#include <cstdint>
#include <vector>

#include "implicit/growth.h"
#include "implicit/octree.h"
#include "implicit/separation.h"
#include "implicit/triangulation.h"

namespace certa::implicit {

/// The triangles of T with exactly one tetrahedron of W.
class Frontier {
public:
    Frontier(const Octree& tree, const Triangulation& triangulation, const Growth& growth);

    /// True only if a triangle keeps away from all of them.
    bool is_clear(const Corners& t) const;
    /// Appends the leaves on both sides of those that it does not keep away from.
    void find_leaves(const Corners& t, std::vector<std::uint32_t>& leaves) const;
    std::size_t size() const { return faces_.size(); }

private:
    struct Node {
        Bounds box;
        std::uint32_t begin, end, second;  ///< the first child follows; second 0: a leaf
    };
    template <class Visit>
    void visit(const Bounds& box, const Visit& visit) const;
    void build(std::uint32_t begin, std::uint32_t end);
    std::vector<Corners> faces_;
    std::vector<std::uint32_t> leaves_;  ///< per face: the leaf of its tetrahedron of W
    std::vector<Bounds> boxes_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
};

}  // namespace certa::implicit
