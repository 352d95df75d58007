// SPDX-License-Identifier: Apache-2.0
#include "formats/delta/stream_writer.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>

#include "base/affine.h"
#include "base/parallel.h"
#include "base/sorting.h"
#include "deltasplat/threads.h"
#include "formats/delta/bit_reader.h"
#include "formats/delta/column_decoder.h"
#include "formats/delta/decode_blocks.h"
#include "formats/delta/delta_columns.h"
#include "formats/delta/delta_stream.h"
#include "formats/delta/stream_index.h"
#include "volume/code_counts.h"

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

// Columns without deltas rest in a volume without empty places.
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

namespace {

glm::ivec3 blockAt(const openvdb::Coord& origin) {
    return {origin.x() >> 3, origin.y() >> 3, origin.z() >> 3};
}

// Writes a slice of a block: 64 numbers, 0 outside of `changed`.
template <typename Number>
void putSlice(std::uint64_t changed, const Number* numbers, RiceCode code, BitWriter& out) {
    std::array<Number, 64> all{};
    std::array<Number, 64> less;
    std::size_t count = 0;
    std::uint64_t rows = 0;
    for (std::uint64_t left = changed; left != 0; left &= left - 1) {
        const int n = std::countr_zero(left);
        all[std::size_t(n)] = numbers[n];
        less[count++] = Number(numbers[n] - 1);
        rows |= std::uint64_t{1} << (n >> 3);
    }
    const RiceChoice ofAll = bestRice<Number>(code, all);
    const RiceChoice ofChanged = bestRice<Number>(code, std::span(less.data(), count));
    const int rowBits = 8 + 8 * std::popcount(rows);
    const bool isMask = ofAll.bits > ofChanged.bits + std::uint64_t(std::min(64, rowBits));
    const SliceForm form = !isMask        ? SliceForm::kAll
                           : rowBits < 64 ? SliceForm::kRows
                                          : SliceForm::kMask;
    const int parameter = isMask ? ofChanged.parameter : ofAll.parameter;
    out.put(1, 1);
    out.put(std::uint64_t(form), 2);
    out.put(std::uint64_t(parameter), code.parameterBits());
    if (form == SliceForm::kMask) out.put(changed, 64);
    if (form == SliceForm::kRows) {
        out.put(rows, 8);
        for (std::uint64_t left = rows; left != 0; left &= left - 1)
            out.put(changed >> (8 * std::countr_zero(left)) & 0xff, 8);
    }
    putPlanes<Number>(out, code, parameter,
                      isMask ? std::span(less.data(), count) : std::span<Number>(all));
}

template <typename Leaf>
void putBlock(const Leaf& leaf, RiceCode code, BitWriter& out) {
    using Number = std::make_unsigned_t<typename Leaf::ValueType>;
    for (openvdb::Index s = 0; s < 8; ++s) {
        const auto changed = leaf.getValueMask().template getWord<std::uint64_t>(s);
        if (changed == 0) {
            out.put(0, 1);
        } else {
            putSlice(changed, reinterpret_cast<const Number*>(leaf.buffer().data()) + 64 * s, code,
                     out);
        }
    }
}

// Positions of blocks in slabs, u and v, counted from the box's first block.
class Places {
  public:
    explicit Places(const DeltaHeader& header)
        : first_(toSliceOrder(header.box.min, header.sliceAxis) >> 3),
          blocksPerSlab_(header.keyInterval / 8) {}

    template <typename Leaf>
    glm::ivec3 columnOf(const Leaf& leaf) const {
        const glm::ivec3 block = blockAt(leaf.origin()) - first_;
        return {block.x / blocksPerSlab_, block.y, block.z};
    }
    int firstBlockOf(const glm::ivec3& column) const {
        return first_.x + column.x * blocksPerSlab_;
    }

  private:
    glm::ivec3 first_;
    int blocksPerSlab_;
};

template <typename Leaf>
BitWriter packColumn(std::span<const Leaf* const> leaves, int firstBlock, RiceCode code) {
    BitWriter out;
    out.putNumber(leaves.size() - 1);
    int next = firstBlock;
    for (const Leaf* const leaf : leaves) {
        const int block = leaf->origin().x() >> 3;
        out.putNumber(std::uint64_t(block - next));
        putBlock(*leaf, code, out);
        next = block + 1;
    }
    return out;
}

// Writes a column's place relative to the column before, and its length.
void putColumn(const glm::ivec3& column, glm::ivec3& before, std::size_t words, BitWriter& out) {
    if (column.x != before.x) before = {before.x, 0, -1};
    if (column.y != before.y) before.z = -1;
    out.putNumber(std::uint64_t(column.x - before.x));
    out.putNumber(std::uint64_t(column.y - before.y));
    out.putNumber(std::uint64_t(column.z - before.z - 1));
    out.putNumber(words - 1);
    before = column;
}

template <typename Tree>
std::vector<std::uint64_t> wordsOf(const Tree& deltas, const DeltaHeader& header) {
    using Leaf = typename Tree::LeafNodeType;
    const Places places(header);
    const RiceCode code{deltaWidth(header)};
    std::vector<const Leaf*> leaves;
    deltas.getNodes(leaves);
    std::erase_if(leaves, [](const Leaf* leaf) { return leaf->isEmpty(); });
    std::sort(leaves.begin(), leaves.end(), [&](const Leaf* a, const Leaf* b) {
        const glm::ivec3 p = places.columnOf(*a), q = places.columnOf(*b);
        return std::tuple(p.x, p.y, p.z, a->origin().x()) <
               std::tuple(q.x, q.y, q.z, b->origin().x());
    });
    const std::vector<std::size_t> begins = runBegins(leaves, [&](const Leaf* a, const Leaf* b) {
        return places.columnOf(*a) == places.columnOf(*b);
    });
    const std::size_t count = begins.size() - 1;
    if (count == 0) return {};

    std::vector<BitWriter> columns(count);
    parallelForChunks(count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::span<const Leaf* const> own(&leaves[begins[i]], begins[i + 1] - begins[i]);
            columns[i] = packColumn<Leaf>(own, places.firstBlockOf(places.columnOf(*own[0])), code);
        }
    });
    std::optional<StreamCodes> codes;
    if constexpr (std::is_same_v<Tree, openvdb::Int32Tree>)
        codes = streamCodes(leaves, begins, header);
    const auto index = [&](const StreamCodes* known) {
        BitWriter out;
        out.putNumber(count);
        out.put(known ? 1 : 0, 1);
        glm::ivec3 before(0, 0, -1);
        for (std::size_t i = 0; i < count; ++i) {
            putColumn(places.columnOf(*leaves[begins[i]]), before, columns[i].words().size(), out);
            if (known) known->putRange(i, out);
        }
        if (known) {
            known->putHistogram(out);
            known->putBox({toSliceOrder(header.box.min, header.sliceAxis),
                           toSliceOrder(header.box.max, header.sliceAxis)},
                          out);
        }
        std::vector<std::uint64_t> words = out.words();
        if (known) words.push_back(streamSum(words.data(), words.size()));
        return words;
    };
    std::vector<std::uint64_t> words = index(nullptr);
    std::size_t packed = 0;
    for (const BitWriter& column : columns) packed += column.words().size();
    if (codes) {
        // Only if the file hardly grows.
        constexpr std::size_t kLeastShare = 50;
        std::vector<std::uint64_t> knowing = index(&*codes);
        if (knowing.size() <= words.size() + (words.size() + packed) / kLeastShare)
            words = std::move(knowing);
    }
    words.reserve(words.size() + packed);
    for (const BitWriter& column : columns)
        words.insert(words.end(), column.words().begin(), column.words().end());
    return words;
}

}  // namespace

std::vector<std::uint64_t> streamOf(const openvdb::TreeBase& deltas, const DeltaHeader& header) {
    if (deltas.isType<openvdb::Int64Tree>())
        return wordsOf(static_cast<const openvdb::Int64Tree&>(deltas), header);
    return wordsOf(static_cast<const openvdb::Int32Tree&>(deltas), header);
}

}  // namespace deltasplat
