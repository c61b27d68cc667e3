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
    if (options.weight != Weight::indicator && options.neighborhood == Neighborhood::geodesic)
        refuse(defects, "weight needs a ball or rings");
    if (options.weight != Weight::indicator && options.neighborhood == Neighborhood::rings) {
        if (options.weight == Weight::kernel4) refuse(defects, "kernel4 needs a ball");
        if (options.rim != Rim::dual) refuse(defects, "weight needs the rim dual");
        if (options.estimator != Estimator::normal_cycle) refuse(defects, "weights over rings need normal_cycle");
        if (options.bounds) refuse(defects, "bounds are on rings without weight");
    }
    if (options.all_sheets && options.neighborhood != Neighborhood::ball)
        refuse(defects, "all_sheets needs a ball of given radius");
    if (options.max_curvature && !(*options.max_curvature > 0.0 && std::isfinite(*options.max_curvature)))
        refuse(defects, "max_curvature must be above 0");
    if (options.bounds && options.neighborhood != Neighborhood::rings) refuse(defects, "bounds need rings");
    if (options.bounds && options.estimator != Estimator::normal_cycle)
        refuse(defects, "bounds need the estimator normal_cycle");
    if (options.estimator == Estimator::corrected && options.neighborhood != Neighborhood::rings &&
        options.neighborhood != Neighborhood::ball)
        refuse(defects, "the corrected estimator needs rings or a ball of given radius");
    if (options.estimator != Estimator::normal_cycle && options.all_sheets)
        refuse(defects, "all_sheets needs the estimator normal_cycle");
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

/// Multiplies by a power of two, as ldexp does, in one multiplication where the power is a double.
class PowerOfTwo {
public:
    explicit PowerOfTwo(int exponent)
        : exponent_(exponent), factor_(std::abs(exponent) <= 1022 ? std::ldexp(1.0, exponent) : 0.0) {}
    double operator()(double x) const { return factor_ != 0.0 ? factor_ * x : std::ldexp(x, exponent_); }

private:
    int exponent_;
    double factor_;
};

/// Collects rows in sorted order and restores the input's order at the end: two cache lines read per vertex instead of
/// a dozen arrays written to at random, which costs as much as three rings.
class Output {
public:
    Output(const Surface& surface, const CurvatureOptions& options, CurvatureResult& result)
        : surface_(surface),
          result_(result),
          unit_(surface.exponent),
          area_(2 * unit_),
          per_length_(-unit_),
          per_area_(-2 * unit_),
          rows_(surface.used_vertices) {
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
    }

    void write(Index vertex, const VertexRow& row) {
        write_densities(rows_[vertex], row);
        if (result_.mean_measure.empty() && result_.tensor.empty() && result_.radius.empty()) return;
        const Index i = surface_.vertex_sources[vertex];
        const auto length = [&](double x) { return std::ldexp(x, unit_); };
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

    /// To be called once, after the last row.
    void restore_order(const RunControl& control) {
        core::parallel_for(result_.flags.size(), 4096, control, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const Index v = surface_.sorted_vertices[i];
                result_.flags[i] = surface_.flags[v];
                if (v >= rows_.size()) continue;
                const Row& row = rows_[v];
                result_.flags[i] |= static_cast<std::uint8_t>(row.flags);
                result_.area[i] = row.area, result_.mean[i] = row.mean, result_.gaussian[i] = row.gaussian;
                result_.k_min[i] = row.k_min, result_.k_max[i] = row.k_max;
                result_.dir_min[i] = row.dir_min, result_.dir_max[i] = row.dir_max, result_.normal[i] = row.normal;
                result_.confidence[i] = row.confidence;
            }
        });
    }

private:
    struct alignas(64) Row {
        double area = 0.0, mean = 0.0, gaussian = 0.0, k_min = 0.0, k_max = 0.0, confidence = 0.0;
        Point3 dir_min, dir_max, normal;
        std::uint64_t flags = 0;
    };

    /// Regions so small that densities overflow have none: 0, and a flag.
    void write_densities(Row& out, const VertexRow& row) const {
        out.flags = row.flags;
        out.area = area_(row.sums.area);
        const double mean = per_length_(row.mean), gaussian = per_area_(row.gaussian);
        const double k_min = per_length_(row.principal.k_min), k_max = per_length_(row.principal.k_max);
        const bool defined = (row.flags & vertex_flags::undefined) == 0 && std::isfinite(mean) &&
                             std::isfinite(gaussian) && std::isfinite(k_min) && std::isfinite(k_max) &&
                             std::isfinite(norm(row.principal.dir_min));
        if (!defined) {
            out.flags |= vertex_flags::undefined;
            return;
        }
        out.mean = mean, out.gaussian = gaussian;
        out.k_min = k_min, out.k_max = k_max;
        out.dir_min = row.principal.dir_min, out.dir_max = row.principal.dir_max, out.normal = row.principal.normal;
        out.confidence = row.principal.confidence;
    }

    const Surface& surface_;
    CurvatureResult& result_;
    int unit_;
    PowerOfTwo area_, per_length_, per_area_;
    std::vector<Row> rows_;
};

FactoryPointer choose_factory(const Surface& surface, const Cells& cells, const CurvatureOptions& options,
                              double radius, const RunControl& control) {
    if (options.estimator == Estimator::corrected)
        return make_corrected_factory(
            surface, cells,
            {options.rings, options.rim, options.neighborhood == Neighborhood::ball ? radius : 0.0, options.weight});
    if (options.estimator == Estimator::jet)
        return make_jet_factory(surface, cells, options.jet_degree,
                                options.neighborhood == Neighborhood::rings ? options.rings : 0, radius);
    switch (options.neighborhood) {
        case Neighborhood::rings:
            return make_ring_factory(surface, cells, options.rings, options.rim, options.weight);
        case Neighborhood::ball:
            return make_ball_factory(surface, cells, radius, options.weight, options.all_sheets, control);
        case Neighborhood::automatic_ball:
            return make_automatic_ball_factory(surface, cells, options.weight, control);
        case Neighborhood::geodesic:
            return make_geodesic_factory(surface, cells, radius, control);
    }
    return nullptr;
}

/// Theorem 13's numbers for the ring of every vertex (as a union of triangles, whatever its rim).
void compute_bounds(const Surface& surface, const Cells& cells, const CurvatureOptions& options,
                    CurvatureResult& result, const RunControl& control) {
    result.bounds.resize(surface.positions.size());
    const std::vector<TriangleShape> shapes = build_shapes(surface, control);
    Pool<RingWalker> pool;
    core::parallel_for(surface.used_vertices, 1024, control, [&](std::size_t begin, std::size_t end) {
        if (control.cancelled()) return;
        auto walker = pool.take([&] { return std::make_unique<RingWalker>(surface, cells); });
        for (std::size_t v = begin; v < end; ++v) {
            const Index i = surface.vertex_sources[v];
            const std::vector<Index>& faces = walker->collect_faces(static_cast<Index>(v), options.rings);
            const double estimate = std::max(std::abs(result.k_min[i]), std::abs(result.k_max[i]));
            const double kappa = std::ldexp(options.max_curvature.value_or(estimate), surface.exponent);
            BoundSum sum(surface, cells, shapes, kappa);
            sum.add_region(faces, [&](Index f) { return walker->holds_face(f); });
            result.bounds[i] = sum.result(!options.max_curvature);
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
    output.restore_order(control);
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
