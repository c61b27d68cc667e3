// The main job from end to end: validate, triangulate the input points, recover what is missing, restart with balls
// where that does not end, label.
// The guarantee behind the default: whatever does not end well is named by the recovery and joins a protected set that
// only grows; its last stage is the thesis's algorithm, which terminates (Theorem 8).
#include <certa/conforming.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "conforming/build_complex.h"
#include "conforming/emission.h"
#include "conforming/engine.h"
#include "conforming/facet_interior.h"
#include "conforming/growth.h"
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
    std::optional<Delaunay3> triangulation;    // of the input points; the first attempt takes it
    std::vector<std::uint8_t> present_facets;  // triangle facets that are faces of it, and marked
};

class Conformer {
public:
    Conformer(const PiecewiseLinearComplex& input, const ConformOptions& options, const AttemptLimits& limits,
              const RunControl& control)
        : input_(input), options_(options), limits_(limits), control_(control), clock_(result_.statistics) {}

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
    const AttemptLimits& limits_;
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
        complex.ignored_points = structure.ignored_points;
        std::sort(complex.ignored_points.begin(), complex.ignored_points.end());
        control_.report("delaunay", 0.0);
        clock_.run("delaunay",
                   [&] { prepared_.triangulation.emplace().build(complex.points, prepared_.complex.ignored_points); });
        clock_.run("survey", [&] { find_present(); });
        control_.report("validate", 0.0);
        validate_places(structure);
        if (!prepared_.triangulation->is_solid()) {
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
        if (!prepared_.triangulation->is_solid()) return;
        for (std::uint32_t f = 0; f < complex.frames.size(); ++f) {
            const auto t = triangle_of(complex, f);
            if (!t) continue;
            const delaunay::FaceHandle face = prepared_.triangulation->find_face((*t)[0], (*t)[1], (*t)[2]);
            if (face.cell == nullptr) continue;
            prepared_.triangulation->mark_face(face, f);
            prepared_.present_facets[f] = 1;
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
            complex.dropped_segments = std::move(merged.dropped_segments);
            prepared_.triangulation->clear_marks();
            find_present();
        }
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

    /// Protection, and the refinement around it, can take millions of points where a complex has slivers; without the
    /// user's word, no more than this.
    std::size_t protection_limit() const {
        if (options_.max_points) return point_limit();
        const std::size_t base = options_.protection == Protection::needed ? 200'000 : 4'000'000;
        return base + 50 * prepared_.complex.points.size();
    }

    /// The points and chains around protected vertices and segments; none when that exceeds a limit.
    std::optional<ProtectedArea> protect(const ProtectedSet& set) {
        const Complex& complex = prepared_.complex;
        BallOptions balls;
        balls.alpha = options_.alpha;
        balls.min_radius = options_.min_feature.resolve(complex.diagonal);
        // Each ball inside a segment is a point; those of vertices are points of the input.
        balls.max_balls = std::max(protection_limit(), complex.points.size());
        const ProtectingBalls built = build_protecting_balls(complex, feature_size(), set, balls, control_);
        result_.statistics.protecting_balls = built.balls.size();
        result_.outcome = built.outcome;
        if (built.obstacle) report_ball_obstacle(*built.obstacle);
        if (built.outcome != Outcome::done) return std::nullopt;
        ProtectedArea area = build_protected_area(complex, interior(), built);
        if (complex.points.size() + area.points.size() <= protection_limit()) return area;
        result_.outcome = Outcome::over_budget;
        const Ball& last = built.balls.back();
        const ElementRef face{last.kind == BallKind::vertex ? ElementKind::vertex : ElementKind::segment, last.index};
        report_ball_obstacle({face, {ElementKind::vertex, no_index}, last.center, last.radius});
        return std::nullopt;
    }

    void report_ball_obstacle(const BallObstacle& obstacle) {
        const auto name = [](const ElementRef& e) { return name_element(e.kind, e.index); };
        const bool crowded = result_.outcome == Outcome::over_budget;
        std::vector<ElementRef> elements{obstacle.protected_face};
        std::string message =
            crowded ? "too many points would be needed for protecting balls" : "a protecting ball would be too small";
        message += " on " + name(obstacle.protected_face) + ' ' + name_place(obstacle.place);
        if (obstacle.near_face.index != no_index) {
            elements.push_back(obstacle.near_face);
            message += ", which " + name(obstacle.near_face) + " comes near to";
        }
        message += ": its radius would be " + name_number(obstacle.radius);
        message += crowded ? "; simplify the place or raise max_points" : "; simplify the place or lower min_feature";
        result_.obstacles.push_back(
            {DefectKind::point_near_facet, std::move(elements), obstacle.place, std::move(message)});
    }

    Delaunay3 triangulate(const std::optional<ProtectedArea>& area) {
        return clock_.run("delaunay", [&] {
            Delaunay3 triangulation;
            std::vector<Point3> points = prepared_.complex.points;
            if (area) {
                for (const NewPoint& p : area->points) points.push_back(p.position);
            }
            triangulation.build(points, prepared_.complex.ignored_points);
            return triangulation;
        });
    }

    /// One way to go about it: what is protected beforehand, and the rules for the rest.
    struct Plan {
        ProtectedSet set;
        bool protects = false;
        bool lazy = false;  // mirroring and budgets; else the thesis
        std::size_t restarts = 0;
        SplitRule rule = SplitRule::copy;
        std::size_t most_added = 0;  // 0: as many Steiner points as the budgets allow
    };
    struct Attempt {
        Attempt(const Complex& complex, std::optional<ProtectedArea> given, const RecoveryOptions& recovery_options,
                const RunControl& control)
            : area(std::move(given)),
              options(recovery_options),
              mesh(complex),
              recovery(mesh, area ? &*area : nullptr, options, control) {}
        std::optional<ProtectedArea> area;
        RecoveryOptions options;
        MeshState mesh;
        Recovery recovery;
        RecoveryResult end;
        std::size_t added() const { return mesh.owners.size(); }
    };

    Plan first_plan() {
        const Complex& complex = prepared_.complex;
        switch (options_.protection) {
            case Protection::all:
                return {.set = protect_all(complex), .protects = true};
            case Protection::sharp:
                return {.set = protect_sharp(complex, interior()), .protects = true};
            case Protection::needed:
                break;
        }
        return {.set = protect_nothing(complex), .lazy = true};
    }

    RecoveryOptions recovery_options(const Plan& plan) const {
        RecoveryOptions recovery;
        recovery.gabriel = options_.gabriel;
        recovery.mirroring = plan.lazy;
        recovery.split_rule = plan.rule;
        recovery.max_points = plan.protects ? protection_limit() : point_limit();
        if (plan.lazy) {
            const std::size_t factor = std::size_t{1} << std::min<std::size_t>(plan.restarts, 20);
            // Empty diametral balls take a few times as many points as presence does (fans: seven times).
            recovery.owner_budget = factor * limits_.owner_budget * (options_.gabriel ? 4 : 1);
            recovery.total_budget = factor * (limits_.total_budget + 50 * prepared_.complex.points.size());
        }
        if (plan.most_added > 0) recovery.total_budget = plan.most_added;
        return recovery;
    }

    /// Nothing where the balls cannot be built; the result says why.
    std::unique_ptr<Attempt> try_plan(const Plan& plan) {
        std::optional<ProtectedArea> area;
        if (plan.protects) {
            control_.report("protect", 0.0);
            area = clock_.run("protect", [&] { return protect(plan.set); });
            if (!area) return nullptr;
        }
        auto attempt = std::make_unique<Attempt>(prepared_.complex, std::move(area), recovery_options(plan), control_);
        const bool pristine = !plan.protects && prepared_.triangulation.has_value();
        Delaunay3 start = pristine ? *std::exchange(prepared_.triangulation, {}) : triangulate(attempt->area);
        attempt->mesh.min_feature = options_.min_feature.resolve(prepared_.complex.diagonal);
        attempt->mesh.reset(std::move(start), attempt->area ? &*attempt->area : nullptr,
                            plan.lazy ? PieceRule::present : PieceRule::gabriel);
        attempt->end = clock_.run("recover", [&] {
            return attempt->recovery.run(pristine ? prepared_.present_facets : std::vector<std::uint8_t>{});
        });
        return attempt;
    }

    /// More protection where the last attempt was stuck; false when there is no more to be had.
    bool change_plan(Plan& plan, const RecoveryResult& end) {
        if (!plan.lazy || !end.stuck) return false;
        ++plan.restarts;
        if (plan.restarts > limits_.restarts_before_all ||
            !grow_protected_set(plan.set, prepared_.complex, end.obstructions)) {
            plan.set = protect_all(prepared_.complex);
            plan.lazy = false;
        }
        plan.protects = true;
        return true;
    }

    static bool is_done(const Attempt* attempt) { return attempt != nullptr && attempt->end.outcome == Outcome::done; }

    /// Recovery of small complexes is cheap, and no split rule gives the fewest points everywhere: another one may also
    /// stay within max_points where the first does not.
    void try_other_rules(const Plan& plan, std::unique_ptr<Attempt>& best) {
        if (!plan.lazy || plan.protects || prepared_.complex.frames.size() > limits_.facets_for_trials) return;
        const bool hit_limit = best->end.outcome == Outcome::over_budget && !best->end.stuck;
        if (!hit_limit && (!is_done(best.get()) || best->added() < limits_.added_for_trials)) return;
        for (const SplitRule rule : {SplitRule::middle_first, SplitRule::shells}) {
            Plan other = plan;
            other.rule = rule;
            if (is_done(best.get())) other.most_added = best->added() - 1;
            std::unique_ptr<Attempt> attempt = try_plan(other);
            if (attempt->end.outcome == Outcome::cancelled) {
                best = std::move(attempt);
                return;
            }
            if (is_done(attempt.get()) && (!is_done(best.get()) || attempt->added() < best->added()))
                best = std::move(attempt);
        }
    }

    /// Balls are little help where very many pages overlap in a narrow fan: as the first attempt, with more patience.
    void try_patiently(Plan& plan, std::unique_ptr<Attempt>& attempt) {
        if (options_.protection != Protection::needed || plan.restarts == 0 || is_done(attempt.get())) return;
        if (result_.outcome == Outcome::cancelled || (attempt && attempt->end.outcome == Outcome::cancelled)) return;
        const Plan patient{
            .set = protect_nothing(prepared_.complex), .lazy = true, .restarts = limits_.doublings_at_last};
        std::unique_ptr<Attempt> last = try_plan(patient);
        if (!is_done(last.get()) && last->end.outcome != Outcome::cancelled) return;
        plan = patient;
        attempt = std::move(last);
        result_.outcome = Outcome::done;
        result_.obstacles.clear();
        result_.statistics.protecting_balls = 0;
    }

    void recover() {
        Plan plan = first_plan();
        std::unique_ptr<Attempt> attempt = try_plan(plan);
        if (attempt) {
            result_.statistics.missing_segments = attempt->end.missing_segments;
            result_.statistics.missing_facets = attempt->end.missing_facets;
        }
        // Without balls there is no next attempt: what the last one had stays, as partial.
        for (std::unique_ptr<Attempt> next; attempt && change_plan(plan, attempt->end); attempt = std::move(next)) {
            next = try_plan(plan);
            if (next == nullptr) break;
        }
        result_.statistics.restarts = plan.restarts;
        try_patiently(plan, attempt);
        if (result_.outcome == Outcome::cancelled) return;
        if (!attempt || result_.outcome != Outcome::done) {
            if (attempt) emit_partial(attempt->mesh, attempt->recovery, result_);
            return;
        }
        try_other_rules(plan, attempt);
        result_.outcome = attempt->end.outcome;
        if (result_.outcome == Outcome::done) {
            control_.report("label", 0.0);
            clock_.run("label", [&] { emit_mesh(attempt->mesh, attempt->recovery, input_, options_, result_); });
            if (attempt->area) label_balls(*attempt->area);
        } else if (result_.outcome != Outcome::cancelled) {
            report_obstructions(attempt->end);
            emit_partial(attempt->mesh, attempt->recovery, result_);
        }
    }

    void label_balls(const ProtectedArea& area) {
        result_.ball_radii.assign(result_.mesh.positions.size(), 0.0);
        for (std::size_t i = 0; i < area.balls.size(); ++i)
            result_.ball_radii[area.ball_centers[i]] = area.balls[i].radius;
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

ConformResult mesh_complex(const PiecewiseLinearComplex& input, const ConformOptions& options,
                           const AttemptLimits& limits, const RunControl& control) {
    check_options(options);
    std::optional<tbb::global_control> threads;
    if (control.threads > 0) threads.emplace(tbb::global_control::max_allowed_parallelism, control.threads);
    return Conformer(input, options, limits, control).run();
}

}  // namespace conforming

ConformResult conform(const PiecewiseLinearComplex& input, const ConformOptions& options, const RunControl& control) {
    if (!options.repair && !options.triangulate) return conforming::mesh_complex(input, options, {}, control);
    RepairedComplex repaired = repair_complex(input, options, control);
    ConformOptions rest = options;
    rest.repair = rest.triangulate = false;
    ConformResult result = conforming::mesh_complex(repaired.complex, rest, {}, control);
    result.repairs = std::move(repaired.repairs);
    for (FacetId& f : result.mesh.triangle_facets) f = repaired.facet_sources[index_of(f)];
    for (VertexSource& v : result.mesh.vertex_sources) {
        if (v.origin == VertexOrigin::facet) v.index = index_of(repaired.facet_sources[v.index]);
    }
    return result;
}

}  // namespace certa
