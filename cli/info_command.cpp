// `certa info FILE`: what a file holds, in numbers.
#include <certa/conforming.h>
#include <certa/info.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <numbers>

#include "commands.h"
#include "interrupt.h"
#include "report.h"
#include "session.h"

namespace certa::cli {
namespace {

struct InfoArguments {
    CommonFlags common;
    FileArgument input;
};

std::string text_of_point(const Point3& p) {
    using frontend::text_of;
    return text_of(p.x) + " " + text_of(p.y) + " " + text_of(p.z);
}

std::string degree_text(const SurfaceInfo& s) {
    if (s.smallest_degree == s.largest_degree) return "of " + std::to_string(s.largest_degree) + " corners";
    return "of " + std::to_string(s.smallest_degree) + " to " + std::to_string(s.largest_degree) + " corners";
}

void say_surface(Session& session, const SurfaceInfo& s) {
    if (s.polygons == 0) return;
    session.say("surface      " + counted(s.polygons, "polygon") + " " + degree_text(s) + ", " +
                counted(s.edges, "edge") + ", " + counted(s.vertices, "vertex", "vertices"));
    std::string shape = counted(s.components, "component") + ", " +
                        (s.closed ? std::string("closed")
                                  : "open (" + counted(s.boundary_edges, "boundary edge") + " in " +
                                        counted(s.boundary_loops, "loop") + ")");
    if (s.manifold)
        shape += s.orientable ? ", manifold, orientable" : ", manifold, not orientable";
    else
        shape += ", not manifold (" + counted(s.non_manifold_edges, "edge") + ", " +
                 counted(s.non_manifold_vertices, "vertex", "vertices") + ")";
    if (s.euler_characteristic) shape += ", Euler characteristic " + std::to_string(*s.euler_characteristic);
    if (s.genus) shape += ", genus " + std::to_string(*s.genus);
    session.say("topology     " + shape);
    if (s.inconsistent_edges > 0)
        session.say("orientation  " + counted(s.inconsistent_edges, "edge") +
                    " between polygons that face opposite ways");
    if (s.repeated_polygons > 0)
        session.say("repeated     " + counted(s.repeated_polygons, "polygon") + " on the vertices of an earlier one");
    session.say("area         " + frontend::text_of(s.area) +
                (s.volume ? ", enclosed volume " + frontend::text_of(*s.volume) : std::string()));
}

void say_tetrahedra(Session& session, const TetrahedraInfo& t) {
    if (t.tetrahedra == 0) return;
    std::string line = counted(t.tetrahedra, "tetrahedron", "tetrahedra") + " on " +
                       counted(t.vertices, "vertex", "vertices") + " in " + counted(t.components, "component");
    if (t.regions > 0) line += ", " + counted(t.regions, "region");
    session.say("volume mesh  " + line + ", " + counted(t.boundary_triangles, "boundary triangle"));
    if (t.flat + t.inverted + t.non_manifold_triangles > 0)
        session.say("defects      " + counted(t.flat, "flat tetrahedron", "flat tetrahedra") + ", " +
                    text_of_count(t.inverted) + " inverted, " + counted(t.non_manifold_triangles, "triangle") +
                    " of three or more tetrahedra");
    const auto degrees = [](double radians) { return frontend::text_of(radians * 180.0 / std::numbers::pi); };
    session.say("measures     volume " + frontend::text_of(t.volume) + ", dihedral angles " +
                degrees(t.smallest_dihedral_radians) + " to " + degrees(t.largest_dihedral_radians) + " degrees");
}

void say_info(Session& session, const MeshDocument& document, const DocumentInfo& info) {
    std::string points = counted(info.points, "point");
    if (info.duplicate_points > 0) points += ", " + text_of_count(info.duplicate_points) + " equal to an earlier one";
    if (info.unused_points > 0) points += ", " + text_of_count(info.unused_points) + " unused";
    session.say("points       " + points);
    if (info.points > 0)
        session.say("box          " + text_of_point(info.lower) + " to " + text_of_point(info.upper) + ", diagonal " +
                    frontend::text_of(info.diagonal));
    std::string complex = counted(info.facets, "facet") + ", " + counted(info.segments, "segment");
    if (info.facet_holes > 0) complex += ", " + counted(info.facet_holes, "facet hole");
    if (info.isolated_segments > 0) complex += ", " + counted(info.isolated_segments, "isolated segment");
    if (info.isolated_points > 0) complex += ", " + counted(info.isolated_points, "isolated point");
    if (info.region_holes > 0) complex += ", " + counted(info.region_holes, "region hole");
    if (info.region_seeds > 0) complex += ", " + counted(info.region_seeds, "region seed");
    session.say("complex      " + complex);
    say_surface(session, info.surface);
    say_tetrahedra(session, info.tetrahedra);
    constexpr std::array locations{"vertices", "polygons", "segments", "tetrahedra"};
    for (const Field& field : document.fields)
        session.say("field        " + field.name + " of " + locations.at(static_cast<std::size_t>(field.location)) +
                    ", " + counted(field.components, "component"));
}

/// What `conform` would refuse, self-intersections among them.
void find_and_say_defects(Session& session, const PiecewiseLinearComplex& complex) {
    const ComplexDefects found = session.timed("find_defects", [&] {
        const GracefulScope graceful;
        return find_defects(complex, {}, session.control());
    });
    session.report()["info"]["defects"] = to_json(found.defects);
    session.report()["info"]["defect_count"] = found.defect_count;
    std::map<std::string, std::size_t> kinds;
    for (const Defect& defect : found.defects) ++kinds[name_of(defect.kind)];
    std::vector<std::string> counts;
    for (const auto& [kind, count] : kinds) counts.push_back(text_of_count(count) + " " + kind);
    if (found.defects.empty())
        session.say("valid        no self-intersections or other defects: `conform` takes it");
    else
        session.say("invalid      " + joined(counts) + ": `conform` refuses it");
    for (std::size_t i = 0; i < std::min<std::size_t>(3, found.defects.size()); ++i)
        session.say("             " + found.defects[i].message);
}

ExitCode run_info(Session& session, const InfoArguments& arguments) {
    const MeshDocument document = session.read(arguments.input, "input");
    const DocumentInfo info = session.timed("info", [&] { return compute_info(document); });
    session.report()["info"] = to_json(info);
    Json fields = Json::array();
    constexpr std::array locations{"vertices", "polygons", "segments", "tetrahedra"};
    for (const Field& field : document.fields)
        fields.push_back({{"name", field.name},
                          {"location", locations.at(static_cast<std::size_t>(field.location))},
                          {"components", field.components}});
    session.report()["info"]["fields"] = fields;
    say_info(session, document, info);
    // The constraint triangles of a volume mesh may coincide on purpose.
    if (document.tetrahedra.empty() && document.complex.polygon_count() + document.complex.segments.size() > 0)
        find_and_say_defects(session, document.complex);
    if (interrupt_flag()) return ExitCode::interrupted;
    return ExitCode::done;
}

}  // namespace

void add_info_command(CLI::App& app, Action& action) {
    auto arguments = std::make_shared<InfoArguments>();
    CLI::App* command = app.add_subcommand("info", "Print what a file holds: counts, box, topology, tetrahedra");
    command->footer("Example:\n  certa info part.off");
    command->add_option("FILE", arguments->input.path, "mesh or complex (-: standard input)")->required();
    add_format_option(*command, "--input-format", arguments->input);
    add_common_flags(*command, arguments->common);
    command->callback([arguments, &action] {
        action = [arguments] {
            Session session("info", arguments->common);
            return session.run([&] { return run_info(session, *arguments); });
        };
    });
}

}  // namespace certa::cli
