// Memory limits and use, from /proc, control groups (version 2, the process's own and all above it) and getrusage.
// Whatever cannot be read does not limit.
#include "machine.h"

#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <limits>
#include <optional>
#include <string_view>

namespace certa::cli {
namespace {

constexpr std::uint64_t unlimited = std::numeric_limits<std::uint64_t>::max();

std::optional<std::uint64_t> number_in(const std::string& path) {
    std::ifstream file(path);
    std::uint64_t value = 0;
    if (!(file >> value)) return std::nullopt;  // also for "max"
    return value;
}

/// The value of a line "Name:  123 kB", in bytes.
std::optional<std::uint64_t> kilobytes_in(const std::string& path, std::string_view name) {
    std::ifstream file(path);
    std::string word;
    while (file >> word) {
        std::uint64_t value = 0;
        if (word == name && file >> value) return value * 1024;
    }
    return std::nullopt;
}

/// What the control groups leave, from the process's own up to the root of what is visible.
std::uint64_t left_by_control_groups() {
    std::ifstream file("/proc/self/cgroup");
    std::string line, group;
    while (std::getline(file, line))
        if (line.starts_with("0::")) group = line.substr(3);
    std::uint64_t left = unlimited;
    for (;;) {
        const std::string folder = "/sys/fs/cgroup" + (group == "/" ? std::string() : group);
        const auto limit = number_in(folder + "/memory.max"), used = number_in(folder + "/memory.current");
        // Cached files are given back when memory is asked for.
        const auto reclaimable = kilobytes_in(folder + "/memory.stat", "inactive_file");
        if (limit && used) {
            const std::uint64_t cached = std::min(*used, reclaimable.value_or(0) / 1024);
            left = std::min(left, *limit - std::min(*limit, *used - cached));
        }
        if (group.empty() || group == "/") return left;
        group.resize(group.find_last_of('/'));
    }
}

std::uint64_t left_by_address_space() {
    rlimit limit{};
    if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return unlimited;
    const std::uint64_t used = kilobytes_in("/proc/self/status", "VmSize:").value_or(0);
    return limit.rlim_cur - std::min<std::uint64_t>(limit.rlim_cur, used);
}

}  // namespace

std::uint64_t available_memory() {
    const std::uint64_t free = kilobytes_in("/proc/meminfo", "MemAvailable:").value_or(unlimited);
    return std::min({free, left_by_control_groups(), left_by_address_space()});
}

std::uint64_t peak_memory() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

std::string text_of_bytes(std::uint64_t bytes) {
    const bool large = bytes >= 1'000'000'000;
    const double value = static_cast<double>(bytes) / (large ? 1e9 : 1e6);
    std::array<char, 32> buffer;
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::fixed, 1);
    return std::string(buffer.data(), end.ptr) + (large ? " GB" : " MB");
}

}  // namespace certa::cli
