// Directed edges must occur once each with their opposites (closed, oriented, two triangles per edge); the triangles
// around a vertex must be one cycle (no pinches); the genus of a component follows from its Euler characteristic.
#include "implicit/topology.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "core/vector3.h"

namespace certa::test {
namespace {

std::uint32_t find(std::vector<std::uint32_t>& parents, std::uint32_t i) {
    while (parents[i] != i) i = parents[i] = parents[parents[i]];
    return i;
}

/// Around vertex v, `next` leads from each neighbour to the following one.
bool is_one_cycle(const std::map<std::uint32_t, std::uint32_t>& next) {
    std::size_t steps = 0;
    std::uint32_t at = next.begin()->first;
    do {
        const auto found = next.find(at);
        if (found == next.end()) return false;
        at = found->second;
        ++steps;
    } while (at != next.begin()->first && steps <= next.size());
    return steps == next.size();
}

}  // namespace

MeshTopology measure(const TriangleMesh& mesh) {
    MeshTopology result;
    const std::size_t count = mesh.positions.size();
    std::vector<std::map<std::uint32_t, std::uint32_t>> next(count);
    std::vector<std::uint32_t> parents(count);
    std::iota(parents.begin(), parents.end(), 0u);
    for (const Triangle& triangle : mesh.triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = index_of(triangle[i]), b = index_of(triangle[(i + 1) % 3]),
                                c = index_of(triangle[(i + 2) % 3]);
            if (a == b) result.flaw = "a triangle repeats a vertex";
            if (!next[a].emplace(b, c).second) result.flaw = "a directed edge occurs twice";
            parents[find(parents, a)] = find(parents, b);
            result.longest_edge = std::max(result.longest_edge, distance(mesh.positions[a], mesh.positions[b]));
        }
        const Point3 &p = mesh.positions[index_of(triangle[0])], &q = mesh.positions[index_of(triangle[1])],
                     &r = mesh.positions[index_of(triangle[2])];
        result.signed_volume += dot(p, cross(q, r)) / 6;
    }
    if (!result.flaw.empty()) return result;
    std::map<std::uint32_t, int> euler;
    for (std::uint32_t v = 0; v < count; ++v) {
        if (next[v].empty() || !is_one_cycle(next[v])) {
            result.flaw = "the triangles around a vertex are no cycle";
            return result;
        }
        // Vertices count 1, edges half at each end, triangles a third at each corner; times 6.
        const int degree = static_cast<int>(next[v].size());
        euler[find(parents, v)] += 6 - 3 * degree + 2 * degree;
    }
    for (const auto& [root, six_times] : euler) result.genera.push_back(1 - six_times / 12);
    std::sort(result.genera.begin(), result.genera.end());
    return result;
}

}  // namespace certa::test
