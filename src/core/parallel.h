#pragma once
// The one door to threads: loops over index ranges on oneTBB, with the caller's thread count.
#include <certa/run_control.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
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
/// every range before everything after the loop. Debian's oneTBB is not built for it, so it cannot see that by itself.
class LoopFence {
public:
#if defined(__SANITIZE_THREAD__)
    void open() { __tsan_release(&start_); }
    void enter() { __tsan_acquire(&start_); }
    void leave() { __tsan_release(&end_); }
    void close() { __tsan_acquire(&end_); }

private:
    char start_ = 0, end_ = 0;
#else
    void open() {}
    void enter() {}
    void leave() {}
    void close() {}
#endif
};

/// Calls body(begin, end) for ranges that cover 0 ... count - 1, each about `grain` long, in any order, from at most
/// `control.threads` threads (0: all). Results must not depend on how the ranges are cut. Exceptions come through.
template <class Body>
void parallel_for(std::size_t count, std::size_t grain, const RunControl& control, const Body& body) {
    LoopFence fence;
    fence.open();
    const auto loop = [&] {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain), [&](const auto& range) {
            fence.enter();
            body(range.begin(), range.end());
            fence.leave();
        });
    };
    const int available = tbb::this_task_arena::max_concurrency();
    if (control.threads == 0 || control.threads >= static_cast<unsigned>(available)) {
        loop();
    } else {
        tbb::task_arena(static_cast<int>(control.threads)).execute(loop);
    }
    fence.close();
}

}  // namespace certa::core
