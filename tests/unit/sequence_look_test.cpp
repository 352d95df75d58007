// SPDX-License-Identifier: Apache-2.0
// What all frames are shown by does not depend on the order in which they are looked at, and comes
// back from a file.
#include "sequence/sequence_look.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "deltasplat/optics/default_ramp.h"
#include "deltasplat/optics/transfer_function.h"
#include "support/make_volume.h"
#include "support/same_volume.h"

namespace deltasplat {
namespace {

TEST(ValueCounts, CountsEachOfFewValues) {
    ValueCounts counts;
    for (int i = 0; i < 3000; ++i) counts.add(i % 1500, 2);
    EXPECT_EQ(counts.counts().size(), 1500u);
    EXPECT_EQ(counts.counts().at(7), 4u);
    EXPECT_EQ(counts.relativeError(), 0);
}

TEST(ValueCounts, RoundsManyWhateverTheirOrder) {
    std::mt19937 random(1);
    std::vector<double> values;
    for (int i = 0; i < 50000; ++i) values.push_back(std::exp(double(random()) / 1e9) - 20);
    // Rounded at the end, or at times.
    ValueCounts one;
    for (const double value : values) one.add(value, 1);
    EXPECT_EQ(one.counts().size(), values.size());
    EXPECT_EQ(one.relativeError(), 0);
    one.limit();
    std::shuffle(values.begin(), values.end(), random);
    ValueCounts other;
    for (std::size_t i = 0; i < values.size(); ++i) {
        other.add(values[i], 1);
        if (i % 10000 == 0) other.limit();
    }
    other.limit();
    EXPECT_EQ(one.counts(), other.counts());
    EXPECT_EQ(one.bits(), other.bits());
    EXPECT_LE(one.counts().size(), ValueCounts::kMost);
    EXPECT_GT(one.counts().size(), ValueCounts::kMost / 8);
    std::uint64_t sum = 0;
    for (const auto& [value, count] : one.counts()) sum += count;
    EXPECT_EQ(sum, values.size());
    EXPECT_LT(one.relativeError(), 0.01);
}

// Three volumes, of which one lies elsewhere in the world.
std::vector<Volume> someFrames() {
    std::vector<Volume> frames;
    for (int i = 0; i < 3; ++i) {
        frames.push_back(test::makeVolume(
            {glm::ivec3(-2 * i), glm::ivec3(6 + 3 * i)},
            [&](int x, int y, int z) { return (x * x + 3 * y * y + z * z + 40 * i) % 200; },
            {0.5, 0.5, 0.5}));
    }
    test::changed(frames[1])->worldFromIndex[3].x = 10;
    return frames;
}

void expectTheSame(const Volume& a, const Volume& b) {
    test::expectSameFacts(a, b);
    EXPECT_EQ(defaultRange(a), defaultRange(b));
    EXPECT_EQ(bulkRange(a), bulkRange(b));
    for (Code code = 0; code < 200; ++code)
        EXPECT_EQ(a.codeBook().valueOf(code), b.codeBook().valueOf(code));
}

TEST(SequenceLook, IsOfAllFramesWhateverTheirOrder) {
    const std::vector<Volume> frames = someFrames();
    SequenceLook look(0);
    SequenceLook turned(0);
    for (std::size_t i = 0; i < 3; ++i) {
        for (const auto& [one, frame] :
             {std::pair(&look, i), std::pair(&turned, std::size_t{2} - i)}) {
            EXPECT_EQ(&one->standIn(frame, kMainGrid, frames[frame]), &frames[frame]);
            one->addSeen(frame, frames[frame]);
        }
    }
    look.finish();
    turned.finish();
    const Volume& whole = look.standIn(0, kMainGrid, frames[0]);
    expectTheSame(whole, turned.standIn(2, kMainGrid, frames[2]));
    expectTheSame(look.seen(), turned.seen());
    EXPECT_EQ(whole.activeCount(),
              frames[0].activeCount() + frames[1].activeCount() + frames[2].activeCount());
    // From -4 to 12 voxels, and one frame that is moved by 20.
    EXPECT_EQ(look.seen().box(), (IndexBox{{-4, -4, -4}, {29, 12, 12}}));
    EXPECT_EQ(look.smallestVoxelWorld(), 0.5);

    SequenceLook read(0);
    read.takeJson(nlohmann::ordered_json::parse(look.toJson().dump()));
    EXPECT_TRUE(read.isFinished());
    expectTheSame(read.standIn(0, kMainGrid, frames[0]), whole);
    expectTheSame(read.seen(), look.seen());
    EXPECT_EQ(read.smallestVoxelWorld(), 0.5);
}

// Of one frame, ranges are those of its volume.
TEST(SequenceLook, OfOneFrameIsThatFrame) {
    const Volume volume = someFrames()[0];
    SequenceLook look(0);
    look.standIn(0, kMainGrid, volume);
    look.addSeen(0, volume);
    look.finish();
    const Volume& whole = look.standIn(0, kMainGrid, volume);
    EXPECT_EQ(defaultRange(whole), defaultRange(volume));
    EXPECT_EQ(bulkRange(whole), bulkRange(volume));
    EXPECT_EQ(look.seen().box(), volume.box());
    EXPECT_EQ(look.seen().worldFromIndex(), volume.worldFromIndex());
}

TEST(SequenceLook, RefusesWhatIsNoneInAFile) {
    const Volume volume = someFrames()[0];
    SequenceLook look(0);
    look.standIn(0, kMainGrid, volume);
    look.addSeen(0, volume);
    look.finish();
    const auto changed = [&](const char* member, const nlohmann::ordered_json& value) {
        nlohmann::ordered_json json = look.toJson();
        json["seen"][member] = value;
        SequenceLook other(0);
        EXPECT_ANY_THROW(other.takeJson(json)) << member;
    };
    changed("values", nlohmann::ordered_json::array());
    changed("bits", 99);
    changed("range", "wide");
    changed("world_from_index", {{0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 1}});
}

}  // namespace
}  // namespace deltasplat
