// The main job from end to end: validate, triangulate the input points, recover what is missing, restart with balls
// where that does not end, label.
// The guarantee behind the default: whatever does not end well is named by the recovery and joins a protected set that
// only grows; its last stage is the thesis's algorithm, which terminates (Theorem 8).
#include <certa/conforming.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <optional>

#include "conforming/build_complex.h"
#include "conforming/emission.h"
#include "conforming/facet_interior.h"
#include "conforming/local_feature_size.h"
#include "conforming/merge_coplanar.h"
#include "conforming/protected_area.h"
#include "conforming/protecting_balls.h"
#include "conforming/recovery.h"
#include "conforming/validate.h"
#include "conforming/validate_messages.h"

namespace certa {
namespace conforming {
namespace {

using delaunay::Delaunay3;

/// Seconds per stage, in order; a stage that comes again adds up.
class StageClock {
public:
    explicit StageClock(ConformStatistics& statistics) : statistics_(statistics) {}
    template <class Work>
    auto run(const char* stage, const Work& work) {
        struct Stop {
            ConformStatistics& statistics;
            const char* stage;
            std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
            ~Stop() {
                const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
                auto& all = statistics.stage_seconds;
                const auto same = std::find_if(all.begin(), all.end(), [&](const auto& s) { return s.first == stage; });
                if (same == all.end()) {
                    all.emplace_back(stage, seconds);
                } else {
                    same->second += seconds;
                }
            }
        };
        const Stop stop{statistics_, stage};
        return work();
    }

private:
    ConformStatistics& statistics_;
};

void check_options(const ConformOptions& options) {
    std::vector<Defect> defects;
    const auto require = [&](bool fine, const std::string& message) {
        if (!fine) defects.push_back({DefectKind::option_out_of_range, {}, {}, message});
    };
    require(options.alpha > 0.0 && options.alpha < 0.5, "alpha must be above 0 and below 0.5; 0.4 is a good choice");
    require(options.planarity.value >= 0.0, "planarity must not be negative");
    require(options.min_feature.value >= 0.0, "min_feature must not be negative");
    if (!defects.empty()) throw InputError(std::move(defects));
}

/// What a run is made from, once; restarts begin here.
struct Prepared {
    Complex complex;
    std::vector<std::uint32_t> ignored_points;
    Delaunay3 triangulation;                   // of the input points; moved from by the first attempt
    std::vector<std::uint8_t> present_facets;  // triangle facets that are faces of it
};

class Conformer {
public:
    Conformer(const PiecewiseLinearComplex& input, const ConformOptions& options, const RunControl& control)
        : input_(input), options_(options), control_(control), clock_(result_.statistics) {}

    ConformResult run() {
        prepare();
        if (control_.cancelled()) {
            result_.outcome = Outcome::cancelled;
            return std::move(result_);
        }
        recover();
        return std::move(result_);
    }

private:
    const PiecewiseLinearComplex& input_;
    const ConformOptions& options_;
    const RunControl& control_;
    ConformResult result_;
    StageClock clock_;
    Prepared prepared_;
    std::optional<FacetInterior> interior_;
    std::optional<LocalFeatureSize> feature_size_;

    void prepare() {
        ValidationReport structure = clock_.run("validate", [&] { return validate_structure(input_); });
        if (!structure.ok()) {
            // The whole list, what lies where included.
            throw InputError(clock_.run("validate", [&] { return validate(input_, options_, control_).defects; }));
        }
        Complex& complex = prepared_.complex;
        complex = clock_.run("validate", [&] { return build_complex(input_); });
        prepared_.ignored_points = structure.ignored_points;
        std::sort(prepared_.ignored_points.begin(), prepared_.ignored_points.end());
        control_.report("delaunay", 0.0);
        clock_.run("delaunay", [&] { prepared_.triangulation.build(complex.points, prepared_.ignored_points); });
        clock_.run("survey", [&] { find_present(); });
        control_.report("validate", 0.0);
        validate_places(structure);
        if (!prepared_.triangulation.is_solid()) {
            throw InputError({{DefectKind::empty_input,
                               {},
                               {},
                               "all points lie in one plane: there is no volume to fill; add a point off the plane"}});
        }
        result_.statistics.input_points = complex.points.size();
        result_.statistics.segments = complex.segments.size();
        result_.statistics.facets = complex.frames.size();
    }

    void find_present() {
        const Complex& complex = prepared_.complex;
        prepared_.present_facets.assign(complex.frames.size(), 0);
        if (!prepared_.triangulation.is_solid()) return;
        for (std::uint32_t f = 0; f < complex.frames.size(); ++f) {
            if (const auto t = triangle_of(complex, f)) {
                prepared_.present_facets[f] = prepared_.triangulation.has_face((*t)[0], (*t)[1], (*t)[2]) ? 1 : 0;
            }
        }
    }

    void validate_places(const ValidationReport& structure) {
        Complex& complex = prepared_.complex;
        std::vector<std::uint8_t> segments(complex.segments.size(), 0);
        for (std::uint32_t f = 0; f < complex.frames.size(); ++f) {
            if (prepared_.present_facets[f] == 0) continue;
            for (const Side& side : complex.facet_sides[f]) segments[side.segment] = 1;
        }
        ValidationReport report = clock_.run("validate", [&] {
            return validate_geometry(input_, complex, structure, options_, {prepared_.present_facets, segments},
                                     control_);
        });
        if (control_.cancelled()) return;
        if (!report.ok()) throw InputError(std::move(report.defects));
        result_.warnings = structure.notes;
        result_.warnings.insert(result_.warnings.end(), report.notes.begin(), report.notes.end());
        adopt_elements(complex, report);
        for (const AdoptedPoint& adopted : report.adopted_points) prepared_.present_facets[adopted.facet] = 0;
        for (const AdoptedSegment& adopted : report.adopted_segments) prepared_.present_facets[adopted.facet] = 0;
        if (options_.merge_coplanar) {
            MergedComplex merged = merge_coplanar(complex, input_.segments.size());
            complex = std::move(merged.complex);
            for (std::uint32_t f = 0; f < complex.frames.size(); ++f) {
                if (!triangle_of(complex, f)) prepared_.present_facets[f] = 0;
            }
        }
    }

    ProtectedSet first_set() {
        switch (options_.protection) {
            case Protection::all:
                return protect_all(prepared_.complex);
            case Protection::sharp:
                return protect_sharp(prepared_.complex, interior());
            case Protection::needed:
                break;
        }
        return protect_nothing(prepared_.complex);
    }

    const FacetInterior& interior() {
        if (!interior_) interior_ = build_facet_interior(prepared_.complex);
        return *interior_;
    }

    const LocalFeatureSize& feature_size() {
        if (!feature_size_) feature_size_.emplace(prepared_.complex, interior());
        return *feature_size_;
    }

    std::size_t point_limit() const {
        constexpr auto most = static_cast<std::size_t>(std::numeric_limits<std::uint32_t>::max() / 4);
        return options_.max_points ? static_cast<std::size_t>(std::min<std::uint64_t>(*options_.max_points, most))
                                   : most;
    }

    /// The points and chains around protected vertices and segments; none when nothing is protected.
    std::optional<ProtectedArea> protect(const ProtectedSet& set) {
        BallOptions balls;
        balls.alpha = options_.alpha;
        balls.min_radius = options_.min_feature.resolve(prepared_.complex.diagonal);
        const std::size_t room = point_limit() - std::min(point_limit(), prepared_.complex.points.size());
        balls.max_balls = std::min<std::size_t>(20'000'000, prepared_.complex.points.size() + room);
        const ProtectingBalls built = build_protecting_balls(prepared_.complex, feature_size(), set, balls, control_);
        result_.statistics.protecting_balls = built.balls.size();
        if (built.outcome == Outcome::done) return build_protected_area(prepared_.complex, interior(), built);
        result_.outcome = built.outcome;
        if (built.obstacle) report_ball_obstacle(*built.obstacle);
        return std::nullopt;
    }

    void report_ball_obstacle(const BallObstacle& obstacle) {
        const auto name = [](const ElementRef& e) { return name_element(e.kind, e.index); };
        const bool crowded = result_.outcome == Outcome::over_budget;
        std::string message =
            crowded ? "too many protecting balls would be needed" : "a protecting ball would be too small";
        message += " on " + name(obstacle.protected_face) + ", which " + name(obstacle.near_face) + " comes near to " +
                   name_place(obstacle.place) + ": its radius would be " + name_number(obstacle.radius);
        message += crowded ? "; simplify the place or raise max_points" : "; simplify the place or lower min_feature";
        result_.obstacles.push_back({crowded ? DefectKind::point_near_facet : DefectKind::point_near_facet,
                                     {obstacle.protected_face, obstacle.near_face},
                                     obstacle.place,
                                     message});
    }

    Delaunay3 triangulate(const std::optional<ProtectedArea>& area) {
        return clock_.run("delaunay", [&] {
            Delaunay3 triangulation;
            std::vector<Point3> points = prepared_.complex.points;
            if (area) {
                for (const NewPoint& p : area->points) points.push_back(p.position);
            }
            triangulation.build(points, prepared_.ignored_points);
            return triangulation;
        });
    }

    void recover() {
        const bool lazy = options_.protection == Protection::needed;
        ProtectedSet set = first_set();
        bool anything = !lazy;
        MeshState mesh(prepared_.complex);
        mesh.min_feature = options_.min_feature.resolve(prepared_.complex.diagonal);
        RecoveryOptions recovery_options;
        recovery_options.gabriel = options_.gabriel;
        recovery_options.mirroring = lazy;
        recovery_options.max_points = point_limit();
        const PieceRule rule = lazy ? PieceRule::present : PieceRule::gabriel;
        for (std::size_t attempt = 0;; ++attempt) {
            std::optional<ProtectedArea> area;
            if (anything) {
                control_.report("protect", 0.0);
                area = clock_.run("protect", [&] { return protect(set); });
                if (!area) return;
            }
            mesh.reset(attempt == 0 && !area ? std::move(prepared_.triangulation) : triangulate(area),
                       area ? &*area : nullptr, rule);
            Recovery recovery(mesh, area ? &*area : nullptr, recovery_options, control_);
            const RecoveryResult end = clock_.run("recover", [&] {
                return recovery.run(area ? std::span<const std::uint8_t>{} : prepared_.present_facets);
            });
            if (attempt == 0) {
                result_.statistics.missing_segments = end.missing_segments;
                result_.statistics.missing_facets = end.missing_facets;
            }
            result_.statistics.restarts = attempt;
            result_.outcome = end.outcome;
            if (end.outcome == Outcome::done) {
                control_.report("label", 0.0);
                clock_.run("label", [&] { emit_mesh(mesh, recovery, input_, options_, result_); });
                return;
            }
            if (end.outcome == Outcome::cancelled) return;
            report_obstructions(end);
            emit_partial(mesh, recovery, result_);
            return;
        }
    }

    void report_obstructions(const RecoveryResult& end) {
        for (const Obstruction& o : end.obstructions) {
            const bool budget = end.outcome == Outcome::over_budget;
            Defect defect{
                o.element.kind == ElementKind::segment ? DefectKind::point_near_segment : DefectKind::point_near_facet,
                {o.element},
                o.place,
                "recovering " + name_element(o.element.kind, o.element.index) + " stopped " + name_place(o.place) +
                    ": " + o.reason +
                    (budget ? "; raise max_points or simplify the place"
                            : "; lower min_feature or simplify the place")};
            if (o.vertex != no_index) defect.elements.push_back({ElementKind::vertex, o.vertex});
            result_.obstacles.push_back(std::move(defect));
        }
    }
};

}  // namespace
}  // namespace conforming

ConformResult conform(const PiecewiseLinearComplex& input, const ConformOptions& options, const RunControl& control) {
    conforming::check_options(options);
    std::optional<tbb::global_control> threads;
    if (control.threads > 0) threads.emplace(tbb::global_control::max_allowed_parallelism, control.threads);
    if (!options.repair && !options.triangulate) return conforming::Conformer(input, options, control).run();
    RepairedComplex repaired = repair_complex(input, options, control);
    ConformOptions rest = options;
    rest.repair = rest.triangulate = false;
    ConformResult result = conforming::Conformer(repaired.complex, rest, control).run();
    result.repairs = std::move(repaired.repairs);
    for (FacetId& f : result.mesh.triangle_facets) f = repaired.facet_sources[index_of(f)];
    for (VertexSource& v : result.mesh.vertex_sources) {
        if (v.origin == VertexOrigin::facet) v.index = index_of(repaired.facet_sources[v.index]);
    }
    return result;
}

}  // namespace certa
