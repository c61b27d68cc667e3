#pragma once
// Where the time goes.
#include <certa/remeshing.h>

#include <chrono>

namespace certa::remeshing {

/// Adds the time since the last call to a stage of the statistics.
class Stopwatch {
public:
    explicit Stopwatch(RemeshStatistics& statistics) : statistics_(statistics) {}
    void stage(const char* name) {
        const auto now = std::chrono::steady_clock::now();
        const double seconds = std::chrono::duration<double>(now - start_).count();
        start_ = now;
        for (auto& [known, sum] : statistics_.stage_seconds)
            if (known == name) {
                sum += seconds;
                return;
            }
        statistics_.stage_seconds.push_back({name, seconds});
    }

private:
    RemeshStatistics& statistics_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace certa::remeshing
