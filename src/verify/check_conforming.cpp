// The public checker: decides promises 1-4 of docs/conventions.md on the doubles of a mesh, sharing no code with what
// makes meshes (own predicates, own reading of the complex). Each stage's file opens with its proof:
//   check_tetrahedra  well-formed: what the other stages rest on
//   check_domain      the tetrahedra fill the convex hull or the kept regions exactly once
//   check_delaunay    no vertex inside a circumsphere; gabriel
//   check_segments, check_facets   conforming and faithful
//   check_regions     labelled
#include <certa/conforming.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "verify/subject.h"

namespace certa {
namespace {

using namespace verify;

/// Roundings of a coordinate that an added vertex may be off, at least: no mesh can be better than a few ulps.
constexpr double rounding_allowance = 8.0;

void check_options(const ConformingCheckOptions& options) {
    std::vector<Defect> defects;
    const auto check = [&](const Length& length, const char* name) {
        if (std::isfinite(length.value) && length.value >= 0.0) return;
        defects.push_back(
            {DefectKind::option_out_of_range,
             {{ElementKind::option, 0}},
             {},
             std::string(name) + " is " + show(length.value) + "; expected a number that is not negative"});
    };
    check(options.planarity, "planarity");
    check(options.deviation, "deviation");
    if (!defects.empty()) throw InputError(std::move(defects));
}

/// Resolves lengths against the bounding box of the input; a relative deviation is at least a few roundings of the
/// largest coordinate.
void resolve_lengths(Subject& subject) {
    const auto& positions = subject.complex.positions;
    if (positions.empty()) return;
    Point3 low = positions[0], high = low;
    double largest = 0.0;
    for (const Point3& p : positions) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
        largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    }
    const double diagonal = std::hypot(high.x - low.x, high.y - low.y, high.z - low.z);
    const double rounding = rounding_allowance * (std::nextafter(largest, INFINITY) - largest);
    subject.deviation = subject.options.deviation.resolve(diagonal);
    if (subject.options.deviation.relative_to_diagonal) subject.deviation = std::max(subject.deviation, rounding);
    subject.planarity = subject.options.planarity.resolve(diagonal);
}

template <class Labels, class Elements>
bool are_labelled(const Labels& labels, const Elements& elements) {
    return !labels.empty() && labels.size() == elements.size();
}

std::vector<std::uint8_t> find_used(const TetMesh& mesh) {
    std::vector<std::uint8_t> used(mesh.positions.size(), 0);
    for (const Tetrahedron& t : mesh.tetrahedra) {
        for (const VertexId v : t) used[index_of(v)] = 1;
    }
    return used;
}

/// What can be said of a mesh that is too broken for the stages.
ConformingCheck finish(Findings&& findings, ConformingCheck check) {
    check.violation_count = findings.count();
    check.violations = std::move(findings.violations());
    return check;
}

}  // namespace

ConformingCheck check_conforming(const TetMesh& mesh, const PiecewiseLinearComplex& complex,
                                 const ConformingCheckOptions& options, const RunControl& control) {
    std::optional<tbb::global_control> threads;
    if (control.threads > 0) threads.emplace(tbb::global_control::max_allowed_parallelism, control.threads);
    check_options(options);
    const Plc plc(complex, options.merge_coplanar);
    Findings findings;
    ConformingCheck result;
    bool usable = check_arrays(mesh, findings);
    if (mesh.positions.size() < complex.positions.size()) {
        findings.add(Promise::faithful, {}, {},
                     "the mesh has " + std::to_string(mesh.positions.size()) + " vertices, fewer than the " +
                         std::to_string(complex.positions.size()) + " input points");
        usable = false;
    }
    if (!usable) return finish(std::move(findings), result);
    const auto stage = [&](const char* name, double fraction) {
        control.report(name, fraction);
        return !control.cancelled();
    };
    stage("check: adjacency", 0.0);
    const TetFaces faces(mesh);
    const VertexTree tree(mesh.positions);
    Subject subject{mesh, complex, options, control, plc, faces, tree};
    resolve_lengths(subject);
    subject.tetrahedron_labels = are_labelled(mesh.tetrahedron_regions, mesh.tetrahedra);
    subject.triangle_labels = are_labelled(mesh.triangle_facets, mesh.triangles);
    subject.edge_labels = are_labelled(mesh.edge_segments, mesh.edges);
    subject.sources = are_labelled(mesh.vertex_sources, mesh.positions);
    subject.used = find_used(mesh);
    Domain domain;
    Chains chains;
    const bool complete = [&] {
        if (!stage("check: tetrahedra", 0.1)) return false;
        check_tetrahedra(subject, findings);
        mark_walls(subject, findings);
        if (!stage("check: domain", 0.25)) return false;
        domain = check_domain(subject, findings);
        if (!stage("check: delaunay", 0.35)) return false;
        check_delaunay(subject, domain, findings);
        if (!stage("check: segments", 0.7)) return false;
        chains = check_segments(subject, findings);
        if (!stage("check: facets", 0.8)) return false;
        result.max_deviation = check_facets(subject, chains, findings);
        if (!stage("check: regions", 0.9)) return false;
        check_regions(subject, domain, findings);
        if (options.gabriel) check_gabriel(subject, findings);
        return !control.cancelled();
    }();
    if (complete) {
        result.full_hull = domain.full_hull;
        result.tetrahedra_checked = mesh.tetrahedra.size();
        result.segments_checked = plc.segments.size();
        result.facets_checked = plc.facet_count();
        stage("check", 1.0);
    } else {
        findings.add(Promise::well_formed, {}, {}, "the check was cancelled: nothing is proved");
    }
    return finish(std::move(findings), result);
}

}  // namespace certa
