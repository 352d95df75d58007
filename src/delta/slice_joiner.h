// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec4.hpp>
#include <memory>
#include <span>
#include <vector>

#include "delta/class_index.h"
#include "delta/look_palette.h"

namespace deltasplat {

/// How looks of several slices are joined.
struct LookRun {
    int slices = 2;            ///< that become one
    bool lastInFront = false;  ///< whether slices lie in front of those before them
    /// To how many bits the square root of a colour's channel is rounded, 2 to kMostBits; opacity,
    /// or transmittance where that is less, to 2^(bits - 3) levels an octave.
    int bits = kMostBits;

    static constexpr int kMostBits = 7;

    bool operator==(const LookRun&) const = default;
};

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
    /// Of classes of any colours, over steps of one length: what they look like one behind the
    /// other, numbered as it comes up (looks()). One class alone, however often it is there, is
    /// what it is; others are rounded.
    /// @param lights  of each class, premultiplied RGBA; the first, of what is empty, is 0
    static SliceJoiner ofLooks(const std::vector<glm::dvec4>& lights, const LookRun& run);

    /// Of sums, the extinctions that classes have once they are joined, the first of them 0. Each
    /// is within 2^-11 of what it stands for, down to 2^-58 of the largest.
    std::vector<double> levels() const;
    bool isOfLooks() const { return palette_ != nullptr; }
    const LookRun& run() const { return run_; }
    /// Of looks, whether more came up than there are numbers for: then what was joined is nothing.
    bool hasTooMany() const { return palette_ && palette_->hasTooMany(); }
    /// Of looks, what has come up so far: [number], colour, not multiplied by opacity, and opacity
    /// over a step. Not while others join.
    std::vector<glm::dvec4> looks() const;

    /// Joins 8x8 voxels of slices that lie one behind the other.
    /// @param slices  the first of them in each
    /// @param pitch   from row to row of them
    /// @param out     [64]
    /// @param cache   the caller's own, for all that it joins
    void join(std::span<const ClassIndex* const> slices, std::size_t pitch, ClassIndex* out,
              LookCache& cache) const;

    /// Whether both give the same numbers to the same classes.
    bool operator==(const SliceJoiner&) const = default;

  private:
    SliceJoiner() = default;
    void joinLooks(std::span<const ClassIndex* const> slices, std::size_t pitch, ClassIndex* out,
                   LookCache& cache) const;

    std::size_t classCount_ = 0;  // of pairs
    // Of sums: extinctions, in units that the largest, if not infinite, is 1/2 to 1 of.
    std::vector<float> shares_;
    double unit_ = 1;
    std::int32_t first_ = 0;  // as SumLevels has it
    std::int32_t count_ = 0;
    bool hasOpaque_ = false;
    int opacityBits() const;
    std::vector<double> channelLevels(std::size_t channel) const;

    // Of looks:
    LookRun run_;
    std::vector<std::array<float, 4>> lights_;  // [classes]
    std::array<double, 3> largest_{};           // of each channel of colours
    // Classes that have numbers of their own where they are alone, for each time that they are
    // there: the first ones. 0: there are too many, and these are rounded as well.
    std::size_t aloneClasses_ = 0;
    std::shared_ptr<LookPalette> palette_;
};

}  // namespace deltasplat
