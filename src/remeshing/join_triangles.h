#pragma once
// Fewer triangles than T-nodes ask for: two that are near each other become quads with what lies between them.
#include "remeshing/coarse_mesh.h"

namespace certa::remeshing {

/// Polygons (by their corners, from any of them on) and what covers the same in their place. Those of one may come
/// from another before it.
struct Recut {
    std::vector<std::vector<Index>> before, after;
};

/// Ways to cut anew what two triangles cover with the quads on a short way between them (none, one or two), where that
/// gives quads only, well shaped, and nothing is bent by more than 30 degrees. Sides on features stay, and all
/// vertices. Deterministic.
std::vector<Recut> find_recuts(const CoarseMesh& mesh);

/// Does those, in order, of which all polygons are there. Faces of the graph that share pieces are listed in `joined`.
CoarseMesh recut(const CoarseMesh& mesh, const std::vector<Recut>& recuts);

}  // namespace certa::remeshing
