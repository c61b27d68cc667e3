// `certa convert IN OUT`: from one format to another. The writer refuses what the format cannot carry, so nothing is
// lost without being said.
#include <memory>

#include "commands.h"
#include "session.h"

namespace certa::cli {
namespace {

struct ConvertArguments {
    CommonFlags common;
    FileArgument input, output;
    frontend::OutputOptions options;
};

ExitCode run_convert(Session& session, const ConvertArguments& arguments) {
    session.require_writable(arguments.output);
    const MeshDocument document = session.read(arguments.input, "input");
    session.write(arguments.output, document, arguments.options);
    return ExitCode::done;
}

}  // namespace

void add_convert_command(CLI::App& app, Action& action) {
    auto arguments = std::make_shared<ConvertArguments>();
    CLI::App* command = app.add_subcommand("convert", "Convert between formats, losing nothing silently");
    command->footer("Example:\n  certa convert part.stl part.ply --encoding ascii");
    command->add_option("IN", arguments->input.path, "mesh or complex (-: standard input)")->required();
    command->add_option("OUT", arguments->output.path, "file to write (-: standard output)")->required();
    add_format_option(*command, "--input-format", arguments->input);
    add_format_option(*command, "--output-format", arguments->output);
    add_options(*command, frontend::output_options().first(2), arguments->options);
    add_common_flags(*command, arguments->common);
    command->callback([arguments, &action] {
        action = [arguments] {
            Session session("convert", arguments->common);
            return session.run([&] { return run_convert(session, *arguments); });
        };
    });
}

}  // namespace certa::cli
