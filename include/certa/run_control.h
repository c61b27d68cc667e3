#pragma once
// How a long computation is watched and stopped.
#include <atomic>
#include <functional>
#include <string_view>

namespace certa {

/// Passed to every long computation; the default runs silently to the end on all cores.
struct RunControl {
    /// Called now and then from the calling thread with the stage's name and the fraction of it done, in [0, 1].
    std::function<void(std::string_view stage, double fraction)> progress;
    /// Set to true from any thread or from a signal handler: the computation ends soon with Outcome::cancelled.
    const std::atomic<bool>* cancel = nullptr;
    /// Number of threads; 0 means all. Results do not depend on it.
    unsigned threads = 0;

    /// Somebody asked for the end.
    bool cancelled() const { return cancel != nullptr && cancel->load(std::memory_order_relaxed); }
    /// Calls `progress` if there is one.
    void report(std::string_view stage, double fraction) const {
        if (progress) progress(stage, fraction);
    }
};

/// How a computation ended. Anything but `done` keeps what was computed, labelled as partial.
enum class Outcome : unsigned char { done, over_budget, below_min_feature, undecided, cancelled };
/// The name as it is written here.
const char* name_of(Outcome outcome);

}  // namespace certa
