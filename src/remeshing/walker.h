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

    /// The nearest point as far as triangle after triangle from `start` on can tell, nearer each time; nothing where
    /// that takes many steps or ends in a vertex. Right where p is near the mesh and the start near p (not beyond
    /// centres of curvature), and several times as fast as a tree there.
    std::optional<core::NearestPoint> find(const Point3& p, Index start) const;

private:
    std::span<const Point3> positions_;
    std::span<const Triangle> triangles_;
    std::vector<std::array<Index, 3>> beside_;  ///< across the side opposite to each corner; no_index: nothing
};

}  // namespace certa::remeshing
