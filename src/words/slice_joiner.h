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

/// Joins consecutive slices to one and gives classes to its voxels.
class SliceJoiner {
  public:
    /// Joins two slices of 256 classes at most to pair numbers, `first * classCount + second`.
    static SliceJoiner ofPairs(std::size_t classCount);
    /// Joins classes that differ only in absorption, to the level (levels()) nearest to the sum.
    /// @param extinctions  [class], infinite if opaque; the first class is empty and 0
    /// @param slices       number of slices that are joined
    static SliceJoiner ofSums(const std::vector<double>& extinctions, int slices = 2);
    /// Joins classes of any colours, for one step length.
    /// @param lights  as for LookJoiner
    static SliceJoiner ofLooks(const std::vector<glm::dvec4>& lights, const LookRun& run);

    /// Extinctions of summed classes; the first is 0. Within 2^-11, down to 2^-58 of the largest.
    std::vector<double> levels() const;
    /// The joiner of looks, if there is one.
    std::optional<LookJoiner>& looks() { return looks_; }
    const std::optional<LookJoiner>& looks() const { return looks_; }
    /// Whether looks exceeded the numbers. Then all results are invalid.
    bool hasTooManyLooks() const { return looks_ && looks_->hasTooMany(); }

    /// Joins the voxels of consecutive slices to 8x8 voxels.
    /// @param slices  first voxel in each slice; of more than two, empty pairs may be left out
    /// @param pitch   distance of rows
    /// @param slice   index of the result in its block: 0 to 7
    /// @param out     [64]
    /// @param cache   one per caller, for all of its joins
    void join(std::span<const ClassIndex* const> slices, std::size_t pitch, std::size_t slice,
              ClassIndex* out, LookCache& cache) const;

    /// Whether both give the same numbers to the same classes. Looks must share one numbering.
    bool operator==(const SliceJoiner&) const = default;

  private:
    SliceJoiner() = default;

    std::size_t classCount_ = 0;  // for pairs
    // For sums: extinctions in a unit that makes the largest finite one 1/2 to 1.
    std::vector<float> shares_;
    double unit_ = 1;
    std::int32_t first_ = 0;  // as in SumLevels
    std::int32_t count_ = 0;
    bool hasOpaque_ = false;
    std::optional<LookJoiner> looks_;
};

}  // namespace deltasplat
