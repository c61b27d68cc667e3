// The parallel loop covers every index once, for any count, grain and number of threads, and lets exceptions through.
#include "core/parallel.h"

#include <gtest/gtest.h>

#include <mutex>
#include <numeric>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

namespace {

TEST(ParallelFor, CoversEveryIndexOnce) {
    for (const unsigned threads : {0U, 1U, 2U, 7U}) {
        for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{1000}, std::size_t{100'000}}) {
            std::vector<int> visits(count, 0);  // disjoint ranges: no two threads touch the same entry
            certa::RunControl control;
            control.threads = threads;
            certa::core::parallel_for(count, 64, control, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) ++visits[i];
            });
            EXPECT_EQ(visits, std::vector<int>(count, 1)) << threads << " threads, " << count << " items";
        }
    }
}

TEST(ParallelFor, KeepsToTheNumberOfThreads) {
    std::mutex mutex;
    std::set<std::thread::id> seen;
    certa::RunControl control;
    control.threads = 1;
    certa::core::parallel_for(10'000, 1, control, [&](std::size_t, std::size_t) {
        const std::lock_guard lock(mutex);
        seen.insert(std::this_thread::get_id());
    });
    EXPECT_EQ(seen.size(), 1U);
}

TEST(ParallelFor, ExceptionsComeThrough) {
    EXPECT_THROW(certa::core::parallel_for(1000, 1, {},
                                           [](std::size_t begin, std::size_t) {
                                               if (begin == 500) throw std::runtime_error("stop");
                                           }),
                 std::runtime_error);
}

}  // namespace
