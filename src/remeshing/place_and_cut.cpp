// Rounds of both; numbers of rounds are what the models of the benchmark gain by.
#include "remeshing/place_and_cut.h"

#include <algorithm>

namespace certa::remeshing {

std::vector<Recut> place_and_cut(const CoarseMesh& polygons, const core::TriangleTree& input, const PlaceMesh& place,
                                 bool is_quick, CoarseMesh& coarse) {
    constexpr double far_at_first = 4.0, far_in_the_end = 8.0;  // in root mean squares
    std::vector<Recut> recuts;
    PlacementOptions options;
    options.rounds = 4;
    options.peak_rounds = 0;
    CoarseMesh cut = coarse, known = polygons;  // with open faces, and without
    const auto place_all = [&](double far) {
        const double rms = place(cut, options).rms_after;
        coarse.points = cut.points;
        coarse.places = cut.places;
        std::copy_n(cut.points.begin(), known.points.size(), known.points.begin());
        const std::vector<Recut> found = find_far_recuts(recut(known, recuts), input, far * rms);
        recuts.insert(recuts.end(), found.begin(), found.end());
        return !found.empty();
    };
    place_all(far_at_first);
    const std::vector<Recut> joins = find_recuts(recut(known, recuts));
    recuts.insert(recuts.end(), joins.begin(), joins.end());
    options = {};
    options.rounds = is_quick ? 2 : 5;
    options.peak_rounds = is_quick ? 5 : 10;
    for (int round = 0; round < 2; ++round) {
        cut = recut(coarse, recuts);
        if (!place_all(far_in_the_end) || is_quick) break;
        options.rounds = 1;
        options.peak_rounds = 4;
    }
    return recuts;
}

}  // namespace certa::remeshing
