// Short creases that polygons miss: a vertex on each, before mending would have to put triangles of the input there.
#include <cmath>

#include "remeshing/cut_far.h"
#include "remeshing/remesher.h"

namespace certa::remeshing {

/// Points of creases that are farther away than mending will allow, or nearly so.
std::vector<MissedCrease> Remesher::missed_creases(const CoarseMesh& mesh, const Judge& judge) const {
    constexpr double nearly = 0.97, of_error = 0.85;
    if (wanted_count() == 0.0) return find_missed_creases(mesh_, judge, mesh, of_error * wanted_error());
    CreaseRule rule = mending_rule(0.0).creases;
    rule.of_bound *= nearly;
    const double limit = crease_limit(rule, mesh_, judge, mesh, control_);
    if (std::isinf(limit)) return {};
    return find_missed_creases(mesh_, judge, mesh, limit);
}

/// Polygons are cut around points of creases that they miss, where that breaks nothing.
void Remesher::cover_creases() {
    constexpr int most_rounds = 3;
    if (options_.output != RemeshOutput::quad_dominant || filled_.points.size() != placed_.points.size()) return;
    Judge judge{input_, *tree_, mesh_.diagonal, is_embedded_.value_or(true), mesh_.is_cut_open};
    for (int round = 0; round < most_rounds && !control_.cancelled(); ++round) {
        CoarseMesh mesh = recut(placed_, recuts_);
        const std::vector<MissedCrease> missed = missed_creases(mesh, judge);
        if (missed.empty()) return;
        const auto before = static_cast<Index>(mesh.points.size());
        std::vector<Recut> recuts = cut_around_points(mesh, missed, *tree_);
        // What they break is not done.
        for (;;) {
            CoarseMesh looked_at = recut(mesh, recuts);
            std::vector<std::uint8_t> is_bad(mesh.points.size(), 0);
            for (const Index q : judge_input(looked_at, judge).polygons)
                for (const Index v : looked_at.polygon(q)) is_bad[v] = 1;
            const std::size_t gone =
                std::erase_if(recuts, [&](const Recut& r) { return is_bad[r.after.front().back()] != 0; });
            if (gone == 0) break;
        }
        if (recuts.empty()) return;
        for (Index v = before; v < mesh.points.size(); ++v) {
            placed_.add_vertex(mesh.points[v], mesh.places[v]);
            filled_.add_vertex(mesh.points[v], mesh.places[v]);
        }
        recuts_.insert(recuts_.end(), recuts.begin(), recuts.end());
    }
}

}  // namespace certa::remeshing
