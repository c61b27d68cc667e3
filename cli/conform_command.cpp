// `certa conform INPUT [-o OUT]`: reads, meshes, verifies the result with the independent checker, writes.
// Everything that can be refused without work is refused first; nothing is written unless all of it succeeded, except
// with --keep-partial, which labels the file as partial.
#include <certa/conforming.h>

#include <algorithm>
#include <memory>

#include "commands.h"
#include "interrupt.h"
#include "report.h"
#include "session.h"

namespace certa::cli {
namespace {

struct ConformArguments {
    CommonFlags common;
    FileArgument input, output;
    ConformOptions options;
    frontend::OutputOptions output_options;
    bool no_verify = false, keep_partial = false;
};

bool holds_tetrahedra(Format format) {
    return format == Format::medit || format == Format::vtu || format == Format::msh || format == Format::node;
}

void require_volume_format(const Session& session, const FileArgument& output) {
    session.require_writable(output);
    const Format format = output.format ? *output.format : *format_of(output.path);
    if (!holds_tetrahedra(format))
        throw UsageError(std::string(name_of(format)) + " holds no tetrahedra; write .mesh, .vtu, .msh or .node");
}

/// Bytes that conform, the check and writing take with the default protection. Fitted from above to measured peaks of
/// surfaces, geology and soups of 5k to 1M facets with up to one Steiner point per point of the input: these take 0.5
/// to 1.0 of it. What matters is the number of points that come out, at 1,500 to 3,300 bytes each, which nobody knows
/// beforehand: narrow places can take many times more.
std::uint64_t estimated_bytes(const PiecewiseLinearComplex& complex) {
    constexpr std::uint64_t per_point = 1500, per_corner = 300, fixed = 20'000'000;
    return fixed + per_point * complex.positions.size() + per_corner * complex.corners.size();
}

double diagonal_of(const PiecewiseLinearComplex& complex) {
    MeshDocument points;
    points.complex.positions = complex.positions;
    return compute_info(points).diagonal;
}

void report_mesh(Session& session, const ConformResult& result) {
    Json& entry = session.report()["mesh"];
    entry["vertices"] = result.mesh.positions.size();
    entry["tetrahedra"] = result.mesh.tetrahedra.size();
    entry["triangles"] = result.mesh.triangles.size();
    entry["edges"] = result.mesh.edges.size();
    std::vector<RegionId> regions = result.mesh.tetrahedron_regions;
    std::sort(regions.begin(), regions.end());
    entry["regions"] = std::unique(regions.begin(), regions.end()) - regions.begin();
    session.report()["outcome"] = name_of(result.outcome);
    session.report()["statistics"] = to_json(result.statistics);
    session.note_defects("repairs", result.repairs);
    session.note_defects("warnings", result.warnings);
    session.note_defects("obstacles", result.obstacles);
    for (const auto& [stage, seconds] : result.statistics.stage_seconds)
        session.detail("  " + stage + ": " + text_of_seconds(seconds));
}

void say_mesh(Session& session, const ConformResult& result) {
    const std::size_t added =
        result.mesh.positions.size() - std::min(result.mesh.positions.size(), result.statistics.input_points);
    session.say("mesh: " + counted(result.mesh.positions.size(), "vertex", "vertices") + " (" + text_of_count(added) +
                " added: " + text_of_count(result.statistics.steiner_on_segments) + " on segments, " +
                text_of_count(result.statistics.steiner_in_facets) + " in facets), " +
                counted(result.mesh.tetrahedra.size(), "tetrahedron", "tetrahedra") + ", " +
                counted(result.mesh.triangles.size(), "constraint triangle"));
}

/// The promises that the checker decides.
std::vector<std::string> promises(const ConformOptions& options) {
    std::vector<std::string> names{"delaunay", "conforming", "faithful", "labelled"};
    if (options.gabriel) names.push_back("gabriel");
    return names;
}

void verify(Session& session, const ConformArguments& arguments, const ConformResult& result,
            const PiecewiseLinearComplex& complex) {
    const ConformingCheckOptions options{.gabriel = arguments.options.gabriel,
                                         .merge_coplanar = arguments.options.merge_coplanar,
                                         .planarity = arguments.options.planarity};
    const ConformingCheck check = session.timed("check", [&] {
        const GracefulScope graceful;
        return check_conforming(result.mesh, complex, options, session.control());
    });
    session.report()["check"] = to_json(check);
    if (interrupt_flag()) return;
    if (!check.ok()) {
        std::string text = "the result failed its own check and was not written: " + check.violations.front().promise +
                           ": " + check.violations.front().message;
        throw InternalError(text);
    }
    session.report()["proved"] = promises(arguments.options);
    session.say("verified: " + joined(promises(arguments.options)) +
                "; largest distance of an added vertex from its "
                "segment or facet " +
                frontend::text_of(check.max_deviation));
}

ExitCode end_unfinished(Session& session, const ConformArguments& arguments, const ConformResult& result,
                        const PiecewiseLinearComplex& complex) {
    if (result.outcome == Outcome::cancelled) return ExitCode::interrupted;
    session.say(std::string("not finished: ") + name_of(result.outcome) +
                (arguments.keep_partial ? "" : "; --keep-partial would write what there is"));
    if (arguments.keep_partial && arguments.output.given()) {
        MeshDocument document =
            make_document(result.mesh, complex, arguments.output_options.reference, result.region_attributes);
        document.remark = std::string("partial result, not conforming: ") + name_of(result.outcome);
        session.write(arguments.output, document, arguments.output_options);
    }
    return ExitCode::unable;
}

/// The input, mended where --repair and --triangulate ask for it, with what was done in the report.
PiecewiseLinearComplex repaired(Session& session, const ConformArguments& arguments,
                                const PiecewiseLinearComplex& complex) {
    if (!arguments.options.repair && !arguments.options.triangulate) return complex;
    RepairedComplex result = session.timed("repair", [&] {
        const GracefulScope graceful;
        return repair_complex(complex, arguments.options, session.control());
    });
    session.note_defects("repairs", result.repairs);
    Json& sources = session.report()["facet_sources"] = Json::array();  // of the facets after the input's own
    for (std::size_t f = complex.facet_count(); f < result.facet_sources.size(); ++f)
        sources.push_back(std::uint64_t{index_of(result.facet_sources[f])} + 1);
    return std::move(result.complex);
}

void write_mesh(Session& session, const ConformArguments& arguments, const ConformResult& result,
                const PiecewiseLinearComplex& complex) {
    MeshDocument document =
        make_document(result.mesh, complex, arguments.output_options.reference, result.region_attributes);
    if (!result.ball_radii.empty())
        document.fields.push_back({"ball_radius", Location::vertices, 1, result.ball_radii});
    session.write(arguments.output, document, arguments.output_options);
}

ExitCode run_conform(Session& session, const ConformArguments& arguments) {
    if (arguments.output.given()) require_volume_format(session, arguments.output);
    const MeshDocument input = session.read(arguments.input, "input");
    if (!input.tetrahedra.empty())
        session.warn("the input's " + counted(input.tetrahedra.size(), "tetrahedron is", "tetrahedra are") +
                     " not used; its points, segments and polygons are");
    session.report()["options"] = to_json(frontend::conform_options(), arguments.options, diagonal_of(input.complex));
    session.report()["options"]["reference"] =
        frontend::value_of(frontend::output_options().back(), arguments.output_options);
    session.report()["options"]["verify"] = !arguments.no_verify;
    session.require_memory(estimated_bytes(input.complex), "meshing " +
                                                               counted(input.complex.positions.size(), "point") +
                                                               " and " + counted(input.complex.facet_count(), "facet"));
    // From here on the complex is the repaired one: it is what the mesh conforms to and is checked against.
    const PiecewiseLinearComplex complex = repaired(session, arguments, input.complex);
    ConformOptions options = arguments.options;
    options.repair = options.triangulate = false;
    const ConformResult result = session.timed("conform", [&] {
        const GracefulScope graceful;
        return conform(complex, options, session.control());
    });
    report_mesh(session, result);
    if (result.outcome != Outcome::done) return end_unfinished(session, arguments, result, complex);
    say_mesh(session, result);
    if (!arguments.no_verify) verify(session, arguments, result, complex);
    if (interrupt_flag()) return ExitCode::interrupted;
    if (arguments.output.given()) write_mesh(session, arguments, result, complex);
    return ExitCode::done;
}

}  // namespace

void add_conform_command(CLI::App& app, Action& action) {
    auto arguments = std::make_shared<ConformArguments>();
    CLI::App* command =
        app.add_subcommand("conform", "Make the conforming Delaunay tetrahedral mesh of a surface mesh or a complex");
    command->footer("Example:\n  certa conform part.off -o part.mesh");
    command->add_option("INPUT", arguments->input.path, "surface mesh or complex (-: standard input)")->required();
    command
        ->add_option("-o,--output", arguments->output.path,
                     "tetrahedral mesh to write (-: standard output); without it only the report is printed")
        ->type_name("OUT");
    add_format_option(*command, "--input-format", arguments->input);
    add_format_option(*command, "--output-format", arguments->output);
    add_options(*command, frontend::conform_options(), arguments->options);
    add_options(*command, frontend::output_options(), arguments->output_options);
    command->add_flag("--no-verify", arguments->no_verify, "do not check the result before writing it");
    command->add_flag("--keep-partial", arguments->keep_partial,
                      "write OUT even where the run could not finish, labelled as partial inside the file");
    add_common_flags(*command, arguments->common);
    command->callback([arguments, &action] {
        action = [arguments] {
            Session session("conform", arguments->common);
            return session.run([&] { return run_conform(session, *arguments); });
        };
    });
}

}  // namespace certa::cli
