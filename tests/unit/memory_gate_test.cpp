// SPDX-License-Identifier: Apache-2.0
#include "batch/memory_gate.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

namespace deltasplat {
namespace {

TEST(MemoryGate, KeepsToItsBytes) {
    MemoryGate gate(10);
    std::atomic<int> inside{0};
    std::atomic<int> most{0};
    std::vector<std::thread> threads;
    for (int i = 0; i < 8; ++i) {
        threads.emplace_back([&] {
            for (int k = 0; k < 200; ++k) {
                const MemoryGate::Pass pass(gate, 4);
                const int now = ++inside;
                int known = most;
                while (now > known && !most.compare_exchange_weak(known, now)) {
                }
                std::this_thread::yield();
                --inside;
            }
        });
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_LE(most, 2);
}

TEST(MemoryGate, LetsInWhatIsTooLargeAlone) {
    MemoryGate gate(10);
    std::atomic<bool> isIn{false};
    std::thread other;
    {
        const MemoryGate::Pass pass(gate, 1000);
        EXPECT_EQ(pass.share(), 1);
        other = std::thread([&] {
            const MemoryGate::Pass second(gate, 1);
            isIn = true;
        });
        for (int i = 0; i < 1000; ++i) std::this_thread::yield();
        EXPECT_FALSE(isIn);
    }
    other.join();
    EXPECT_TRUE(isIn);
    const MemoryGate::Pass half(gate, 5);
    EXPECT_EQ(half.share(), 0.5);
}

TEST(MemoryGate, LetsInWithoutAnyMemory) {
    MemoryGate gate(0);
    const MemoryGate::Pass pass(gate, 5);
    EXPECT_EQ(pass.share(), 1);
}

}  // namespace
}  // namespace deltasplat
