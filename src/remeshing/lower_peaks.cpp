// Peaks of the distance where a count is the goal: a few polygons that no placement brings near.
#include <algorithm>

#include "remeshing/remesher.h"

namespace certa::remeshing {

/// What is many root mean squares away, as long as that is little, is cut along its best diagonal, then around new
/// vertices, and all is placed again with the largest distances in mind.
void Remesher::lower_peaks() {
    constexpr double far_away = 7.5, most_share = 0.02;
    constexpr int most_rounds = 2;
    if (!options_.placement || options_.output != RemeshOutput::quad_dominant) return;
    const auto find_far = [&] {
        std::vector<Index> far;
        for (Index q = 0; q < farthest_.size(); ++q)
            if (farthest_[q] > far_away * rms_) far.push_back(q);
        return far;
    };
    PlacementOptions options;
    options.rounds = 0;
    options.peak_rounds = 4;
    for (int round = 0; round < most_rounds && !control_.cancelled(); ++round) {
        if (find_far().empty()) return;
        if (round == 0) {
            drop_harmful_recuts();
            CoarseMesh whole = recut(filled_, recuts_);
            place(whole, options);
            take_places(whole);
        }
        const std::vector<Index> far = find_far();
        if (double(far.size()) > most_share * double(farthest_.size())) return;
        CoarseMesh mesh = judged_;
        if (!cut_far(far, filled_.points.size() == placed_.points.size(), mesh)) return;
        place(mesh, options);
        take_places(mesh);
    }
}

}  // namespace certa::remeshing
