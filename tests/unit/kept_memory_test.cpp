// SPDX-License-Identifier: Apache-2.0
#include "base/kept_memory.h"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace deltasplat {
namespace {

constexpr std::size_t kMiB = std::size_t{1} << 20;

TEST(KeptMemory, givesBlocksToTheNextWhoAsks) {
    KeptMemory memory;
    void* const first = memory.allocate(4 * kMiB);
    memory.deallocate(first, 4 * kMiB);
    EXPECT_EQ(memory.idleBytes(), 4 * kMiB);
    // For what is somewhat smaller too.
    void* const second = memory.allocate(3 * kMiB);
    EXPECT_EQ(second, first);
    EXPECT_EQ(memory.idleBytes(), 0u);
    memory.deallocate(second, 3 * kMiB);
    EXPECT_EQ(memory.idleBytes(), 4 * kMiB);
}

TEST(KeptMemory, holdsNoMoreThanWasInUseAtOneTime) {
    KeptMemory memory;
    for (std::size_t size = 1; size <= 16; ++size) {
        void* const block = memory.allocate(size * kMiB);
        EXPECT_LE(memory.idleBytes() + size * kMiB, size * kMiB);
        memory.deallocate(block, size * kMiB);
    }
    EXPECT_EQ(memory.idleBytes(), 16 * kMiB);
    // Too large for this: it would be wasted.
    void* const small = memory.allocate(kMiB);
    EXPECT_EQ(memory.idleBytes(), 0u);
    memory.deallocate(small, kMiB);
}

TEST(KeptMemory, givesBackWhatAPictureHadNoUseFor) {
    KeptMemory memory;
    memory.deallocate(memory.allocate(4 * kMiB), 4 * kMiB);
    memory.endPicture();
    EXPECT_EQ(memory.idleBytes(), 4 * kMiB);
    memory.endPicture();
    EXPECT_EQ(memory.idleBytes(), 0u);
}

TEST(KeptMemory, isForManyThreads) {
    KeptMemory memory;
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t) {
        threads.emplace_back([&memory, t] {
            for (int i = 0; i < 200; ++i) {
                std::pmr::vector<int> values(std::size_t(20000 + 3000 * (i % 7)), t, &memory);
                ASSERT_EQ(values.front(), t);
                ASSERT_EQ(values.back(), t);
            }
        });
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_LE(memory.idleBytes(), 4 * kMiB);
}

}  // namespace
}  // namespace deltasplat
