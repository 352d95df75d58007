// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec4.hpp>
#include <optional>
#include <span>
#include <vector>

#include "volume/code_math.h"
#include "words/look_joiner.h"

namespace deltasplat {

/// Joins slices that lie one behind the other to one: what the classes of their voxels become.
class SliceJoiner {
  public:
    /// Of two slices, of classes 0..classCount - 1, at most 256: the pair's number, `first *
    /// classCount + second`.
    static SliceJoiner ofPairs(std::size_t classCount);
    /// Of classes that differ in nothing but how much light they absorb: the level (levels()) that
    /// is nearest to what all absorb.
    /// @param extinctions  of each class, infinite if opaque; the first, of what is empty, is 0
    /// @param slices       that become one
    static SliceJoiner ofSums(const std::vector<double>& extinctions, int slices = 2);
    /// Of classes of any colours, over steps of one length.
    /// @param lights  as LookJoiner takes them
    static SliceJoiner ofLooks(const std::vector<glm::dvec4>& lights, const LookRun& run);

    /// Of sums, the extinctions that classes have once they are joined, the first of them 0. Each
    /// is within 2^-11 of what it stands for, down to 2^-58 of the largest.
    std::vector<double> levels() const;
    /// What joins looks; empty: pairs or sums are joined.
    std::optional<LookJoiner>& looks() { return looks_; }
    const std::optional<LookJoiner>& looks() const { return looks_; }
    /// Whether more looks came up than there are numbers for: then what was joined is nothing.
    bool hasTooManyLooks() const { return looks_ && looks_->hasTooMany(); }

    /// Joins voxels of slices that lie one behind the other, as many as become 8x8.
    /// @param slices  the first of them in each; of more than two, pairs may be left out in which
    ///                nothing is seen
    /// @param pitch   from row to row of them
    /// @param slice   the place of what they become among the slices of its block: 0 to 7
    /// @param out     [64]
    /// @param cache   the caller's own, for all that it joins
    void join(std::span<const ClassIndex* const> slices, std::size_t pitch, std::size_t slice,
              ClassIndex* out, LookCache& cache) const;

    /// Whether both give the same numbers to the same classes: of looks, only if they have one
    /// numbering.
    bool operator==(const SliceJoiner&) const = default;

  private:
    SliceJoiner() = default;

    std::size_t classCount_ = 0;  // of pairs
    // Of sums: extinctions, in units that the largest, if not infinite, is 1/2 to 1 of.
    std::vector<float> shares_;
    double unit_ = 1;
    std::int32_t first_ = 0;  // as SumLevels has it
    std::int32_t count_ = 0;
    bool hasOpaque_ = false;
    std::optional<LookJoiner> looks_;
};

}  // namespace deltasplat
