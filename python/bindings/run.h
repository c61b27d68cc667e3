#pragma once
// How a job of the library runs under Python: on a thread of its own, without the interpreter's lock, while the
// calling thread listens for signals and hands progress on.
#include <certa/run_control.h>
#include <pybind11/pybind11.h>

#include <functional>
#include <optional>
#include <utility>

namespace certa::python {

/// What the caller wants to see of a job.
struct Watch {
    pybind11::object progress;  ///< called with the stage's name and the fraction done, or None
    unsigned threads = 0;       ///< 0: all
};

/// Calls `work` on another thread and returns when it has ended; what it throws comes through.
///
/// Guarantee: within 50 ms of a signal (Ctrl-C) the handler has run; if it raises, or `progress` does, the job is
///            cancelled and, once it has ended, that exception comes through instead of a result.
void run_watched(const Watch& watch, const std::function<void(const RunControl&)>& work);

/// The result of a job that runs in this way.
template <class Work>
auto run(const Watch& watch, const Work& work) {
    std::optional<decltype(work(std::declval<const RunControl&>()))> result;
    run_watched(watch, [&](const RunControl& control) { result.emplace(work(control)); });
    return std::move(*result);
}

}  // namespace certa::python
