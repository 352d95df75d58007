// SPDX-License-Identifier: Apache-2.0
// Columns of deltas that stand for millions of blocks: what shows nothing costs nothing.
#include "formats/delta/column_decoder.h"

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "formats/delta/delta_format.h"
#include "formats/delta/exact_slots.h"
#include "volume/slot_blocks.h"

namespace deltasplat {
namespace {

constexpr int kBlocks = 1 << 26;  // more than can be gone through one by one, column after column
constexpr int kColumns = 100;

// What changes in blocks: in their first slice all voxels, or the first one alone.
struct Change {
    int delta;
    bool isOfOne = false;
};
using Changes = std::map<int, Change>;

class Walker : public DeltaWalker {
  public:
    explicit Walker(Changes changes) : changes_(std::move(changes)) {}

    bool start(const DeltaColumn&) override {
        next_ = changes_.begin();
        return true;
    }
    int block() const override { return next_ == changes_.end() ? kNoBlock : next_->first; }
    const BlockDeltas* take() override {
        const Change& change = next_->second;
        const std::uint64_t voxels = change.isOfOne ? 1 : ~std::uint64_t{0};
        deltas_.changed = {voxels};
        deltas_.given = {voxels};
        numbers_.assign(64, toZigzag(std::int32_t(change.delta)));
        deltas_.numbers = numbers_.data();
        ++next_;
        return &deltas_;
    }

  private:
    Changes changes_;
    Changes::const_iterator next_;
    BlockDeltas deltas_;
    std::vector<std::int32_t> numbers_;
};

struct Decoded {
    bool isSound = true;
    std::vector<SlotBlock> blocks;
    std::uint64_t active = 0;
};

// Decodes many columns, of which only some codes are seen.
Decoded decode(const Changes& changes, const SeenCodes& seen, int keyInterval = 8 * kBlocks,
               int columns = kColumns) {
    DeltaHeader header;
    header.sliceAxis = 0;
    header.keyInterval = keyInterval;
    header.box = {{0, 0, 0}, {8 * kBlocks - 4, 7, 7}};
    header.codeCount = 10;
    header.active = ~std::uint64_t{0};
    const BlockLayout layout(header);
    const std::string where = "a column";
    ColumnDecoder decoder(std::make_unique<Walker>(changes),
                          {header, layout, slotRulesOf(header), where, &seen}, nullptr, 0);
    Decoded decoded;
    for (int i = 0; i < columns && decoded.isSound; ++i)
        decoded.isSound = decoder.decode({}, {0, kBlocks - 1}, decoded.blocks);
    decoded.active = decoder.activeCount();
    return decoded;
}

SeenCodes onlySeen(Code seen) {
    return SeenCodes([=](int code) { return code == seen; });
}

TEST(ColumnDecoder, PassesOverWhatGoesOnUnseen) {
    // Slot 4, code 3, from the first block to the box's end, which lacks three slices of a block.
    const Decoded decoded = decode({{0, {4}}}, onlySeen(7));
    EXPECT_TRUE(decoded.isSound);
    EXPECT_TRUE(decoded.blocks.empty());
    EXPECT_EQ(decoded.active, std::uint64_t{kColumns} * 64 * (8ull * kBlocks - 3));
}

TEST(ColumnDecoder, FindsWhatIsSeenBetween) {
    // Code 7 in two blocks in the middle, of which the first voxel stays behind.
    const int middle = kBlocks / 2 + 5;
    const Changes changes{{0, {4}}, {middle, {4}}, {middle + 2, {-4}}, {middle + 9, {1, true}}};
    const Decoded decoded = decode(changes, onlySeen(7));
    EXPECT_TRUE(decoded.isSound);
    ASSERT_EQ(decoded.blocks.size(), 2u * kColumns);
    for (std::size_t i = 0; i < decoded.blocks.size(); ++i) {
        EXPECT_EQ(decoded.blocks[i].position.x, middle + int(i % 2));
        EXPECT_EQ(decoded.blocks[i].highest, 7);
    }
    EXPECT_EQ(decoded.active, std::uint64_t{kColumns} * 64 * (8ull * kBlocks - 3));
}

TEST(ColumnDecoder, PassesOverBlocksOfSeveralCodes) {
    const Decoded decoded = decode({{3, {4}}, {5, {1, true}}}, onlySeen(7));
    EXPECT_TRUE(decoded.isSound);
    EXPECT_TRUE(decoded.blocks.empty());
    EXPECT_EQ(decoded.active, std::uint64_t{kColumns} * 64 * (8ull * kBlocks - 3 - 24));
}

TEST(ColumnDecoder, EndsWithItsSlab) {
    // Slabs of 1024 blocks: what began in one is gone in the next.
    const Decoded decoded = decode({{1, {4}}, {3 * 1024 - 3, {8}}}, onlySeen(7), 8 << 10);
    EXPECT_TRUE(decoded.isSound);
    EXPECT_EQ(decoded.blocks.size(), 3u * kColumns);
    EXPECT_EQ(decoded.active, std::uint64_t{kColumns} * 512 * (1023 + 3));
}

TEST(ColumnDecoder, RefusesMoreVoxelsThanThereAre) {
    DeltaHeader header;
    header.sliceAxis = 0;
    header.keyInterval = 8 * kBlocks;
    header.box = {{0, 0, 0}, {8 * kBlocks - 1, 7, 7}};
    header.codeCount = 10;
    header.active = 512ull * kBlocks - 1;
    const BlockLayout layout(header);
    const std::string where = "a column";
    const SeenCodes seen = onlySeen(7);
    ColumnDecoder decoder(std::make_unique<Walker>(Changes{{0, {4}}}),
                          {header, layout, slotRulesOf(header), where, &seen}, nullptr, 0);
    std::vector<SlotBlock> blocks;
    EXPECT_FALSE(decoder.decode({}, {0, kBlocks - 1}, blocks));
}

}  // namespace
}  // namespace deltasplat
