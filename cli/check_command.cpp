// `certa check FILE [--against INPUT]`: decides what `conform` promises, on any file; surface meshes are passed on.
// Without INPUT there is nothing to conform to: what is decided is the Delaunay property and the form of the mesh.
#include <certa/conforming.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "check_surface_command.h"
#include "commands.h"
#include "implicit_arguments.h"
#include "interrupt.h"
#include "report.h"
#include "session.h"

namespace certa::cli {
namespace {

struct CheckArguments {
    CommonFlags common;
    FileArgument file, against;
    ConformingCheckOptions options;
    SurfaceCheckOptions surface;
    ConformOptions repairs;   // `repair` and `triangulate` of the run that made the mesh
    std::string certificate;  // of an implicit surface: --against is a function then
    std::vector<double> box;  // of a function
};

void say_violations(Session& session, const ConformingCheck& check) {
    const std::size_t shown =
        session.flags().verbose ? check.violations.size() : std::min<std::size_t>(20, check.violations.size());
    for (std::size_t i = 0; i < shown; ++i) {
        const Violation& violation = check.violations[i];
        session.say(violation.promise + ": " + violation.message);
    }
    if (check.violation_count > shown) session.say("... " + counted(check.violation_count - shown, "more violation"));
}

/// The complex that the mesh was made from, after the repairs that it was made with.
PiecewiseLinearComplex read_against(Session& session, const CheckArguments& arguments) {
    PiecewiseLinearComplex complex = session.read(arguments.against, "against").complex;
    if (!arguments.repairs.repair && !arguments.repairs.triangulate) return complex;
    ConformOptions options = arguments.repairs;
    options.planarity = arguments.options.planarity;
    return repair_complex(complex, options).complex;
}

ExitCode run_check(Session& session, const CheckArguments& arguments) {
    if (!arguments.certificate.empty() && !arguments.against.given())
        throw UsageError("--certificate needs --against with the function that the mesh was made from");
    const MeshDocument document = session.read(arguments.file, "input");
    if (!arguments.certificate.empty())
        return check_implicit_mesh(session, document, {arguments.against.path}, arguments.certificate);
    // What has no name of a mesh file is a function.
    if (document.tetrahedra.empty() && arguments.against.given() && !arguments.against.format &&
        !format_of(arguments.against.path))
        return check_mesh_against_function(session, document, {arguments.against.path}, arguments.box);
    if (!arguments.box.empty()) throw UsageError("--box is for surface meshes --against a function");
    if (document.tetrahedra.empty() && arguments.against.given())
        return check_surface_mesh(session, document, session.read(arguments.against, "against"), arguments.surface);
    if (document.tetrahedra.empty())
        throw UsageError(arguments.file.path +
                         " has no tetrahedra: a surface mesh is checked with --against and the surface that it stands "
                         "for; `certa info` describes surfaces and complexes");
    const FileArgument& against = arguments.against;
    if (against.given() && against.path != "-" && !against.format && !format_of(against.path) &&
        !std::filesystem::exists(against.path))
        throw UsageError(arguments.file.path +
                         " has tetrahedra: they are checked --against a file, and there is none of the name " +
                         against.path + "; surface meshes are checked against functions");
    const TetMesh mesh = make_tet_mesh(document);
    const bool alone = !arguments.against.given();
    const PiecewiseLinearComplex complex = alone ? PiecewiseLinearComplex{} : read_against(session, arguments);
    const ConformingCheck check = session.timed("check", [&] {
        const GracefulScope graceful;
        return alone ? check_delaunay_mesh(mesh, arguments.options, session.control())
                     : check_conforming(mesh, complex, arguments.options, session.control());
    });
    if (interrupt_flag()) return ExitCode::interrupted;
    std::vector<std::string> promises{"well-formed", "delaunay"};
    if (!alone) promises.insert(promises.end(), {"conforming", "faithful", "labelled"});
    if (arguments.options.gabriel) promises.push_back("gabriel");
    session.report()["check"] = to_json(check);
    session.report()["checked"] = promises;
    const std::string counts = counted(check.tetrahedra_checked, "tetrahedron", "tetrahedra") + ", " +
                               counted(check.segments_checked, "segment") + ", " +
                               counted(check.facets_checked, "facet") + " checked";
    if (!check.ok()) {
        say_violations(session, check);
        session.say("VIOLATED: " + counted(check.violation_count, "violation") + "; " + counts);
        return ExitCode::violated;
    }
    session.report()["proved"] = promises;
    session.say("verified: " + joined(promises) + "; " + counts);
    if (alone) session.say("without --against, nothing is said about the complex that the mesh was made from");
    return ExitCode::done;
}

}  // namespace

void add_check_command(CLI::App& app, Action& action) {
    auto arguments = std::make_shared<CheckArguments>();
    CLI::App* command = app.add_subcommand(
        "check", "Verify what `conform` promises on any tetrahedral mesh, what `remesh` promises on any surface mesh");
    command->footer(
        "Example:\n  certa check part.mesh --against part.off\n"
        "  certa check coarse.obj --against scan.ply --error 0.1%\n"
        "  certa check ball.off --against \"x^2+y^2+z^2-1\"");
    command->add_option("FILE", arguments->file.path, "tetrahedral or surface mesh (-: standard input)")->required();
    command
        ->add_option("--against", arguments->against.path,
                     "the surface mesh or complex that it was made from or stands for; or a function")
        ->type_name("INPUT");
    command->add_option("--certificate", arguments->certificate, "of `implicit`: verify a triangle mesh by it")
        ->type_name("FILE");
    command
        ->add_option("--box", arguments->box,
                     "against a function: low and high corner (default: the mesh's box, enlarged by about a sixth)")
        ->expected(6)
        ->type_name("X0 Y0 Z0 X1 Y1 Z1");
    add_format_option(*command, "--input-format", arguments->file);
    add_format_option(*command, "--against-format", arguments->against);
    add_options(*command, frontend::conforming_check_options(), arguments->options);
    add_options(*command, frontend::surface_check_options(), arguments->surface);
    command->add_flag("--repair", arguments->repairs.repair, "the mesh was made with --repair");
    command->add_flag("--triangulate", arguments->repairs.triangulate, "the mesh was made with --triangulate");
    add_common_flags(*command, arguments->common);
    command->callback([arguments, &action] {
        action = [arguments] {
            Session session("check", arguments->common);
            return session.run([&] { return run_check(session, *arguments); });
        };
    });
}

}  // namespace certa::cli
