// `certa check FILE --against INPUT` for surface meshes, by any program: decides what `remesh` promises.
// Segments of INPUT are creases, whatever their angle.
#include "check_surface_command.h"

#include <algorithm>

#include "interrupt.h"
#include "report.h"

namespace certa::cli {
namespace {

Json to_json(const OneSidedDistance& d) {
    return {{"mean", d.mean},
            {"rms", d.rms},
            {"largest", d.largest},
            {"largest_place", cli::to_json(d.largest_place)},
            {"bound", d.bound}};
}

Json to_json(const SurfaceShape& s) {
    Json components = Json::array();
    for (const ComponentShape& part : s.components)
        components.push_back({{"genus", part.genus},
                              {"boundary_loops", part.boundary_loops},
                              {"euler_characteristic", part.euler_characteristic}});
    return {{"vertices", s.vertices},
            {"edges", s.edges},
            {"polygons", s.polygons},
            {"triangles", s.triangles},
            {"quads", s.quads},
            {"boundary_edges", s.boundary_edges},
            {"boundary_loops", s.boundary_loops},
            {"non_manifold_edges", s.non_manifold_edges},
            {"non_manifold_vertices", s.non_manifold_vertices},
            {"inconsistent_edges", s.inconsistent_edges},
            {"components", components}};
}

std::string describe(const SurfaceShape& s) {
    std::int64_t genus = 0;
    for (const ComponentShape& part : s.components) genus += part.genus;
    return counted(s.vertices, "vertex", "vertices") + ", " + counted(s.polygons, "polygon") + " (" +
           counted(s.quads, "quad") + ", " + counted(s.triangles, "triangle") + "), " +
           counted(s.components.size(), "component") + ", genus " + std::to_string(genus) + ", " +
           counted(s.boundary_loops, "boundary loop");
}

}  // namespace

Json to_json(const SurfaceCheck& check) {
    Json violations = Json::array();
    for (const Violation& violation : check.violations)
        violations.push_back({{"promise", violation.promise},
                              {"elements", cli::to_json(violation.elements)},
                              {"place", cli::to_json(violation.place)},
                              {"message", violation.message}});
    const CreaseCover& c = check.creases;
    return {{"violation_count", check.violation_count},
            {"violations", violations},
            {"distance", cli::to_json(check.distance)},
            {"mesh", to_json(check.mesh)},
            {"input", to_json(check.input)},
            {"creases",
             {{"edges", c.edges},
              {"corners", c.corners},
              {"length", c.length},
              {"mean_distance", c.mean_distance},
              {"largest_distance", c.largest_distance},
              {"largest_place", cli::to_json(c.largest_place)},
              {"corner_distance", c.corner_distance}}},
            {"folded_polygons", check.folded_polygons},
            {"contacts", check.contacts},
            {"possible_contacts", check.possible_contacts},
            {"input_contacts", check.input_contacts}};
}

namespace {

void say_findings(Session& session, const SurfaceCheck& check) {
    const SurfaceDistance& d = check.distance;
    const auto both = [&](double length) {
        char text[64];
        std::snprintf(text, sizeof text, "%.4g (%.3g of the diagonal)", length, length / d.diagonal);
        return std::string(text);
    };
    session.say("mesh         " + describe(check.mesh));
    session.say("input        " + describe(check.input));
    session.say("RMS          " + both(d.rms));
    session.say("Hausdorff    at least " + both(d.hausdorff) + ", at most " + both(d.hausdorff_bound));
    if (check.creases.edges > 0)
        session.say("creases      mean " + both(check.creases.mean_distance) + ", largest " +
                    both(check.creases.largest_distance) + "; corners " + both(check.creases.corner_distance));
    if (check.possible_contacts > check.contacts)
        session.say("note: " + counted(check.possible_contacts - check.contacts, "pair") +
                    " of polygons would meet if cut along other diagonals");
    if (!d.is_tight) session.warn("the search for the bound ran out of pieces: it holds, but is larger than need be");
}

}  // namespace

Json to_json(const SurfaceDistance& d) {
    return {{"to_second", to_json(d.to_second)},
            {"to_first", to_json(d.to_first)},
            {"rms", d.rms},
            {"hausdorff", d.hausdorff},
            {"hausdorff_bound", d.hausdorff_bound},
            {"diagonal", d.diagonal},
            {"is_tight", d.is_tight}};
}

PolygonMesh polygons_of(const MeshDocument& document, const std::string& name) {
    PolygonMesh mesh;
    const PiecewiseLinearComplex& complex = document.complex;
    mesh.positions = complex.positions;
    for (std::size_t p = 0; p < complex.polygon_count(); ++p) {
        const auto begin = complex.corners.begin() + complex.polygon_offsets[p],
                   end = complex.corners.begin() + complex.polygon_offsets[p + 1];
        if (end - begin < 3) continue;
        mesh.corners.insert(mesh.corners.end(), begin, end);
        mesh.offsets.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
    }
    if (mesh.offsets.size() == 1) throw UsageError(name + " has no polygons: there is no surface to check");
    return mesh;
}

ExitCode check_surface_mesh(Session& session, const MeshDocument& document, const MeshDocument& against,
                            SurfaceCheckOptions options) {
    if (!against.tetrahedra.empty())
        throw UsageError("--against is a tetrahedral mesh: a surface mesh is checked against a surface");
    const PolygonMesh mesh = polygons_of(document, "FILE"), input = polygons_of(against, "--against");
    session.require_memory(1500 * (mesh.corners.size() + input.corners.size()), "checking these surfaces");
    options.features = against.complex.segments;
    session.report()["options"] = to_json(frontend::surface_check_options(), options, 0.0);
    const SurfaceCheck check = session.timed("check", [&] {
        const GracefulScope graceful;
        return check_surface(mesh, input, options, session.control());
    });
    if (check.outcome == Outcome::cancelled || interrupt_flag()) return ExitCode::interrupted;
    session.report()["check"] = to_json(check);
    session.report()["checked"] = check.promises;
    say_findings(session, check);
    if (!check.ok()) {
        const std::size_t shown =
            session.flags().verbose ? check.violations.size() : std::min<std::size_t>(20, check.violations.size());
        for (std::size_t i = 0; i < shown; ++i)
            session.say(check.violations[i].promise + ": " + check.violations[i].message);
        if (check.violation_count > shown)
            session.say("... " + counted(check.violation_count - shown, "more violation"));
        session.say("VIOLATED: " + counted(check.violation_count, "violation"));
        return ExitCode::violated;
    }
    session.report()["proved"] = check.promises;
    session.say("verified: " + joined(check.promises));
    return ExitCode::done;
}

}  // namespace certa::cli
