// Jobs on a thread of their own. Only the interpreter's main thread runs Python's signal handlers, and only when asked
// to: so the calling thread, be it that one, waits in short steps and asks, instead of computing. The job never needs
// the lock: it leaves its progress in a mailbox, of which the last letter counts. Cancelled, it ends at its next look
// at the flag; since that may take it seconds, the caller leaves it after a while, and both share what it works on.
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

constexpr auto step = 50ms, patience = 500ms;

/// Jobs that nobody waits for any more.
class LeftJobs {
public:
    void begin() {
        const std::lock_guard lock(mutex_);
        ++count_;
    }
    void end() {
        const std::lock_guard lock(mutex_);
        --count_;
        changed_.notify_all();
    }
    bool wait_for_all(std::chrono::milliseconds time) {
        std::unique_lock lock(mutex_);
        return changed_.wait_for(lock, time, [this] { return count_ == 0; });
    }

private:
    std::mutex mutex_;
    std::condition_variable changed_;
    int count_ = 0;
};

LeftJobs& left_jobs() {
    static auto* jobs = new LeftJobs;  // outlives every thread
    return *jobs;
}

/// What the job's thread and the caller's share.
class Job {
public:
    Job(std::function<void(const RunControl&)> work, unsigned threads, bool reports) : work_(std::move(work)) {
        control_.cancel = &cancel_;
        control_.threads = threads;
        if (!reports) return;
        control_.progress = [this](std::string_view stage, double fraction) {
            const std::lock_guard lock(mutex_);
            news_.emplace(stage, fraction);
        };
    }

    /// On the job's own thread. Other packages may have set the caller's floating point to flush small numbers to 0,
    /// and threads inherit that: here the environment is the standard's.
    void compute() {
        std::fesetenv(FE_DFL_ENV);
        std::exception_ptr failure;
        try {
            work_(control_);
        } catch (...) {
            failure = std::current_exception();
        }
        work_ = nullptr;  // what it worked on goes before anybody hears of the end
        const std::lock_guard lock(mutex_);
        failure_ = failure, done_ = true;
        if (left_) left_jobs().end();
        changed_.notify_one();
    }

    bool wait(std::chrono::milliseconds time) {
        std::unique_lock lock(mutex_);
        return changed_.wait_for(lock, time, [this] { return done_; });
    }
    void cancel() { cancel_ = true; }
    /// False if it has ended meanwhile.
    bool leave() {
        const std::lock_guard lock(mutex_);
        if (done_) return false;
        left_ = true;
        left_jobs().begin();
        return true;
    }
    std::optional<std::pair<std::string, double>> take_news() {
        const std::lock_guard lock(mutex_);
        return std::exchange(news_, std::nullopt);
    }
    const std::exception_ptr& failure() const { return failure_; }

private:
    std::function<void(const RunControl&)> work_;
    RunControl control_;
    std::atomic<bool> cancel_{false};
    std::mutex mutex_;
    std::condition_variable changed_;
    bool done_ = false, left_ = false;
    std::optional<std::pair<std::string, double>> news_;
    std::exception_ptr failure_;
};

/// Hands news on. Needs the lock; throws what the callback raises.
void deliver(Job& job, const py::object& progress) {
    if (const auto news = job.take_news()) progress(news->first, news->second);
}

/// Waits for the end of the job. Returns what interrupted it, if anything did.
std::optional<py::error_already_set> listen(Job& job, const py::object& progress) {
    const py::gil_scoped_release released;
    while (!job.wait(step)) {
        const py::gil_scoped_acquire held;
        try {
            if (PyErr_CheckSignals() != 0) throw py::error_already_set();
            deliver(job, progress);
        } catch (py::error_already_set& error) {
            return std::move(error);
        }
    }
    return std::nullopt;
}

/// Ends a job that was interrupted, or leaves it.
void stop(Job& job, std::thread& worker, bool may_leave) {
    const py::gil_scoped_release released;
    job.cancel();
    if (may_leave && !job.wait(patience) && job.leave())
        worker.detach();
    else
        worker.join();
}

void wait_for_left_jobs() {
    const py::gil_scoped_release released;
    while (!left_jobs().wait_for_all(step)) {
        const py::gil_scoped_acquire held;
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    }
}

}  // namespace

void run_watched(const Watch& watch, std::function<void(const RunControl&)> work) {
    const auto job = std::make_shared<Job>(std::move(work), watch.threads, !watch.progress.is_none());
    std::thread worker([job] { job->compute(); });
    if (auto interruption = listen(*job, watch.progress)) {
        stop(*job, worker, watch.may_leave);
        throw std::move(*interruption);
    }
    worker.join();
    deliver(*job, watch.progress);
    if (job->failure()) std::rethrow_exception(job->failure());
}

void add_waiting(py::module_&) {
    py::module_::import("atexit").attr("register")(py::cpp_function(&wait_for_left_jobs));
}

}  // namespace certa::python
