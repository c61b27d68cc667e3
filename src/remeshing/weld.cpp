// Equal points of a soup as one, for those who look at a remeshed soup beside its input (remesh, stage 1).
#include <certa/remeshing.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "core/union_find.h"
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

namespace remeshing {

std::vector<Index> joined_points(const TriangleMesh& mesh) {
    std::vector<Index> own(mesh.positions.size());
    std::iota(own.begin(), own.end(), 0U);
    std::vector<Index> first = merge_points(mesh.positions);
    if (first == own || count_open(mesh, first) < count_open(mesh, own)) return first;
    core::UnionFind sets(own.size());
    for (const Triangle& t : mesh.triangles)
        for (std::size_t i = 0; i < 3; ++i) {
            const Index a = index_of(t[i]), b = index_of(t[(i + 1) % 3]);
            if (first[a] == first[b]) sets.unite(a, b);
        }
    std::vector<Index> least(own.size(), no_index);
    for (Index v = 0; v < own.size(); ++v) {
        Index& set = least[sets.find(v)];
        if (set == no_index) set = v;
        own[v] = set;
    }
    return own;
}

}  // namespace remeshing

WeldedSurface weld_surface(const TriangleMesh& mesh) {
    WeldedSurface welded{mesh, {}, 0};
    const std::vector<remeshing::Index> first = remeshing::joined_points(mesh);
    for (remeshing::Index v = 0; v < first.size(); ++v) {
        welded.numbers.push_back(VertexId{first[v]});
        welded.merged += first[v] != v ? 1 : 0;
    }
    std::vector<std::array<std::uint32_t, 4>> sorted;  // corners and number
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        std::array<std::uint32_t, 3> c{};
        for (std::size_t i = 0; i < 3; ++i) c[i] = first[index_of(mesh.triangles[t][i])];
        std::sort(c.begin(), c.end());
        if (c[0] != c[1] && c[1] != c[2]) sorted.push_back({c[0], c[1], c[2], static_cast<std::uint32_t>(t)});
    }
    std::sort(sorted.begin(), sorted.end());
    std::vector<std::uint32_t> kept;
    for (std::size_t i = 0; i < sorted.size(); ++i)
        if (i == 0 || !std::equal(sorted[i].begin(), sorted[i].begin() + 3, sorted[i - 1].begin()))
            kept.push_back(sorted[i][3]);
    std::sort(kept.begin(), kept.end());
    welded.mesh.triangles.clear();
    for (const std::uint32_t t : kept) {
        const Triangle& c = mesh.triangles[t];
        welded.mesh.triangles.push_back(
            {welded.numbers[index_of(c[0])], welded.numbers[index_of(c[1])], welded.numbers[index_of(c[2])]});
    }
    return welded;
}

}  // namespace certa
