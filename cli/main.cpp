// The command `certa`: parses arguments with CLI11, maps its outcomes to our exit codes, runs one subcommand.
#include <cstdio>
#include <exception>
#include <string>

#include "build_info.h"
#include "commands.h"
#include "frontend/option_table.h"
#include "interrupt.h"
#include "manual.h"

namespace {

using certa::cli::ExitCode;

std::string version_text() {
    return std::string("certa ") + certa::cli::version() + " (commit " + certa::cli::commit() + ")\n" +
           certa::cli::library_versions();
}

/// The subcommand that was named, for messages; the program itself if none was.
std::string invoked(const CLI::App& app) {
    const auto subcommands = app.get_subcommands();
    return subcommands.empty() ? "certa" : "certa " + subcommands.front()->get_name();
}

int refuse_usage(const std::string& command, const std::string& message) {
    std::fprintf(stderr, "%s: %s\nSee '%s --help'.\n", command.c_str(), message.c_str(), command.c_str());
    return static_cast<int>(ExitCode::usage);
}

int run(int argc, char** argv) {
    CLI::App app("certa: surface discretization you can trust\n", "certa");
    app.footer(
        "Exit codes: 0 done and verified, 1 a check found a violation, 2 usage, 3 bad input or file,\n"
        "4 not possible within the limits, 70 a bug of ours, 130 interrupted.\n"
        "See 'certa COMMAND --help' for options and an example.");
    app.set_version_flag("--version", version_text(), "print version, commit and library versions");
    app.require_subcommand(1);
    certa::cli::Action action;
#ifdef CERTA_HAS_CONFORM
    certa::cli::add_conform_command(app, action);
#endif
    certa::cli::add_curvature_command(app, action);
    certa::cli::add_remesh_command(app, action);
    certa::cli::add_implicit_command(app, action);
    certa::cli::add_check_command(app, action);
    certa::cli::add_info_command(app, action);
    certa::cli::add_convert_command(app, action);
    certa::cli::add_view_command(app, action);

    const auto add_printer = [&](const char* name, const char* description, auto make) {
        app.add_subcommand(name, description)->group("")->callback([&action, make] {
            action = [make] {
                std::fputs(make().c_str(), stdout);
                return ExitCode::done;
            };
        });
    };
    add_printer("manual", "Print the manual page",
                [&app] { return certa::cli::manual_page(app, certa::cli::version()); });
    add_printer("completion", "Print the completion for bash", [&app] { return certa::cli::bash_completion(app); });

    if (argc < 2) {
        std::fputs(app.help().c_str(), stderr);
        return static_cast<int>(ExitCode::usage);
    }
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error);  // --help and --version
        return refuse_usage(invoked(app), error.what());
    } catch (const certa::frontend::OptionError& error) {
        return refuse_usage(invoked(app), error.what());
    }
    certa::cli::install_signal_handlers();
    return static_cast<int>(action());
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "certa: %s\nThis is a bug in Certa: please report it with the command.\n", error.what());
        return static_cast<int>(ExitCode::bug);
    }
}
