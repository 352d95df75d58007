// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "base/parallel.h"
#include "deltasplat/threads.h"
#include "support/odd_floats.h"

namespace deltasplat {
namespace {

using test::OddFloats;

// Asked of the arithmetic itself.
bool isDefault() {
    volatile double one = 1, tiny = 1e-310, small = 1e-30;
    return tiny * one != 0 && one + small == 1 && one - small == 1;
}

TEST(DefaultFloats, LastAsLongAsTheyLive) {
    EXPECT_TRUE(isDefault());
    for (const OddFloats::Kind kind : OddFloats::kinds()) {
        const OddFloats odd(kind);
        EXPECT_FALSE(isDefault()) << OddFloats::name(kind);
        {
            const DefaultFloats floats;
            EXPECT_TRUE(isDefault()) << OddFloats::name(kind);
        }
        EXPECT_TRUE(odd.stillSet()) << OddFloats::name(kind);
    }
}

// The threads are started, and the work is given, by one that does odd arithmetic.
TEST(DefaultFloats, AreWhatParallelWorkHas) {
    for (const OddFloats::Kind kind : OddFloats::kinds()) {
        const OddFloats odd(kind);
        const ThreadLimit threads(4);
        std::atomic<int> wrong = 0;
        parallelFor(100, [&](std::size_t) {
            // Gives other threads time to join.
            std::this_thread::sleep_for(std::chrono::microseconds(200));
            if (!isDefault()) ++wrong;
        });
        EXPECT_EQ(wrong, 0) << OddFloats::name(kind);
        EXPECT_TRUE(odd.stillSet()) << OddFloats::name(kind);
    }
}

}  // namespace
}  // namespace deltasplat
