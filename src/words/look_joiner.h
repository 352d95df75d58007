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

/// Parameters of joining looks.
struct LookRun {
    int slices = 2;            ///< number of slices joined to one
    bool lastInFront = false;  ///< each slice lies in front of the previous one
    /// Square roots of colour channels are rounded to this many bits, kLeastBits to kMostBits. The
    /// smaller of opacity and transmittance is rounded to 2^(bits - 1) levels per octave.
    int bits = kMostBits;
    /// Number of joined voxels that then become their mean look, along u and along v: 1, 2 or 4.
    int within = 1;

    static constexpr int kMostBits = 10;
    static constexpr int kLeastBits = 2;

    bool operator==(const LookRun&) const = default;
};

/// Joins slices of classes of any colours, for one step length, and numbers the joined looks as
/// they occur. A voxel with only one class in its slices keeps its exact look (unless neighbouring
/// voxels are joined). Other looks are rounded: with kMostBits to the nearest level, with fewer
/// bits so that the mean of many voxels is kept, to 0.0006 of the largest with 5 bits.
class LookJoiner {
  public:
    /// @param lights  [class]: premultiplied RGBA; the first class is empty and 0
    LookJoiner(const std::vector<glm::dvec4>& lights, const LookRun& run);

    const LookRun& run() const { return run_; }
    /// As SliceJoiner::join.
    void join(std::span<const ClassIndex* const> slices, std::size_t pitch, std::size_t slice,
              ClassIndex* out, LookCache& cache) const;
    /// Returns the looks so far, [number]: straight colour, opacity over a step. Not during joins.
    std::vector<glm::dvec4> looks() const;

    /// Whether looks exceeded the numbers. Then all results are invalid.
    bool hasTooMany() const { return palette_->hasTooMany(); }
    /// Number of looks so far, without single classes. Not while others join.
    std::size_t count() const { return palette_->count(); }
    /// Announces a sample: a sixteenth of all joins, from all over the volume. If there are no
    /// looks yet, it may use a third of the numbers. Not while others join.
    void beginSample() const;
    /// Announces the rest. If voxels within slices are joined, too many looks are reported if the
    /// growth within the sample foretells more than there are numbers. Not while others join.
    /// @param ofHalf  count() after half of the sample
    void endSample(std::size_t ofHalf) const;
    /// Returns a joiner with coarser rounding and no looks so far.
    LookJoiner coarser() const;

    /// Whether both share one numbering.
    bool operator==(const LookJoiner& other) const { return palette_ == other.palette_; }

  private:
    int opacityBits() const { return run_.bits - 1; }
    void joinPairs();

    LookRun run_;
    std::vector<glm::dvec4> lights_;  // [classes]
    using Rgba = std::array<float, 4>;
    std::vector<Rgba> rounded_;  // lights_ as floats
    // [nearer][farther]: looks of pairs; null if pairs do not fit into 16 bits.
    std::shared_ptr<const std::vector<Rgba>> pairs_;
    glm::dvec3 largest_{0.0};            // per colour channel
    std::array<float, 3> perLargest_{};  // 1 / largest_, or 0
    // Number of classes with exact looks, one per count of slices. They have the first numbers. 0
    // if there are too many of them or voxels are averaged: then they are rounded as well.
    std::size_t aloneClasses_ = 0;
    std::shared_ptr<LookPalette> palette_;
};

}  // namespace deltasplat
