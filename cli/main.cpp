// The command `certa`: parses arguments with CLI11, maps its outcomes to our exit codes, runs one subcommand.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

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

/// How many letters must be added, left out or changed to make one word of the other.
std::size_t edits_between(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = std::exchange(row[0], i + 1);
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t changed = diagonal + (a[i] != b[j]);
            diagonal = row[j + 1];
            row[j + 1] = std::min({changed, row[j] + 1, diagonal + 1});
        }
    }
    return row[b.size()];
}

/// "; did you mean 'conform'?" where a name is that close.
std::string suggestion(std::string_view word, const std::vector<std::string>& names) {
    std::size_t best = 1 + word.size() / 3;
    std::string nearest;
    for (const std::string& name : names)
        if (const std::size_t edits = edits_between(word, name); edits < best) best = edits, nearest = name;
    return nearest.empty() ? "" : "; did you mean '" + nearest + "'?";
}

/// What is wrong with a command line that CLI11 refuses, in words for somebody who meant something else.
std::string explain(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv) {
    const auto commands = app.get_subcommands();
    if (commands.empty()) {
        std::vector<std::string> names;
        for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
            if (!command->get_group().empty()) names.push_back(command->get_name());
        if (argc > 1 && argv[1][0] != '-')
            return std::string("'") + argv[1] + "' is no command" + suggestion(argv[1], names);
        return error.what();
    }
    std::string message = error.what();
    if (dynamic_cast<const CLI::ExtrasError*>(&error) == nullptr &&
        dynamic_cast<const CLI::RequiredError*>(&error) == nullptr)
        return message;
    std::vector<std::string> flags;
    for (const CLI::Option* option : commands.front()->get_options())
        for (const std::string& name : option->get_lnames()) flags.push_back("--" + name);
    for (const std::string& extra : app.remaining(true)) {
        if (extra.starts_with("--")) return message + suggestion(extra.substr(0, extra.find('=')), flags);
        if (extra.starts_with("-") && extra != "-")
            return message + "; what begins with '-' and is no option goes after --";
    }
    return message;
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
        return refuse_usage(invoked(app), explain(app, error, argc, argv));
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
