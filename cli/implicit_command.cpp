// `certa implicit EXPR|FILE [-o OUT]`: from a function to a mesh with certified topology, verified by the independent
// checker before it is written. What cannot be certified ends with exit code 4 and the boxes where the proof got stuck;
// nothing is written.
#include <certa/conforming.h>
#include <certa/implicit.h>
#include <certa/io.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include "commands.h"
#include "implicit_arguments.h"
#include "interrupt.h"
#include "machine.h"
#include "report.h"
#include "session.h"

namespace certa::cli {
namespace {

struct ImplicitArguments {
    CommonFlags common;
    FunctionArgument function;
    FileArgument output;
    std::vector<double> box{-2, -2, -2, 2, 2, 2};
    ImplicitOptions options;
    frontend::OutputOptions output_options;
    std::string certificate, level, error, hausdorff, engine = "growth";
    bool no_verify = false;
};

/// The text of `function - level`: the last statement gets a name, if it has none, that one more statement uses.
std::string with_level(std::string text, const std::string& level) {
    std::size_t start = text.rfind("\xEF\xBB\xBF", 0) == 0 ? 3 : 0;
    char last = 0;  // of the statement so far
    int depth = 0;
    for (std::size_t i = start; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '#') {
            while (i + 1 < text.size() && text[i + 1] != '\n' && text[i + 1] != '\r') ++i;
        } else if (depth == 0 && (c == ';' || c == '\n' || c == '\r')) {
            if (last != 0 && (c == ';' || std::strchr("+-*/^=", last) == nullptr)) last = 0;
        } else if (std::isspace(static_cast<unsigned char>(c)) == 0) {
            if (last == 0) start = i;
            depth += c == '(' ? 1 : c == ')' ? -1 : 0;
            last = c;
        }
    }
    std::size_t end = start;
    while (end < text.size() && (std::isalnum(static_cast<unsigned char>(text[end])) != 0 || text[end] == '_')) ++end;
    std::string name = text.substr(start, end - start);
    while (end < text.size() && (text[end] == ' ' || text[end] == '\t')) ++end;
    if (name.empty() || end == text.size() || text[end] != '=') {
        name = "surface";
        while (text.find(name) != std::string::npos) name += "_";
        text.insert(start, name + " = ");
    }
    return text + "\n" + name + " - (" + level + ")\n";
}

std::string place_text(const Point3& p) {
    return "(" + frontend::text_of(p.x) + ", " + frontend::text_of(p.y) + ", " + frontend::text_of(p.z) + ")";
}

/// What an obstacle means and what to do about it.
const char* advice(ImplicitObstacle::Reason reason) {
    switch (reason) {
        case ImplicitObstacle::Reason::singular:
            return "the function and its gradient cannot be told from 0 together: the surface is singular there, or "
                   "nearly "
                   "so; another level, or a smooth blend, may avoid it";
        case ImplicitObstacle::Reason::meets_box:
            return "the surface meets the box there; a larger or smaller --box may not, and --clip meshes what is "
                   "inside";
        case ImplicitObstacle::Reason::tangent_to_box:
            return "the surface is tangent to the box there, or meets one of its corners, or nearly so; another --box "
                   "may not be";
        case ImplicitObstacle::Reason::undefined:
            return "the function is not defined there, or cannot be shown to be; choose a --box where it is";
        case ImplicitObstacle::Reason::precision:
            return "the cells have become as small as doubles allow";
        case ImplicitObstacle::Reason::budget:
            return "--max-cells, --max-depth, --time or the memory of this machine was reached; the boxes are where it "
                   "would go "
                   "on";
        default:
            return "interrupted";
    }
}

void report_result(Session& session, const ImplicitResult& result, bool clipped) {
    Json& report = session.report();
    report["outcome"] = name_of(result.outcome);
    report["verdict"] = name_of(result.verdict);
    const bool decided = result.verdict != ImplicitVerdict::undecided;
    report["status"] = {{"type", decided ? "certified" : "undecided"},
                        {"isotopy", result.isotopic ? "certified"
                                    : decided       ? "not claimed"
                                                    : "undecided"}};
    report["box"] = {{"low", to_json(result.low)}, {"high", to_json(result.high)}};
    report["mesh"] = {{"vertices", result.mesh.positions.size()}, {"triangles", result.mesh.triangles.size()}};
    Json components = Json::array();
    for (const ImplicitComponent& c : result.components) {
        Json entry{{"genus", c.genus}, {"inner_sign", c.inner_sign}, {"degree", c.degree}};
        entry["parent"] = c.parent ? Json(*c.parent + 1) : Json(nullptr);
        if (clipped) entry = {{"genus", c.genus}, {"boundary_loops", c.loops}};
        components.push_back(entry);
    }
    report["components"] = components;
    report["statistics"] = record_of(result.statistics);
    Json obstacles = Json::array();
    for (const ImplicitObstacle& o : result.obstacles)
        obstacles.push_back({{"reason", name_of(o.reason)}, {"low", to_json(o.low)}, {"high", to_json(o.high)}});
    report["obstacles"] = obstacles;
    report["obstacle_count"] = result.obstacle_count;
}

MeshDocument document_of(const ImplicitResult& result, Format format);

/// The guess that --uncertified asks for, labelled as one.
void write_guess(Session& session, const ImplicitArguments& arguments, const ImplicitResult& result) {
    const FileArgument& output = arguments.output;
    MeshDocument document = document_of(result, output.format ? *output.format : *format_of(output.path));
    document.remark = std::string("NOT CERTIFIED: a guess; ") + name_of(result.obstacles.front().reason);
    session.say("NOT CERTIFIED: what is written is a guess");
    session.write(output, document, arguments.output_options);
}

ExitCode end_undecided(Session& session, const ImplicitArguments& arguments, const ImplicitResult& result) {
    if (result.outcome == Outcome::cancelled || interrupt_flag()) return ExitCode::interrupted;
    const ImplicitObstacle& first = result.obstacles.front();
    session.say(std::string("UNDECIDED (") + name_of(first.reason) + "): " + advice(first.reason));
    const std::size_t shown =
        session.flags().verbose ? result.obstacles.size() : std::min<std::size_t>(5, result.obstacles.size());
    for (std::size_t i = 0; i < shown; ++i)
        session.say("  box " + place_text(result.obstacles[i].low) + " to " + place_text(result.obstacles[i].high));
    if (result.obstacle_count > shown)
        session.say("  ... " + counted(result.obstacle_count - shown, "more box", "more boxes"));
    if (!result.mesh.triangles.empty() && arguments.output.given()) write_guess(session, arguments, result);
    return ExitCode::unable;
}

/// A genus, and the loops of a component that has any.
std::string form_of(int genus, int loops) {
    return std::to_string(genus) + (loops == 0 ? "" : " with " + counted(static_cast<std::size_t>(loops), "loop"));
}

void say_result(Session& session, const ImplicitResult& result) {
    const std::string box = " in the box " + place_text(result.low) + " to " + place_text(result.high);
    if (result.verdict == ImplicitVerdict::empty) {
        session.say("EMPTY: the function has no zero" + box);
        return;
    }
    std::string genera;
    for (std::size_t i = 0; i < result.components.size() && i < 20; ++i)
        genera += (i == 0 ? "" : ", ") + form_of(result.components[i].genus, result.components[i].loops);
    if (result.components.size() > 20) genera += ", ...";
    session.say(std::string(result.isotopic ? "CERTIFIED" : "CERTIFIED (type; isotopy is not claimed)") + box + ": " +
                counted(result.components.size(), "component") + " of genus " + genera + "; " +
                counted(result.mesh.positions.size(), "vertex", "vertices") + ", " +
                counted(result.mesh.triangles.size(), "triangle"));
    session.detail("  " + counted(result.statistics.leaves, "leaf", "leaves") + ", " +
                   counted(result.statistics.clusters, "critical cluster") + ", " +
                   counted(result.statistics.rounds, "round"));
}

/// What a check proved, by name.
std::vector<std::string> promises_of(const ImplicitCheck& check) {
    if (check.isotopic) return {"isotopic"};
    if (check.loops.empty()) return {"components", "genera"};
    return {"components", "genera", "boundary_loops"};
}

void verify(Session& session, const ImplicitResult& result, const std::string& function) {
    session.require_memory(estimate_check_memory(result.certificate),
                           "the independent check (--no-verify leaves it for later)");
    const ImplicitCheck check = session.timed("check", [&] {
        const GracefulScope graceful;
        return check_implicit(result.mesh, function, result.certificate, session.control());
    });
    if (interrupt_flag()) return;
    session.report()["check"] = to_json(check);
    if (!check.ok()) {
        // The report must not repeat a claim that did not stand.
        session.report()["verdict"] = name_of(ImplicitVerdict::undecided);
        session.report()["status"] = {{"type", "undecided"}, {"isotopy", "undecided"}};
        throw InternalError("the result failed its own check and was not written: " + check.violations.front());
    }
    std::vector<std::string> promises = promises_of(check);
    if (check.hausdorff) promises.push_back("hausdorff");
    session.report()["proved"] = promises;
    if (check.hausdorff) session.say("within " + frontend::text_of(*check.hausdorff) + " of the zero set, both ways");
    session.say("verified by the independent checker: " + counted(check.leaves_checked, "leaf", "leaves") + ", " +
                counted(check.marks_checked, "mark") + ", " + counted(check.triangles_checked, "triangle"));
}

MeshDocument document_of(const ImplicitResult& result, Format format) {
    MeshDocument document;
    document.complex = make_complex(result.mesh);
    if (format == Format::ply || format == Format::vtu) {
        std::vector<std::int64_t> components;
        for (const std::uint32_t c : result.triangle_components) components.push_back(std::int64_t{c} + 1);
        document.fields.push_back({"component", Location::polygons, 1, std::move(components)});
    }
    return document;
}

void require_surface_format(const Session& session, const FileArgument& output) {
    session.require_writable(output);
    const Format format = output.format ? *output.format : *format_of(output.path);
    if (format != Format::off && format != Format::obj && format != Format::ply && format != Format::stl &&
        format != Format::vtu)
        throw UsageError(std::string(name_of(format)) +
                         " is no format for surfaces here; write .off, .obj, .ply, .stl or .vtu");
}

/// A length above 0; nothing for an empty text.
std::optional<double> length_of(const char* flag, const std::string& text, double diagonal) {
    if (text.empty()) return std::nullopt;
    const Length length = frontend::parse_length(flag, text);
    const double value = length.resolve(diagonal);
    if (!(value > 0)) throw UsageError(std::string(flag) + ": " + text + " is out of range; allowed is above 0");
    return value;
}

ExitCode run_implicit(Session& session, const ImplicitArguments& arguments) {
    if (arguments.output.given()) require_surface_format(session, arguments.output);
    if (!arguments.certificate.empty()) session.require_writable({arguments.certificate, Format::off});
    if (arguments.options.uncertified && arguments.output.given() &&
        (arguments.output.format ? *arguments.output.format : *format_of(arguments.output.path)) == Format::stl)
        throw UsageError("a guess must be labelled in its file, which STL cannot; write .off, .obj, .ply or .vtu");
    FunctionArgument::Source source = arguments.function.read();
    session.report()["input"] = {{"name", source.name}};
    Expression function = parse_expression(source.text, source.name);
    if (!arguments.level.empty()) {
        frontend::parse_number("--level", arguments.level);
        source.text = with_level(source.text, arguments.level);
        function = parse_expression(source.text, source.name);
        session.report()["function"] = source.text;
        session.say("for `check --against`, the function is\n" + source.text);
    }
    Json& options = session.report()["options"];
    for (const auto& option : frontend::implicit_options())
        options[std::string(option.name)] = frontend::value_of(option, arguments.options);
    options["box"] = arguments.box;
    options["verify"] = !arguments.no_verify;
    const auto& b = arguments.box;
    ImplicitOptions settings = arguments.options;
    const double diagonal = std::hypot(b[3] - b[0], b[4] - b[1], b[5] - b[2]);
    settings.error = length_of("--error", arguments.error, diagonal);
    settings.hausdorff = length_of("--hausdorff", arguments.hausdorff, diagonal);
    options["error"] = settings.error ? Json(*settings.error) : Json(nullptr);
    options["hausdorff"] = settings.hausdorff ? Json(*settings.hausdorff) : Json(nullptr);
    options["engine"] = arguments.engine;
    const bool certifies = arguments.engine != "plantinga-vegter";
    settings.engine = !certifies                     ? ImplicitEngine::plantinga_vegter
                      : arguments.engine == "thesis" ? ImplicitEngine::thesis
                                                     : ImplicitEngine::growth;
    if (!certifies && !arguments.certificate.empty())
        throw UsageError("the engine " + arguments.engine + " writes no certificate");
    settings.memory_bytes = available_memory();
    settings.certificate = certifies && (!arguments.no_verify || !arguments.certificate.empty());
    const ImplicitResult result = session.timed("implicit", [&] {
        const GracefulScope graceful;
        return mesh_implicit(function, {b[0], b[1], b[2]}, {b[3], b[4], b[5]}, settings, session.control());
    });
    report_result(session, result, settings.clip);
    if (result.verdict == ImplicitVerdict::undecided) return end_undecided(session, arguments, result);
    say_result(session, result);
    if (result.verdict == ImplicitVerdict::certified && settings.hausdorff && !result.hausdorff) {
        session.say("UNDECIDED (distance): the mesh is isotopic, but not proved to be within " +
                    frontend::text_of(*settings.hausdorff) +
                    " of the zero set; a smaller --hausdorff may be, or --error");
        return ExitCode::unable;
    }
    if (!certifies) session.say("by subdivision with small variation; there is no certificate to verify");
    if (certifies && !arguments.no_verify) verify(session, result, source.text);
    if (interrupt_flag()) return ExitCode::interrupted;
    if (!arguments.certificate.empty()) {
        session.timed("write", [&] { write_text(arguments.certificate, result.certificate); });
        session.say("wrote " + arguments.certificate);
    }
    if (arguments.output.given()) {
        const Format format = arguments.output.format ? *arguments.output.format : *format_of(arguments.output.path);
        session.write(arguments.output, document_of(result, format), arguments.output_options);
    }
    return ExitCode::done;
}

}  // namespace

std::string read_text(const std::string& path) {
    const bool standard = path == "-";
    std::FILE* file = standard ? stdin : std::fopen(path.c_str(), "rb");
    if (file == nullptr) throw IoError(path, 0, "cannot be opened");
    std::string text;
    std::array<char, 65536> buffer;
    while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), file))
        text.append(buffer.data(), count);
    const bool broken = std::ferror(file) != 0;
    if (!standard) std::fclose(file);
    if (broken) throw IoError(standard ? "standard input" : path, 0, "cannot be read");
    return text;
}

namespace {

/// A word with a dot before a letter, such as torus.txt: no expression has that.
bool looks_like_a_file(const std::string& text) {
    if (text.find_first_of(" \t\n()*+^=;,") != std::string::npos) return false;
    const std::size_t dot = text.rfind('.');
    return dot != std::string::npos && dot + 1 < text.size() &&
           std::isalpha(static_cast<unsigned char>(text[dot + 1])) != 0 && text.substr(dot + 1, 1) != "e";
}

}  // namespace

FunctionArgument::Source FunctionArgument::read() const {
    if (text == "-") return {"standard input", read_text(text)};
    std::error_code error;
    if (std::filesystem::is_regular_file(text, error)) return {text, read_text(text)};
    if (looks_like_a_file(text)) throw IoError(text, 0, "no file of this name, and no expression either");
    return {"expression", text};
}

Json to_json(const ImplicitCheck& check) {
    return {{"violation_count", check.violation_count},    {"violations", check.violations},
            {"verdict", name_of(check.verdict)},           {"genera", check.genera},
            {"leaves_checked", check.leaves_checked},      {"marks_checked", check.marks_checked},
            {"triangles_checked", check.triangles_checked}};
}

ExitCode check_implicit_mesh(Session& session, const MeshDocument& document, const FunctionArgument& function,
                             const std::string& certificate) {
    const FunctionArgument::Source source = function.read();
    parse_expression(source.text, source.name);  // for its message; the check reads the text by itself
    const TriangleMesh mesh = make_triangle_mesh(document);
    const std::string proof = read_text(certificate);
    session.require_memory(estimate_check_memory(proof), "checking this certificate");
    const ImplicitCheck check = session.timed("check", [&] {
        const GracefulScope graceful;
        return check_implicit(mesh, source.text, proof, session.control());
    });
    if (interrupt_flag()) return ExitCode::interrupted;
    session.report()["check"] = to_json(check);
    session.report()["checked"] = {"isotopic"};
    if (!check.ok()) {
        for (std::size_t i = 0; i < check.violations.size() && (i < 20 || session.flags().verbose); ++i)
            session.say(check.violations[i]);
        session.say("VIOLATED: " + counted(check.violation_count, "violation") +
                    "; the certificate does not prove what it claims of the mesh and the zero set");
        return ExitCode::violated;
    }
    session.report()["checked"] = session.report()["proved"] = promises_of(check);
    std::string genera;
    for (std::size_t i = 0; i < check.genera.size(); ++i)
        genera += (i == 0 ? " of genus " : ", ") + form_of(check.genera[i], check.loops.empty() ? 0 : check.loops[i]);
    session.say("verified: " +
                std::string(check.isotopic ? "isotopic to the zero set; "
                                           : "components and their type are those of the zero set; ") +
                counted(check.genera.size(), "component") + genera + "; " +
                counted(check.leaves_checked, "leaf", "leaves") + ", " + counted(check.marks_checked, "mark") + ", " +
                counted(check.triangles_checked, "triangle") + " checked");
    return ExitCode::done;
}

void add_implicit_command(CLI::App& app, Action& action) {
    auto arguments = std::make_shared<ImplicitArguments>();
    CLI::App* command =
        app.add_subcommand("implicit", "Mesh the zero set of a function of x, y, z with certified topology");
    command->footer(
        "Example:\n  certa implicit \"(x^2+y^2+z^2+0.84)^2 - 4*(x^2+y^2)\" -o torus.off --certificate torus.json\n"
        "  certa check torus.off --against \"(x^2+y^2+z^2+0.84)^2 - 4*(x^2+y^2)\" --certificate torus.json");
    command
        ->add_option("FUNCTION", arguments->function.text,
                     "expression, or a file of definitions that ends with one (-: standard input)")
        ->required();
    command
        ->add_option("-o,--output", arguments->output.path,
                     "triangle mesh to write (-: standard output); without it only the report is printed")
        ->type_name("OUT");
    add_format_option(*command, "--output-format", arguments->output);
    command
        ->add_option("--box", arguments->box,
                     "low and high corner; without --clip the surface must not meet it (default: -2 to 2)")
        ->expected(6)
        ->type_name("X0 Y0 Z0 X1 Y1 Z1");
    add_options(*command, frontend::implicit_options(), arguments->options);
    command->add_option("--level", arguments->level, "mesh {function = C} instead of {function = 0}")->type_name("C");
    command
        ->add_option(
            "--error", arguments->error,
            "refine and simplify to this distance from the zero set, as sampled (default: as fine as the proof)")
        ->type_name("LENGTH");
    command
        ->add_option("--hausdorff", arguments->hausdorff,
                     "prove that mesh and zero set are within this length of each other; the mesh follows from it")
        ->type_name("LENGTH");
    command
        ->add_option("--engine", arguments->engine,
                     "growth, plantinga-vegter (writes no certificate) or thesis (W by its watershed, for comparison)")
        ->check(CLI::IsMember({"growth", "plantinga-vegter", "thesis"}))
        ->type_name("ENGINE");
    command->add_option("--certificate", arguments->certificate, "write the certificate, JSON, for `check`")
        ->type_name("FILE");
    command->add_flag("--no-verify", arguments->no_verify, "do not run the independent checker before writing");
    add_common_flags(*command, arguments->common);
    command->callback([arguments, &action] {
        action = [arguments] {
            Session session("implicit", arguments->common);
            return session.run([&] { return run_implicit(session, *arguments); });
        };
    });
}

}  // namespace certa::cli
