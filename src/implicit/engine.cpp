// The main loop of Part III: classify, find clusters and degrees, then triangulate, grow W, check the conditions, and
// split what breaks them, a generation a round, until all hold or nothing more can be done.
#include "implicit/engine.h"

#include <certa/implicit.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>

#include "core/assert.h"
#include "implicit/certificate.h"
#include "implicit/clusters.h"
#include "implicit/conditions.h"
#include "implicit/frontier.h"
#include "implicit/growth.h"
#include "implicit/product.h"
#include "implicit/refine.h"
#include "implicit/simplify.h"
#include "implicit/subdivision.h"
#include "implicit/surface.h"
#include "implicit/thicken.h"
#include "interval/environment.h"

namespace certa {
namespace implicit {
namespace {

[[noreturn]] void refuse(DefectKind kind, const std::string& message) {
    throw InputError({Defect{kind, {}, {}, message}});
}

[[noreturn]] void refuse_error(double smallest) {
    char text[200];
    std::snprintf(text, sizeof text,
                  "a mesh that near to the zero set takes more than %zu triangles: ask for %.1g or more",
                  Simplification{}.most_triangles, 1.5 * smallest);
    refuse(DefectKind::option_out_of_range, text);
}

class Engine {
public:
    Engine(const Expression& function, const Grid& grid, const ImplicitOptions& options, const RunControl& control)
        : function_(function),
          tape_(function),
          tree_(grid, options.clip),
          field_(tape_),
          control_(control),
          certificate_(options.certificate),
          error_(options.error),
          hausdorff_(options.hausdorff),
          memory_bytes_(options.memory_bytes),
          uncertified_(options.uncertified),
          watershed_(options.engine == ImplicitEngine::thesis) {
        limits_.max_cells = options.max_cells.value_or(std::uint64_t{1} << 31);
        const auto deepest = static_cast<std::uint64_t>(tree_.max_depth());
        limits_.max_depth = static_cast<int>(std::min(options.max_depth.value_or(deepest), deepest));
        if (options.time_seconds && *options.time_seconds < 1'000'000'000)
            limits_.deadline = std::chrono::steady_clock::now() + std::chrono::seconds(*options.time_seconds);
    }

    ImplicitResult run() {
        result_.low = tree_.grid().place(GridPoint{0, 0, 0});
        result_.high = tree_.grid().place(GridPoint{tree_.grid().side(), tree_.grid().side(), tree_.grid().side()});
        if (const auto obstacle = classify(tree_, tape_, limits_, control_)) return stop(*obstacle);
        std::vector<Cluster> clusters = find_clusters(tree_);
        result_.statistics.clusters = clusters.size();
        std::optional<Triangulation> triangulation;
        Growth growth;
        LinkCache links;
        std::vector<std::uint32_t> split;
        for (;;) {
            ++result_.statistics.rounds;
            if (control_.cancelled()) return stop({ImplicitObstacle::Reason::cancelled, {}});
            if (is_too_large()) return stop({ImplicitObstacle::Reason::budget, {}});
            control_.report("certify", 1.0 - 1.0 / static_cast<double>(1 + result_.statistics.rounds));
            if (triangulation) {
                Triangulation next(tree_, field_, signs_, *triangulation, split);
                triangulation = std::move(next);
            } else {
                triangulation.emplace(tree_, field_, signs_, watershed_);
            }
            growth =
                watershed_ ? grow_watershed(*triangulation, sizes_of_values()) : grow(*triangulation, links, control_);
            Findings findings = check_conditions(tree_, *triangulation, growth, clusters, tape_, control_, proved_);
            if (control_.cancelled()) return stop({ImplicitObstacle::Reason::cancelled, {}});
            if (findings.offenders.empty()) {
                if (is_to_be_simplified(findings)) make_room(*triangulation, growth, findings, clusters);
                return conclude(*triangulation, growth, findings);
            }
            const bool critical = std::any_of(findings.offenders.begin(), findings.offenders.end(),
                                              [&](std::uint32_t leaf) { return tree_.cell(leaf).is_critical(); });
            if (const auto obstacle = split_all(tree_, findings.offenders, tape_, limits_, control_))
                return stop(*obstacle);
            if (critical) clusters = find_clusters(tree_);
            split = std::move(findings.offenders);
        }
    }

private:
    /// |f| at the points of the tree, in doubles; what is no number is larger than everything.
    const std::vector<double>& sizes_of_values() {
        while (sizes_.size() < tree_.points().size()) {
            const double size =
                std::fabs(field_.value(tree_.grid().place(tree_.points()[static_cast<std::uint32_t>(sizes_.size())])));
            sizes_.push_back(std::isnan(size) ? HUGE_VAL : size);
        }
        return sizes_;
    }

    /// Bytes of the next round, from peaks measured on large surfaces: cells and their corners, and for every open leaf
    /// the tetrahedra, stars and links of two leaves.
    bool is_too_large() const {
        if (!memory_bytes_) return false;
        std::uint64_t open = 0;
        for (const Cell& cell : tree_.cells()) open += cell.is_leaf() && cell.known.sign == 0 ? 1 : 0;
        // The watershed has all of T, not only what is near open leaves.
        return 200 * tree_.cells().size() + 8000 * (watershed_ ? tree_.cells().size() : open) > *memory_bytes_;
    }

    void count() {
        result_.statistics.evaluations = tape_.enclosures() + field_.uncounted();
        result_.statistics.cells = tree_.cells().size();
        for (const std::uint32_t leaf : tree_.leaves()) {
            ++result_.statistics.leaves;
            if (tree_.cell(leaf).known.sign == 0) ++result_.statistics.open_leaves;
        }
    }

    ImplicitResult stop(const Obstacle& obstacle) {
        count();
        result_.verdict = ImplicitVerdict::undecided;
        result_.outcome = obstacle.reason == ImplicitObstacle::Reason::cancelled ? Outcome::cancelled
                          : obstacle.reason == ImplicitObstacle::Reason::budget  ? Outcome::over_budget
                                                                                 : Outcome::undecided;
        for (const std::uint32_t leaf : obstacle.leaves) {
            if (result_.obstacles.size() == 1000) break;
            const Cell& cell = tree_.cell(leaf);
            result_.obstacles.push_back(
                {obstacle.reason, tree_.grid().place(cell.low), tree_.grid().place(tree_.high_of(cell))});
        }
        result_.obstacle_count = obstacle.leaves.size();
        if (obstacle.leaves.empty()) result_.obstacles.push_back({obstacle.reason, result_.low, result_.high});
        if (uncertified_ && result_.outcome != Outcome::cancelled && result_.statistics.open_leaves < 1'000'000)
            guess_mesh();
        return std::move(result_);
    }

    /// Where f seems to change its sign on the octree as it stands.
    void guess_mesh() {
        const Triangulation triangulation(tree_, field_, signs_);
        Findings nothing;
        nothing.component_of_point.assign(triangulation.point_count(), 0);
        Surface surface = build_surface(tree_, triangulation, nothing, field_);
        result_.mesh = std::move(surface.mesh);
        result_.triangle_components = std::move(surface.component_of_triangle);
    }

    bool is_to_be_simplified(const Findings& findings) const {
        return (error_ || hausdorff_) && !tree_.is_clipped() && !findings.components.empty();
    }

    /// Room for the simplification. All that W has to do is hold the mesh: if there is no thicker one it stays.
    void make_room(Triangulation& triangulation, Growth& growth, Findings& findings,
                   const std::vector<Cluster>& clusters) {
        const double reach = 2 * (error_ ? *error_ : *hausdorff_);
        auto thick =
            thicken({tree_, signs_, clusters, tape_, limits_, [&] { return is_too_large(); }, control_}, reach);
        if (!thick) return;
        triangulation = std::move(thick->triangulation);
        growth = std::move(thick->growth);
        findings = std::move(thick->findings);
    }

    ImplicitResult conclude(const Triangulation& triangulation, const Growth& growth, const Findings& findings) {
        count();
        Surface surface = build_surface(tree_, triangulation, findings, field_);
        if (is_to_be_simplified(findings)) {
            const Frontier frontier(tree_, triangulation, growth);
            const double smallest = smallest_error(surface, tape_, Simplification{}.most_triangles);
            const double share = error_ ? 1 : 0.75;  // of the length, as simplify_to_distance has it
            if (share * (error_ ? *error_ : *hausdorff_) < smallest) refuse_error(smallest / share);
            if (hausdorff_)
                result_.hausdorff = simplify_to_distance(surface, frontier, tape_, *hausdorff_, control_);
            else if (auto simplified = simplify(surface, &frontier, tape_, {*error_}, control_))
                surface = std::move(*simplified);
            else
                refuse_error(2 * *error_);
            // A mesh that is not as near as it was to be is no result.
            if (control_.cancelled()) return stop({ImplicitObstacle::Reason::cancelled, {}});
        }
        result_.statistics.tetrahedra = triangulation.tetrahedra().size();
        result_.outcome = Outcome::done;
        result_.verdict = findings.components.empty() ? ImplicitVerdict::empty : ImplicitVerdict::certified;
        result_.isotopic = !tree_.is_clipped();
        for (const ComponentOfW& component : findings.components) {
            CERTA_ASSERT((component.euler8 + 2 * component.edge_points) % 8 == 0);
            CERTA_ASSERT((component.euler() + component.loops) % 2 == 0 && component.genus() >= 0);
            result_.components.push_back({component.genus(), 0, 0, std::nullopt, component.loops});
            if (tree_.is_clipped()) continue;
            result_.components.back().inner_sign = component.inner_sign;
            result_.components.back().degree = component.degree8 / 8;
            if (component.parent != none) result_.components.back().parent = component.parent;
        }
        if (certificate_)
            result_.certificate = write_certificate(function_, tree_, triangulation, growth, surface, surface.mesh,
                                                    result_.components, result_.hausdorff);
        result_.mesh = std::move(surface.mesh);
        result_.triangle_components = std::move(surface.component_of_triangle);
        return std::move(result_);
    }

    Expression function_;
    expression::Tape tape_;
    Octree tree_;
    Field field_;
    const RunControl& control_;
    bool certificate_;
    std::optional<double> error_, hausdorff_;
    std::optional<std::uint64_t> memory_bytes_;
    bool uncertified_, watershed_;
    std::vector<double> sizes_;  ///< per point
    Limits limits_;
    std::vector<ProvedFace> proved_;  ///< of the frontier of the last round
    std::vector<Triangulation::PointSign> signs_;
    ImplicitResult result_;
};

}  // namespace

ImplicitResult certify_whole(const Expression& function, const Grid& grid, const ImplicitOptions& options,
                             const RunControl& control) {
    return Engine(function, grid, options, control).run();
}

Grid checked_grid(const Point3& low, const Point3& high) {
    const double sides[3] = {high.x - low.x, high.y - low.y, high.z - low.z};
    for (const double side : sides) {
        if (!std::isfinite(side) || !(side > 0))
            refuse(DefectKind::option_out_of_range,
                   "the box must have finite corners, and its high corner must be above its low one on every axis");
    }
    const auto grid = Grid::around(low, high);
    if (!grid)
        refuse(DefectKind::coordinate_out_of_range,
               "the box is too small for its distance from the origin, or too large or small for doubles: "
               "move or scale the function");
    return *grid;
}

}  // namespace implicit

ImplicitResult mesh_implicit(const Expression& function, const Point3& low, const Point3& high,
                             const ImplicitOptions& options, const RunControl& control) {
    if (options.max_depth && *options.max_depth < 1)
        implicit::refuse(DefectKind::option_out_of_range, "max_depth must be at least 1");
    if (options.time_seconds && *options.time_seconds < 1)
        implicit::refuse(DefectKind::option_out_of_range, "time_seconds must be at least 1");
    if (options.max_cells && *options.max_cells < 64)
        implicit::refuse(DefectKind::option_out_of_range, "max_cells must be at least 64");
    for (const std::optional<double>& length : {options.error, options.hausdorff}) {
        if (length && (!(*length > 0) || !std::isfinite(*length)))
            implicit::refuse(DefectKind::option_out_of_range, "error and hausdorff must be lengths above 0");
    }
    if (options.hausdorff && options.clip)
        implicit::refuse(DefectKind::option_out_of_range, "no distance is proved of surfaces that the box clips");
    if (options.error && options.clip)
        implicit::refuse(DefectKind::option_out_of_range,
                         "surfaces that the box clips are not simplified: leave out error or clip");
    const implicit::Grid grid = implicit::checked_grid(low, high);
    interval::require_sound_environment();
    if (options.engine == ImplicitEngine::plantinga_vegter) {
        if (options.clip || options.hausdorff || options.error)
            implicit::refuse(DefectKind::option_out_of_range,
                             "plantinga_vegter takes none of clip, error, hausdorff: use the engine growth");
        return implicit::mesh_by_subdivision(function, grid, options, control);
    }
    if (options.engine == ImplicitEngine::thesis && options.clip)
        implicit::refuse(DefectKind::option_out_of_range,
                         "the thesis's watershed is for closed surfaces: use the engine growth with clip");
    const std::vector<Expression> factors = implicit::factors_of(function);
    if (!factors.empty() && !options.hausdorff) {
        ImplicitOptions certain = options;
        certain.uncertified = false;
        ImplicitResult result = implicit::mesh_product(function, factors, grid, certain, control);
        const bool guess = options.uncertified && result.outcome != Outcome::cancelled;
        if (result.verdict != ImplicitVerdict::undecided || !guess) return result;
    }
    return implicit::certify_whole(function, grid, options, control);
}

const char* name_of(ImplicitEngine engine) {
    return engine == ImplicitEngine::growth   ? "growth"
           : engine == ImplicitEngine::thesis ? "thesis"
                                              : "plantinga-vegter";
}

const char* name_of(ImplicitVerdict verdict) {
    switch (verdict) {
        case ImplicitVerdict::certified:
            return "certified";
        case ImplicitVerdict::empty:
            return "empty";
        default:
            return "undecided";
    }
}

const char* name_of(ImplicitObstacle::Reason reason) {
    using Reason = ImplicitObstacle::Reason;
    switch (reason) {
        case Reason::singular:
            return "singular";
        case Reason::meets_box:
            return "meets_box";
        case Reason::tangent_to_box:
            return "tangent_to_box";
        case Reason::undefined:
            return "undefined";
        case Reason::precision:
            return "precision";
        case Reason::budget:
            return "budget";
        default:
            return "cancelled";
    }
}

}  // namespace certa
