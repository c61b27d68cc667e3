// `certa remesh INPUT [-o OUT]`: polygons along lines of curvature.
//
// Plan: read, make one surface of triangles, take tagged edges from the file's segments and from --features, remesh,
// report, check the result by what shares no code with the remesher, write.
#include <certa/curvature.h>
#include <certa/remeshing.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <memory>
#include <set>

#include "check_surface_command.h"
#include "commands.h"
#include "interrupt.h"
#include "report.h"
#include "session.h"

namespace certa::cli {
namespace {

struct RemeshArguments {
    CommonFlags common;
    FileArgument input, output, lines;
    RemeshOptions options;
    frontend::OutputOptions output_options;
    std::string features, guides;
    bool no_placement = false, no_verify = false;
};

/// Pairs of vertex numbers that count from 1, one pair a line; `#` starts a comment.
std::vector<Edge> read_edges(const std::string& path, std::size_t vertices) {
    std::ifstream file(path);
    if (!file) throw IoError(path, 0, "cannot be read");
    std::vector<Edge> edges;
    std::string line;
    for (std::uint64_t number = 1; std::getline(file, line); ++number) {
        const char* at = line.data();
        const char* end = line.data() + std::min(line.find('#'), line.size());
        std::vector<std::uint32_t> ends;
        while (at != end) {
            if (*at == ' ' || *at == '\t' || *at == '\r' || *at == ',') {
                ++at;
                continue;
            }
            std::uint32_t vertex = 0;
            const auto [next, error] = std::from_chars(at, end, vertex);
            if (error != std::errc() || vertex == 0)
                throw IoError(path, number, "expected the number of a vertex, from 1");
            if (vertex > vertices)
                throw IoError(path, number,
                              "names vertex " + std::to_string(vertex) + " of " + std::to_string(vertices));
            ends.push_back(vertex - 1);
            at = next;
        }
        if (ends.empty()) continue;
        if (ends.size() != 2) throw IoError(path, number, "expected two vertices of an edge");
        edges.push_back({VertexId{ends[0]}, VertexId{ends[1]}});
    }
    if (edges.empty()) throw IoError(path, 0, "names no edge: expected two vertex numbers a line, from 1");
    return edges;
}

/// Segments that are edges of the surface: others cannot be creases.
std::vector<Edge> edges_among(const std::vector<Edge>& segments, const TriangleMesh& mesh, Session& session) {
    if (segments.empty()) return {};
    const WeldedSurface welded = weld_surface(mesh);
    std::set<std::pair<VertexId, VertexId>> edges;
    for (const Triangle& t : welded.mesh.triangles)
        for (std::size_t i = 0; i < 3; ++i) edges.insert(std::minmax(t[i], t[(i + 1) % 3]));
    std::vector<Edge> found;
    for (const Edge& s : segments) {
        const VertexId a = welded.numbers[index_of(s[0])], b = welded.numbers[index_of(s[1])];
        if (edges.count(std::minmax(a, b)) > 0) found.push_back(s);
    }
    if (found.size() < segments.size())
        session.warn(counted(segments.size() - found.size(), "segment") +
                     " of the file that no side of a polygon is are left out: creases are edges of the surface");
    return found;
}

MeshDocument document_of(const RemeshResult& result) {
    MeshDocument document;
    document.complex.positions = result.mesh.positions;
    document.complex.corners = result.mesh.corners;
    document.complex.polygon_offsets = result.mesh.offsets;
    for (std::size_t i = 0; i + 1 < result.mesh.offsets.size(); ++i)
        document.complex.facet_offsets.push_back(static_cast<std::uint32_t>(i + 1));
    document.complex.hole_offsets.assign(result.mesh.offsets.size(), 0);
    return document;
}

/// Lines as segments with a family (1 min, 2 max), umbilics as points with their type.
MeshDocument line_document(const RemeshResult& result) {
    MeshDocument document;
    std::vector<std::int64_t> family, umbilic;
    for (const CurvatureLine& line : result.lines) {
        const std::uint32_t first = static_cast<std::uint32_t>(document.complex.positions.size());
        const std::uint32_t count = static_cast<std::uint32_t>(line.points.size());
        document.complex.positions.insert(document.complex.positions.end(), line.points.begin(), line.points.end());
        for (std::uint32_t i = 0; i + 1 < count + (line.closed ? 1U : 0U); ++i) {
            document.complex.segments.push_back({VertexId{first + i}, VertexId{first + (i + 1) % count}});
            family.push_back(line.maximum ? 2 : 1);
        }
    }
    umbilic.resize(document.complex.positions.size(), 0);
    for (const Umbilic& u : result.umbilics) {
        document.complex.positions.push_back(u.place);
        umbilic.push_back(u.half_turns);
    }
    document.fields.push_back({"family", Location::segments, 1, std::move(family)});
    document.fields.push_back({"umbilic_half_turns", Location::vertices, 1, std::move(umbilic)});
    return document;
}

Point3 cross(const Point3& a, const Point3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double square(const Point3& a) { return a.x * a.x + a.y * a.y + a.z * a.z; }

/// What cutting the input's polygons into triangles means for the rest.
void say_triangulation(Session& session, const MeshDocument& document, const TriangulatedSurface& surface) {
    const auto& offsets = document.complex.polygon_offsets;
    std::size_t small = 0;
    if (document.tetrahedra.empty())
        for (std::size_t p = 0; p + 1 < offsets.size(); ++p) small += offsets[p + 1] - offsets[p] < 3 ? 1 : 0;
    if (small > 0) session.warn(counted(small, "polygon") + " of fewer than three corners left out");
    const auto normal = [&](std::size_t t) {
        const auto& [a, b, c] = surface.mesh.triangles[t];
        const Point3 &o = surface.mesh.positions[index_of(a)], &p = surface.mesh.positions[index_of(b)],
                     &q = surface.mesh.positions[index_of(c)];
        return cross({p.x - o.x, p.y - o.y, p.z - o.z}, {q.x - o.x, q.y - o.y, q.z - o.z});
    };
    constexpr double flat = 1e-12;  // sine of the angle between two triangles, squared
    std::size_t warped = 0;
    std::uint32_t last = no_index;
    for (std::size_t t = 1; t < surface.source_faces.size(); ++t) {
        const std::uint32_t face = surface.source_faces[t];
        if (face != surface.source_faces[t - 1] || face == last) continue;
        const Point3 n = normal(t - 1), m = normal(t), turn = cross(n, m);
        if (!(square(turn) > flat * square(n) * square(m))) continue;
        last = face;
        ++warped;
    }
    if (warped > 0)
        session.warn(counted(warped, "polygon") + " of the input not planar: distances are to the triangles that " +
                     (warped == 1 ? "it was" : "they were") + " cut into");
}

void say_result(Session& session, const RemeshStatistics& s) {
    using frontend::text_of;
    session.say("input        " + counted(s.input_vertices, "vertex", "vertices") + ", " +
                counted(s.input_triangles, "triangle") + ", " + counted(s.components, "component") + ", " +
                counted(s.boundary_loops, "boundary loop") + ", " +
                counted(s.feature_curves, "crease or boundary curve"));
    session.say("lines        " + std::to_string(s.lines_max) + " max, " + std::to_string(s.lines_min) + " min, " +
                std::to_string(s.closed_lines) + " closed; " + counted(s.wedges, "wedge") + ", " +
                counted(s.trisectors, "trisector"));
    const double share = s.faces > 0 ? 100.0 * static_cast<double>(s.quads) / static_cast<double>(s.faces) : 0.0;
    session.say("result       " + counted(s.vertices, "vertex", "vertices") + ", " + counted(s.faces, "face") + ", " +
                counted(s.quads, "quad") + " (" + std::to_string(static_cast<int>(share)) + " %)");
    if (s.mended_regions > 0)
        session.say("mended       " + counted(s.mended_regions, "region") + " by " +
                    counted(s.mended_triangles, "triangle") +
                    " of the input, where polygons would turn away, meet or be too far");
    if (s.cut_faces > 0)
        session.say("cut          " + counted(s.cut_faces, "face") +
                    " into triangles, so that every way to fill them keeps the error");
    if (s.subdivision_rounds > 0)
        session.say("subdivided   " + counted(s.subdivision_rounds, "round") + "; " +
                    counted(s.held_vertices, "vertex", "vertices") + " held back, " + counted(s.coarse_faces, "face") +
                    " left coarse");
    if (s.distance_bound > 0.0) session.say("distance     at most " + text_of(s.distance_bound) + ", proved");
    for (const std::string& note : s.notes) session.warn(note);
}

/// Nothing that folds, meets itself, misses a crease or is too far is written.
void verify(Session& session, const RemeshArguments& arguments, const RemeshResult& result, const TriangleMesh& input) {
    SurfaceCheckOptions options;
    options.feature_angle_radians = arguments.options.feature_angle_radians;
    options.features = arguments.options.features;
    options.error = arguments.options.error;
    const WeldedSurface welded = weld_surface(input);  // what the result is a result of
    for (Edge& edge : options.features)
        for (VertexId& v : edge)
            if (index_of(v) < welded.numbers.size()) v = welded.numbers[index_of(v)];
    const SurfaceCheck check = session.timed("check", [&] {
        const GracefulScope graceful;
        return check_surface(result.mesh, make_polygon_mesh(welded.mesh), options, session.control());
    });
    session.report()["check"] = to_json(check);
    if (interrupt_flag() || check.outcome == Outcome::cancelled) return;
    if (check.ok()) {
        session.report()["proved"] = check.promises;
        session.say("verified: " + joined(check.promises));
        return;
    }
    for (std::size_t i = 0; i < std::min<std::size_t>(5, check.violations.size()); ++i)
        session.say(check.violations[i].promise + ": " + check.violations[i].message);
    throw Inability("the result fails its check (" + counted(check.violation_count, "violation") +
                    ") and is not written; another --vertices, --error or --feature-angle may do, --no-verify writes "
                    "it as it is");
}

ExitCode run_remesh(Session& session, RemeshArguments& arguments) {
    if (arguments.output.given()) {
        session.require_writable(arguments.output);
        const Format format = arguments.output.format ? *arguments.output.format : *format_of(arguments.output.path);
        if ((format == Format::stl || format == Format::medit) && arguments.options.output != RemeshOutput::triangles)
            throw UsageError("-o: " + std::string(name_of(format)) +
                             " cannot carry this mix of polygons; add --output triangles, or write .off, .obj, .ply, "
                             ".poly, .vtu or .msh");
    }
    if (arguments.lines.given()) {
        session.require_writable(arguments.lines);
        const Format format = *format_of(arguments.lines.path);
        if (format != Format::vtu && format != Format::ply)
            throw UsageError("--lines: " + std::string(name_of(format)) +
                             " cannot say which family lines are of; .vtu and .ply can");
    }
    const MeshDocument document = session.read(arguments.input, "input");
    const std::uint64_t corners = document.complex.corners.size() + 12 * document.tetrahedra.size();
    session.require_memory(700 * corners + 400 * document.complex.positions.size(), "remeshing this surface");
    const TriangulatedSurface surface = session.timed("triangulate", [&] { return triangulate(document); });
    say_triangulation(session, document, surface);
    arguments.options.placement = !arguments.no_placement;
    if (!arguments.options.error && !arguments.options.vertices && !arguments.options.faces)
        arguments.options.error = default_remesh_error;
    arguments.options.lines = arguments.lines.given();
    arguments.options.features = edges_among(document.complex.segments, surface.mesh, session);
    if (!arguments.features.empty())
        for (const Edge& edge : read_edges(arguments.features, document.complex.positions.size()))
            arguments.options.features.push_back(edge);
    if (!arguments.guides.empty())
        arguments.options.guides = read_edges(arguments.guides, document.complex.positions.size());
    session.report()["options"] = to_json(frontend::remesh_options(), arguments.options, 0.0);
    session.report()["options"]["placement"] = arguments.options.placement;
    session.report()["options"]["verify"] = !arguments.no_verify;
    const RemeshResult result = session.timed("remesh", [&] {
        const GracefulScope graceful;
        return remesh(surface.mesh, arguments.options, session.control());
    });
    if (result.outcome == Outcome::cancelled) return ExitCode::interrupted;
    session.report()["outcome"] = name_of(result.outcome);
    session.report()["statistics"] = record_of(result.statistics);
    for (const auto& [stage, seconds] : result.statistics.stage_seconds)
        session.report()["stage_seconds"][stage] = seconds;
    say_result(session, result.statistics);
    for (const auto& [stage, seconds] : result.statistics.stage_seconds)
        session.detail(stage + " " + frontend::text_of(seconds) + " s");
    if (interrupt_flag()) return ExitCode::interrupted;
    if (result.outcome != Outcome::done)
        throw Inability("remesh: what was asked for could not be had (" + std::string(name_of(result.outcome)) +
                        "); nothing is written");
    if (!arguments.no_verify) verify(session, arguments, result, surface.mesh);
    if (interrupt_flag()) return ExitCode::interrupted;
    if (arguments.output.given()) session.write(arguments.output, document_of(result), arguments.output_options);
    if (arguments.lines.given()) session.write(arguments.lines, line_document(result), arguments.output_options);
    return ExitCode::done;
}

}  // namespace

void add_remesh_command(CLI::App& app, Action& action) {
    auto arguments = std::make_shared<RemeshArguments>();
    CLI::App* command = app.add_subcommand(
        "remesh", "Few polygons along lines of curvature: anisotropic, quad-dominant, with creases and boundary kept");
    command->footer(
        "Without --error, --vertices or --faces the error is 0.2 % of the diagonal.\n"
        "Examples:\n  certa remesh scan.ply --vertices 1500 -o coarse.obj\n"
        "  certa remesh part.off --error 0.1% --lines lines.vtu -o part.obj");
    command->add_option("INPUT", arguments->input.path, "surface mesh (-: standard input)")->required();
    command
        ->add_option("-o", arguments->output.path,
                     "polygon mesh to write (-: standard output); without it only the report is printed")
        ->type_name("OUT");
    add_format_option(*command, "--input-format", arguments->input);
    add_format_option(*command, "--output-format", arguments->output);
    // `output` here is what the polygons are; the file's name has -o.
    add_options(*command, frontend::remesh_options(), arguments->options);
    // The other commands take a file there.
    command->get_option("--output")->check([](const std::string& text) {
        return text.find_first_of("./") == std::string::npos
                   ? std::string()
                   : "'" + text + "' is a file's name: a file goes after -o, --output says what faces it gets";
    });
    command->get_option("--error")->excludes("--vertices", "--faces");
    command->get_option("--vertices")->excludes("--faces");
    command
        ->add_option("--features", arguments->features,
                     "creases, whatever their angle: a file with two vertex numbers a line, from 1")
        ->type_name("FILE");
    command
        ->add_option("--guides", arguments->guides,
                     "edges of the input that lines follow without being creases: a file like that of --features")
        ->type_name("FILE");
    command->add_option("--lines", arguments->lines.path, "also write lines and umbilics (.vtu, .ply)")
        ->type_name("FILE");
    command->add_flag("--no-placement", arguments->no_placement, "leave vertices on the input surface");
    command->add_flag("--no-verify", arguments->no_verify, "do not check the result before writing it");
    add_options(*command, frontend::output_options().first(2), arguments->output_options);
    add_common_flags(*command, arguments->common);
    command->callback([arguments, &action] {
        action = [arguments] {
            Session session("remesh", arguments->common);
            return session.run([&] { return run_remesh(session, *arguments); });
        };
    });
}

}  // namespace certa::cli
