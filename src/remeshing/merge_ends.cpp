// Short sides first; what a contraction makes shorter comes into the queue anew.
#include "remeshing/merge_ends.h"

#include <algorithm>
#include <queue>

#include "core/vector3.h"

namespace certa::remeshing {
namespace {

constexpr double smooth_share = 0.5;  ///< of the reach, for sides that are on no feature

struct Candidate {
    double length = 0.0;
    Index a = no_index, b = no_index;
    friend bool operator<(const Candidate& l, const Candidate& r) {  // the shortest first
        if (l.length != r.length) return l.length > r.length;
        return l.a != r.a ? l.a > r.a : l.b > r.b;
    }
};

}  // namespace

std::vector<MergedVertex> merge_line_ends(CoarseMesh& mesh, std::span<const double> reach,
                                          const ArrangementRule& rule) {
    Contraction contraction(mesh, rule);
    std::priority_queue<Candidate> queue;
    const auto push = [&](Index a, Index b) {
        const double length = distance(mesh.points[a], mesh.points[b]), most = std::min(reach[a], reach[b]);
        if (length < (contraction.is_feature_side(a, b) ? most : smooth_share * most))
            queue.push({length, std::min(a, b), std::max(a, b)});
    };
    const auto merge = [&](Index v, Index into) {
        const std::vector<Index> around = contraction.neighbours(v);
        if (!std::binary_search(around.begin(), around.end(), into) || !contraction.merge(v, into)) return false;
        for (const Index x : around)
            if (x != into) push(into, x);
        return true;
    };
    for (Index q = 0; q < contraction.polygon_count(); ++q) {
        const std::vector<Index>& ring = contraction.ring(q);
        for (std::size_t i = 0; i < ring.size(); ++i) push(ring[i], ring[(i + 1) % ring.size()]);
    }
    while (!queue.empty()) {
        const Candidate next = queue.top();
        queue.pop();
        if (contraction.around(next.a).empty() || contraction.around(next.b).empty()) continue;
        if (!merge(next.b, next.a)) merge(next.a, next.b);
    }
    return contraction.write_back();
}

}  // namespace certa::remeshing
