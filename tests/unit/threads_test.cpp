// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/threads.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "base/parallel.h"
#include "base/progress.h"
#include "deltasplat/error.h"

namespace deltasplat {
namespace {

// The most threads that take part in work of many pieces at one time. Over time there may be more:
// one leaves, and another takes its place.
std::size_t threadsAtWork() {
    std::mutex mutex;
    std::size_t now = 0;
    std::size_t most = 0;
    parallelFor(200, [&](std::size_t) {
        {
            const std::lock_guard lock(mutex);
            most = std::max(most, ++now);
        }
        // Long enough for others to come, who then are seen.
        std::this_thread::sleep_for(std::chrono::microseconds(100));
        const std::lock_guard lock(mutex);
        --now;
    });
    return most;
}

TEST(ThreadLimit, TheLastOneMadeCounts) {
    const ThreadLimit outer(3);
    EXPECT_EQ(threadCount(), 3);
    {
        const ThreadLimit inner(1);
        EXPECT_EQ(threadCount(), 1);
        EXPECT_EQ(threadsAtWork(), 1u);
    }
    EXPECT_EQ(threadCount(), 3);
    EXPECT_LE(threadsAtWork(), 3u);
}

TEST(ThreadLimit, LimitsEndInAnyOrder) {
    const int before = threadCount();
    std::optional<ThreadLimit> first(std::in_place, 2);
    std::optional<ThreadLimit> second(std::in_place, 3);
    std::optional<ThreadLimit> third(std::in_place, 4);
    second.reset();
    EXPECT_EQ(threadCount(), 4);
    first.reset();
    EXPECT_EQ(threadCount(), 4);
    EXPECT_LE(threadsAtWork(), 4u);
    third.reset();
    EXPECT_EQ(threadCount(), before);
    EXPECT_GE(threadsAtWork(), 1u);
}

TEST(ThreadLimit, MayEndOnAnotherThread) {
    const int before = threadCount();
    std::optional<ThreadLimit> limit(std::in_place, before + 1);
    std::thread([&] { limit.reset(); }).join();
    EXPECT_EQ(threadCount(), before);
}

TEST(ThreadLimit, IsForTheThreadThatMadeIt) {
    const ThreadLimit limit(7);
    std::atomic<int> made = 0;
    std::vector<std::thread> threads;
    for (int count = 1; count <= 4; ++count) {
        threads.emplace_back([&made, count] {
            const ThreadLimit own(count);
            // All of them live at once.
            for (++made; made < 4;) std::this_thread::yield();
            for (int i = 0; i < 50; ++i) {
                ASSERT_EQ(threadCount(), count);
                ASSERT_LE(threadsAtWork(), std::size_t(count));
            }
        });
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(threadCount(), 7);
}

TEST(ThreadLimit, WorkWithinWorkHasTheSameLimit) {
    const ThreadLimit limit(2);
    std::atomic<int> others = 0;
    parallelFor(8, [&](std::size_t) {
        if (threadCount() != 2) ++others;
        parallelFor(8, [&](std::size_t) {
            if (threadCount() != 2) ++others;
        });
    });
    EXPECT_EQ(others, 0);
}

TEST(ThreadLimit, RefusesFewerThanNone) {
    EXPECT_THROW(ThreadLimit(-1), Error);
}

TEST(SharedProgress, NeverFallsAndIsToldByOneThreadAtATime) {
    std::atomic<int> inside = 0;
    double last = 0;
    Listener listener;
    listener.progress = [&](double share) {
        EXPECT_EQ(++inside, 1);
        EXPECT_GE(share, last);
        last = share;
        --inside;
    };
    SharedProgress progress(listener);
    const ThreadLimit limit(4);
    std::atomic<int> done = 0;
    parallelFor(1000, [&](std::size_t) { progress.report(++done / 1000.0); });
    EXPECT_GT(last, 0);
}

// A listener may ask the library for something itself.
TEST(SharedProgress, DoesNotLockAListenerThatReports) {
    int calls = 0;
    SharedProgress* inner = nullptr;
    Listener listener;
    listener.progress = [&](double) {
        ++calls;
        std::thread([&] { inner->report(1); }).join();
    };
    SharedProgress progress(listener);
    inner = &progress;
    progress.report(0.5);
    EXPECT_EQ(calls, 1);
}

}  // namespace
}  // namespace deltasplat
