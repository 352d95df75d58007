// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <vector>

#include "splat/word_colors.h"

namespace deltasplat {

/// The words of a slice that are seen as something of their own, lit when they are first asked for
/// and kept until the next slice. Not for several threads at once.
class LitSlice {
  public:
    /// @param colors  must outlive the slice, as `deltas`
    LitSlice(const PackedDeltas& deltas, const WordColors& colors)
        : deltas_(deltas), colors_(colors) {}

    /// Takes on a slice, unless it is in hand.
    void begin(int slice);
    /// Returns what a word of the slice looks like on a plane; valid until the next slice.
    /// @param word  its number among all words
    const LitWord& of(std::size_t word, int plane);

    /// Bytes that it takes at most if a slice has so many words.
    static double bytes(double words, int planes) { return sizeof(LitWord) * words * planes; }

  private:
    static constexpr std::uint32_t kUnlit = 0xFFFFFFFF;

    const PackedDeltas& deltas_;
    const WordColors& colors_;
    int slice_ = 0;
    bool hasSlice_ = false;
    std::size_t first_ = 0;               // word of the slice
    std::vector<std::uint32_t> placeOf_;  // [words of the slice]: in lit_, or kUnlit
    std::deque<LitWord> lit_;             // [lit words][planes]; deques move nothing
    std::size_t used_ = 0;
};

}  // namespace deltasplat
