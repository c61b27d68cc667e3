#pragma once
// One line on a terminal that says what is going on; nothing anywhere else.
#include <chrono>
#include <string>
#include <string_view>

namespace certa::cli {

class ProgressLine {
public:
    /// Draws only if `wanted` and standard error is a terminal that can move its cursor.
    explicit ProgressLine(bool wanted);
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;
    ~ProgressLine() { clear(); }

    /// At most ten times a second, and whenever the stage changes.
    void show(std::string_view stage, double fraction);
    void clear();

private:
    bool enabled_ = false;
    bool drawn_ = false;
    std::string stage_;
    std::chrono::steady_clock::time_point last_{};
};

}  // namespace certa::cli
