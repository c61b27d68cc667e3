// `certa check MESH --against FUNCTION` without a certificate: certified, refuted, or undecided with the triangles.
#include <certa/implicit_mesh.h>
#include <certa/io.h>

#include <algorithm>

#include "frontend/option_table.h"
#include "implicit_arguments.h"
#include "interrupt.h"
#include "machine.h"
#include "report.h"
#include "session.h"

namespace certa::cli {
namespace {

std::string show(const Point3& p) {
    return "(" + frontend::text_of(p.x) + ", " + frontend::text_of(p.y) + ", " + frontend::text_of(p.z) + ")";
}

std::string list_of(const std::vector<int>& genera) {
    std::string text = counted(genera.size(), "component");
    for (std::size_t i = 0; i < genera.size() && i < 20; ++i)
        text += (i == 0 ? " of genus " : ", ") + std::to_string(genera[i]);
    return text + (genera.size() > 20 ? ", ..." : "");
}

void report_check(Session& session, const ImplicitMeshCheck& check) {
    std::vector<std::uint32_t> triangles = check.triangles;
    for (std::uint32_t& t : triangles) ++t;
    Json obstacles = Json::array();
    for (const ImplicitObstacle& o : check.obstacles)
        obstacles.push_back({{"reason", name_of(o.reason)}, {"low", to_json(o.low)}, {"high", to_json(o.high)}});
    session.report()["check"] = {{"verdict", name_of(check.verdict)},
                                 {"reasons", check.reasons},
                                 {"triangles", triangles},
                                 {"triangle_count", check.triangle_count},
                                 {"surface_known", check.surface_known},
                                 {"mesh_genera", check.mesh_genera},
                                 {"surface_genera", check.surface_genera},
                                 {"faces_positive", check.faces_positive},
                                 {"obstacles", obstacles},
                                 {"box", {{"low", to_json(check.low)}, {"high", to_json(check.high)}}},
                                 {"leaves_checked", check.leaves_checked},
                                 {"marks_checked", check.marks_checked}};
    session.report()["checked"] = {"isotopic"};
}

}  // namespace

ExitCode check_mesh_against_function(Session& session, const MeshDocument& document, const FunctionArgument& function,
                                     const std::vector<double>& box) {
    const FunctionArgument::Source source = function.read();
    const Expression expression = parse_expression(source.text, source.name);  // errors name the source
    const TriangleMesh mesh = make_triangle_mesh(document);
    if (mesh.positions.empty() && box.empty()) throw UsageError("an empty mesh has no place: give the box with --box");
    std::array<Point3, 2> b = box.empty() ? find_box_around(mesh) : std::array<Point3, 2>{};
    if (!box.empty()) b = {{{box[0], box[1], box[2]}, {box[3], box[4], box[5]}}};
    ImplicitOptions options;
    options.memory_bytes = available_memory();
    const ImplicitMeshCheck check = session.timed("check", [&] {
        const GracefulScope graceful;
        return check_mesh_against(mesh, source.text, b[0], b[1], options, session.control());
    });
    if (interrupt_flag()) return ExitCode::interrupted;
    report_check(session, check);
    const std::string where = " in the box " + show(check.low) + " to " + show(check.high);
    if (check.verdict == ImplicitMeshVerdict::certified) {
        session.report()["proved"] = {"isotopic"};
        session.say("CERTIFIED: isotopic to the zero set" + where + ": " + list_of(check.mesh_genera));
        if (!check.faces_positive) session.say("some triangles face the negative side of the function");
        return ExitCode::done;
    }
    const bool refuted = check.verdict == ImplicitMeshVerdict::refuted;
    const std::size_t shown =
        session.flags().verbose ? check.reasons.size() : std::min<std::size_t>(5, check.reasons.size());
    session.say((refuted ? "REFUTED: not isotopic to the zero set" : "UNDECIDED: nothing is claimed") + where);
    for (std::size_t i = 0; i < shown; ++i) session.say("  " + check.reasons[i]);
    if (!check.obstacles.empty())
        session.say(std::string("  ") + name_of(check.obstacles.front().reason) + ": box " +
                    show(check.obstacles.front().low) + " to " + show(check.obstacles.front().high));
    if (check.triangle_count > shown) session.say("  " + counted(check.triangle_count, "triangle") + " in all");
    if (!refuted && check.surface_known)
        session.say("  the zero set has " + list_of(check.surface_genera) +
                    "; a finer mesh, or another --box, may be decided");
    return refuted ? ExitCode::violated : ExitCode::unable;
}

}  // namespace certa::cli
