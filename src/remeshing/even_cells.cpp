// Even cells, as long as they are as sound as the network's.
#include "remeshing/even_out.h"
#include "remeshing/remesher.h"
#include "remeshing/templates.h"

namespace certa::remeshing {

/// Slides the vertices of the network's polygons. Where that breaks some, their vertices go back, farther around them
/// each time.
void Remesher::even_cells(CoarseMesh& polygons) {
    constexpr int most_rounds = 6;
    CoarseMesh even = polygons;
    if (options_.output == RemeshOutput::polygons) {
        // As quads and triangles, which have a shape to be even in.
        CoarseMesh filled = make_quad_dominant(polygons);
        even_out(mesh_, field_, best_->spacing, *tree_, filled, control_);
        even.points = filled.points, even.places = filled.places;
    } else {
        even_out(mesh_, field_, best_->spacing, *tree_, even, control_);
    }
    for (int round = 0; round < most_rounds && !control_.cancelled(); ++round) {
        double reach = best_->reach;
        const std::vector<Index> broken = broken_faces(*best_, even, reach);
        if (broken.size() <= best_->broken) {
            polygons = std::move(even);
            return;
        }
        std::vector<std::uint8_t> goes_back(even.points.size(), 0);
        for (Index q = 0; q < even.polygon_count(); ++q)
            if (std::binary_search(broken.begin(), broken.end(), even.parent(q)))
                for (const Index v : even.polygon(q)) goes_back[v] = 1;
        for (int ring = 0; ring < round; ++ring) mark_around(even, goes_back);
        for (Index v = 0; v < goes_back.size(); ++v)
            if (goes_back[v] != 0) even.points[v] = polygons.points[v], even.places[v] = polygons.places[v];
    }
}

/// What will be mended gets corners where the network has its nodes: around it, vertices go back there before, and are
/// placed again, if that leaves less to mend.
void Remesher::undo_evening() {
    constexpr int rings = 2;
    Judge judge{input_, *tree_, mesh_.diagonal, is_embedded_.value_or(true), mesh_.is_cut_open};
    CoarseMesh mesh;
    const auto find_unsound = [&] {
        mesh = recut(filled_, recuts_);
        std::vector<Index> polygons = judge_input(mesh, judge).polygons;
        for (const MissedCrease& missed : missed_creases(mesh, judge)) polygons.push_back(missed.polygon);
        sort_unique(polygons);
        return polygons;
    };
    const std::vector<Index> unsound = find_unsound();
    if (unsound.empty()) return;
    std::vector<std::uint8_t> goes_back(placed_.points.size(), 0);
    for (const Index q : unsound)
        for (const Index v : mesh.polygon(q))
            if (v < goes_back.size()) goes_back[v] = 1;
    for (int ring = 0; ring < rings; ++ring) mark_around(placed_, goes_back);
    const CoarseMesh& network = best_->polygons;
    const CoarseMesh filled = filled_, placed = placed_, judged = judged_;
    const std::vector<double> farthest = farthest_;
    const double rms = rms_;
    for (Index v = 0; v < network.points.size(); ++v)
        if (goes_back[v] != 0) filled_.points[v] = network.points[v], filled_.places[v] = network.places[v];
    PlacementOptions options;
    options.rounds = 3;
    options.peak_rounds = 3;
    CoarseMesh whole = recut(filled_, recuts_);
    place(whole, options);
    take_places(whole);
    if (find_unsound().size() < unsound.size()) return;
    filled_ = filled, placed_ = placed, judged_ = judged;
    farthest_ = farthest, rms_ = rms;
}

}  // namespace certa::remeshing
