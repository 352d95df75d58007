// SPDX-License-Identifier: Apache-2.0
#include "delta/slice_mixer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

namespace deltasplat {
namespace {

Volume volumeOf(const CodeBook& book, const std::vector<Code>& codes) {
    Volume volume;
    volume.codeBook = book;
    volume.histogram.assign(kCodeCount, 0);
    for (const Code code : codes) ++volume.histogram[code];
    return volume;
}

// What a mix of two slices of one value each comes out as: the values of its thin slices.
std::vector<double> mixed(const Volume& volume, int perVoxel, Slot here, Slot before, Slot behind) {
    const SliceMixer mixer(volume, perVoxel);
    std::vector<Slot> same(kSlotCount);
    std::iota(same.begin(), same.end(), 0);
    SliceMixer::Window window;
    window.before.fill(before);
    window.slots.fill(here);
    window.behind.fill(behind);
    std::vector<double> values;
    for (int part = 0; part < perVoxel; ++part) {
        BlockSlots slots;
        mixer.mix(window, part, same, slots);
        for (int t = 0; t < 8; ++t) {
            const Slot slot = slots[64 * std::size_t(t) + 17];
            EXPECT_EQ(slot, slots[64 * std::size_t(t)]);
            if (slot == kEmptySlot) {
                values.push_back(NAN);
                continue;
            }
            EXPECT_NE(mixer.levels().histogram[slot - 1], 0u);
            values.push_back(mixer.levels().codeBook.valueOf(Code(slot - 1)));
        }
    }
    return values;
}

TEST(SliceMixer, ThinSlicesLieEvenlyBetweenThoseOfTheVolume) {
    const Volume volume = volumeOf(CodeBook::integer(-100), {0, 40, 200});
    const std::vector<double> two = mixed(volume, 2, 41, 1, 201);
    ASSERT_EQ(two.size(), 16u);
    EXPECT_EQ(two[0], -60 - 40 / 4.0);
    EXPECT_EQ(two[1], -60);
    EXPECT_EQ(two[14], -60);
    EXPECT_EQ(two[15], -60 + 160 / 4.0);
    const std::vector<double> three = mixed(volume, 3, 41, 1, 201);
    ASSERT_EQ(three.size(), 24u);
    EXPECT_NEAR(three[0], -60 - 40 / 3.0, 0.1);
    EXPECT_EQ(three[1], -60);
    EXPECT_NEAR(three[23], -60 + 160 / 3.0, 0.1);
}

TEST(SliceMixer, WhatIsNotActiveHasNoValue) {
    const Volume volume = volumeOf(CodeBook::integer(), {7, 9});
    for (const double value : mixed(volume, 4, 10, kEmptySlot, kEmptySlot)) EXPECT_EQ(value, 9);
    for (const double value : mixed(volume, 2, kEmptySlot, 8, 10)) EXPECT_TRUE(std::isnan(value));
}

// Codes that are not evenly spaced: mixed values must be those of values, not of codes.
TEST(SliceMixer, MixesValuesOfAnyBook) {
    std::mt19937 random(11);
    std::vector<double> table{-3e5, -2, -1e-4, 0, 1e-6, 0.3, 1, 1000, 4e7};
    const std::vector<Code> codes{0, 1, 2, 3, 4, 5, 6, 7, 8};
    for (const Volume& volume :
         {volumeOf(CodeBook::ofTable(table), codes),
          volumeOf(CodeBook::half(), {0x3C00, 0x8000, 0x9234, 0xBC00, 0xC123, 0xFBFF})}) {
        std::vector<Code> present;
        for (int code = 0; code < kCodeCount; ++code)
            if (volume.histogram[code] != 0) present.push_back(Code(code));
        for (int i = 0; i < 40; ++i) {
            const auto pick = [&] { return present[random() % present.size()]; };
            const Code here = pick(), before = pick(), behind = pick();
            const double v = volume.codeBook.valueOf(here);
            const auto near = [&](double got, double a, double b, double share) {
                const double expected = a + (b - a) * share;
                const double smallest = 1e-6 / 4;
                EXPECT_NEAR(got, expected, 1e-3 * std::abs(expected) + smallest)
                    << a << " and " << b;
            };
            const std::vector<double> values = mixed(volume, 2, here + 1, before + 1, behind + 1);
            near(values.front(), v, volume.codeBook.valueOf(before), 0.25);
            near(values[5], v, v, 0);
            near(values.back(), v, volume.codeBook.valueOf(behind), 0.25);
        }
    }
}

TEST(SliceMixer, LevelsAreAsManyAsThereIsRoomFor) {
    std::vector<Code> all(kCodeCount);
    std::iota(all.begin(), all.end(), Code{0});
    const Volume volume = volumeOf(CodeBook::linear(0, 1), all);
    const SliceMixer mixer(volume, 2);
    for (const int code : {0, 1, 30000, 65535}) {
        EXPECT_EQ(mixer.levels().codeBook.valueOf(mixer.levelOf(Code(code))),
                  volume.codeBook.valueOf(Code(code)));
    }
}

}  // namespace
}  // namespace deltasplat
