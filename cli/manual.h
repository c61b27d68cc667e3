#pragma once
// What an installation brings along besides the program, made from the same options as its help.
#include <CLI/CLI.hpp>
#include <string>

namespace certa::cli {

/// The manual page certa(1), in roff.
std::string manual_page(const CLI::App& app, const std::string& version);
/// Completion for bash (zsh: after `bashcompinit`).
std::string bash_completion(const CLI::App& app);

}  // namespace certa::cli
