// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "formats/delta/bit_reader.h"
#include "formats/delta/delta_columns.h"
#include "formats/delta/delta_format.h"
#include "formats/delta/delta_stream.h"
#include "formats/delta/plane_kernels.h"
#include "formats/delta/stream_index.h"

namespace deltasplat {

/// Goes over the blocks of a part of a stream, in the order of slices.
/// @tparam Number  std::int32_t, or std::int64_t where the header says so (deltaWidth)
template <typename Number>
class PartWalker {
  public:
    /// @param words  of the stream, with kStreamPadding behind them
    PartWalker(const std::uint64_t* words, const DeltaHeader& header)
        : words_(words),
          lastBlock_(toSliceOrder(header.box.max, header.sliceAxis).x >> 3),
          blocksPerSlab_(header.keyInterval / 8),
          code_{deltaWidth(header)},
          in_(words, 0) {}

    /// Goes to the first block; returns whether the part is sound so far.
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
    /// Returns the slice of the block that is next, divided by 8; of a damaged part, where that is.
    int block() const { return block_; }
    /// Returns the deltas of this block, until the next is taken, and goes on; null if the part is
    /// damaged.
    const BlockDeltasOf<Number>* take() {
        if (!takeBlock() || in_.position() > end_) return nullptr;
        ++block_;
        isDone_ = left_-- == 0;
        // Behind the last block less than a word is left.
        if (isDone_ ? in_.position() + 63 < end_ : !advance()) return nullptr;
        return &deltas_;
    }

  private:
    using Bits = std::make_unsigned_t<Number>;

    // Goes over the blocks without deltas.
    bool advance() {
        const std::uint64_t gap = in_.takeNumber();
        if (gap >= std::uint64_t(behind_ - block_)) return false;
        block_ += int(gap);
        return true;
    }

    // Returns whether it is a block with deltas: otherwise it is damaged.
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

    // Of the part in hand.
    BitReader in_;
    std::size_t end_ = 0;  // bits
    int block_ = 0;
    int behind_ = 0;          // no block of the part is this one
    std::uint64_t left_ = 0;  // blocks behind this one
    bool isDone_ = true;
    BlockDeltasOf<Number> deltas_;
    std::array<Bits, 512> numbers_;
};

}  // namespace deltasplat
