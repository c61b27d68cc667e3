#pragma once
// What the machine has, and what this process took.
#include <cstdint>
#include <string>

namespace certa::cli {

/// Bytes that this process may still take: free memory, the control group's limit and the address space limit.
std::uint64_t available_memory();

/// Largest resident size so far, in bytes.
std::uint64_t peak_memory();

/// "1.4 GB"
std::string text_of_bytes(std::uint64_t bytes);

}  // namespace certa::cli
