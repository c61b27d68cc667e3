#pragma once
// The one door to threads: loops over index ranges on oneTBB, with the caller's thread count.
#include <certa/run_control.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>

#include <cstddef>

#if defined(__SANITIZE_THREAD__)
#include <sanitizer/tsan_interface.h>
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define __SANITIZE_THREAD__ 1  // as g++ says it
#include <sanitizer/tsan_interface.h>
#endif
#endif

namespace certa::core {

/// What the scheduler guarantees, said to ThreadSanitizer: everything before the loop happens before every range,
/// every range before everything after the loop, also when one throws. Debian's oneTBB is not built for it, so it
/// cannot see that by itself. Elsewhere these do nothing.
class LoopFence {
public:
    LoopFence() { release(&start_); }
    LoopFence(const LoopFence&) = delete;
    LoopFence& operator=(const LoopFence&) = delete;
    ~LoopFence() { acquire(&end_); }

    /// Lives while a range is worked on.
    class Range {
    public:
        explicit Range(LoopFence& fence) : fence_(fence) { acquire(&fence_.start_); }
        Range(const Range&) = delete;
        Range& operator=(const Range&) = delete;
        ~Range() { release(&fence_.end_); }

    private:
        LoopFence& fence_;
    };

private:
#if defined(__SANITIZE_THREAD__)
    static void acquire(char* address) { __tsan_acquire(address); }
    static void release(char* address) { __tsan_release(address); }
#else
    static void acquire(char*) {}
    static void release(char*) {}
#endif
    char start_ = 0, end_ = 0;
};

/// Calls body(begin, end) for ranges that cover 0 ... count - 1, each about `grain` long, in any order, from at most
/// `control.threads` threads (0: all). Results must not depend on how the ranges are cut. Exceptions come through.
template <class Body>
void parallel_for(std::size_t count, std::size_t grain, const RunControl& control, const Body& body) {
    LoopFence fence;
    const auto loop = [&] {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain), [&](const auto& range) {
            const LoopFence::Range inside(fence);
            body(range.begin(), range.end());
        });
    };
    const int available = tbb::this_task_arena::max_concurrency();
    if (control.threads == 0 || control.threads >= static_cast<unsigned>(available)) {
        loop();
    } else {
        tbb::task_arena(static_cast<int>(control.threads)).execute(loop);
    }
}

/// Calls both, possibly at the same time.
template <class First, class Second>
void parallel_invoke(const First& first, const Second& second) {
    LoopFence fence;
    tbb::parallel_invoke(
        [&] {
            const LoopFence::Range inside(fence);
            first();
        },
        [&] {
            const LoopFence::Range inside(fence);
            second();
        });
}

}  // namespace certa::core
