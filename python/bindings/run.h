#pragma once
// How a job of the library runs under Python: on a thread of its own, without the interpreter's lock, while the
// calling thread listens for signals and hands progress on.
#include <certa/run_control.h>
#include <pybind11/pybind11.h>

#include <functional>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>

namespace certa::python {

/// What the caller wants to see of a job.
struct Watch {
    pybind11::object progress = pybind11::none();  ///< called with the stage's name and the fraction done, or None
    unsigned threads = 0;                          ///< 0: all
    /// Interrupted, a job that does not notice soon is left to end by itself; false: it is waited for.
    bool may_leave = true;
};

/// Calls `work` on another thread and returns when it has ended; what it throws comes through.
///
/// Input:     work that owns what it uses, none of it Python's: it may outlive the call.
/// Guarantee: within 50 ms of a signal (Ctrl-C) the handler has run; if it raises, or `progress` does, the job is
///            cancelled, and within half a second more that exception comes through instead of a result. The end of
///            the process waits for jobs that were left.
void run_watched(const Watch& watch, std::function<void(const RunControl&)> work);

/// The result of a job that runs in this way.
template <class Work>
auto run(const Watch& watch, Work work) {
    using Result = std::invoke_result_t<Work&, const RunControl&>;
    struct Task {
        Work work;
        std::optional<Result> result;
    };
    const auto task = std::make_shared<Task>(Task{std::move(work), std::nullopt});
    run_watched(watch, [task](const RunControl& control) { task->result.emplace(task->work(control)); });
    return std::move(*task->result);
}

/// Makes the interpreter wait for jobs that were left before it ends.
void add_waiting(pybind11::module_& module);

}  // namespace certa::python
