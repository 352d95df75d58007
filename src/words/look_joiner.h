// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <span>
#include <vector>

#include "volume/code_math.h"
#include "words/look_palette.h"

namespace deltasplat {

/// How looks of several slices are joined.
struct LookRun {
    int slices = 2;            ///< that become one
    bool lastInFront = false;  ///< whether slices lie in front of those before them
    /// To how many bits the square root of a colour's channel is rounded, kLeastBits to kMostBits;
    /// opacity, or transmittance where that is less, to 2^(bits - 1) levels an octave.
    int bits = kMostBits;
    /// Voxels of what slices become, along u and along v, that become one: 1, 2 or 4. That looks
    /// like their mean.
    int within = 1;

    static constexpr int kMostBits = 10;
    static constexpr int kLeastBits = 2;

    bool operator==(const LookRun&) const = default;
};

/// Joins slices of classes of any colours, over steps of one length: numbers what voxels look like
/// one behind the other as it comes up. One class alone, however often it is there, is what it is
/// (unless voxels become one); others are rounded: to kMostBits to the nearest level, to fewer so
/// that the mean of many voxels stays what it is, to 0.0006 of the largest with 5 bits.
class LookJoiner {
  public:
    /// @param lights  of each class, premultiplied RGBA; the first, of what is empty, is 0
    LookJoiner(const std::vector<glm::dvec4>& lights, const LookRun& run);

    const LookRun& run() const { return run_; }
    /// As SliceJoiner::join.
    void join(std::span<const ClassIndex* const> slices, std::size_t pitch, std::size_t slice,
              ClassIndex* out, LookCache& cache) const;
    /// Returns what has come up so far: [number], colour, not multiplied by opacity, and opacity
    /// over a step. Not while others join.
    std::vector<glm::dvec4> looks() const;

    /// Whether more came up than there are numbers for: then what was joined is nothing.
    bool hasTooMany() const { return palette_->hasTooMany(); }
    /// How many have come up so far, but for those that are alone. Not while others join.
    std::size_t count() const { return palette_->count(); }
    /// Says that what is joined from now on is a sixteenth of all, from all over the volume: there
    /// are too many if this has many, unless looks have come up before. Not while others join.
    void beginSample() const;
    /// Says that all else follows. Of means, there are too many if so many would come up in all, as
    /// many more each time that what is joined doubles. Not while others join.
    /// @param ofHalf  what count() was when half of the sample had been joined
    void endSample(std::size_t ofHalf) const;
    /// Returns the same, rounded further, of which nothing has come up yet.
    LookJoiner coarser() const;

    /// Whether both have one numbering.
    bool operator==(const LookJoiner& other) const { return palette_ == other.palette_; }

  private:
    int opacityBits() const { return run_.bits - 1; }
    void joinPairs();

    LookRun run_;
    std::vector<glm::dvec4> lights_;  // [classes]
    using Rgba = std::array<float, 4>;
    std::vector<Rgba> rounded_;  // the same
    // [nearer][farther]: what two of them look like; null: they are too many for 16 bits.
    std::shared_ptr<const std::vector<Rgba>> pairs_;
    glm::dvec3 largest_{0.0};            // of each channel of colours
    std::array<float, 3> perLargest_{};  // 1 / that, 0 where it is 0
    // Classes that have numbers of their own where they are alone, for each time that they are
    // there: the first ones. 0: there are too many, or means are taken, and these are rounded as
    // well.
    std::size_t aloneClasses_ = 0;
    std::shared_ptr<LookPalette> palette_;
};

}  // namespace deltasplat
