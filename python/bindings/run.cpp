// Jobs on a thread of their own. Only the interpreter's main thread runs Python's signal handlers, and only when asked
// to: so the calling thread, be it that one, waits in short steps and asks, instead of computing. The job never needs
// the lock: it leaves its progress in a mailbox, of which the last letter counts.
#include "run.h"

#include <cfenv>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <string>
#include <thread>

namespace certa::python {
namespace {

namespace py = pybind11;
using namespace std::chrono_literals;

class Job {
public:
    Job(const Watch& watch, const std::function<void(const RunControl&)>& work) : watch_(watch), work_(work) {}

    void run() {
        {
            const py::gil_scoped_release released;
            std::thread worker([this] { compute(); });
            wait(worker);
        }
        if (!interruption_) deliver();
        if (interruption_) interruption_->restore(), throw py::error_already_set();
        if (failure_) std::rethrow_exception(failure_);
    }

private:
    /// On the job's own thread. Other packages may have set the caller's floating point to flush small numbers to 0,
    /// and threads inherit that: here the environment is the standard's.
    void compute() {
        std::fesetenv(FE_DFL_ENV);
        RunControl control;
        control.cancel = &cancel_;
        control.threads = watch_.threads;
        if (!watch_.progress.is_none())
            control.progress = [this](std::string_view stage, double fraction) {
                const std::lock_guard lock(mutex_);
                stage_ = stage, fraction_ = fraction, news_ = true;
            };
        try {
            work_(control);
        } catch (...) {
            failure_ = std::current_exception();
        }
        const std::lock_guard lock(mutex_);
        done_ = true;
        changed_.notify_one();
    }

    void wait(std::thread& worker) {
        for (std::unique_lock lock(mutex_); !changed_.wait_for(lock, 50ms, [this] { return done_; });) {
            lock.unlock();
            if (!interruption_) {
                const py::gil_scoped_acquire held;
                listen();
            }
            lock.lock();
        }
        worker.join();
    }

    void listen() {
        if (PyErr_CheckSignals() != 0)
            interrupt(py::error_already_set());
        else
            deliver();
    }

    void deliver() {
        std::string stage;
        double fraction = 0.0;
        {
            const std::lock_guard lock(mutex_);
            if (!news_) return;
            news_ = false, stage = stage_, fraction = fraction_;
        }
        try {
            watch_.progress(stage, fraction);
        } catch (py::error_already_set& error) {
            interrupt(std::move(error));
        }
    }

    void interrupt(py::error_already_set&& error) {
        interruption_.emplace(std::move(error));
        cancel_ = true;
    }

    const Watch& watch_;
    const std::function<void(const RunControl&)>& work_;
    std::atomic<bool> cancel_{false};
    std::mutex mutex_;
    std::condition_variable changed_;
    bool done_ = false, news_ = false;
    std::string stage_;
    double fraction_ = 0.0;
    std::exception_ptr failure_;
    std::optional<py::error_already_set> interruption_;
};

}  // namespace

void run_watched(const Watch& watch, const std::function<void(const RunControl&)>& work) { Job(watch, work).run(); }

}  // namespace certa::python
