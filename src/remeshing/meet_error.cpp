// An error as the goal: networks, closer where it is not kept, until little is left to mend (remesh, stage 12).
#include <certa/distance.h>
#include <certa/io.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/triangle_tree.h"
#include "remeshing/cut_far.h"
#include "remeshing/remesher.h"
#include "remeshing/templates.h"

namespace certa::remeshing {

/// Lines come closer together around polygons that are farther than `limit`: distances go like squares of spacing.
void Remesher::refine_where_far(double error, double limit) {
    const Spacing spacing = compute_spacing(mesh_, field_, rule_of(error), caps_.at(error));
    for (std::size_t q = 0; q < judged_.polygon_count(); ++q) {
        if (farthest_[q] <= limit) continue;
        const double factor = std::clamp(std::sqrt(0.9 * limit / farthest_[q]), 0.5, 0.9);
        for (const Index v : judged_.polygon(q)) {
            const Index f = judged_.places[v].face;
            for (Index c = 3 * f; c < 3 * f + 3; ++c) caps_.lower_families(mesh_.wedges[c], factor, spacing);
        }
    }
}

/// The share of the placed polygons that are farther from the input than `limit`, as far as samples show.
double Remesher::far_share(double limit) const {
    const auto far = std::count_if(farthest_.begin(), farthest_.end(), [&](double d) { return d > limit; });
    return static_cast<double>(far) / static_cast<double>(farthest_.size());
}

/// So far is this share of the placed polygons at most.
double Remesher::far_quantile(double share) const {
    std::vector<double> sorted = farthest_;
    std::sort(sorted.begin(), sorted.end());
    return sorted[std::min(sorted.size() - 1, static_cast<std::size_t>(share * double(sorted.size())))];
}

/// Polygons of the mesh as it is placed and cut that are farther than `limit`, or cannot be shown not to be.
std::vector<Index> Remesher::far_polygons(double limit) const {
    constexpr std::uint64_t pieces = 200000;
    PolygonMesh mesh{judged_.points, {}, judged_.offsets};
    for (const Index v : judged_.corners) mesh.corners.push_back(VertexId{v});
    std::vector<Index> far;
    for (const FarPlace& place : find_far_places(mesh, make_polygon_mesh(input_), limit, pieces, control_))
        far.push_back(place.is_on_first ? place.polygon : place.nearest);
    std::sort(far.begin(), far.end());
    far.erase(std::unique(far.begin(), far.end()), far.end());
    return far;
}

/// Cuts polygons of the mesh, which is the one judged last, and takes over the vertices that this adds. False: there is
/// nothing to cut.
bool Remesher::cut_far(const std::vector<Index>& far, bool may_add, CoarseMesh& mesh) {
    const std::size_t before = mesh.points.size();
    const std::vector<Recut> recuts = cut_far_polygons(mesh, far, *tree_, may_add);
    if (recuts.empty()) return false;
    mesh = recut(mesh, recuts);
    for (std::size_t v = before; v < mesh.points.size(); ++v) {
        placed_.add_vertex(mesh.points[v], mesh.places[v]);
        filled_.add_vertex(mesh.points[v], mesh.places[v]);
    }
    recuts_.insert(recuts_.end(), recuts.begin(), recuts.end());
    return true;
}

/// What is too far is placed with the largest distances in mind; then it is cut along its best diagonal, then around
/// new vertices.
void Remesher::come_near(double limit) {
    constexpr int most_rounds = 8;
    const bool may_add = filled_.points.size() == placed_.points.size();
    PlacementOptions options;
    options.rounds = 0;
    options.peak_rounds = 6;
    if (!options_.placement || far_share(0.85 * limit) == 0.0) options.peak_rounds = 0;
    drop_harmful_recuts();
    CoarseMesh whole = recut(filled_, recuts_);
    place(whole, options);
    take_places(whole);
    // Polygons as lines cut them are no cuts: how they are filled is nobody's business.
    if (options_.output == RemeshOutput::polygons) return;
    for (int round = 0; round < most_rounds && !control_.cancelled(); ++round) {
        const std::vector<Index> far = far_polygons(limit);
        watch_.stage("certificate");
        CoarseMesh mesh = judged_;
        if (!cut_far(far, may_add, mesh)) return;
        const CoarseMesh unplaced = mesh;
        const double largest = far_quantile(1.0);
        options.peak_rounds = 3;
        if (options_.placement) place(mesh, options);
        if (!options_.placement || far_quantile(1.0) > 1.02 * largest) {
            mesh = unplaced;
            options.peak_rounds = 0;
            place(mesh, options);
        }
        take_places(mesh);
    }
}

/// Quads from T-nodes that turn away or meet others are as they were; the rest stays as it is.
void Remesher::drop_harmful_recuts() {
    Judge judge{input_, *tree_, mesh_.diagonal, is_embedded_.value_or(true), mesh_.is_cut_open};
    for (int round = 0; round < 8 && !recuts_.empty() && !control_.cancelled(); ++round) {
        CoarseMesh looked_at = recut(placed_, recuts_);
        const std::vector<Index> damaged = judge_input(looked_at, judge).polygons;
        if (damaged.empty()) return;
        std::vector<std::uint8_t> is_bad(placed_.points.size(), 0);
        for (const Index q : damaged)
            for (const Index v : looked_at.polygon(q)) is_bad[v] = 1;
        const std::size_t gone = std::erase_if(recuts_, [&](const Recut& r) {
            return std::any_of(r.after.begin(), r.after.end(), [&](const std::vector<Index>& ring) {
                return std::all_of(ring.begin(), ring.end(), [&](Index v) { return is_bad[v] != 0; });
            });
        });
        if (gone == 0) return;
    }
}

/// Vertices go where those of the mesh are that has been placed.
void Remesher::take_places(const CoarseMesh& mesh) {
    filled_.points = mesh.points;
    filled_.places = mesh.places;
    std::copy_n(mesh.points.begin(), placed_.points.size(), placed_.points.begin());
    std::copy_n(mesh.places.begin(), placed_.places.size(), placed_.places.begin());
}

/// The bound that is proved for the result as it stands, for every way to fill its polygons.
double Remesher::prove_distance() {
    DistanceOptions options;
    options.samples = 10000;
    const double coarsest = options.resolution.resolve(mesh_.diagonal);
    options.resolution = {std::min(coarsest, 0.25 * wanted_error()), false};
    const SurfaceDistance distance = measure_distance(result_.mesh, make_polygon_mesh(input_), options, control_);
    watch_.stage("certificate");
    return result_.statistics.distance_bound = distance.hausdorff_bound;
}

/// One network, mended so that the error is kept; empty where that cannot be proved.
std::optional<Remesher::Attempt> Remesher::attempt_error() {
    const double wanted = wanted_error();
    constexpr double tightness = 1.03;  // bounds are proved to within 2 %
    CoarseMesh mesh = mended(placed_, wanted / tightness);
    if (control_.cancelled()) return std::nullopt;
    emit(mesh);
    if (prove_distance() > wanted) return std::nullopt;
    return Attempt{std::move(*best_), std::move(mesh), result_.statistics};
}

/// A network of several times as many vertices as the input has: the input's own triangles are fewer then.
bool Remesher::is_finer_than_input(double error) const {
    constexpr double times = 3.0, least = 1e-8;  // of the diagonal, lest numbers overflow
    const RemeshStatistics& s = result_.statistics;
    error = std::max(error, least * mesh_.diagonal);
    return expected_vertices(mesh_, compute_spacing(mesh_, field_, rule_of(error), caps_.at(error))) >
           times * static_cast<double>(s.input_vertices - s.merged_points - s.unused_vertices);
}

/// Epsilon by the distances that placement leaves, then lines closer together around far polygons, then cuts; at last
/// mending, which keeps the error by triangles of the input. The fewest faces count, triangles three times.
void Remesher::meet_error() {
    double error = start_error();
    const double wanted = wanted_error();
    constexpr int most_rounds = 6;
    const std::string too_fine = "so small an error takes more polygons than the input has";
    if (is_finer_than_input(error)) {
        while (error < mesh_.diagonal && is_finer_than_input(error))
            error = std::max(1.5 * error, 1e-8 * mesh_.diagonal);
        best_.emplace(draft(error));  // for its lines
        if (!control_.cancelled()) give_input_within_error(too_fine);
        return;
    }
    std::optional<Attempt> kept;
    const auto cost_of = [](const Attempt& attempt) {
        double cost = 0.0;
        for (std::size_t q = 0; q < attempt.mesh.polygon_count(); ++q)
            cost += attempt.mesh.polygon(q).size() == 3 ? 3.0 : 1.0;
        return cost;
    };
    for (int round = 0; round < most_rounds; ++round) {
        if (round > 0 && is_finer_than_input(error)) {
            if (kept) break;
            return give_input_within_error(too_fine);
        }
        best_.emplace(draft(error));
        if (control_.cancelled()) return;
        if (!finish()) break;
        if (control_.cancelled()) return;
        if (farthest_.empty()) break;  // no polygons
        const double share = far_share(0.97 * wanted);
        const double factor = 0.75 * wanted / far_quantile(0.9);
        if (round == 0 ? factor < 0.9 || factor > 1.2 : round == 1 && share > 0.1) {
            error *= std::clamp(factor, 0.25, 2.0);
            continue;
        }
        refine_where_far(error, 0.9 * wanted);
        if (share > 0.025 && round < 4) continue;
        come_near(wanted / 1.03);
        cover_creases();
        std::optional<Attempt> next = attempt_error();
        if (control_.cancelled()) return;
        if (!next) continue;
        const double cost = cost_of(*next);
        const RemeshStatistics s = next->statistics;
        if (kept && cost > 0.98 * cost_of(*kept)) break;
        kept.emplace(std::move(*next));
        if (3 * s.mended_triangles > kept->mesh.polygon_count()) {
            // Too far apart for the topology, whatever the error allows.
            error *= 0.75;
            continue;
        }
        if (double(s.mended_triangles) + double(s.cut_faces) < 0.03 * double(kept->mesh.polygon_count())) break;
    }
    const auto faces = kept ? kept->mesh.polygon_count() : 0;
    if (kept && 2 * kept->statistics.mended_triangles < faces) return keep(std::move(*kept));
    // Mostly triangles of the input: all of them, thinned out, may be fewer.
    if (kept) best_.emplace(kept->draft);
    give_input_within_error("no network of lines will do");
    if (control_.cancelled() || !kept) return;
    const RemeshStatistics& s = result_.statistics;
    if (result_.outcome == Outcome::done && double(s.faces) + 2.0 * double(s.triangles) < cost_of(*kept)) return;
    result_.outcome = Outcome::done;
    keep(std::move(*kept));
}

/// Triangles of the input, as few as the error allows.
void Remesher::give_input_within_error(const std::string& why) {
    const double wanted = wanted_error();
    for (const double part : {0.5, 0.2, 1e-4}) {
        if (control_.cancelled()) return;
        give_input(part * wanted, why);
        if (prove_distance() <= wanted) return;
    }
    result_.outcome = Outcome::over_budget;
    result_.statistics.notes.push_back("the error asked for could not be proved: the bound is " +
                                       text_of(result_.statistics.distance_bound));
}

}  // namespace certa::remeshing
