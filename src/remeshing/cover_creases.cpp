// Short creases that polygons miss: a vertex on each, before mending would have to put triangles of the input there.
#include <certa/distance.h>
#include <certa/io.h>

#include "remeshing/cut_far.h"
#include "remeshing/remesher.h"

namespace certa::remeshing {

/// Points of creases that are farther away than mending will allow. That goes by the bound on the distance, which takes
/// a while: first by what is surely less.
std::vector<MissedCrease> Remesher::missed_creases(const CoarseMesh& mesh, const Judge& judge) const {
    constexpr double safely = 0.97, of_error = 0.85, of_reach = 0.9;
    if (wanted_count() == 0.0) return find_missed_creases(mesh_, judge, mesh, of_error * wanted_error());
    if (find_missed_creases(mesh_, judge, mesh, of_reach * reach_of(mesh_, judge, mesh)).empty()) return {};
    PolygonMesh polygons{mesh.points, {}, mesh.offsets};
    for (const Index v : mesh.corners) polygons.corners.push_back(VertexId{v});
    DistanceOptions options;
    options.samples = 10000;
    const double bound = measure_distance(polygons, make_polygon_mesh(input_), options, control_).hausdorff_bound;
    return find_missed_creases(mesh_, judge, mesh, safely * mending_rule(0.0).cover * bound);
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
