#pragma once
// From triangle to triangle to the nearest point.
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "core/triangle_tree.h"
#include "remeshing/coarse_mesh.h"

namespace certa::remeshing {

/// Over a mesh that stays as it is; queries may run at the same time.
class Walker {
public:
    Walker(std::span<const Point3> positions, std::span<const Triangle> triangles);

    /// A point of the mesh to which none across an edge is nearer, found from `start` in a few steps; nothing where
    /// that takes more of them or ends in a vertex. Several times as fast as a tree where the start is near.
    std::optional<core::NearestPoint> find(const Point3& p, Index start) const;

private:
    std::span<const Point3> positions_;
    std::span<const Triangle> triangles_;
    std::vector<std::array<Index, 3>> beside_;  ///< across the side opposite to each corner; no_index: nothing
};

}  // namespace certa::remeshing
