// A few rounds, judged as mending is.
#include "remeshing/place_around.h"

#include <certa/distance.h>
#include <certa/io.h>

#include <limits>

namespace certa::remeshing {
namespace {

/// Adds polygons that miss creases by more than the check allows, which goes by the bound on the distance.
void add_creases(const WorkMesh& surface, const Judge& judge, const CoarseMesh& mesh, std::vector<Index>& broken) {
    constexpr double cover = 0.94, anything = std::numeric_limits<double>::infinity();
    std::vector<Index> unused;
    if (add_missed_creases(surface, judge, mesh, anything, unused) <= 0.9 * reach_of(surface, judge, mesh)) return;
    PolygonMesh polygons{mesh.points, {}, mesh.offsets};
    for (const Index v : mesh.corners) polygons.corners.push_back(VertexId{v});
    DistanceOptions options;
    options.samples = 10000;
    const double bound = measure_distance(polygons, make_polygon_mesh(judge.input), options).hausdorff_bound;
    add_missed_creases(surface, judge, mesh, cover * bound, broken);
}

}  // namespace

void place_around(const WorkMesh& surface, const Judge& judge, Index first_added, const PlaceMesh& place,
                  const std::function<std::vector<Index>(CoarseMesh&)>& find_broken, CoarseMesh& mesh) {
    constexpr int most_tries = 6;
    if (2 * static_cast<std::size_t>(first_added) < mesh.points.size()) return;  // there is little to place
    PlacementOptions options;
    options.rounds = 3;
    options.peak_rounds = 4;
    options.fixed_from = first_added;
    CoarseMesh placed = mesh;
    place(placed, options);
    for (int round = 0; round < most_tries; ++round) {
        CoarseMesh looked_at = placed;
        std::vector<Index> broken = find_broken(looked_at);
        if (broken.empty()) add_creases(surface, judge, looked_at, broken);
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
