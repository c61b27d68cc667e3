// `certa view FILE... [-o PAGE]`: one self-contained HTML page that shows the files, with a switch between them.
// Like the other commands it writes nothing that was not asked for: without -o it only reports what the page would
// hold.
#include <certa/view.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <set>

#include "commands.h"
#include "interrupt.h"
#include "report.h"
#include "session.h"
#include "view_boxes.h"

namespace certa::cli {
namespace {

struct ViewArguments {
    CommonFlags common;
    std::vector<std::string> inputs;
    FileArgument format;  // only its format: of all inputs
    std::string output;
    ViewOptions options;
};

/// Above this browsers refuse or crawl: no text of theirs is longer than 512 MiB.
constexpr std::size_t unwieldy_bytes = 400'000'000;

void require_page_name(const Session& session, const std::string& path) {
    if (path == "-") {
        if (session.flags().json == "-") throw UsageError("-o - and --json - cannot both go to standard output");
        return;
    }
    const std::string extension = std::filesystem::path(path).extension().string();
    if (extension != ".html" && extension != ".htm") throw UsageError(path + ": a page is HTML; name it .html");
    // What remains is the same for all outputs; the format is not one of meshes.
    session.require_writable({path, Format::off});
}

/// File names, or paths where two files have the same name.
std::vector<std::string> names_of(const std::vector<std::string>& paths) {
    std::vector<std::string> names;
    std::set<std::string> distinct;
    for (const std::string& path : paths) {
        names.push_back(path == "-" ? "standard input" : std::filesystem::path(path).filename().string());
        distinct.insert(names.back());
    }
    return distinct.size() == names.size() ? names : paths;
}

std::vector<ViewModel> read_models(Session& session, const ViewArguments& arguments) {
    if (std::count(arguments.inputs.begin(), arguments.inputs.end(), "-") > 1)
        throw UsageError("-: standard input can be read once only");
    const std::vector<std::string> names = names_of(arguments.inputs);
    std::vector<ViewModel> models;
    Json inputs = Json::array();
    for (std::size_t i = 0; i < names.size(); ++i) {
        const bool is_boxes = holds_boxes(arguments.inputs[i]);
        models.push_back({names[i],
                          is_boxes ? session.timed("read", [&] { return read_boxes(arguments.inputs[i]); })
                                   : session.read({arguments.inputs[i], arguments.format.format}, "input"),
                          is_boxes});
        inputs.push_back(is_boxes ? Json{{"path", arguments.inputs[i]}, {"format", "json"}}
                                  : session.report()["input"]);
        const MeshDocument& document = models.back().document;
        std::string line = names[i] + ": " + counted(document.complex.positions.size(), "vertex", "vertices");
        if (document.complex.polygon_count() > 0) line += ", " + counted(document.complex.polygon_count(), "polygon");
        if (!document.complex.segments.empty()) line += ", " + counted(document.complex.segments.size(), "segment");
        if (!document.tetrahedra.empty())
            line += ", " + counted(document.tetrahedra.size(), "tetrahedron", "tetrahedra");
        for (const Field& field : document.fields) line += ", " + field.name;
        session.say(line);
        if (interrupt_flag()) break;
    }
    session.report().erase("input");
    session.report()["inputs"] = inputs;
    return models;
}

void write_page(const std::string& path, const std::string& page) {
    if (path != "-") return write_text(path, page);
    if (std::fwrite(page.data(), 1, page.size(), stdout) != page.size() || std::fflush(stdout) != 0)
        throw IoError("standard output", 0, "cannot be written");
}

ExitCode run_view(Session& session, const ViewArguments& arguments) {
    if (!arguments.output.empty()) require_page_name(session, arguments.output);
    const std::vector<ViewModel> models = read_models(session, arguments);
    if (interrupt_flag()) return ExitCode::interrupted;
    const std::string page = session.timed("format", [&] { return format_view(models, arguments.options); });
    session.report()["page"]["bytes"] = page.size();
    if (page.size() > unwieldy_bytes)
        session.warn("the page has " + text_of_count(page.size()) +
                     " bytes, which browsers may refuse to open: show fewer or smaller files");
    if (arguments.output.empty()) {
        session.say("the page would have " + text_of_count(page.size()) + " bytes; -o page.html writes it");
        return ExitCode::done;
    }
    if (interrupt_flag()) return ExitCode::interrupted;
    session.timed("write", [&] { write_page(arguments.output, page); });
    session.report()["output"]["path"] = arguments.output;
    session.report()["output"]["format"] = "html";
    session.say("wrote " + (arguments.output == "-" ? std::string("standard output") : arguments.output));
    return ExitCode::done;
}

}  // namespace

void add_view_command(CLI::App& app, Action& action) {
    auto arguments = std::make_shared<ViewArguments>();
    CLI::App* command = app.add_subcommand("view", "Write a page that shows meshes in a browser");
    command->footer(
        "Examples:\n  certa view part.off part.mesh -o page.html\n"
        "  certa view scan.ply few.obj lines.vtu -o page.html     lines of curvature, from remesh --lines, on the "
        "scan\n"
        "  certa view torus.off torus.json -o page.html           critical clusters of a certificate, in the surface");
    command
        ->add_option("FILE", arguments->inputs,
                     "meshes or complexes with their fields, certificates and reports of `certa implicit` "
                     "(.json); -: standard input")
        ->required();
    command->add_option("-o,--output", arguments->output, "page to write, .html (-: standard output)")
        ->type_name("PAGE");
    command->add_option("--title", arguments->options.title, "title of the page (default: the files' names)")
        ->type_name("TEXT");
    add_options(*command, frontend::view_options(), arguments->options);
    add_format_option(*command, "--input-format", arguments->format);
    add_common_flags(*command, arguments->common);
    command->callback([arguments, &action] {
        action = [arguments] {
            Session session("view", arguments->common);
            return session.run([&] { return run_view(session, *arguments); });
        };
    });
}

}  // namespace certa::cli
