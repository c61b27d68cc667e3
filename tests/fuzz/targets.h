#pragma once
// What is fuzzed: one target per parser of files.
#include <span>
#include <string_view>

namespace certa::fuzz {

/// Names of the targets; each has its folder of files in corpus/.
std::span<const std::string_view> target_names();

/// Parses the bytes as a file of the target's format. What is accepted is written in the same format and read again:
/// the second writing must equal the first. Aborts where it does not, or where anything but a refusal is thrown.
void run_target(std::string_view name, std::string_view bytes);

}  // namespace certa::fuzz
