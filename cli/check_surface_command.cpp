// `certa check FILE --against INPUT` for surface meshes, by any program: decides what `remesh` promises.
// Segments of INPUT are creases, whatever their angle.
#include "check_surface_command.h"

#include <certa/io.h>

#include <algorithm>

#include "interrupt.h"
#include "report.h"

namespace certa::cli {
namespace {

Json shape_to_json(const SurfaceShape& s) {
    Json result = record_of(s);
    result["components"] = Json::array();
    for (const ComponentShape& part : s.components) result["components"].push_back(record_of(part));
    return result;
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
    Json result{{"violation_count", check.violation_count}, {"violations", cli::to_json(check.violations)},
                {"distance", cli::to_json(check.distance)}, {"mesh", shape_to_json(check.mesh)},
                {"input", shape_to_json(check.input)},      {"creases", record_of(check.creases)}};
    result.update(record_of(check));
    return result;
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
    Json result{{"to_second", record_of(d.to_second)}, {"to_first", record_of(d.to_first)}};
    result.update(record_of(d));
    return result;
}

namespace {

PolygonMesh polygons_of(const MeshDocument& document, const std::string& name) {
    PolygonMesh mesh = make_polygon_mesh(document);
    if (mesh.offsets.size() == 1) throw UsageError(name + " has no polygons: there is no surface to check");
    return mesh;
}

}  // namespace

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
