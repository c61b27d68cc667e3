#pragma once
// The subcommands. Each adds its options to the parser and sets `action` to what main runs once parsing has succeeded.
#include <CLI/CLI.hpp>
#include <functional>

#include "exit_code.h"

namespace certa::cli {

using Action = std::function<ExitCode()>;

void add_conform_command(CLI::App& app, Action& action);
void add_check_command(CLI::App& app, Action& action);
void add_curvature_command(CLI::App& app, Action& action);
void add_remesh_command(CLI::App& app, Action& action);
void add_implicit_command(CLI::App& app, Action& action);
void add_info_command(CLI::App& app, Action& action);
void add_convert_command(CLI::App& app, Action& action);
void add_view_command(CLI::App& app, Action& action);

}  // namespace certa::cli
