// Peaks of the distance where a count is the goal: a few polygons that no placement brings near.
#include <algorithm>
#include <cmath>

#include "remeshing/cut_far.h"
#include "remeshing/remesher.h"

namespace certa::remeshing {
namespace {

constexpr double far_away = 7.5, most_share = 0.02;

}  // namespace

/// What is many root mean squares away, as long as that is little.
std::vector<Index> Remesher::find_peaks() const {
    std::vector<Index> far;
    for (Index q = 0; q < farthest_.size(); ++q)
        if (farthest_[q] > far_away * rms_) far.push_back(q);
    return far;
}

/// Peaks are cut along their best diagonal, then around new vertices, and all is placed again with the largest
/// distances in mind.
void Remesher::lower_peaks() {
    constexpr int most_rounds = 2;
    if (!options_.placement || options_.output != RemeshOutput::quad_dominant) return;
    PlacementOptions options;
    options.rounds = 0;
    options.peak_rounds = 4;
    for (int round = 0; round < most_rounds && !control_.cancelled(); ++round) {
        if (find_peaks().empty()) return;
        if (round == 0) {
            drop_harmful_recuts();
            CoarseMesh whole = recut(filled_, recuts_);
            place(whole, options);
            take_places(whole);
        }
        const std::vector<Index> far = find_peaks();
        if (double(far.size()) > most_share * double(farthest_.size())) return;
        CoarseMesh mesh = judged_;
        if (!cut_far(far, filled_.points.size() == placed_.points.size(), mesh)) return;
        place(mesh, options);
        take_places(mesh);
    }
}

/// Mending leaves peaks, too, where corners have gone back to the network. Whether something was cut.
bool Remesher::cut_last_peaks(Judge& judge, CoarseMesh& mesh) {
    if (options_.output != RemeshOutput::quad_dominant || control_.cancelled()) return false;
    PlacementOptions only_measured;
    only_measured.rounds = only_measured.peak_rounds = 0;
    CoarseMesh next = mesh;
    place(next, only_measured);
    const std::vector<Index> far = find_peaks();
    if (far.empty() || double(far.size()) > most_share * double(farthest_.size())) return false;
    next = mesh;
    const std::vector<Recut> recuts = cut_far_polygons(next, far, *tree_, true);
    if (recuts.empty()) return false;
    next = recut(next, recuts);
    if (!judge_input(next, judge).polygons.empty()) return false;
    // Lower peaks mean that creases have to be nearer, too.
    const double limit = crease_limit(mending_rule(0.0).creases, mesh_, judge, next, control_);
    if (!std::isinf(limit) && !find_missed_creases(mesh_, judge, next, limit).empty()) return false;
    mesh = std::move(next);
    return true;
}

}  // namespace certa::remeshing
