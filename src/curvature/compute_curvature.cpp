// The public entry: checks options, chooses the estimator, runs it over all vertices, restores order and units.
//
// Vertices are worked on in blocks of the sorted order, in any order of blocks; rows are written where their vertex
// belongs in the input, so the result does not depend on the number of threads. The surface is in units of a power of
// two (surface.h): results are scaled back by ldexp, exactly.
#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/parallel.h"
#include "curvature/bound.h"
#include "curvature/estimators.h"

namespace certa {
namespace curvature {
namespace {

void refuse(std::vector<Defect>& defects, const std::string& message) {
    defects.push_back({DefectKind::option_out_of_range, {{ElementKind::option, 0}}, {}, message});
}

void require_valid(const CurvatureOptions& options) {
    std::vector<Defect> defects;
    const bool ball = options.neighborhood == Neighborhood::ball || options.neighborhood == Neighborhood::geodesic;
    if (options.rings < 1 || options.rings > 100) refuse(defects, "rings must be in [1, 100]");
    if (ball && !(options.radius.value > 0.0 && std::isfinite(options.radius.value)))
        refuse(defects, "radius must be above 0");
    if (options.jet_degree < 2 || options.jet_degree > 4) refuse(defects, "jet_degree must be in [2, 4]");
    if (options.weight != Weight::indicator && options.neighborhood != Neighborhood::ball &&
        options.neighborhood != Neighborhood::automatic_ball)
        refuse(defects, "weight needs a ball");
    if (options.all_sheets && options.neighborhood != Neighborhood::ball)
        refuse(defects, "all_sheets needs a ball of given radius");
    if (options.max_curvature && !(*options.max_curvature > 0.0 && std::isfinite(*options.max_curvature)))
        refuse(defects, "max_curvature must be above 0");
    if (options.bounds && options.neighborhood != Neighborhood::rings) refuse(defects, "bounds need rings");
    if (options.bounds && options.estimator != Estimator::normal_cycle)
        refuse(defects, "bounds need the estimator normal_cycle");
    if (options.estimator == Estimator::corrected && options.neighborhood != Neighborhood::rings)
        refuse(defects, "the corrected estimator needs rings");
    if (options.estimator == Estimator::automatic &&
        (options.neighborhood != Neighborhood::rings || options.weight != Weight::indicator))
        refuse(defects, "the automatic estimator chooses the region around vertices itself");
    if ((options.measures || options.tensors) && options.estimator != Estimator::normal_cycle)
        refuse(defects, "measures and tensors need the estimator normal_cycle");
    if (options.estimator == Estimator::jet &&
        (options.neighborhood == Neighborhood::automatic_ball || options.neighborhood == Neighborhood::geodesic))
        refuse(defects, "the jet estimator needs rings or a ball of given radius");
    if (!defects.empty()) throw InputError(std::move(defects));
}

class Stopwatch {
public:
    explicit Stopwatch(CurvatureStatistics& statistics) : statistics_(statistics) {}
    void lap(const char* stage) {
        const auto now = std::chrono::steady_clock::now();
        statistics_.stage_seconds.emplace_back(stage, std::chrono::duration<double>(now - last_).count());
        last_ = now;
    }

private:
    CurvatureStatistics& statistics_;
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// Writes rows to their place in the result.
class Output {
public:
    Output(const Surface& surface, const CurvatureOptions& options, CurvatureResult& result)
        : surface_(surface), result_(result), unit_(surface.exponent) {
        const std::size_t n = surface.positions.size();
        for (auto* values :
             {&result.area, &result.mean, &result.gaussian, &result.k_min, &result.k_max, &result.confidence})
            values->assign(n, 0.0);
        for (auto* values : {&result.dir_min, &result.dir_max, &result.normal}) values->assign(n, Point3{});
        if (options.measures)
            for (auto* values :
                 {&result.mean_measure, &result.gaussian_measure, &result.edge_mass, &result.vertex_mass})
                values->assign(n, 0.0);
        if (options.tensors)
            for (auto* values : {&result.tensor, &result.swapped_tensor}) values->assign(n, SymmetricTensor3{});
        if (options.neighborhood == Neighborhood::automatic_ball) result.radius.assign(n, 0.0);
        result.flags.assign(n, 0);
        for (std::size_t v = 0; v < n; ++v) result.flags[surface.vertex_sources[v]] = surface.flags[v];
    }

    void write(Index vertex, const VertexRow& row) {
        const Index i = surface_.vertex_sources[vertex];
        const auto length = [&](double x) { return std::ldexp(x, unit_); };
        const auto area = [&](double x) { return std::ldexp(x, 2 * unit_); };
        result_.area[i] = area(row.sums.area);
        write_densities(i, row);
        result_.flags[i] |= row.flags;
        if (!result_.mean_measure.empty()) {
            result_.mean_measure[i] = length(row.sums.swapped.trace());
            result_.gaussian_measure[i] = row.sums.gaussian;
            result_.edge_mass[i] = length(row.sums.edge_mass);
            result_.vertex_mass[i] = row.sums.vertex_mass;
        }
        if (!result_.tensor.empty()) {
            result_.tensor[i] = scaled_tensor(row.sums.plain, unit_);
            result_.swapped_tensor[i] = scaled_tensor(row.sums.swapped, unit_);
        }
        if (!result_.radius.empty()) result_.radius[i] = length(row.radius);
    }

private:
    /// Regions so small that densities overflow have none: 0, and a flag.
    void write_densities(Index i, const VertexRow& row) {
        const double mean = std::ldexp(row.mean, -unit_), gaussian = std::ldexp(row.gaussian, -2 * unit_);
        const double k_min = std::ldexp(row.principal.k_min, -unit_), k_max = std::ldexp(row.principal.k_max, -unit_);
        const bool defined = (row.flags & vertex_flags::undefined) == 0 && std::isfinite(mean) &&
                             std::isfinite(gaussian) && std::isfinite(k_min) && std::isfinite(k_max) &&
                             std::isfinite(norm(row.principal.dir_min));
        if (!defined) {
            result_.flags[i] |= vertex_flags::undefined;
            return;
        }
        result_.mean[i] = mean, result_.gaussian[i] = gaussian;
        result_.k_min[i] = k_min, result_.k_max[i] = k_max;
        result_.dir_min[i] = row.principal.dir_min, result_.dir_max[i] = row.principal.dir_max;
        result_.normal[i] = row.principal.normal;
        result_.confidence[i] = row.principal.confidence;
    }

    const Surface& surface_;
    CurvatureResult& result_;
    int unit_;
};

FactoryPointer choose_factory(const Surface& surface, const Cells& cells, const CurvatureOptions& options,
                              double radius, const RunControl& control) {
    if (options.estimator == Estimator::corrected)
        return make_corrected_factory(surface, cells, options.rings, options.rim);
    if (options.estimator == Estimator::jet)
        return make_jet_factory(surface, cells, options.jet_degree,
                                options.neighborhood == Neighborhood::rings ? options.rings : 0, radius);
    switch (options.neighborhood) {
        case Neighborhood::rings:
            return make_ring_factory(surface, cells, options.rings, options.rim);
        case Neighborhood::ball:
            return make_ball_factory(surface, cells, radius, options.weight, options.all_sheets, control);
        case Neighborhood::automatic_ball:
            return make_automatic_ball_factory(surface, cells, options.weight, options.all_sheets, control);
        case Neighborhood::geodesic:
            return make_geodesic_factory(surface, cells, radius, control);
    }
    return nullptr;
}

/// Theorem 13's numbers for the ring of every vertex (as a union of triangles, whatever its rim).
void compute_bounds(const Surface& surface, const Cells& cells, const CurvatureOptions& options,
                    CurvatureResult& result, const RunControl& control) {
    result.bounds.resize(surface.positions.size());
    Pool<RingWalker> pool;
    core::parallel_for(surface.used_vertices, 1024, control, [&](std::size_t begin, std::size_t end) {
        if (control.cancelled()) return;
        auto walker = pool.take([&] { return std::make_unique<RingWalker>(surface, cells); });
        for (std::size_t v = begin; v < end; ++v) {
            const Index i = surface.vertex_sources[v];
            const std::vector<Index>& faces = walker->collect_faces(static_cast<Index>(v), options.rings);
            const BoundTerms terms = sum_terms(surface, cells, faces, [&](Index f) { return walker->holds_face(f); });
            const double estimate = std::max(std::abs(result.k_min[i]), std::abs(result.k_max[i]));
            const double kappa = std::ldexp(options.max_curvature.value_or(estimate), surface.exponent);
            result.bounds[i] = evaluate_bound(terms, kappa, !options.max_curvature, surface.exponent);
        }
        pool.give_back(std::move(walker));
    });
}

bool run_all(const Surface& surface, const EstimatorFactory& factory, Output& output, const RunControl& control) {
    Pool<VertexEstimator> pool;
    constexpr std::size_t block = 1024, slice = 64 * block;
    // Slices between which progress is told and the user may stop.
    for (std::size_t start = 0; start < surface.used_vertices; start += slice) {
        control.report("estimate", static_cast<double>(start) / static_cast<double>(surface.used_vertices));
        if (control.cancelled()) return false;
        const std::size_t count = std::min(slice, surface.used_vertices - start);
        core::parallel_for(count, block, control, [&](std::size_t begin, std::size_t end) {
            if (control.cancelled()) return;
            auto estimator = pool.take([&] { return factory.make(); });
            for (std::size_t v = start + begin; v < start + end; ++v) {
                VertexRow row;
                estimator->estimate(static_cast<Index>(v), row);
                output.write(static_cast<Index>(v), row);
            }
            pool.give_back(std::move(estimator));
        });
    }
    return !control.cancelled();
}

}  // namespace
}  // namespace curvature

CurvatureResult compute_curvature(const TriangleMesh& mesh, const CurvatureOptions& asked, const RunControl& control) {
    using namespace curvature;
    require_valid(asked);
    CurvatureResult result;
    CurvatureStatistics times;
    Stopwatch stopwatch(times);
    control.report("build", 0.0);
    const Surface surface = build_surface(mesh, control);
    const Cells cells = build_cells(surface, control);
    result.statistics = surface.statistics;
    result.euler_characteristic = surface.euler_characteristic;
    result.total = measures_of(sum_all(cells), surface.exponent);
    stopwatch.lap("build");
    const CurvatureOptions options =
        asked.estimator == Estimator::automatic ? choose_estimator(surface, cells, asked, result.statistics) : asked;
    const double radius = options.radius.relative_to_diagonal ? options.radius.value * surface.diagonal
                                                              : std::ldexp(options.radius.value, -surface.exponent);
    const FactoryPointer factory = choose_factory(surface, cells, options, radius, control);
    Output output(surface, options, result);
    if (!run_all(surface, *factory, output, control)) result.outcome = Outcome::cancelled;
    stopwatch.lap("estimate");
    if (options.bounds && result.outcome == Outcome::done) {
        compute_bounds(surface, cells, options, result, control);
        stopwatch.lap("bounds");
        if (control.cancelled()) result.outcome = Outcome::cancelled;
    }
    CurvatureStatistics& statistics = result.statistics;
    statistics.mean_edge_length = std::ldexp(statistics.mean_edge_length, surface.exponent);
    statistics.estimator = options.estimator;
    if (options.neighborhood == Neighborhood::ball || options.neighborhood == Neighborhood::geodesic)
        statistics.radius = std::ldexp(radius, surface.exponent);
    if (!result.radius.empty()) {
        std::vector<double> radii = result.radius;
        const auto middle = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
        std::nth_element(radii.begin(), middle, radii.end());
        statistics.radius = *middle;
    }
    for (const std::uint8_t flags : result.flags) statistics.fallbacks += (flags & vertex_flags::fallback) != 0;
    statistics.stage_seconds = times.stage_seconds;
    return result;
}

TubeFormula compute_tube_formula(const CurvatureMeasures& measures) {
    return {measures.area, measures.mean / 2.0, measures.gaussian / 3.0};
}

}  // namespace certa
