// Equal points of a soup as one, for those who look at a remeshed soup beside its input (remesh, stage 1).
#include <certa/remeshing.h>

#include <algorithm>

#include "remeshing/work_mesh.h"

namespace certa {
namespace {

/// Sides that no other triangle has the other way round.
std::size_t count_open(const TriangleMesh& mesh, const std::vector<remeshing::Index>& first) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> sides;
    for (const Triangle& t : mesh.triangles)
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = first[index_of(t[i])], b = first[index_of(t[(i + 1) % 3])];
            if (a != b) sides.push_back({std::min(a, b), std::max(a, b)});
        }
    std::sort(sides.begin(), sides.end());
    std::size_t open = 0;
    for (std::size_t i = 0; i < sides.size();) {
        std::size_t end = i + 1;
        while (end < sides.size() && sides[end] == sides[i]) ++end;
        open += end - i == 1 ? 1 : 0;
        i = end;
    }
    return open;
}

}  // namespace

WeldedSurface weld_surface(const TriangleMesh& mesh) {
    WeldedSurface welded{mesh, {}, 0};
    std::vector<remeshing::Index> own(mesh.positions.size());
    for (remeshing::Index v = 0; v < own.size(); ++v) own[v] = v;
    std::vector<remeshing::Index> first = remeshing::merge_points(mesh.positions);
    const bool joins = first != own && count_open(mesh, first) < count_open(mesh, own);
    if (!joins) first = own;
    for (const remeshing::Index v : first) welded.numbers.push_back(VertexId{v});
    if (!joins) return welded;
    welded.mesh.triangles.clear();
    for (const Triangle& t : mesh.triangles) {
        const Triangle renamed{welded.numbers[index_of(t[0])], welded.numbers[index_of(t[1])],
                               welded.numbers[index_of(t[2])]};
        if (renamed[0] == renamed[1] || renamed[1] == renamed[2] || renamed[2] == renamed[0]) continue;
        welded.mesh.triangles.push_back(renamed);
    }
    for (remeshing::Index v = 0; v < own.size(); ++v) welded.merged += first[v] != v ? 1 : 0;
    return welded;
}

}  // namespace certa
