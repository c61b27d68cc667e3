// The whole way from triangles to polygons (thesis, Part II chapter 4; docs/remesh.md).
//
// Plan: input and features, directions, smoothing; then rounds of spacing, lines, graph, polygons, until the number of
// vertices or faces is what was asked for; then placement. Vertices go like 1 / epsilon, so a few steps of the secant
// rule on logarithms find epsilon; the round that came nearest counts.
#include <certa/distance.h>
#include <certa/io.h>
#include <certa/remeshing.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/assert.h"
#include "core/parallel.h"
#include "core/triangle_tree.h"
#include "remeshing/cancel_umbilics.h"
#include "remeshing/caps.h"
#include "remeshing/check_options.h"
#include "remeshing/coarsen.h"
#include "remeshing/crowded.h"
#include "remeshing/flat_faces.h"
#include "remeshing/give_result.h"
#include "remeshing/guides.h"
#include "remeshing/isotropic.h"
#include "remeshing/mend.h"
#include "remeshing/missed_creases.h"
#include "remeshing/nearer_origin.h"
#include "remeshing/pair_triangles.h"
#include "remeshing/place_and_cut.h"
#include "remeshing/place_around.h"
#include "remeshing/placement.h"
#include "remeshing/polygons.h"
#include "remeshing/remesher.h"
#include "remeshing/rescue.h"
#include "remeshing/share_nodes.h"
#include "remeshing/sound_subdivision.h"
#include "remeshing/stitch.h"
#include "remeshing/stopwatch.h"
#include "remeshing/surface_cut.h"
#include "remeshing/templates.h"
#include "remeshing/trace_lines.h"

namespace certa {
namespace remeshing {

namespace {

constexpr double most_trimmed = 0.25;  ///< of what a network has, in vertices or faces

}  // namespace

SpacingRule Remesher::rule_of(double error) const {
    SpacingRule rule;
    rule.error = caps_.given(error);
    rule.isotropy = options_.isotropy;
    rule.transfer = options_.transfer;
    rule.balance = balance_;
    rule.most = caps_.of_families();
    if (options_.vertices || options_.faces) rule.evening = 1.0 / 3.0;
    if (options_.hyperbolic_spacing) rule.hyperbolic = std::numbers::sqrt2;
    if (options_.isotropic_samples == IsotropicSamples::all) rule.near_umbilics = 0.8;
    return rule;
}

/// Vertices on creases stay on them, so that their sides miss them by the whole sagitta; placement halves others.
ArrangementRule Remesher::arrangement_rule(double error) const {
    const double most = options_.vertices || options_.faces ? mesh_.diagonal : 0.8 * wanted_error();
    return {std::min(0.75 * error, most), std::min(1.4 * error, most)};
}

double Remesher::start_error(double wanted) {
    if (wanted == 0.0) return 0.8 * wanted_error();
    constexpr double share = 0.68;  // of vertices expected where lines are as far apart as they may: gaps are narrower
    caps_.expect(wanted);
    double error = 4e-3 * mesh_.diagonal;
    for (int round = 0; round < 4; ++round) {
        const double expected =
            expected_vertices(mesh_, compute_spacing(mesh_, field_, rule_of(error), caps_.at(error))) /
            (share * wanted);
        error *= std::clamp(expected, 0.05, 20.0);
        if (std::abs(expected - 1.0) < 0.01) break;
    }
    return caps_.given(error);
}

bool Remesher::prepare() {
    control_.report("curvature", 0.0);
    field_ = measure_directions(mesh_, control_);
    watch_.stage("tensors");
    if (control_.cancelled()) return false;
    double length = 5.0 * mesh_.mean_edge;
    if (options_.smooth) length = options_.smooth->resolve(mesh_.diagonal);
    if (!options_.guides.empty()) {
        const Spacing spacing = compute_spacing(mesh_, field_, rule_of(start_error(wanted_count())), {});
        double reach = 0.0;
        for (Index w = 0; w < mesh_.wedge_count(); ++w) reach += std::min(spacing.at[0][w], spacing.at[1][w]);
        reach /= mesh_.wedge_count();
        follow_guides(mesh_, field_, 0.6 * reach, 2.0 * std::max(length, reach));
    }
    control_.report("smoothing", 0.2);
    if (options_.smoothing_method == SmoothingMethod::gaussian)
        smooth_by_gaussian(mesh_, field_, length, control_);
    else
        smooth_directions(mesh_, field_, length, control_);
    watch_.stage("smoothing");
    RemeshStatistics& s = result_.statistics;
    s.smoothing = length;
    const Spacing spacing = compute_spacing(mesh_, field_, rule_of(start_error(wanted_count())), {});
    s.cancelled_pairs = cancel_umbilic_pairs(mesh_, spacing, field_, control_);
    watch_.stage("umbilics");
    count_umbilics(field_, mesh_, s);
    return !control_.cancelled();
}

/// Faces whose polygons turn away or meet others, or miss creases by much more than they are away elsewhere: too coarse
/// for what the surface does there. `reach` grows to what they are away.
std::vector<Index> Remesher::broken_faces(const Draft& draft, CoarseMesh polygons, double& reach) {
    Judge judge{input_, *tree_, mesh_.diagonal, is_embedded_.value_or(true), mesh_.is_cut_open};
    std::vector<Index> faces;
    std::vector<Index> broken = judge_input(polygons, judge).polygons;
    if (draft.open.size() == draft.filled.size() && !(mesh_.minor_edges.empty() && mesh_.minor_corners.empty())) {
        constexpr double part = 0.8;  // placement brings polygons nearer, and then fewer creases are near enough
        reach = std::max(reach, reach_of(mesh_, judge, polygons));
        add_missed_creases(mesh_, judge, polygons, part * reach, broken);
    }
    for (const Index q : broken)
        if (const Index f = polygons.parent(q);
            f != no_index && !std::binary_search(draft.open.begin(), draft.open.end(), f))
            faces.push_back(polygons.parent(q));
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    return faces;
}

/// Faces that will not be polygons but triangles of the input: in flat patches, which no line crosses, what is no disk;
/// with `all`, whatever is none. They are no flaws any more.
std::vector<Index> Remesher::open_faces(Flaws& flaws, const Draft& draft, bool all) const {
    std::vector<std::uint8_t> is_kept(mesh_.patch_count, 0);
    if (!all)
        for (Index w = 0; w < mesh_.wedge_count(); ++w)
            if (draft.spacing.wanted[0][w] || draft.spacing.wanted[1][w])
                is_kept[mesh_.patches[mesh_.wedge_first[w] / 3]] = 1;
    std::vector<std::uint8_t> is_flawed(mesh_.patch_count, 0), is_met(mesh_.patch_count, 0);
    for (const Index p : flaws.patches) is_flawed[p] = 1;
    std::optional<DiskTest> is_disk;
    if (!flaws.patches.empty()) is_disk.emplace(draft.network, draft.graph);
    std::vector<Index> open;
    for (Index f = 0; f < draft.faces.size(); ++f) {
        const Index p = patch_beside(draft.graph, draft.network, draft.faces[f].front());
        if (p == no_index || is_kept[p] != 0) continue;
        is_met[p] = 1;
        if (std::binary_search(flaws.faces.begin(), flaws.faces.end(), f) ||
            (is_flawed[p] != 0 && !(*is_disk)(draft.faces[f])))
            open.push_back(f);
    }
    std::erase_if(flaws.patches, [&](Index p) { return is_met[p] != 0; });
    std::erase_if(flaws.faces, [&](Index f) { return std::binary_search(open.begin(), open.end(), f); });
    return open;
}

/// Where a patch is flawed although lines tie all of it: rims of what is no disk.
void Remesher::add_rims(const Draft& draft, Flaws& flaws) const {
    std::vector<std::uint8_t> is_looked_at(mesh_.patch_count, 0);
    for (const Index p : flaws.patches) is_looked_at[p] = 1;
    for (const FlawPlace& place : flaws.places)
        if (place.size > 0.0) is_looked_at[place.patch] = 0;
    if (std::all_of(is_looked_at.begin(), is_looked_at.end(), [](std::uint8_t b) { return b == 0; })) return;
    const DiskTest is_disk(draft.network, draft.graph);
    for (const auto& face : draft.faces) {
        const Index p = patch_beside(draft.graph, draft.network, face.front());
        if (p == no_index || is_looked_at[p] == 0 || is_disk(face)) continue;
        FlawPlace place{p, {}, 0.0};
        for (const Index h : face) {
            place.nodes.push_back(draft.graph.tail(h));
            place.size = std::max(place.size, distance(draft.graph.nodes[draft.graph.tail(h)].point,
                                                       draft.graph.nodes[draft.graph.tail(face.front())].point));
        }
        flaws.places.push_back(std::move(place));
    }
}

void Remesher::merge_ends(Draft& draft) const {
    constexpr double share = 0.5;  // of the spacing of lines
    std::vector<double> reach;
    for (const SurfacePlace& place : draft.polygons.places) {
        double least = mesh_.diagonal;
        for (Index c = 3 * place.face; c < 3 * place.face + 3; ++c)
            for (const auto& at : draft.spacing.at) least = std::min(least, at[mesh_.wedges[c]]);
        reach.push_back(share * least);
    }
    draft.merged = merge_line_ends(draft.polygons, reach, arrangement_rule(draft.error));
}

/// Faces around isotropic samples become triangles.
void Remesher::add_samples(Draft& d) const {
    if (options_.isotropic_samples == IsotropicSamples::none) return;
    SampleRule rule;
    rule.error = 2.0 * d.error;
    rule.everywhere = options_.isotropic_samples == IsotropicSamples::all;
    d.samples = triangulate_around(choose_samples(d.graph, d.network, d.faces, field_, d.spacing, rule), d.polygons);
}

/// Cutting may repeat an edge that is there already: such polygons get a vertex in the middle instead.
void Remesher::relieve_crowded(Draft& d) {
    for (int fans = 0; fans < 3; ++fans) {
        const std::vector<Index> crowded = crowded_vertices(cut(d.polygons));
        if (crowded.empty()) return;
        d.polygons = fan_out(d.polygons, crowded);
    }
}

Draft Remesher::draft(double error) {
    constexpr int patience = 6, most_rounds = 16, most_broken_rounds = 3;
    int broken_rounds = 0;
    std::optional<Draft> before;  // the last one without flaws, and its broken faces
    std::size_t were_broken = 0;
    caps_.loosen(error);
    for (int round = 0;; ++round) {
        Spacing spacing = compute_spacing(mesh_, field_, rule_of(error), caps_.at(error));
        watch_.stage("spacing");
        const double given = caps_.given(error);
        Draft d{error, given, trace_lines(mesh_, field_, spacing, trace_rule_, control_)};
        d.spacing = std::move(spacing);
        watch_.stage("lines");
        ++result_.statistics.rounds;
        d.graph = build_graph(d.network, arrangement_rule(given));
        simplify_graph(d.graph, d.network);
        share_nodes(d.graph, mesh_);
        d.faces = d.graph.trace_faces(mesh_);
        Flaws flaws = find_flaws(d.graph, d.network, d.faces);
        d.open = open_faces(flaws, d, false);
        if (round >= patience && !flaws.empty()) {
            const std::vector<Index> given_up = open_faces(flaws, d, true);
            d.gives_up = !given_up.empty();
            d.open.insert(d.open.end(), given_up.begin(), given_up.end());
            std::sort(d.open.begin(), d.open.end());
        }
        if (flaws.empty()) {
            d.polygons = make_polygons(d.graph, d.faces, d.open, d.counts, d.nodes);
            merge_ends(d);
            d.filled =
                fill_flat_faces(d.network, d.graph, d.faces, d.open, d.nodes, d.merged, 0.02 * given, d.polygons);
            add_samples(d);
            relieve_crowded(d);
        }
        watch_.stage("arrangement");
        if (flaws.empty() && !control_.cancelled()) {
            std::vector<Index> broken = broken_faces(d, cut(d.polygons), d.reach);
            d.broken = broken.size();
            watch_.stage("damage");
            constexpr double dear = 30.0;  // vertices for a face that is mended no more
            if (before && (broken.size() >= were_broken ||
                           count_of(d) > count_of(*before) + dear * static_cast<double>(were_broken))) {
                caps_.take_back();
                return std::move(*before);
            }
            if (!broken.empty() && broken_rounds++ < most_broken_rounds) {
                were_broken = broken.size();
                caps_.refine_broken(broken, d.graph, d.faces, d.spacing);
                before.emplace(std::move(d));
                continue;
            }
        }
        if (flaws.empty() || control_.cancelled()) return d;
        if (round == most_rounds) {
            for (Index f = 0; f < mesh_.face_count() && d.flaws.empty(); ++f)
                if (std::binary_search(flaws.patches.begin(), flaws.patches.end(), mesh_.patches[f]))
                    d.flaws.push_back(mesh_.points[mesh_.faces[f][0]]);
            for (const Index f : flaws.faces) d.flaws.push_back(d.graph.nodes[d.graph.tail(d.faces[f][0])].point);
            return d;
        }
        if (round > 0) add_rims(d, flaws);
        caps_.refine(flaws, d.graph, d.faces, d.spacing, round >= 2);
    }
}

double Remesher::count_of(const Draft& draft) {
    if (!options_.faces && mesh_.is_cut_open) return static_cast<double>(count_vertices(draft.polygons, true));
    if (!options_.faces) return static_cast<double>(draft.polygons.points.size() - draft.merged.size());
    // Cutting into quads and triangles adds faces.
    return static_cast<double>(
        (options_.output == RemeshOutput::polygons ? draft.polygons : cut(draft.polygons)).polygon_count());
}

/// A few vertices too many are those that matter least. Where that breaks polygons, they stay as they were.
void Remesher::trim(Draft& d, double wanted) {
    constexpr int most_tries = 5;
    if (1.0 - wanted / count_of(d) > most_trimmed) return;
    std::vector<std::uint8_t> is_free(d.nodes.size(), 1);
    const CoarseMesh polygons = d.polygons;
    const std::vector<MergedVertex> merged = d.merged;
    for (int tries = 0; tries < most_tries && !control_.cancelled(); ++tries) {
        for (int round = 0; round < 3 && count_of(d) > wanted + 0.5; ++round) {
            const double count = count_of(d);
            const auto vertices = static_cast<double>(d.polygons.points.size() - d.merged.size());
            const double merges = options_.faces ? std::ceil((1.0 - wanted / count) * vertices) : count - wanted;
            append_merged(d.merged, coarsen(*tree_, arrangement_rule(d.error), static_cast<std::size_t>(merges),
                                            is_free, d.polygons));
            relieve_crowded(d);
        }
        double reach = d.reach;
        const std::vector<Index> broken = broken_faces(d, cut(d.polygons), reach);
        if (broken.size() <= d.broken) {
            d.reach = reach;
            break;
        }
        d.polygons = polygons, d.merged = merged;
        // The polygons that became these stay, and after a while those around them.
        std::vector<std::uint8_t> stays(polygons.points.size(), 0);
        for (Index q = 0; q < polygons.polygon_count(); ++q)
            if (std::binary_search(broken.begin(), broken.end(), polygons.parent(q)))
                for (const Index v : polygons.polygon(q)) stays[v] = 1;
        for (int ring = 1; ring < tries; ++ring) mark_around(polygons, stays);
        for (Index v = 0; v < is_free.size(); ++v)
            if (stays[v] != 0) is_free[v] = 0;
    }
    watch_.stage("trimming");
}

/// The last network will do again where it has a few vertices too many and can be trimmed.
void Remesher::search(double wanted) {
    constexpr double most_again = 0.12, enough = 1.02;
    const double before = untrimmed_ ? count_of(*untrimmed_) : 0.0;
    if (before >= wanted && before * (1.0 - most_again) <= wanted) {
        best_.emplace(*untrimmed_);
        trim(*best_, wanted);
        if (count_of(*best_) <= enough * wanted) return;
    }
    best_.reset();
    find_network(wanted);
    if (best_) untrimmed_.emplace(*best_);
    if (best_ && best_->flaws.empty() && !control_.cancelled()) trim(*best_, wanted);
}

/// Counts jump where a closed line more or less fits: epsilon is bracketed, then the limit of gaps, then one family
/// gets more lines for fewer of the other. Somewhat too many will do, see `trim`.
void Remesher::find_network(double wanted) {
    double best_miss = 1e300;
    const auto miss_of = [](double off, const Draft& d) {
        constexpr double of_mending = 0.02, of_broken = 0.002, of_giving_up = 1.0;  // mending changes the count again
        constexpr double of_too_few = 3.0;
        const bool can_be_trimmed = off > 0.0 && off < -std::log(1.0 - most_trimmed);
        return (can_be_trimmed ? 0.25 * off
                : off > 0.0    ? off
                               : -of_too_few * off) +
               (d.broken > 0 ? of_mending : 0.0) + of_broken * static_cast<double>(d.broken) +
               (d.gives_up ? of_giving_up : 0.0);
    };
    int networks = 0;
    /// How far the count is off a little more than what is wanted, as a logarithm; empty: near enough, or cancelled.
    const auto attempt = [&](double error) -> std::optional<double> {
        // What one error needs so that faces are disks, a larger one does not.
        caps_.forget_flaws();
        Draft d = draft(error);
        if (control_.cancelled()) return std::nullopt;
        ++networks;
        // Of what is given up, nodes tell how many vertices there would be.
        const double count = d.gives_up ? static_cast<double>(d.nodes.size()) : count_of(d);
        const double off = std::log(std::max(count, 1.0) / wanted);
        constexpr double aim = 0.04;
        const bool whole = d.flaws.empty();
        if (!best_ || (whole && miss_of(off, d) < best_miss)) {
            best_miss = whole ? miss_of(off, d) : 1e300;
            best_.emplace(std::move(d));
        }
        if (best_miss < (networks < 4 ? 0.015 : 0.03)) return std::nullopt;
        return off - aim;
    };
    trace_rule_ = {};
    balance_ = 1.0;
    const double start = start_error(1.05 * wanted);
    struct End {
        double knob = 0.0, off = 0.0;
    };
    std::optional<End> many, few, last;
    double error = start;
    for (int round = 0; round < 6; ++round) {
        const std::optional<double> off = attempt(error);
        if (!off) return;
        (*off > 0.0 ? many : few) = End{std::log(error), *off};
        double step = *off;
        if (last) step /= std::clamp((last->off - *off) / (std::log(error) - last->knob), 0.5, 1.5);
        step = std::clamp(step, -1.2, 1.2);
        last = End{std::log(error), *off};
        if (many && few) {
            const double part = std::clamp(many->off / (many->off - few->off), 0.15, 0.85);
            step = many->knob + part * (few->knob - many->knob) - std::log(error);
        }
        error *= std::exp(step);
    }
    if (!many || !few) return;
    error = std::exp(0.5 * (many->knob + few->knob));
    double low = 0.62, high = 0.9;
    for (const double first : {best_miss, 0.0, 0.0, 0.0}) {
        trace_rule_.gap_above = first > 0.0 ? 0.75 : 0.5 * (low + high);
        const std::optional<double> off = attempt(error);
        if (!off) return;
        (*off > 0.0 ? low : high) = trace_rule_.gap_above;
    }
    trace_rule_.gap_above = 0.75;
    for (const double balance : {1.02, 0.98, 1.05, 0.95}) {
        balance_ = balance;
        if (!attempt(best_->knob)) return;
    }
}

/// Vertices of the input's own curves, for placement along them.
PlacementReport Remesher::place(CoarseMesh& mesh, PlacementOptions options) {
    options.both_diagonals = wanted_count() == 0.0;
    std::vector<FeatureEdge> features;
    for (Index e = 0; e < mesh_.edge_curves.size(); ++e) {
        const Index h = mesh_.edge_halfedges[e];
        if (mesh_.edge_curves[e] != no_index)
            features.push_back({mesh_.start_of(h), mesh_.end_of(h), mesh_.edge_curves[e]});
    }
    control_.report("placement", 0.9);
    const std::vector<Point3> before = mesh.points;
    PlacementReport report = place_vertices(input_, features, mesh, options, control_);
    // To the last bit: copies of a corner find each other by it.
    for (std::size_t v = 0; v < before.size(); ++v)
        if (mesh.kinds[v] == VertexKind::corner) mesh.points[v] = before[v];
    farthest_ = report.farthest;
    rms_ = report.rms_after;
    judged_ = mesh;
    watch_.stage("placement");
    return report;
}

CoarseMesh Remesher::cut(const CoarseMesh& polygons) {
    switch (options_.output) {
        case RemeshOutput::polygons:
            return options_.max_degree > 0 ? limit_degree(polygons, options_.max_degree) : polygons;
        case RemeshOutput::quad_dominant:
            return make_quad_dominant(polygons);
        case RemeshOutput::triangles:
            return make_triangles(polygons, *tree_);
    }
    return polygons;
}

void Remesher::describe_polygons() {
    RemeshStatistics& s = result_.statistics;
    s.spacing_error = best_->error;
    s.t_nodes = best_->counts.t_nodes;
    s.isotropic_samples = best_->samples;
    const double polygons = static_cast<double>(std::max<std::size_t>(best_->counts.polygons, 1));
    s.quad_share_with_t = static_cast<double>(best_->counts.quads_with_t) / polygons;
    s.quad_share_without_t = static_cast<double>(best_->counts.quads_without_t) / polygons;
}

/// Cuts and places the polygons. False: there are none, because no network has only disks for faces.
bool Remesher::finish() {
    recuts_.clear();
    describe_polygons();
    if (!best_->flaws.empty()) return false;
    CoarseMesh polygons = cut(best_->polygons);
    if (options_.placement) even_cells(polygons);
    CoarseMesh coarse = polygons;
    fill_open_faces(best_->layout(), {input_, *tree_, mesh_.diagonal, true}, mending_rule(0.0), coarse, control_);
    watch_.stage("outputs");
    // Where nearly all is from the input, there is little to place and much to look at.
    const bool is_mostly_input = coarse.points.size() > 4 * polygons.points.size();
    const bool places = options_.placement && !is_mostly_input;
    const bool is_cut_anew = options_.output == RemeshOutput::quad_dominant;
    if (places && options_.output == RemeshOutput::polygons) {
        // Placed as quads and triangles, which say how the polygons are filled.
        CoarseMesh filled = make_quad_dominant(coarse);
        place(filled);
        coarse.points = filled.points;
        coarse.places = filled.places;
    } else if (places && is_cut_anew) {
        const auto place_mesh = [&](CoarseMesh& m, const PlacementOptions& options) { return place(m, options); };
        recuts_ = place_and_cut(polygons, *tree_, place_mesh, wanted_count() == 0.0, coarse);
    } else if (places) {
        place(coarse);
    } else if (wanted_count() == 0.0) {
        PlacementOptions only_measured;
        only_measured.rounds = only_measured.peak_rounds = 0;
        place(coarse, only_measured);
    }
    filled_ = std::move(coarse);
    placed_ = polygons;
    for (std::size_t v = 0; v < placed_.points.size(); ++v) {
        placed_.points[v] = filled_.points[v];
        placed_.places[v] = filled_.places[v];
    }
    if (options_.output == RemeshOutput::quad_dominant && recuts_.empty()) recuts_ = find_recuts(placed_);
    if (places) undo_evening();
    if (places && wanted_count() > 0.0) {
        lower_peaks();
        cover_creases();
    }
    return true;
}

/// Whether contacts matter is known only when there are some: the input is asked then.
Damage Remesher::judge_input(CoarseMesh& mesh, Judge& judge) {
    judge.is_embedded = is_embedded_.value_or(true);
    Damage damage = find_damage(judge, mesh, control_);
    if (is_embedded_ || damage.contacts == 0) return damage;
    is_embedded_ = !has_contact(input_, mesh_.point_sources, control_);
    judge.is_embedded = *is_embedded_;
    return *is_embedded_ ? damage : find_damage(judge, mesh, control_);
}

MendingRule Remesher::mending_rule(double error) const {
    MendingRule rule;
    rule.tolerance = error > 0.0 ? 0.7 * error : 0.5 * best_->error;
    rule.side_tolerance = error > 0.0 ? 0.9 * error : 1.5 * best_->error;
    rule.crease_reach = arrangement_rule(best_->error).crease_error;
    rule.error = error;
    rule.reach = error;
    if (options_.subdivide > 0)
        rule.creases = {0.7, 0.7};  // subdivision lowers the distance, and with it what is allowed
    rule.all_triangles = options_.output == RemeshOutput::triangles || options_.max_degree == 3;
    rule.recuts = recuts_;
    rule.all_recuts = error > 0.0;
    return rule;
}

CoarseMesh Remesher::mended(CoarseMesh mesh, double error) {
    Judge judge{input_, *tree_, mesh_.diagonal, is_embedded_.value_or(true), mesh_.is_cut_open};
    CoarseMesh looked_at = recut(mesh, recuts_);
    judge_input(looked_at, judge);
    const MendingReport report = mend(best_->layout(), judge, mending_rule(error), mesh, control_);
    RemeshStatistics& s = result_.statistics;
    s.mended_regions = report.regions;
    s.mended_triangles = report.triangles;
    s.cut_faces = report.cut_faces;
    if (options_.placement && error == 0.0 && report.regions > 0 && report.left.empty()) {
        const auto place_all = [&] {
            place_around(
                report.first_added, [&](CoarseMesh& m, const PlacementOptions& how) { return place(m, how); },
                [&](CoarseMesh& m) {
                    std::vector<Index> broken = judge_input(m, judge).polygons;
                    if (!broken.empty()) return broken;
                    const double limit = crease_limit(mending_rule(0.0).creases, mesh_, judge, m, control_);
                    if (!std::isinf(limit)) add_missed_creases(mesh_, judge, m, limit, broken);
                    return broken;
                },
                mesh, control_);
        };
        place_all();
        if (cut_last_peaks(judge, mesh)) place_all();
    }
    rescue_components(best_->layout(), judge, {mending_rule(error).tolerance, report.left}, mesh, control_);
    watch_.stage("mending");
    return mesh;
}

/// Instead of a network: the input with fewer triangles.
void Remesher::give_input(double tolerance, const std::string& why) {
    const std::size_t vertices = options_.vertices ? *options_.vertices : options_.faces ? *options_.faces / 2 : 0;
    Judge judge{input_, *tree_, mesh_.diagonal, is_embedded_.value_or(true), mesh_.is_cut_open};
    CoarseMesh mesh;
    for (const double part : {1.0, 0.25, 1e-4}) {
        mesh = thin_input(mesh_, judge, part * tolerance, vertices, control_);
        judge_input(mesh, judge);
        if (part == 1e-4 || control_.cancelled() || find_damage(judge, mesh, control_).polygons.empty()) break;
    }
    const bool may_pair = options_.output != RemeshOutput::triangles && options_.max_degree != 3;
    if (may_pair && find_damage(judge, mesh, control_).polygons.empty()) {
        CoarseMesh paired = pair_triangles(mesh, std::vector<Index>(mesh.polygon_count(), 0), 5e-3 * tolerance);
        if (find_damage(judge, paired, control_).polygons.empty()) mesh = std::move(paired);
    }
    result_.statistics.mended_regions = mesh_.component_count;
    result_.statistics.mended_triangles = mesh.polygon_count();
    const std::string place = best_->flaws.empty() ? "" : ", first near " + text_of(best_->flaws.front());
    const std::string note = why + place + ": the result is made of triangles of the input, thinned out";
    std::vector<std::string>& notes = result_.statistics.notes;
    if (notes.empty() || notes.back() != note) notes.push_back(note);
    emit(mesh);
}

void Remesher::finish_count() {
    if (!finish()) {
        give_input(options_.vertices || options_.faces ? mesh_.diagonal : best_->error, "no network of lines will do");
        return;
    }
    constexpr double of_mending = 0.15, enough = 0.03;  // of a result that is all mended; in logarithms of the count
    const double wanted = wanted_count();
    std::optional<Attempt> kept;
    double least = 1e300, network = 0.0, aim = std::log(wanted);
    std::optional<std::array<double, 2>> few,
        many;  // logarithms: what the network had, how far off it came out
    std::vector<double> aims;
    // What mending adds, the network has to do without.
    for (int round = 0; round < 6; ++round) {
        CoarseMesh mesh = mended(placed_, 0.0);
        if (control_.cancelled()) return;
        const double count = final_count(mesh), off = std::log(count / wanted);
        const double drafted = count_of(*best_);
        const bool is_mended = std::abs(count - drafted) > 0.01 * wanted;
        const double miss = std::abs(off) + of_mending * static_cast<double>(result_.statistics.mended_triangles) /
                                                static_cast<double>(mesh.polygon_count());
        if (miss < least) {
            least = miss;
            network = drafted;
            kept.emplace(Attempt{std::move(*best_), std::move(mesh), result_.statistics});
        }
        if (least < enough || (round == 0 && !is_mended)) break;
        // As much as it was this time, unless that has been tried; the next network may need less of it.
        const double tried = std::log(drafted), most_step = round == 0 ? 0.1 : 1.0;
        (off > 0.0 ? many : few) = {tried, off};
        aims.push_back(aim);
        aim = std::max(std::log(wanted) - std::log(count / drafted), tried - most_step);
        if (std::any_of(aims.begin(), aims.end(), [&](double a) { return std::abs(a - aim) < 0.01; })) {
            aim = tried - std::clamp(off, -most_step, most_step);
            if (!is_mended) {
                aim = 0.5 * (tried + std::log(wanted));
            } else if (many && few) {
                const double part = std::clamp((*many)[1] / ((*many)[1] - (*few)[1]), 0.2, 0.8);
                aim = (*many)[0] + part * ((*few)[0] - (*many)[0]);
            }
        }
        const double least_network = network;
        search(std::max(std::exp(aim), 4.0));
        if (control_.cancelled() || !best_) return;
        // Fewer cannot be had: where lines get no polygons, they come closer together.
        if (round > 1 && off > 0.0 && count_of(*best_) > least_network) break;
        if (!finish()) break;
    }
    keep(std::move(*kept));
    note_count(final_count(kept->mesh), wanted, network, result_.statistics);
}

/// The last stage: rounds of subdivision, which keep what has been promised, of what would have been given without.
void Remesher::subdivide_result() {
    if (options_.subdivide == 0 || control_.cancelled() || result_.outcome != Outcome::done) return;
    const bool keeps_error = wanted_count() == 0.0;
    const Judge judge{input_, *tree_, mesh_.diagonal, is_embedded_.value_or(true), mesh_.is_cut_open};
    SubdivisionRule rule{options_.subdivide, keeps_error ? wanted_error() / 1.03 : 0.0, &mesh_};
    SubdivisionReport report;
    const CoarseMesh coarse = given_;
    emit(subdivide_soundly(coarse, rule, judge, report, control_));
    watch_.stage("subdivision");
    if (keeps_error && !control_.cancelled() && prove_distance() > wanted_error()) {
        report = {};
        emit(coarse);
        prove_distance();
    }
    give_report(report, options_.subdivide, result_.statistics);
}

/// Takes an attempt for the result; its times are those of all.
void Remesher::keep(Attempt&& attempt) {
    best_.emplace(std::move(attempt.draft));
    attempt.statistics.stage_seconds = result_.statistics.stage_seconds;
    attempt.statistics.rounds = result_.statistics.rounds;
    result_.statistics = std::move(attempt.statistics);
    emit(attempt.mesh);
}

RemeshResult Remesher::run() {
    check_error(options_, mesh_.diagonal);
    if (prepare()) {
        if (options_.vertices || options_.faces) {
            search(wanted_count());
            if (best_ && !control_.cancelled()) finish_count();
        } else {
            meet_error();
        }
    }
    if (best_) subdivide_result();
    if (control_.cancelled() || !best_) {
        result_.outcome = Outcome::cancelled;
        return std::move(result_);
    }
    give_lines(best_->network, field_, mesh_, options_.lines, result_);
    control_.report("done", 1.0);
    return std::move(result_);
}

}  // namespace remeshing

RemeshResult remesh(const TriangleMesh& mesh, const RemeshOptions& options, const RunControl& control) {
    remeshing::check_options(options);
    if (const std::optional<Point3> origin = remeshing::far_origin(mesh))
        return remeshing::remesh_near_origin(mesh, *origin, options, control);
    RemeshResult result = remeshing::Remesher(mesh, options, control).run();
    const double wanted = static_cast<double>(options.vertices ? *options.vertices : options.faces.value_or(0));
    const auto miss = [&](const RemeshResult& r) {
        return std::abs(
            std::log(static_cast<double>(options.vertices ? r.statistics.vertices : r.statistics.faces) / wanted));
    };
    if (wanted <= static_cast<double>(mesh.positions.size()) || options.subdivide > 0 ||
        result.outcome != Outcome::done || miss(result) <= 0.05)
        return result;
    // Edges of the input may be too long for lines as close as they would have to be.
    RemeshResult other = remeshing::Remesher(mesh, options, control, wanted).run();
    if (other.outcome != Outcome::done) return other;
    return miss(other) < miss(result) ? std::move(other) : std::move(result);
}

}  // namespace certa
