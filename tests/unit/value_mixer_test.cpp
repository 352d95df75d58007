// SPDX-License-Identifier: Apache-2.0
#include "words/value_mixer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <numeric>
#include <random>

#include "support/simd_levels.h"

namespace deltasplat {
namespace {

Volume volumeOf(const CodeBook& book, const std::vector<Code>& codes) {
    VolumeData volume;
    volume.codeBook = book;
    volume.histogram.assign(kCodeCount, 0);
    for (const Code code : codes) ++volume.histogram[code];
    return Volume(std::move(volume));
}

std::vector<Slot> sameSlots() {
    std::vector<Slot> same(kSlotCount);
    std::iota(same.begin(), same.end(), 0);
    return same;
}

double valueOf(const ValueMixer& mixer, Slot slot) {
    if (slot == kEmptySlot) return NAN;
    EXPECT_NE(mixer.levels().histogram()[slot - 1], 0u);
    return mixer.levels().codeBook().valueOf(Code(slot - 1));
}

// What a mix of two slices of one value each comes out as: the values of its thin slices.
std::vector<double> mixed(const Volume& volume, int perVoxel, Slot here, Slot before, Slot behind) {
    const ValueMixer mixer(volume, {perVoxel, 1});
    MixWindow window;
    for (int s = -1; s <= 8; ++s) {
        for (int n = 0; n < 64; ++n)
            window.at({s, n / 8, n % 8}) = s < 0 ? before : s > 7 ? behind : here;
    }
    std::vector<BlockSlots> parts(static_cast<std::size_t>(perVoxel));
    mixer.mix(window, MixMap(sameSlots(), {}), parts);
    std::vector<double> values;
    for (const BlockSlots& slots : parts) {
        for (std::size_t t = 0; t < 8; ++t) {
            const Slot slot = slots[64 * t + 17];
            EXPECT_EQ(slot, slots[64 * t]);
            values.push_back(valueOf(mixer, slot));
        }
    }
    return values;
}

TEST(ValueMixer, ThinSlicesLieEvenlyBetweenThoseOfTheVolume) {
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

TEST(ValueMixer, WhatIsNotActiveHasNoValue) {
    const Volume volume = volumeOf(CodeBook::integer(), {7, 9});
    for (const double value : mixed(volume, 4, 10, kEmptySlot, kEmptySlot)) EXPECT_EQ(value, 9);
    for (const double value : mixed(volume, 2, kEmptySlot, 8, 10)) EXPECT_TRUE(std::isnan(value));
}

// Codes that are not evenly spaced: mixed values must be those of values, not of codes.
TEST(ValueMixer, MixesValuesOfAnyBook) {
    std::mt19937 random(11);
    std::vector<double> table{-3e5, -2, -1e-4, 0, 1e-6, 0.3, 1, 1000, 4e7};
    const std::vector<Code> codes{0, 1, 2, 3, 4, 5, 6, 7, 8};
    for (const Volume& volume :
         {volumeOf(CodeBook::ofTable(table), codes),
          volumeOf(CodeBook::half(), {0x3C00, 0x8000, 0x9234, 0xBC00, 0xC123, 0xFBFF})}) {
        std::vector<Code> present;
        for (int code = 0; code < kCodeCount; ++code)
            if (volume.histogram()[code] != 0) present.push_back(Code(code));
        for (int i = 0; i < 40; ++i) {
            const auto pick = [&] { return present[random() % present.size()]; };
            const Code here = pick(), before = pick(), behind = pick();
            const double v = volume.codeBook().valueOf(here);
            const auto near = [&](double got, double a, double b, double share) {
                const double expected = a + (b - a) * share;
                const double smallest = 1e-6 / 4;
                EXPECT_NEAR(got, expected, 1e-3 * std::abs(expected) + smallest)
                    << a << " and " << b;
            };
            const std::vector<double> values = mixed(volume, 2, here + 1, before + 1, behind + 1);
            near(values.front(), v, volume.codeBook().valueOf(before), 0.25);
            near(values[5], v, v, 0);
            near(values.back(), v, volume.codeBook().valueOf(behind), 0.25);
        }
    }
}

// All eight corners of each place, by a plain formula: voxels that are not active have the value of
// the one that a thin voxel belongs to.
TEST(ValueMixer, WithinSlicesValuesAreTrilinear) {
    std::mt19937 random(5);
    for (const bool full : {true, false}) {
        const Volume volume = volumeOf(CodeBook::integer(), {0, 100, 255});
        const ValueMixer mixer(volume, {2, 2});
        MixWindow window;
        for (Slot& slot : window.slots) slot = Slot(random() % 256 + 1);
        // Of two neighbours one is active, so that no order of the axes matters.
        for (int i = 0; !full && i < 1000; i += 2)
            window.slots[std::size_t(i)] = (i / 100 + i / 10) % 4 == 0 ? kEmptySlot : Slot(7);
        std::vector<BlockSlots> blocks(8);
        mixer.mix(window, MixMap(sameSlots(), {}), blocks);
        const auto place = [](int thin) { return 0.5 * thin - 0.25; };
        for (int s = 0; s < 16; ++s) {
            for (int u = 0; u < 16; ++u) {
                for (int v = 0; v < 16; ++v) {
                    const BlockSlots& block =
                        blocks[std::size_t(4 * (u / 8) + 2 * (s / 8) + v / 8)];
                    const Slot got = block[std::size_t(64 * (s % 8) + 8 * (u % 8) + v % 8)];
                    const Slot own = window.at({s / 2, u / 2, v / 2});
                    if (own == kEmptySlot) {
                        EXPECT_EQ(got, kEmptySlot);
                        continue;
                    }
                    ASSERT_NE(got, kEmptySlot);
                    if (!full) continue;
                    double expected = 0;
                    for (int corner = 0; corner < 8; ++corner) {
                        const glm::dvec3 at(place(s), place(u), place(v));
                        const glm::ivec3 low(glm::floor(at));
                        const glm::ivec3 near =
                            low + glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
                        const glm::dvec3 share = 1.0 - glm::abs(at - glm::dvec3(near));
                        expected += share.x * share.y * share.z * (window.at(near) - 1);
                    }
                    EXPECT_EQ(valueOf(mixer, got), expected);
                }
            }
        }
    }
}

// A voxel between others that are not active keeps its value in all its parts.
TEST(ValueMixer, WithinSlicesAloneIsUnmixed) {
    const Volume volume = volumeOf(CodeBook::integer(), {0, 77});
    const ValueMixer mixer(volume, {3, 2});
    MixWindow window;
    window.at({4, 3, 7}) = 78;
    std::vector<BlockSlots> parts(12);
    mixer.mix(window, MixMap(sameSlots(), {}), parts);
    int found = 0;
    for (const BlockSlots& block : parts) {
        for (const Slot slot : block) {
            if (slot == kEmptySlot) continue;
            ++found;
            EXPECT_EQ(valueOf(mixer, slot), 77);
        }
    }
    EXPECT_EQ(found, 12);
}

// What is too thin for any of its parts to reach what can be seen is drawn as it is.
TEST(ValueMixer, NothingThatCanBeSeenVanishes) {
    const Volume volume = volumeOf(CodeBook::integer(), {0, 100});
    const ValueMixer mixer(volume, {2, 2}, true);
    for (const double threshold : {30.0, 50.0, 60.0, 99.0}) {
        std::vector<Slot> map(kSlotCount, kEmptySlot);
        for (int level = 0; level < kCodeCount; ++level) {
            if (mixer.levels().codeBook().valueOf(Code(level)) >= threshold)
                map[std::size_t(level) + 1] = level + 1;
        }
        MixWindow window;
        window.slots.fill(1);
        window.at({3, 4, 5}) = 101;                                                  // a voxel,
        for (int v = -1; v <= 8; ++v) window.at({0, 0, v}) = 101;                    // a line,
        for (int n = 0; n < 100; ++n) window.at({6, n / 10 - 1, n % 10 - 1}) = 101;  // a plate
        std::vector<BlockSlots> blocks(8);
        mixer.mix(window, MixMap(map, {}), blocks);
        const auto seenOf = [&](const glm::ivec3& place) {
            int seen = 0;
            for (int part = 0; part < 8; ++part) {
                const glm::ivec3 thin = 2 * place + glm::ivec3(part / 4, part / 2 % 2, part % 2);
                const int block = 4 * (thin.y / 8) + 2 * (thin.x / 8) + thin.z / 8;
                const int slot = 64 * (thin.x % 8) + 8 * (thin.y % 8) + thin.z % 8;
                seen += blocks[std::size_t(block)][std::size_t(slot)] != kEmptySlot;
            }
            return seen;
        };
        EXPECT_EQ(seenOf({3, 4, 5}), 8) << threshold;
        EXPECT_EQ(seenOf({0, 0, 4}), 8) << threshold;
        EXPECT_EQ(seenOf({6, 2, 2}), 8) << threshold;
        EXPECT_EQ(seenOf({3, 6, 2}), 0) << threshold;
    }
}

// Haze around it hides nothing, as long as the voxel is clearly more opaque.
TEST(ValueMixer, NothingVanishesInHaze) {
    const Volume volume = volumeOf(CodeBook::integer(), {2, 100});
    const ValueMixer mixer(volume, {2, 2}, true);
    std::vector<Slot> all(kSlotCount, kEmptySlot);
    for (int level = 0; level < kCodeCount; ++level)
        if (mixer.levels().histogram()[std::size_t(level)] != 0)
            all[std::size_t(level) + 1] = level + 1;
    for (const double haze : {1e-12, 1e-3, 0.05, 0.4}) {
        SCOPED_TRACE(haze);
        // Opaque from 80 on.
        std::vector<float> opacities(kSlotCount);
        for (int level = 0; level < kCodeCount; ++level) {
            const double value = mixer.levels().codeBook().valueOf(Code(level));
            opacities[std::size_t(level) + 1] = float(value < 80 ? haze : 1);
        }
        MixWindow window;
        window.slots.fill(3);
        window.at({3, 4, 5}) = 101;
        for (int n = 0; n < 100; ++n) window.at({6, n / 10 - 1, n % 10 - 1}) = 101;
        std::vector<BlockSlots> blocks(8);
        mixer.mix(window, MixMap(all, opacities), blocks);
        std::size_t opaque = 0;
        for (const BlockSlots& block : blocks)
            for (const Slot slot : block) opaque += opacities[std::size_t(slot)] == 1;
        // Of the voxel, and of the plate's 64.
        EXPECT_EQ(opaque, 8u * 65);
    }
}

// Of a voxel of which nothing would be seen in the middles of what it becomes, as much is seen as a
// fine ray march of the values between voxels sees, and no more than that.
TEST(ValueMixer, WhatIsSeenBetweenMiddlesIsSeenOnAverage) {
    const Volume volume = volumeOf(CodeBook::integer(), {0, 200});
    for (const Subdivision& parts : {Subdivision{2, 2}, Subdivision{4, 2}}) {
        const ValueMixer mixer(volume, parts);
        for (const double threshold : {110.0, 130.0, 150.0, 195.0}) {
            SCOPED_TRACE(threshold);
            // A ramp from there on.
            const auto opacityOf = [&](double value) {
                return std::clamp((value - threshold) / (200 - threshold), 0.0, 1.0);
            };
            std::vector<Slot> map(kSlotCount, kEmptySlot);
            std::vector<float> opacities(kSlotCount);
            for (int level = 0; level < kCodeCount; ++level) {
                if (mixer.levels().histogram()[std::size_t(level)] == 0) continue;
                const double opacity = opacityOf(mixer.levels().codeBook().valueOf(Code(level)));
                if (opacity == 0) continue;
                map[std::size_t(level) + 1] = level + 1;
                opacities[std::size_t(level) + 1] = float(opacity);
            }
            MixWindow window;
            window.slots.fill(1);
            window.at({3, 4, 5}) = 201;
            std::vector<BlockSlots> blocks(std::size_t(parts.slices * parts.within * parts.within));
            mixer.mix(window, MixMap(map, opacities), blocks);
            double seen = 0;
            for (const BlockSlots& block : blocks)
                for (const Slot slot : block) seen += double(opacities[std::size_t(slot)]);
            constexpr int kFine = 40;
            double fine = 0;
            for (int n = 0; n < kFine * kFine * kFine; ++n) {
                const auto share = [](int i) { return 1 - std::abs((i + 0.5) / kFine - 0.5); };
                fine += opacityOf(200 * share(n % kFine) * share(n / kFine % kFine) *
                                  share(n / kFine / kFine));
            }
            seen /= parts.voxels();
            fine /= kFine * kFine * kFine;
            EXPECT_NEAR(seen, fine, 0.4 * fine + 0.007);
            const ValueMixer keeps(volume, parts, true);
            keeps.mix(window, MixMap(map, opacities), blocks);
            double kept = 0;
            for (const BlockSlots& block : blocks)
                for (const Slot slot : block) kept += double(opacities[std::size_t(slot)]);
            EXPECT_GE(kept / parts.voxels(), fine);
        }
    }
}

// What lies beside a voxel is not mixed with it where slices alone are divided, and has no say.
TEST(ValueMixer, NothingVanishesInHazeBesideAnything) {
    const Volume volume = volumeOf(CodeBook::integer(), {0, 2, 100});
    const ValueMixer mixer(volume, {2, 1}, true);
    std::vector<Slot> map(kSlotCount, kEmptySlot);
    std::vector<float> opacities(kSlotCount);
    for (int level = 0; level < kCodeCount; ++level) {
        if (mixer.levels().histogram()[std::size_t(level)] == 0) continue;
        const double value = mixer.levels().codeBook().valueOf(Code(level));
        map[std::size_t(level) + 1] = value < 1 ? kEmptySlot : level + 1;
        opacities[std::size_t(map[std::size_t(level) + 1])] = value < 1    ? 0.0f
                                                              : value < 80 ? 0.1f
                                                                           : 1.0f;
    }
    MixWindow window;
    window.slots.fill(3);
    window.at({3, 4, 5}) = 101;
    window.at({3, 4, 6}) = 1;  // clear
    std::vector<BlockSlots> blocks(2);
    mixer.mix(window, MixMap(map, opacities), blocks);
    int opaque = 0;
    for (const BlockSlots& block : blocks)
        for (const Slot slot : block) opaque += opacities[std::size_t(slot)] == 1;
    EXPECT_EQ(opaque, 2);
}

// What the blocks of a window become, voxel by voxel: mixed along one axis after the other, and
// what would vanish as it is.
struct PlainMix {
    const ValueMixer& mixer;
    const MixWindow& window;
    const MixMap& map;

    // Of what is not active there is none.
    double codeAt(const glm::ivec3& place) const {
        const Slot slot = window.at(place);
        return slot == kEmptySlot ? NAN : slot - 1;
    }
    double between(double here, double other, double share) const {
        return std::isnan(other) ? here : here + share * (other - here);
    }
    // `thin` is a place of parts.
    double at(const glm::ivec3& thin) const {
        const glm::ivec3 per = perVoxel();
        const glm::ivec3 place = thin / per;
        const auto alongSlices = [&](const glm::ivec3& from) {
            const int offset = 2 * (thin.x % per.x) + 1 - per.x;
            const glm::ivec3 next = from + glm::ivec3(offset < 0 ? -1 : 1, 0, 0);
            return between(codeAt(from), codeAt(next), std::abs(offset) / (2.0 * per.x));
        };
        if (per.y == 1) return alongSlices(place);
        const auto alongU = [&](const glm::ivec3& from) {
            const glm::ivec3 next = from + glm::ivec3(0, thin.y % 2 == 0 ? -1 : 1, 0);
            return between(alongSlices(from), alongSlices(next), 0.25);
        };
        const glm::ivec3 next = place + glm::ivec3(0, 0, thin.z % 2 == 0 ? -1 : 1);
        return between(alongU(place), alongU(next), 0.25);
    }
    std::size_t levelSlot(double code) const {
        const CodeBook& levels = mixer.levels().codeBook();
        return std::isnan(code) ? 0 : std::size_t(levels.codeOf(code)) + 1;
    }
    glm::ivec3 perVoxel() const {
        const Subdivision& parts = mixer.parts();
        return {parts.slices, parts.within, parts.within};
    }
    // Whether a voxel stays what it is, whose parts are as opaque as that at most.
    bool wouldVanish(const glm::ivec3& place, float most) const {
        const float own = map.opacities[levelSlot(codeAt(place))];
        if (own == 0 || most >= own / 2) return false;
        float least = 1;
        for (int n = 0; n < 27; ++n) {
            const glm::ivec3 side = glm::ivec3(n / 9, n / 3 % 3, n % 3) - 1;
            if (perVoxel().y == 1 && (side.y != 0 || side.z != 0)) continue;
            const double code = codeAt(place + side);
            if (!std::isnan(code)) least = std::min(least, map.opacities[levelSlot(code)]);
        }
        return most == 0 || most - least < (own - least) / 32;
    }
    // @param kept  how many voxels would vanish
    std::vector<BlockSlots> blocks(int& kept) const {
        const glm::ivec3 per = perVoxel();
        std::vector<BlockSlots> blocks(std::size_t(per.x * per.y * per.z));
        for (int n = 0; n < 512; ++n) {
            const glm::ivec3 place(n / 64, n / 8 % 8, n % 8);
            std::vector<Slot*> parts;
            float most = 0;
            for (int i = 0; i < per.x * per.y * per.z; ++i) {
                const glm::ivec3 thin =
                    place * per + glm::ivec3(i / (per.y * per.z), i / per.z % per.y, i % per.z);
                const int block = (thin.y / 8 * per.x + thin.x / 8) * per.z + thin.z / 8;
                const int voxel = 64 * (thin.x % 8) + 8 * (thin.y % 8) + thin.z % 8;
                parts.push_back(&blocks[std::size_t(block)][std::size_t(voxel)]);
                const std::size_t level = levelSlot(at(thin));
                *parts.back() = map.slots[level];
                most = std::max(most, map.opacities[level]);
            }
            if (!wouldVanish(place, most)) continue;
            ++kept;
            for (Slot* part : parts) *part = map.slots[levelSlot(codeAt(place))];
        }
        return blocks;
    }
};

// Clear and opaque classes of a few levels each, and voxels that are not active here and there.
// @param rise  whether higher levels are no less opaque, and most are clear
void expectPlainMix(const std::vector<Code>& codes, const Subdivision& parts, bool rise) {
    const Volume volume = volumeOf(CodeBook::integer(), codes);
    const ValueMixer mixer(volume, parts, true);
    std::mt19937 random(11);
    std::vector<Slot> slots(kSlotCount, kEmptySlot);
    const std::size_t highest = mixer.levelOf(codes.back());
    for (std::size_t level = 0; level < kCodeCount; ++level) {
        const bool isClear = rise ? 10 * level < 8 * highest : level % 30 < 10;
        const std::size_t look =
            rise ? std::min(level * 150 / highest, std::size_t{198}) : level / 7 % 199;
        slots[level + 1] = isClear ? kEmptySlot : Slot(1 + look);
    }
    std::vector<float> opacities{0};
    for (int i = 1; i < 200; ++i)
        opacities.push_back(i % 3 == 0 ? 1.0f : float(random() % 1000 + 1) / 8000);
    if (rise) std::sort(opacities.begin(), opacities.end());
    const MixMap map(slots, opacities);
    EXPECT_EQ(map.rising == kSlotCount, rise);
    int kept = 0;
    for (const unsigned empty : {0u, 2u, 7u}) {
        SCOPED_TRACE(empty);
        MixWindow window;
        for (Slot& slot : window.slots)
            slot = random() % 8 < empty ? kEmptySlot : codes[random() % codes.size()] + 1;
        const std::vector<BlockSlots> expected = PlainMix{mixer, window, map}.blocks(kept);
        test::atEveryLevel([&] {
            std::vector<BlockSlots> blocks(expected.size());
            mixer.mix(window, map, blocks);
            EXPECT_EQ(blocks, expected);
        });
    }
    if (rise) {
        EXPECT_GT(kept, 0);
    }
}

TEST(ValueMixer, EvenLevelsAreAsAPlainMixOnEverySimdLevel) {
    std::vector<Code> few(200);
    std::iota(few.begin(), few.end(), Code{3});
    // One level each, to which what is mixed is rounded.
    std::vector<Code> many(60000);
    std::iota(many.begin(), many.end(), Code{5});
    for (const Subdivision& parts : {Subdivision{2, 2}, Subdivision{2, 1}, Subdivision{4, 1},
                                     Subdivision{1, 2}, Subdivision{4, 2}}) {
        for (const bool rise : {false, true}) {
            expectPlainMix(few, parts, rise);
            expectPlainMix(many, parts, rise);
        }
    }
}

// However values lie, none that the volume has is rounded, and those between are near.
TEST(ValueMixer, OwnValuesAreKeptExactly) {
    const auto check = [](const std::vector<double>& values, double precision) {
        std::vector<Code> codes(values.size());
        std::iota(codes.begin(), codes.end(), Code{0});
        const Volume volume = volumeOf(CodeBook::ofTable(values), codes);
        const ValueMixer mixer(volume, {2, 2});
        const CodeBook& levels = mixer.levels().codeBook();
        for (const Code code : codes) EXPECT_EQ(levels.valueOf(mixer.levelOf(code)), values[code]);
        MixWindow window;
        std::mt19937 random(3);
        for (Slot& slot : window.slots) slot = Slot(random() % values.size() + 1);
        std::vector<BlockSlots> blocks(8);
        mixer.mix(window, MixMap(sameSlots(), {}), blocks);
        const auto at = [&](int s, int u, int v) {
            return values[std::size_t(window.at({s, u, v})) - 1];
        };
        const auto lerp = [](double a, double b) { return 0.75 * a + 0.25 * b; };
        const auto row = [&](int s, int u) { return lerp(at(s, u, 3), at(s, u, 2)); };
        const double expected = lerp(lerp(row(3, 3), row(2, 3)), lerp(row(3, 2), row(2, 2)));
        const double got = valueOf(mixer, blocks[0][64 * 6 + 8 * 6 + 6]);
        EXPECT_NEAR(got, expected, precision);
    };
    check({0, 1000001, 1000002, 1000003}, 200);
    check({1e-37, 292.5, 292.75, 293, 293.25, 293.5}, 0.05);
    check({-1e300, -1e-300, 0, 1e-310, 3e-310, 7e307}, 1e297);
    std::vector<double> many;
    for (int i = 0; i < 65536; ++i) many.push_back(101320 + i / 6553.6);
    check(many, 1e-4);
    many[0] = 1e-37;
    check(many, 1e-1);
    // As a rounded share of a code's spacing is no power of two, a value next to a corner of a
    // transfer function must not fall short of it.
    std::vector<Code> codes(1338);
    std::iota(codes.begin(), codes.end(), Code{0});
    const Volume integers = volumeOf(CodeBook::integer(), codes);
    const ValueMixer mixer(integers, {2, 2});
    for (const Code code : codes)
        EXPECT_EQ(mixer.levels().codeBook().valueOf(mixer.levelOf(code)), code);
}

TEST(ValueMixer, LevelsAreAsManyAsThereIsRoomFor) {
    std::vector<Code> all(kCodeCount);
    std::iota(all.begin(), all.end(), Code{0});
    const Volume volume = volumeOf(CodeBook::linear(0, 1), all);
    const ValueMixer mixer(volume, {2, 1});
    for (const int code : {0, 1, 30000, 65535}) {
        EXPECT_EQ(mixer.levels().codeBook().valueOf(mixer.levelOf(Code(code))),
                  volume.codeBook().valueOf(Code(code)));
    }
}

}  // namespace
}  // namespace deltasplat
