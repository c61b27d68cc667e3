// The progress line: a carriage return, the stage, a bar, the percentage, and the rest of the line erased.
#include "progress_line.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace certa::cli {

ProgressLine::ProgressLine(bool wanted) {
    const char* terminal = std::getenv("TERM");
    enabled_ = wanted && isatty(STDERR_FILENO) == 1 && terminal != nullptr && std::string_view(terminal) != "dumb";
}

void ProgressLine::show(std::string_view stage, double fraction) {
    if (!enabled_) return;
    const auto now = std::chrono::steady_clock::now();
    if (drawn_ && stage == stage_ && now - last_ < std::chrono::milliseconds(100)) return;
    last_ = now;
    stage_ = stage;
    drawn_ = true;
    constexpr int width = 30;
    const double shown = std::clamp(fraction, 0.0, 1.0);
    const int filled = static_cast<int>(shown * width);
    std::string bar(static_cast<std::size_t>(filled), '#');
    bar.append(static_cast<std::size_t>(width - filled), '.');
    std::fprintf(stderr, "\r%-24.24s [%s] %3d %%\033[K", stage_.c_str(), bar.c_str(), static_cast<int>(shown * 100));
    std::fflush(stderr);
}

void ProgressLine::clear() {
    if (!drawn_) return;
    std::fputs("\r\033[K", stderr);
    std::fflush(stderr);
    drawn_ = false;
}

}  // namespace certa::cli
