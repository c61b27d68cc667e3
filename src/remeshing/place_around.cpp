// A few rounds, judged as mending is.
#include "remeshing/place_around.h"

namespace certa::remeshing {

void place_around(Index first_added, const PlaceMesh& place,
                  const std::function<std::vector<Index>(CoarseMesh&)>& find_broken, CoarseMesh& mesh,
                  const RunControl& control) {
    constexpr int most_tries = 6;
    if (2 * static_cast<std::size_t>(first_added) < mesh.points.size()) return;  // there is little to place
    PlacementOptions options;
    options.rounds = 3;
    options.peak_rounds = 4;
    options.fixed_from = first_added;
    CoarseMesh placed = mesh;
    place(placed, options);
    for (int round = 0; round < most_tries && !control.cancelled(); ++round) {
        CoarseMesh looked_at = placed;
        const std::vector<Index> broken = find_broken(looked_at);
        if (broken.empty()) {
            mesh = std::move(looked_at);
            return;
        }
        // What does not help here helps farther around.
        std::vector<std::uint8_t> goes_back(placed.points.size(), 0);
        for (const Index q : broken)
            for (const Index v : looked_at.polygon(q)) goes_back[v] = 1;
        for (int ring = 0; ring < round; ++ring) mark_around(looked_at, goes_back);
        for (Index v = 0; v < goes_back.size(); ++v)
            if (goes_back[v] != 0) placed.points[v] = mesh.points[v];
    }
}

}  // namespace certa::remeshing
