// An error as the goal: networks, closer where it is not kept, until little is left to mend (remesh, stage 12).
#include <certa/distance.h>
#include <certa/io.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/triangle_tree.h"
#include "remeshing/remesher.h"
#include "remeshing/templates.h"

namespace certa::remeshing {

/// Caps the spacing around vertices and triangle centres of either surface that are farther than `limit` from the
/// other. Returns the share of the input's vertices that are.
double Remesher::refine_where_far(double error, double limit) {
    const Spacing spacing = compute_spacing(mesh_, field_, rule_of(error), caps_.at(error));
    const auto lower = [&](Index w) { caps_.lower(w, 0.45 * std::min(spacing.at[0][w], spacing.at[1][w])); };
    const core::TriangleTree& input = *tree_;
    const CoarseMesh triangles = make_triangles(filled_, input);
    std::vector<Triangle> ids;
    for (std::size_t i = 0; i < triangles.polygon_count(); ++i) {
        const auto t = triangles.polygon(i);
        ids.push_back({VertexId{t[0]}, VertexId{t[1]}, VertexId{t[2]}});
        const Point3 &a = triangles.points[t[0]], &b = triangles.points[t[1]], &c = triangles.points[t[2]];
        for (const Point3& p : {(1.0 / 3.0) * (a + b + c), 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)}) {
            const core::NearestPoint nearest = input.find_nearest(p);
            if (nearest.squared_distance <= limit * limit) continue;
            for (Index k = 0; k < 3; ++k) lower(mesh_.wedges[3 * nearest.triangle + k]);
        }
    }
    const core::TriangleTree result(triangles.points, ids);
    std::size_t far = 0;
    for (Index w = 0; w < mesh_.wedge_count(); ++w) {
        const Point3& p = mesh_.points[mesh_.wedge_vertices[w]];
        if (result.find_nearest(p).squared_distance <= limit * limit) continue;
        lower(w);
        ++far;
    }
    return static_cast<double>(far) / static_cast<double>(mesh_.wedge_count());
}

/// The share of the placed triangles that are farther from the input than `limit`, and vertices of the input
/// likewise.
double Remesher::far_share(double limit) const {
    const CoarseMesh triangles = make_triangles(filled_, *tree_);
    std::vector<Triangle> ids;
    std::size_t far = 0, looked = 0;
    for (std::size_t i = 0; i < triangles.polygon_count(); ++i, ++looked) {
        const auto t = triangles.polygon(i);
        ids.push_back({VertexId{t[0]}, VertexId{t[1]}, VertexId{t[2]}});
        const Point3 middle = (1.0 / 3.0) * (triangles.points[t[0]] + triangles.points[t[1]] + triangles.points[t[2]]);
        far += tree_->find_nearest(middle).squared_distance > limit * limit ? 1 : 0;
    }
    const core::TriangleTree result(triangles.points, ids);
    std::size_t far_below = 0;
    for (const Point3& p : mesh_.points) far_below += result.find_nearest(p).squared_distance > limit * limit ? 1 : 0;
    return std::max(static_cast<double>(far) / static_cast<double>(looked),
                    static_cast<double>(far_below) / static_cast<double>(mesh_.points.size()));
}

/// The bound that is proved for the result as it stands, for every way to fill its polygons.
double Remesher::prove_distance() {
    DistanceOptions options;
    options.samples = 10000;
    const SurfaceDistance distance = measure_distance(result_.mesh, make_polygon_mesh(input_), options, control_);
    watch_.stage("certificate");
    return result_.statistics.distance_bound = distance.hausdorff_bound;
}

/// One network, mended so that the error is kept; empty where that would be mending above all.
std::optional<Remesher::Attempt> Remesher::attempt_error(double most_far) {
    const double wanted = wanted_error();
    if (far_share(wanted) > most_far) return std::nullopt;
    constexpr double tightness = 1.03;  // bounds are proved to within 2 %
    CoarseMesh mesh = mended(placed_, wanted / tightness);
    if (control_.cancelled()) return std::nullopt;
    emit(mesh);
    if (prove_distance() > wanted) return std::nullopt;
    return Attempt{std::move(*best_), std::move(mesh), result_.statistics};
}

/// Lines closer together until mending, which keeps the error by cutting and by triangles of the input, has little
/// to do. What has the fewest faces counts: whatever is mended has many.
void Remesher::meet_error() {
    double error = start_error();
    constexpr std::array<double, 6> most_far{0.002, 0.002, 0.002, 0.02, 0.02, 0.3};
    std::optional<Attempt> kept;
    for (const double far : most_far) {
        best_.emplace(draft(error));
        if (control_.cancelled()) return;
        if (!finish()) break;
        std::optional<Attempt> next = attempt_error(far);
        if (control_.cancelled()) return;
        if (next) {
            const auto faces = [](const Attempt& attempt) { return double(attempt.mesh.polygon_count()); };
            if (kept && faces(*next) > 0.98 * faces(*kept)) break;
            kept.emplace(std::move(*next));
            const RemeshStatistics& s = kept->statistics;
            if (double(s.mended_triangles) < 0.05 * faces(*kept) && double(s.cut_faces) < 0.1 * faces(*kept)) break;
        }
        // Far in a few places: lines closer together there; far nearly everywhere: a smaller epsilon.
        const double share = refine_where_far(error, 0.75 * wanted_error());
        if (share > 0.1 || share == 0.0) error *= 0.7;
    }
    const auto faces = kept ? kept->mesh.polygon_count() : 0;
    if (kept && 2 * kept->statistics.mended_triangles < faces) return keep(std::move(*kept));
    // Mostly triangles of the input: all of them, thinned out, may be fewer.
    if (kept) best_.emplace(kept->draft);
    give_input_within_error();
    if (control_.cancelled() || !kept) return;
    if (result_.outcome == Outcome::done && result_.statistics.faces < faces) return;
    result_.outcome = Outcome::done;
    keep(std::move(*kept));
}

/// Nothing else has helped: triangles of the input, as few as the error allows.
void Remesher::give_input_within_error() {
    const double wanted = wanted_error();
    for (const double part : {0.5, 0.2, 1e-4}) {
        if (control_.cancelled()) return;
        give_input(part * wanted);
        if (prove_distance() <= wanted) return;
    }
    result_.outcome = Outcome::over_budget;
    result_.statistics.notes.push_back("the error asked for could not be proved: the bound is " +
                                       text_of(result_.statistics.distance_bound));
}

}  // namespace certa::remeshing
