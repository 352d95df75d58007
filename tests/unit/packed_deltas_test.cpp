// SPDX-License-Identifier: Apache-2.0
#include "words/packed_deltas.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <random>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "base/bits.h"
#include "deltasplat/threads.h"
#include "support/make_volume.h"
#include "support/simd_levels.h"
#include "view/base_plane.h"
#include "words/slice_joiner.h"

namespace deltasplat {
namespace {

// Classes of visible voxels by (slice, u, v).
using Classes = std::map<std::tuple<int, int, int>, ClassIndex>;

std::vector<Slot> plainClasses() {
    std::vector<Slot> classes(kSlotCount, 0);
    for (Slot slot = 1; slot < kSlotCount; ++slot) classes[slot] = slot <= 60 ? 0 : slot / 8;
    return classes;
}

Classes classesOf(const Volume& volume, int axis, const std::vector<Slot>& classOfSlot) {
    Classes classes;
    for (auto voxel = volume.codes()->tree().cbeginValueOn(); voxel; ++voxel) {
        openvdb::CoordBBox box;
        voxel.getBoundingBox(box);
        const Slot found = classOfSlot[*voxel + 1];
        if (found == 0) continue;
        for (auto place = box.begin(); place; ++place) {
            const glm::ivec3 p = toSliceOrder(*place, axis);
            classes[{p.x, p.y, p.z}] = ClassIndex(found);
        }
    }
    return classes;
}

constexpr Encoding kEncodings[] = {Encoding::kChanges,
                                   Encoding::kWhole,
                                   Encoding::kFewerWordsOrStamps,
                                   Encoding::kFewerWords,
                                   Encoding::kFewerWordsOrVoxels,
                                   Encoding::kFewerWordsOrWrites};

// Encodings, and whether slices are walked from the last one on.
const std::vector<std::pair<Encoding, bool>> kWays = [] {
    std::vector<std::pair<Encoding, bool>> ways;
    for (const Encoding encoding : kEncodings)
        for (const bool descending : {false, true}) ways.emplace_back(encoding, descending);
    return ways;
}();

PackOptions optionsOf(int axis, Encoding encoding, std::span<const Slot> classes, bool descending) {
    PackOptions options{axis, encoding, classes, {}};
    options.descending = descending;
    return options;
}

// Walks the words as a renderer does.
Classes walk(const PackedDeltas& packed) {
    Classes all;
    std::map<std::tuple<int, int>, ClassIndex> plane;
    for (const PlannedSlab& slab : packed.slabs) {
        plane.clear();
        const int last = slab.firstSlice + slab.sliceCount - 1;
        for (int i = 0; i < slab.sliceCount; ++i) {
            const int s = packed.descending ? last - i : slab.firstSlice + i;
            if (slab.whole) plane.clear();
            for (const DeltaWord& word : packed.slice(s)) {
                std::uint64_t rest = slab.whole ? word.visible : word.changed;
                EXPECT_NE(rest, 0u);
                for (; rest != 0; rest &= rest - 1) {
                    const int n = std::countr_zero(rest);
                    plane[{8 * word.block.x + n / 8, 8 * word.block.y + n % 8}] = word.classes[n];
                }
                for (int n = 0; n < 64; ++n) EXPECT_EQ(word.visible >> n & 1, word.classes[n] != 0);
            }
            for (const auto& [place, found] : plane) {
                if (found != 0) all[{s, std::get<0>(place), std::get<1>(place)}] = found;
            }
        }
    }
    return all;
}

// Classes of joined slices, and of `within` voxels beside each other, voxel by voxel.
Classes joinedClassesOf(const Classes& classes, const SliceJoiner& joiner,
                        std::span<const glm::ivec2> slants, int within = 1) {
    const auto classAt = [&](int s, int u, int v) {
        const auto voxel = classes.find({s, u, v});
        return voxel == classes.end() ? ClassIndex{0} : voxel->second;
    };
    const int count = int(slants.size());
    const std::size_t pitch = std::size_t(8 * within);
    Classes joined;
    LookCache cache;
    const auto join = [&](int slice, int u, int v) {
        if (joined.contains({slice, u, v})) return;
        std::vector<std::vector<ClassIndex>> voxels(slants.size());
        std::vector<const ClassIndex*> slices;
        for (int i = 0; i < count; ++i) {
            const glm::ivec2& slant = slants[std::size_t(i)];
            std::vector<ClassIndex>& square = voxels[std::size_t(i)];
            square.resize(pitch * pitch);
            for (int n = 0; n < within * within; ++n) {
                const glm::ivec2 beside(n / within, n % within);
                square[std::size_t(beside.x) * pitch + std::size_t(beside.y)] =
                    classAt(count * slice + i, within * u + beside.x - slant.x,
                            within * v + beside.y - slant.y);
            }
            slices.push_back(square.data());
        }
        std::array<ClassIndex, 64> out;
        joiner.join(slices, pitch, 0, out.data(), cache);
        joined[{slice, u, v}] = out[0];
    };
    for (const auto& [place, found] : classes) {
        const auto [s, u, v] = place;
        const int slice = floorDiv(s, count);
        const glm::ivec2& slant = slants[std::size_t(s - count * slice)];
        join(slice, floorDiv(u + slant.x, within), floorDiv(v + slant.y, within));
    }
    return joined;
}

// Of so many slices, as lines of sight go.
std::vector<glm::ivec2> slantsOf(int count, const glm::dvec2& shiftPerSlice) {
    const JoinedSlants joined = joinedSlants(shiftPerSlice, count);
    return {joined.slants.begin(), joined.slants.begin() + count};
}

const IndexBox kBox{{-19, 5, -60}, {30, 40, 2}};

TEST(PackedDeltas, AddUpToTheClassesOfTheVolume) {
    const Volume volume = test::randomVolume(kBox, 3);
    const std::vector<Slot> classes = plainClasses();
    for (int axis = 0; axis < 3; ++axis) {
        const Classes expected = classesOf(volume, axis, classes);
        for (const auto& [encoding, descending] : kWays) {
            for (const int threads : {1, 2}) {
                const ThreadLimit limit(threads);
                const PackedDeltas packed =
                    packDeltas(volume, optionsOf(axis, encoding, classes, descending));
                EXPECT_EQ(walk(packed), expected) << axis;
                EXPECT_EQ(packed.visible(), expected.size());
            }
        }
    }
}

// Classes that follow each other, in one piece and in some, of leaves whose inactive voxels hold
// any codes.
TEST(PackedDeltas, TakeClassesThatFollowEachOther) {
    std::vector<Slot> rising(kSlotCount, 0);
    std::vector<Slot> pieces(kSlotCount, 0);
    for (Slot slot = 61; slot <= 256; ++slot) {
        rising[slot] = slot - 60;
        pieces[slot] = slot < 70 ? slot + 130 : slot < 250 ? slot - 69 : 180;
    }
    CodeTree::Tree tree = test::randomVolume(kBox, 5).codes()->tree();
    std::mt19937 random(6);
    for (auto leaf = tree.beginLeaf(); leaf; ++leaf)
        for (auto off = leaf->beginValueOff(); off; ++off)
            leaf->setValueOnly(off.pos(), Code(random() % 2 == 0 ? random() % 256 : random()));
    Volume volume = test::randomVolume(kBox, 5);
    test::changed(volume)->codes = std::make_shared<CodeTree>(std::in_place, tree);
    std::vector<double> extinctions(257, 0.01);
    extinctions[0] = 0;
    const SliceJoiner joiner = SliceJoiner::ofSums(extinctions);
    for (const std::vector<Slot>& classes : {rising, pieces}) {
        for (int axis = 0; axis < 3; ++axis) {
            const Classes expected = classesOf(volume, axis, classes);
            PackOptions options = optionsOf(axis, Encoding::kChanges, classes, false);
            EXPECT_EQ(walk(packDeltas(volume, options)), expected) << axis;
            options.joiner = &joiner;
            const std::array<glm::ivec2, 2> slants = {glm::ivec2(0), {-1, 1}};
            options.slants = slants;
            EXPECT_EQ(walk(packDeltas(volume, options)),
                      joinedClassesOf(expected, joiner, options.slants))
                << axis;
        }
    }
}

// Slices a slab, counted from the block that the first one begins in.
int keyIntervalOf(const PackedDeltas& packed) {
    const int first = packed.box.min.x >> 3;
    const int end =
        packed.slabs.size() > 1 ? packed.slabs[1].firstSlice >> 3 : (packed.box.max.x >> 3) + 1;
    return 8 * (end - first);
}

TEST(PackedDeltas, CountWhatTheDeltaGridCounts) {
    const Volume volume = test::randomVolume(kBox, 4);
    const std::vector<Slot> classes = plainClasses();
    for (int axis = 0; axis < 3; ++axis) {
        for (const Encoding encoding : kEncodings) {
            const PackedDeltas packed = packDeltas(volume, {axis, encoding, classes, {}});
            const DeltaGrid grid = makeDeltaGrid(volume, {axis, keyIntervalOf(packed), classes});
            EXPECT_EQ(packed.visible(), grid.visible());
            EXPECT_EQ(packed.deltas(), grid.deltas());
            ASSERT_EQ(packed.slabs.size(), grid.slabs.size());
            for (std::size_t i = 0; i < grid.slabs.size(); ++i) {
                EXPECT_EQ(packed.slabs[i].firstSlice, grid.slabs[i].firstSlice);
                EXPECT_EQ(packed.slabs[i].sliceCount, grid.slabs[i].sliceCount);
                EXPECT_EQ(packed.slabs[i].visible, grid.slabs[i].visible);
                EXPECT_EQ(packed.slabs[i].deltas, grid.slabs[i].deltas);
            }
        }
    }
}

void expectSameWords(std::span<const DeltaWord> words, std::span<const DeltaWord> expected) {
    ASSERT_EQ(words.size(), expected.size());
    for (std::size_t i = 0; i < words.size(); ++i) {
        EXPECT_EQ(words[i].visible, expected[i].visible);
        EXPECT_EQ(words[i].changed, expected[i].changed);
        EXPECT_EQ(words[i].block, expected[i].block);
        EXPECT_TRUE(std::equal(words[i].classes, words[i].classes + 64, expected[i].classes));
    }
}

TEST(PackedDeltas, PartsHaveTheWordsOfTheWhole) {
    const Volume volume = test::randomVolume(kBox, 6);
    const std::vector<Slot> classes = plainClasses();
    for (int axis = 0; axis < 3; ++axis) {
        for (const auto& [encoding, descending] : kWays) {
            const PackOptions options = optionsOf(axis, encoding, classes, descending);
            const PackedDeltas whole = packDeltas(volume, options);
            // Slab by slab, some at a time, and all.
            for (const double bytes : {0.0, 3e5, 1e9}) {
                DeltaPacker packer(volume, options);
                EXPECT_TRUE(packer.canBeParted());
                const PackedDeltas planned = packer.packOrPlan(bytes);
                EXPECT_EQ(planned.words.empty(), bytes != 1e9);
                EXPECT_EQ(planned.visible(), whole.visible());
                EXPECT_EQ(planned.deltas(), whole.deltas());
                ASSERT_EQ(planned.slabs.size(), whole.slabs.size());
                if (bytes == 1e9) {
                    EXPECT_TRUE(packer.parts().empty());
                    expectSameWords(planned.words, whole.words);
                    continue;
                }
                int next = 0;
                for (const SlabRange& range : packer.parts()) {
                    EXPECT_EQ(range.first, next);
                    next = range.last;
                    const PackedDeltas part = packer.pack(range);
                    for (int i = 0; i < int(whole.slabs.size()); ++i) {
                        const PlannedSlab& slab = whole.slabs[std::size_t(i)];
                        EXPECT_EQ(part.slabs[std::size_t(i)].whole, slab.whole);
                        const bool isIn = i >= range.first && i < range.last;
                        for (int s = slab.firstSlice; s < slab.firstSlice + slab.sliceCount; ++s)
                            expectSameWords(part.slice(s),
                                            isIn ? whole.slice(s) : std::span<const DeltaWord>());
                    }
                }
                EXPECT_EQ(next, int(whole.slabs.size()));
                const auto parts = int(packer.parts().size());
                const int slabs = int(whole.slabs.size());
                EXPECT_GE(parts, bytes == 0 ? slabs : 1);
                EXPECT_LE(parts, slabs);
            }
        }
    }
}

// In parts as well.
TEST(PackedDeltas, JoinSlices) {
    // Odd beginnings and ends, blocks that are alone, and others of which only edges are there.
    const IndexBox box{{-19, 5, -121}, {30, 40, 62}};
    const Volume volume = test::makeVolume(box, [](int x, int y, int z) {
        const bool isGap = (x >> 4) % 3 == 0 || (z >> 3) % 4 == 1 || (y >> 3) == 2;
        return isGap || (x + y * y + z) % 3 == 0 ? test::kInactive : (x * 7 + y * 3 + z * 5) & 255;
    });
    const std::vector<Slot> classes = plainClasses();
    std::vector<double> extinctions(40);
    for (std::size_t i = 0; i < extinctions.size(); ++i) extinctions[i] = 0.01 * double(i * i);
    std::vector<glm::dvec4> lights;
    for (std::size_t i = 0; i < 40; ++i) {
        const double alpha = i == 0 ? 0 : 1 / double(i);
        lights.emplace_back(alpha * 0.02 * double(i), 0.5 * alpha, 0, alpha);
    }
    struct Case {
        SliceJoiner joiner;
        std::vector<glm::ivec2> slants;
        int within = 1;
    };
    std::vector<Case> cases;
    for (int i = 0; i < 18; ++i) {
        const SliceJoiner joiner =
            i < 9 ? SliceJoiner::ofPairs(40) : SliceJoiner::ofSums(extinctions);
        cases.push_back({joiner, {{0, 0}, {i / 3 % 3 - 1, i % 3 - 1}}});
    }
    for (const bool lastInFront : {false, true}) {
        const auto ofLooks = [&](int slices) {
            return SliceJoiner::ofLooks(lights, {slices, lastInFront});
        };
        cases.push_back({ofLooks(2), {{0, 0}, {-1, 0}}});
        cases.push_back({ofLooks(4), {{0, 0}, {0, -1}, {0, -2}, {0, -3}}});
        cases.push_back(
            {ofLooks(8), {{0, 0}, {1, 0}, {1, -1}, {2, -1}, {3, -1}, {4, -2}, {4, -2}, {5, -2}}});
        cases.push_back({SliceJoiner::ofSums(extinctions, 8),
                         {{0, 0}, {0, 1}, {0, 2}, {0, 3}, {0, 4}, {0, 5}, {0, 6}, {0, 7}}});
        // Of several blocks, and of columns that are not beside one.
        cases.push_back({ofLooks(16), slantsOf(16, {0.45, -1})});
        cases.push_back({ofLooks(32), slantsOf(32, {-1, 0.7})});
        cases.push_back({SliceJoiner::ofSums(extinctions, 32), slantsOf(32, {1, 0})});
        // Voxels beside each other as well.
        const auto ofMeans = [&](int slices, int within) {
            return SliceJoiner::ofLooks(
                lights, {.slices = slices, .lastInFront = lastInFront, .within = within});
        };
        cases.push_back({ofMeans(4, 2), slantsOf(4, {1, 1}), 2});
        cases.push_back({ofMeans(16, 2), slantsOf(16, {0.45, -1}), 2});
        cases.push_back({ofMeans(32, 2), slantsOf(32, {1, 0.2}), 2});
        cases.push_back({ofMeans(32, 4), slantsOf(32, {-1, 0.7}), 4});
    }
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const SliceJoiner& joiner = cases[i].joiner;
        // Some of them.
        if (test::kIsSanitized && i % 4 != 0) continue;
        for (int axis = 0; axis < 3; ++axis) {
            const Classes expected = joinedClassesOf(classesOf(volume, axis, classes), joiner,
                                                     cases[i].slants, cases[i].within);
            for (const auto& [encoding, descending] : kWays) {
                PackOptions options = optionsOf(axis, encoding, classes, descending);
                options.joiner = &joiner;
                options.slants = cases[i].slants;
                options.joinedWithin = cases[i].within;
                const PackedDeltas whole = packDeltas(volume, options);
                EXPECT_EQ(walk(whole), expected) << i << ", axis " << axis;
                EXPECT_EQ(whole.visible(), expected.size());
                if (axis != 2) continue;
                DeltaPacker packer(volume, options);
                packer.packOrPlan(0);
                EXPECT_GT(packer.parts().size(), cases[i].slants.size() == 2 ? 2u : 0u);
                for (const SlabRange& range : packer.parts()) {
                    const PackedDeltas part = packer.pack(range);
                    const PlannedSlab& slab = whole.slabs[std::size_t(range.first)];
                    for (int s = slab.firstSlice; s < slab.firstSlice + slab.sliceCount; ++s)
                        expectSameWords(part.slice(s), whole.slice(s));
                }
            }
        }
    }
}

// Parts number no looks that the whole has not, however many these are.
TEST(PackedDeltas, JoinManyLooksInParts) {
    // Each column has a pair of its own, nearly: the sample has few of all.
    const Volume volume = test::makeVolume({{0, 0, 0}, {255, 255, 31}}, [](int x, int y, int z) {
        return z % 2 == 0 ? (13 * x + 7 * y) % 199 : (5 * x + 29 * y) % 199;
    });
    std::vector<Slot> classes(kSlotCount, 0);
    for (Slot slot = 1; slot < kSlotCount; ++slot) classes[slot] = slot % 200;
    std::vector<glm::dvec4> lights(1);
    for (std::size_t i = 1; i < 200; ++i) {
        const double alpha = std::exp2(-0.04 * double(i));
        const auto share = [&](int step) {
            return alpha * double(i * std::size_t(step) % 97) / 97;
        };
        lights.emplace_back(share(7), share(31), share(55), alpha);
    }
    const SliceJoiner joiner = SliceJoiner::ofLooks(lights, {2});
    PackOptions options = optionsOf(2, Encoding::kFewerWordsOrStamps, classes, false);
    const std::array<glm::ivec2, 2> slants = {glm::ivec2(0), {1, 0}};
    options.joiner = &joiner;
    options.slants = slants;
    DeltaPacker packer(volume, options);
    packer.packOrPlan(0);
    ASSERT_GT(packer.parts().size(), 0u);
    EXPECT_GT(packer.joiner()->looks()->looks().size(), 65536u / 3);
    options.joiner = &*packer.joiner();
    const PackedDeltas whole = packDeltas(volume, options);
    EXPECT_GT(whole.visible(), 0u);
    for (const SlabRange& range : packer.parts()) {
        const PackedDeltas part = packer.pack(range);
        for (int i = range.first; i < range.last; ++i) {
            const PlannedSlab& slab = whole.slabs[std::size_t(i)];
            for (int s = slab.firstSlice; s < slab.firstSlice + slab.sliceCount; ++s)
                expectSameWords(part.slice(s), whole.slice(s));
        }
    }
}

// Of a tree's tiles, too.
TEST(PackedDeltas, JoinSlicesOfTiles) {
    Volume volume = test::makeVolume({{0, 0, 0}, {63, 63, 63}}, [](int x, int y, int z) {
        return x < 32 ? 200 : (x + y + z) % 3 == 0 ? 90 : test::kInactive;
    });
    const auto pruned = std::make_shared<CodeTree>(std::in_place, volume.codes()->tree());
    pruned->tree().prune();
    Volume tiled = volume;
    test::changed(tiled)->codes = pruned;
    const std::vector<Slot> classes = plainClasses();
    const SliceJoiner joiner = SliceJoiner::ofPairs(40);
    for (int axis = 0; axis < 3; ++axis) {
        PackOptions options = optionsOf(axis, Encoding::kChanges, classes, false);
        options.joiner = &joiner;
        const std::array<glm::ivec2, 2> slants = {glm::ivec2(0), {1, -1}};
        options.slants = slants;
        const Classes expected =
            joinedClassesOf(classesOf(volume, axis, classes), joiner, options.slants);
        EXPECT_EQ(walk(packDeltas(tiled, options)), expected);
    }
}

// Either way the same slabs, and in them as many changes within as there are the other way.
TEST(PackedDeltas, ChangeBackOnTheOtherWay) {
    const Volume volume = test::randomVolume(kBox, 7);
    const std::vector<Slot> classes = plainClasses();
    const auto withinSlabs = [](const PackedDeltas& packed) {
        std::uint64_t changes = 0;
        for (const PlannedSlab& slab : packed.slabs) {
            const int last = slab.firstSlice + slab.sliceCount - 1;
            const int key = packed.descending ? last : slab.firstSlice;
            for (int s = slab.firstSlice; s <= last; ++s) {
                for (const DeltaWord& word : packed.slice(s)) {
                    if (s == key) {
                        EXPECT_EQ(word.changed, word.visible);
                    } else {
                        changes += std::uint64_t(std::popcount(word.changed));
                    }
                }
            }
        }
        return changes;
    };
    for (int axis = 0; axis < 3; ++axis) {
        const PackedDeltas up =
            packDeltas(volume, optionsOf(axis, Encoding::kChanges, classes, false));
        const PackedDeltas down =
            packDeltas(volume, optionsOf(axis, Encoding::kChanges, classes, true));
        EXPECT_EQ(withinSlabs(up), withinSlabs(down));
        ASSERT_EQ(up.slabs.size(), down.slabs.size());
        for (std::size_t i = 0; i < up.slabs.size(); ++i) {
            EXPECT_EQ(up.slabs[i].firstSlice, down.slabs[i].firstSlice);
            EXPECT_EQ(up.slabs[i].deltas, down.slabs[i].deltas);
        }
    }
}

TEST(PackedDeltas, TakeTilesOfTheTree) {
    Volume volume = test::makeVolume({{0, 0, 0}, {63, 63, 63}}, [](int x, int y, int z) {
        return x < 32 ? 200 : (x + y + z) % 3 == 0 ? 90 : test::kInactive;
    });
    const auto pruned = std::make_shared<CodeTree>(std::in_place, volume.codes()->tree());
    pruned->tree().prune();
    EXPECT_LT(pruned->tree().leafCount(), volume.codes()->tree().leafCount());
    const std::vector<Slot> classes = plainClasses();
    for (int axis = 0; axis < 3; ++axis) {
        const Classes expected = classesOf(volume, axis, classes);
        Volume tiled = volume;
        test::changed(tiled)->codes = pruned;
        EXPECT_EQ(walk(packDeltas(tiled, {axis, Encoding::kChanges, classes, {}})), expected);
    }
}

// Held voxels stay within the rule of their true ones, never change their visibility, and the first
// slice holds nothing.
TEST(PackedDeltas, HoldsAgainstTheTrueSlot) {
    const Volume volume = test::randomVolume({{0, 0, 0}, {30, 20, 40}}, 5);
    std::vector<Slot> classes = plainClasses();
    for (Slot slot = 61; slot < kSlotCount; ++slot) classes[slot] = slot < 65536 ? slot : 1;
    constexpr int kReach = 9;
    const auto holds = [](Slot held, Slot slot) { return std::abs(held - slot) <= kReach; };
    for (int axis = 0; axis < 3; ++axis) {
        const Classes truth = classesOf(volume, axis, classes);
        const PackedDeltas exact = packDeltas(volume, {axis, Encoding::kChanges, classes, {}});
        const PackedDeltas held = packDeltas(volume, {axis, Encoding::kChanges, classes, holds});
        EXPECT_LT(held.deltas(), exact.deltas());
        EXPECT_EQ(held.visible(), exact.visible());
        const Classes shown = walk(held);
        ASSERT_EQ(shown.size(), truth.size());
        int different = 0;
        for (const auto& [place, found] : truth) {
            const int distance = std::abs(int(shown.at(place)) - int(found));
            EXPECT_LE(distance, kReach);
            if (std::get<0>(place) == held.box.min.x) {
                EXPECT_EQ(distance, 0);
            }
            different += distance != 0;
        }
        EXPECT_GT(different, 0);
    }
}

// What is held is looked up if few codes are seen, and asked for if a far corner has many more.
TEST(PackedDeltas, HoldsTheSameWhereManyCodesAreSeen) {
    const auto code = [](int x, int y, int z) { return 100 + (x * 5 + y * 3 + z * z) % 97; };
    const auto volumeOf = [&](bool manyMore) {
        return test::makeVolume({{-9, 0, 0}, {30, 60, 20}}, [&](int x, int y, int z) {
            if (y < 24) return (x + y + z) % 5 == 0 ? test::kInactive : code(x, y, z);
            return manyMore && y > 40 ? 300 + (x + 9) + 40 * z : test::kInactive;
        });
    };
    std::vector<Slot> classes(kSlotCount, 0);
    for (Slot slot = 1; slot < kSlotCount; ++slot) classes[slot] = slot < 65536 ? slot : 1;
    const auto holds = [](Slot held, Slot slot) { return std::abs(held - slot) <= 6; };
    for (int axis = 0; axis < 3; ++axis) {
        const auto shown = [&](bool manyMore) {
            const Volume volume = volumeOf(manyMore);
            return walk(packDeltas(volume, {axis, Encoding::kChanges, classes, holds}));
        };
        const Classes few = shown(false);
        const Classes many = shown(true);
        EXPECT_GT(many.size(), few.size() + 512);
        for (const auto& [place, found] : few) EXPECT_EQ(many.at(place), found);
    }
}

TEST(PackedDeltas, EmptyVolumeHasNoSlabs) {
    VolumeData volume;
    volume.codes = std::make_shared<CodeTree>();
    const PackedDeltas packed = packDeltas(Volume(volume), {});
    EXPECT_TRUE(packed.slabs.empty());
    EXPECT_EQ(packed.visible(), 0u);
}

}  // namespace
}  // namespace deltasplat
