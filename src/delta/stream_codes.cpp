// SPDX-License-Identifier: Apache-2.0
#include "delta/stream_codes.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <memory>
#include <numeric>
#include <string>

#include "deltasplat/threads.h"
#include "ingest/codes/code_counts.h"
#include "ingest/delta/column_decoder.h"
#include "ingest/delta/decode_blocks.h"
#include "ingest/delta/delta_columns.h"
#include "parallel.h"
#include "view/affine.h"

namespace deltasplat {
namespace {

using Leaf = openvdb::Int32Tree::LeafNodeType;

glm::ivec3 blockOf(const Leaf& leaf) {
    const openvdb::Coord origin = leaf.origin();
    return {origin.x() >> 3, origin.y() >> 3, origin.z() >> 3};
}

class LeafWalker : public DeltaWalker {
  public:
    explicit LeafWalker(const std::vector<const Leaf*>& leaves) : leaves_(leaves) {}

    bool start(const DeltaColumn& column) override {
        next_ = column.begin;
        end_ = column.end;
        return true;
    }
    int block() const override { return next_ == end_ ? kNoBlock : blockOf(*leaves_[next_]).x; }
    const BlockDeltas* take() override {
        const Leaf& leaf = *leaves_[next_++];
        std::int32_t* number = numbers_.data();
        for (std::size_t s = 0; s < 8; ++s) {
            const auto changed = leaf.getValueMask().getWord<std::uint64_t>(openvdb::Index(s));
            deltas_.changed[s] = deltas_.given[s] = changed;
            const std::int32_t* const slice = leaf.buffer().data() + 64 * s;
            for (std::uint64_t left = changed; left != 0; left &= left - 1)
                *number++ = slice[std::countr_zero(left)];
        }
        deltas_.numbers = numbers_.data();
        return &deltas_;
    }

  private:
    const std::vector<const Leaf*>& leaves_;
    std::size_t next_ = 0;
    std::size_t end_ = 0;
    BlockDeltas deltas_{};
    std::array<std::int32_t, 512> numbers_;
};

// Of a volume without empty places, columns without deltas rest.
bool addRest(const DeltaHeader& header, const SlotRules& rules, StreamCodes& found) {
    const std::uint64_t counted =
        std::accumulate(found.histogram.begin(), found.histogram.end(), std::uint64_t{0});
    if (counted > header.active || (!header.restActive && counted != header.active)) return false;
    if (header.restActive) found.histogram[std::size_t(rules.rest - 1)] += header.active - counted;
    return true;
}

}  // namespace

void StreamCodes::putRange(std::size_t column, BitWriter& out) const {
    const auto [lowest, highest] = ranges[column];
    out.putNumber(lowest);
    out.putNumber(std::uint64_t(highest - lowest));
}

void StreamCodes::putHistogram(BitWriter& out) const {
    const auto used = [](std::uint64_t count) { return count > 0; };
    out.putNumber(std::uint64_t(std::count_if(histogram.begin(), histogram.end(), used)));
    std::size_t next = 0;
    for (std::size_t code = 0; code < histogram.size(); ++code) {
        if (histogram[code] == 0) continue;
        out.putNumber(code - next);
        out.putNumber(histogram[code] - 1);
        next = code + 1;
    }
}

void StreamCodes::putBox(const IndexBox& box, BitWriter& out) const {
    for (int axis = 0; axis < 3; ++axis) {
        out.putNumber(std::uint64_t(active.min[axis] - box.min[axis]));
        out.putNumber(std::uint64_t(box.max[axis] - active.max[axis]));
    }
}

std::optional<StreamCodes> streamCodes(const std::vector<const Leaf*>& leaves,
                                       const std::vector<std::size_t>& begins,
                                       const DeltaHeader& header) {
    if (!mayDecodeBlocks(header) || !header.inactiveValues.empty()) return std::nullopt;
    const BlockLayout layout(header);
    const SlotRules rules = slotRulesOf(header);
    const std::string where = "packed deltas";
    const ColumnDecoder::Grid grid{header, layout, rules, where};
    const std::size_t count = begins.size() - 1;
    const std::size_t workers = std::min(count, std::size_t(std::max(1, threadCount())));
    CodeCounts counts(std::max<std::size_t>(1, workers));
    StreamCodes found;
    found.ranges.resize(count);
    std::vector<IndexBox> active(workers);
    std::atomic<bool> isSound = true;
    std::atomic<std::size_t> next = 0;
    parallelFor(workers, [&](std::size_t worker) {
        ColumnDecoder decoder(std::make_unique<LeafWalker>(leaves), grid, &counts, worker);
        std::vector<SlotBlock> blocks;
        for (std::size_t i = next++; i < count && isSound; i = next++) {
            const glm::ivec3 first = blockOf(*leaves[begins[i]]);
            const DeltaColumn column{{first.y, first.z}, begins[i], begins[i + 1]};
            blocks.clear();
            const bool isDone =
                decoder.decode(column, layout.blocksOf(layout.slabOf(first.x)), blocks);
            decoder.dropSlots();
            if (!isDone || blocks.empty()) {
                isSound = false;
                break;
            }
            found.ranges[i] = *rangeOf(blocks);
        }
        active[worker] = decoder.active();
    });
    if (!isSound) return std::nullopt;
    for (const IndexBox& box : active) found.active = boxOfBoth(found.active, box);
    if (header.restActive) found.active = {layout.first, layout.last};
    found.histogram = takeHistogram(counts);
    if (!addRest(header, rules, found)) return std::nullopt;
    return found;
}

}  // namespace deltasplat
