// SPDX-License-Identifier: Apache-2.0
#include "formats/delta/delta_stream.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/memory.h"
#include "base/parallel.h"
#include "deltasplat/error.h"
#include "deltasplat/ingest/slot.h"
#include "formats/delta/bit_reader.h"
#include "formats/delta/delta_columns.h"
#include "formats/delta/delta_format.h"
#include "formats/delta/plane_kernels.h"
#include "formats/delta/stream_index.h"
#include "formats/delta/word_tree.h"
#include "volume/leaf_slices.h"

namespace deltasplat {

namespace {

/// Visits a part's blocks as DeltaWalker does. Number is std::int64_t for wide deltas (deltaWidth).
template <typename Number>
class PartWalker {
  public:
    /// @param words  of the stream, followed by kStreamPadding
    PartWalker(const std::uint64_t* words, const DeltaHeader& header)
        : words_(words),
          lastBlock_(toSliceOrder(header.box.max, header.sliceAxis).x >> 3),
          blocksPerSlab_(header.keyInterval / 8),
          code_{deltaWidth(header)},
          in_(words, 0) {}

    bool start(const StreamPart& part) {
        in_ = BitReader(words_, 64 * part.begin);
        end_ = 64 * part.end;
        block_ = part.first.x;
        behind_ = std::min(lastBlock_ + 1, block_ + blocksPerSlab_);
        left_ = in_.takeNumber();
        isDone_ = false;
        return advance();
    }
    bool isDone() const { return isDone_; }
    /// Returns the next block's slice, divided by 8; in a damaged part, the damaged place.
    int block() const { return block_; }
    const BlockDeltasOf<Number>* take() {
        if (!takeBlock() || in_.position() > end_) return nullptr;
        ++block_;
        isDone_ = left_-- == 0;
        // The last block is followed by less than a word.
        if (isDone_ ? in_.position() + 63 < end_ : !advance()) return nullptr;
        return &deltas_;
    }

  private:
    using Bits = std::make_unsigned_t<Number>;

    // Skips the blocks without deltas.
    bool advance() {
        const std::uint64_t gap = in_.takeNumber();
        if (gap >= std::uint64_t(behind_ - block_)) return false;
        block_ += int(gap);
        return true;
    }

    // Returns whether the block has deltas; otherwise it is damaged.
    bool takeBlock() {
        Bits* numbers = numbers_.data();
        std::uint64_t any = 0;
        for (std::size_t s = 0; s < 8; ++s) {
            deltas_.changed[s] = deltas_.given[s] = 0;
            if (in_.take(1) == 0) continue;
            const auto form = SliceForm(in_.take(2));
            const auto parameter = int(in_.take(code_.parameterBits()));
            if (parameter >= code_.width) return false;
            if (form == SliceForm::kAll) {
                deltas_.given[s] = ~std::uint64_t{0};
                deltas_.changed[s] = takePlanes(in_, code_, parameter, 64, numbers);
            } else if (form == SliceForm::kMask || form == SliceForm::kRows) {
                const std::uint64_t mask = form == SliceForm::kMask ? in_.take(64) : takeRows();
                const auto count = std::size_t(std::popcount(mask));
                if (count > 0) takePlanes(in_, code_, parameter, count, numbers);
                for (std::size_t i = 0; i < count; ++i) ++numbers[i];
                deltas_.given[s] = deltas_.changed[s] = mask;
            } else {
                return false;
            }
            numbers += std::popcount(deltas_.given[s]);
            any |= deltas_.changed[s];
        }
        deltas_.numbers = reinterpret_cast<const Number*>(numbers_.data());
        return any != 0;
    }

    std::uint64_t takeRows() {
        std::uint64_t changed = 0;
        for (std::uint64_t rows = in_.take(8); rows != 0; rows &= rows - 1)
            changed |= in_.take(8) << (8 * std::countr_zero(rows));
        return changed;
    }

    const std::uint64_t* words_;
    int lastBlock_;
    int blocksPerSlab_;
    RiceCode code_;

    // State of the current part.
    BitReader in_;
    std::size_t end_ = 0;  // bits
    int block_ = 0;
    int behind_ = 0;          // first block outside of the part
    std::uint64_t left_ = 0;  // blocks left behind this one
    bool isDone_ = true;
    BlockDeltasOf<Number> deltas_;
    std::array<Bits, 512> numbers_;
};

template <typename Leaf>
void fillLeaf(const BlockDeltasOf<typename Leaf::ValueType>& deltas, Leaf& leaf) {
    typename Leaf::NodeMaskType mask;
    auto* const values = leaf.buffer().data();
    const auto* next = deltas.numbers;
    for (openvdb::Index s = 0; s < 8; ++s) {
        for (std::uint64_t given = deltas.given[s]; given != 0; given &= given - 1)
            values[64 * s + openvdb::Index(std::countr_zero(given))] = *next++;
        mask.template getWord<std::uint64_t>(s) = deltas.changed[s];
    }
    leaf.setValueMask(mask);
}

class StreamUnpacker {
  public:
    StreamUnpacker(const openvdb::Int64Tree& tree, const DeltaHeader& header,
                   const std::string& where)
        : header_(header), where_(where), words_(wordsOfTree(tree, kStreamPadding, where)) {
        const std::size_t count = words_.size() - kStreamPadding;
        if (count > 0) index_ = readStreamIndex(words_.data(), count, header, where);
    }

    const StreamIndex& index() const { return index_; }

    template <typename Tree>
    std::shared_ptr<Tree> takeDeltas(const Listener& listener) const;

  private:
    template <typename Leaf>
    using Leaves = std::vector<std::unique_ptr<Leaf>>;

    template <typename Leaf>
    Leaves<Leaf> takePart(const StreamPart& part) const;

    const DeltaHeader& header_;
    const std::string& where_;
    std::vector<std::uint64_t> words_;
    StreamIndex index_;
};

template <typename Leaf>
StreamUnpacker::Leaves<Leaf> StreamUnpacker::takePart(const StreamPart& part) const {
    PartWalker<typename Leaf::ValueType> walker(words_.data(), header_);
    const auto damaged = [&] {
        const glm::ivec3 place = 8 * glm::ivec3(walker.block(), part.first.y, part.first.z);
        throw Error(ErrorCode::kInput, where_, "a damaged stream at " + placeText(place),
                    "blocks one behind the other");
    };
    if (!walker.start(part)) damaged();
    Leaves<Leaf> leaves;
    while (!walker.isDone()) {
        const openvdb::Coord origin(8 * walker.block(), 8 * part.first.y, 8 * part.first.z);
        const auto* const deltas = walker.take();
        if (!deltas) damaged();
        leaves.push_back(std::make_unique<Leaf>(origin, 0, false));
        fillLeaf(*deltas, *leaves.back());
    }
    return leaves;
}

template <typename Tree>
std::shared_ptr<Tree> StreamUnpacker::takeDeltas(const Listener& listener) const {
    using Leaf = typename Tree::LeafNodeType;
    const std::vector<StreamPart>& parts = index_.parts;
    requireMemory(where_, double(countBlocks(words_.data(), parts)) * leafBytes<Leaf>());
    auto tree = std::make_shared<Tree>(0);
    openvdb::tree::ValueAccessor<Tree> accessor(*tree);
    // Portions limit the leaves that are in no tree yet.
    constexpr std::size_t kPortion = 2048;
    for (std::size_t begin = 0; begin < parts.size(); begin += kPortion) {
        const std::size_t count = std::min(kPortion, parts.size() - begin);
        std::vector<Leaves<Leaf>> taken(count);
        parallelForChunks(count, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) taken[i] = takePart<Leaf>(parts[begin + i]);
        });
        for (Leaves<Leaf>& part : taken) {
            for (auto& leaf : part) accessor.addLeaf(leaf.release());
        }
        listener.report(double(begin + count) / double(parts.size()));
    }
    return tree;
}

}  // namespace

UnpackedDeltas unpackDeltas(const TreeGrid& grid, const DeltaHeader& header,
                            const std::string& where, const Listener& listener) {
    const StreamUnpacker unpacker(*grid.as<openvdb::Int64Tree>(), header, where);
    UnpackedDeltas deltas{{nullptr, grid.metadata, grid.map}, codesInUse(unpacker.index(), header)};
    if (header.isWide()) {
        deltas.grid.tree = unpacker.takeDeltas<openvdb::Int64Tree>(listener);
    } else {
        deltas.grid.tree = unpacker.takeDeltas<openvdb::Int32Tree>(listener);
    }
    return deltas;
}

int deltaWidth(const DeltaHeader& header) {
    if (header.exact) return *header.exact == ExactValues::kFloat32 ? 32 : 64;
    const std::size_t inactive = header.inactiveValues.size();
    const std::size_t largest =
        inactive > 0 ? std::size_t(kCodeCount) + inactive : std::size_t(header.codeCount);
    return int(std::bit_width(2 * largest));
}

namespace {

class StreamWalker : public DeltaWalker {
  public:
    StreamWalker(const std::uint64_t* words, const std::vector<StreamPart>& parts,
                 const DeltaHeader& header)
        : parts_(parts), part_(words, header) {}

    bool start(const DeltaColumn& column) override {
        next_ = column.begin;
        end_ = column.end;
        return goOn();
    }
    int block() const override { return isDone_ ? kNoBlock : part_.block(); }
    const BlockDeltas* take() override {
        const BlockDeltas* const deltas = part_.take();
        if (deltas && part_.isDone() && !goOn()) return nullptr;
        return deltas;
    }

  private:
    // Goes to the next part. Returns whether it is sound so far.
    bool goOn() {
        isDone_ = next_ == end_;
        return isDone_ || part_.start(parts_[next_++]);
    }

    const std::vector<StreamPart>& parts_;
    std::size_t next_ = 0;
    std::size_t end_ = 0;
    bool isDone_ = true;
    PartWalker<std::int32_t> part_;
};

}  // namespace

StreamColumns::StreamColumns(UnclearedVector<std::uint64_t> words, StreamIndex index,
                             const DeltaHeader& header)
    : header_(&header), words_(std::move(words)), parts_(std::move(index.parts)) {
    columns_ = orderByColumns(parts_, [](const StreamPart& part) { return part.first; });
    blocks_ = countBlocks(words_.data(), parts_);
    if (index.histogram.empty()) return;
    knownCodes_.emplace();
    knownCodes_->all = codesInUse(index, header);
    knownCodes_->parts.reserve(parts_.size());
    const int first = toSliceOrder(header.box.min, header.sliceAxis).x >> 3;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        const StreamPart& part = parts_[i];
        const glm::ivec2 place(part.first.y, part.first.z);
        const int slab = (part.first.x - first) / (header.keyInterval / 8);
        knownCodes_->parts.push_back({{place, i, i + 1}, slab, part.lowest, part.highest});
    }
}

std::optional<StreamColumns> StreamColumns::read(const VdbLeaves& leaves, const DeltaHeader& header,
                                                 const std::string& where) {
    const std::optional<std::size_t> count = countWords(leaves);
    if (!count) return std::nullopt;
    auto words = wordsOfLeaves(leaves, *count, kStreamPadding, where);
    if (!words) return std::nullopt;
    StreamIndex index;
    if (*count > 0) index = readStreamIndex(words->data(), *count, header, where);
    requireMemory(where, double(index.parts.size()) * (sizeof(DeltaColumn) + sizeof(DeltaPart)));
    return StreamColumns(std::move(*words), std::move(index), header);
}

std::unique_ptr<DeltaWalker> StreamColumns::walker() const {
    return std::make_unique<StreamWalker>(words_.data(), parts_, *header_);
}

}  // namespace deltasplat
