// A few rounds, judged as mending is.
#include "remeshing/place_around.h"

#include <algorithm>

namespace certa::remeshing {

void place_around(const WorkMesh& surface, const Judge& judge, Index first_added, const PlaceMesh& place,
                  const std::function<std::vector<Index>(CoarseMesh&)>& find_broken, CoarseMesh& mesh) {
    constexpr int most_tries = 4;
    if (2 * static_cast<std::size_t>(first_added) < mesh.points.size()) return;  // there is little to place
    PlacementOptions options;
    options.rounds = 3;
    options.peak_rounds = 4;
    options.fixed_from = first_added;
    CoarseMesh placed = mesh;
    place(placed, options);
    std::vector<Index> unused;
    const double missed = add_missed_creases(surface, judge, mesh, judge.diagonal, unused);
    for (int round = 0; round < most_tries; ++round) {
        CoarseMesh looked_at = placed;
        std::vector<Index> broken = find_broken(looked_at);
        const double most = std::max(missed, 0.9 * reach_of(surface, judge, looked_at));
        add_missed_creases(surface, judge, looked_at, most, broken);
        if (broken.empty()) {
            mesh = std::move(looked_at);
            return;
        }
        for (const Index q : broken)
            for (const Index v : looked_at.polygon(q)) placed.points[v] = mesh.points[v];
    }
}

}  // namespace certa::remeshing
