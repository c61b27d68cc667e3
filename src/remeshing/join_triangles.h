#pragma once
// Fewer triangles than T-nodes ask for: two that are near each other become quads with what lies between them.
#include <unordered_map>

#include "core/triangle_tree.h"
#include "remeshing/coarse_mesh.h"

namespace certa::remeshing {

/// Polygons (by their corners, from any of them on) and what covers the same in their place. Those of one may come
/// from another before it.
struct Recut {
    std::vector<std::vector<Index>> before, after;
};

/// The sides of a mesh by their ends (pair_key): those on features, sorted, and the polygons beside each.
struct SideTable {
    explicit SideTable(const CoarseMesh& mesh);
    std::vector<std::uint64_t> features;
    std::unordered_map<std::uint64_t, std::array<Index, 2>> beside;
};

/// Ways to cut anew what two triangles cover with the quads on a short way between them (none, one or two), where that
/// gives quads only, well shaped, and nothing is bent by more than 30 degrees. Sides on features stay, and all
/// vertices. Deterministic.
std::vector<Recut> find_recuts(const CoarseMesh& mesh);

/// Two polygons whose common side passes the input by more than `limit`: triangles, where they have diagonals that are
/// half as far at most. Nothing turns away. Deterministic.
std::vector<Recut> find_far_recuts(const CoarseMesh& mesh, const core::TriangleTree& input, double limit);

/// Does those, in order, of which all polygons are there. Faces of the graph that share pieces are listed in `joined`.
CoarseMesh recut(const CoarseMesh& mesh, const std::vector<Recut>& recuts);

}  // namespace certa::remeshing
