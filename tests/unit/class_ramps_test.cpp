// SPDX-License-Identifier: Apache-2.0
#include "volume/class_ramps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

#include "support/simd_levels.h"
#include "volume/block_kernels.h"

namespace deltasplat {
namespace {

// A map whose codes from `first` on have these classes; all others have none.
std::vector<Slot> mapOf(int first, const std::vector<int>& classes) {
    std::vector<Slot> map(kSlotCount, kEmptySlot);
    for (std::size_t i = 0; i < classes.size(); ++i)
        map[std::size_t(first) + i + 1] = Slot(classes[i]);
    return map;
}

// The class that a ramp has for a code, by its description.
int classOf(const ClassRamp& ramp, Code code) {
    if (code < ramp.first) return 0;
    ClassIndex shift = ramp.pieces[0].shift;
    for (const RampPiece& piece : ramp.pieces)
        if (code >= piece.begin) shift = piece.shift;
    return ClassIndex(std::min(code, ramp.last) + shift);
}

bool isRamp(const std::vector<int>& classes) {
    constexpr int kFirst = 100;
    const std::vector<Slot> map = mapOf(kFirst, classes);
    const Code last = Code(kFirst + int(classes.size()) - 1);
    return ClassRamps(map, kFirst, last).of(kFirst, last).has_value();
}

TEST(ClassRamps, FindsWhatTransferFunctionsMake) {
    EXPECT_TRUE(isRamp({0, 0, 0, 1, 2, 3, 4}));
    EXPECT_TRUE(isRamp({1, 2, 3, 4}));
    EXPECT_TRUE(isRamp({0, 7, 8, 9, 9, 9}));        // a ramp that ends
    EXPECT_TRUE(isRamp({0, 0, 5, 5, 5}));           // a threshold
    EXPECT_TRUE(isRamp({0, 8, 9, 1, 2, 3, 4, 4}));  // dark colours, then others
    EXPECT_TRUE(isRamp({0, 196, 1, 2, 197, 3, 4}));
    EXPECT_TRUE(isRamp({3}));
}

TEST(ClassRamps, LeavesOthersAlone) {
    EXPECT_FALSE(isRamp({0, 1, 2, 0, 0}));     // clear again
    EXPECT_FALSE(isRamp({1, 1, 1, 2, 2, 2}));  // labels
    EXPECT_FALSE(isRamp({0, 0, 0}));           // nothing
    std::vector<int> odd;
    for (int i = 0; i < 40; ++i) odd.push_back(i % 2 == 0 ? 100 - i : i + 200);
    EXPECT_TRUE(isRamp({odd.begin(), odd.begin() + 8}));
    EXPECT_FALSE(isRamp({odd.begin(), odd.begin() + 9}));
    // Codes that nobody said would be asked for.
    const std::vector<Slot> map = mapOf(10, {1, 2, 3});
    EXPECT_FALSE(ClassRamps(map, 10, 11).of(10, 12));
    EXPECT_FALSE(ClassRamps(map, 11, 12).of(10, 12));
}

// Every range of codes of random maps, at both ends of the codes that there are.
TEST(ClassRamps, EveryCodeHasItsClass) {
    std::mt19937 random(7);
    int found = 0;
    for (int round = 0; round < 200; ++round) {
        std::vector<int> classes;
        while (classes.size() < 24) {
            const int start = int(random() % 3) * 20 + int(random() % 2);
            const int step = start == 0 ? 0 : int(random() % 2);
            for (int i = 0, n = 1 + int(random() % 7); i < n; ++i)
                classes.push_back(start + step * i);
        }
        const int count = int(classes.size());
        for (const int first : {0, 1000, kCodeCount - count}) {
            const std::vector<Slot> map = mapOf(first, classes);
            const ClassRamps ramps(map, Code(first), Code(first + count - 1));
            for (int lowest = first; lowest < first + count; ++lowest) {
                for (int highest = lowest; highest < first + count; ++highest) {
                    const auto ramp = ramps.of(Code(lowest), Code(highest));
                    if (!ramp) continue;
                    ++found;
                    for (int code = lowest; code <= highest; ++code)
                        ASSERT_EQ(classOf(*ramp, Code(code)), map[std::size_t(code) + 1])
                            << round << ' ' << first << ' ' << lowest << ' ' << highest;
                }
            }
        }
    }
    EXPECT_GT(found, 50000);
}

TEST(ClassRamps, BlocksAreReadAtEverySimdLevel) {
    std::mt19937 random(8);
    for (const int first : {0, 40000, kCodeCount - 13, kCodeCount - 12}) {
        const std::vector<Slot> map = mapOf(first, {0, 0, 196, 197, 1, 2, 198, 3, 4, 5, 5, 5});
        const ClassRamps ramps(map, Code(first), Code(first + 11));
        const auto ramp = ramps.of(Code(first), Code(first + 11));
        ASSERT_TRUE(ramp);
        std::array<Code, 512> codes;
        for (Code& code : codes) code = Code(first + int(random() % 12));
        std::array<ShortSlot, 512> slots;
        for (std::size_t n = 0; n < 512; ++n)
            slots[n] = n % 5 == 0 ? ShortSlot{0} : ShortSlot(codes[n] % 65535 + 1);
        test::atEveryLevel([&] {
            // No block of slots has the last code.
            if (first + 11 < 65535) {
                std::array<ClassIndex, 512> classes;
                classesOfSlots(*ramp, slots.data(), classes.data());
                for (std::size_t n = 0; n < 512; ++n) EXPECT_EQ(classes[n], map[slots[n]]) << n;
            }
            for (int axis = 0; axis < 3; ++axis) {
                std::array<ClassIndex, 512> classes;
                classesOfLeaf(*ramp, codes.data(), axis, classes.data());
                for (int n = 0; n < 512; ++n) {
                    const std::array<int, 3> xyz{n / 64, n / 8 % 8, n % 8};
                    const auto of = [&](int i) { return xyz[std::size_t((axis + i) % 3)]; };
                    EXPECT_EQ(classes[std::size_t(64 * of(0) + 8 * of(1) + of(2))],
                              map[std::size_t(codes[std::size_t(n)]) + 1])
                        << axis << ' ' << n;
                }
            }
        });
    }
}

}  // namespace
}  // namespace deltasplat
