// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "deltasplat/render.h"

namespace deltasplat {

/// What is measured, in the order in which it is shown: the paper's baseline first.
inline constexpr std::array<Method, 4> kBenchMethods = {Method::kTraditional, Method::kSparse,
                                                        Method::kDelta, Method::kAuto};

/// Wall-clock seconds of something that was done several times.
struct Timing {
    double min = 0;
    double median = 0;  ///< of an even count the mean of the two in the middle
};

/// Returns the least and the median; zeros for no times at all.
Timing timingOf(std::vector<double> seconds);

/// All rounds of one method, the first left out.
struct MethodRuns {
    Method method = Method::kAuto;
    std::uint64_t stamps = 0;
    Timing prepare;
    Timing splat;
    Timing composite;
    Timing warp;
    Timing render;  ///< splat, composite, merge and warp
    /// Its first picture that is not, bit for bit, that of the run; empty, as promised: none.
    std::optional<Image> differs;

    /// Returns the median of splat over the stamps; 0 without stamps.
    double nanosecondsPerStamp() const;
};

/// How far two pictures are apart.
struct PictureDifference {
    double color = 0;  ///< largest absolute difference of a premultiplied colour channel
    double alpha = 0;
};

/// Returns the largest differences of two pictures of the same size.
PictureDifference differenceOf(const Image& a, const Image& b);

/// What a tolerance does to the picture.
struct ToleranceRuns {
    Tolerance tolerance;
    PictureDifference bound;     ///< proved; infinity: none is known
    PictureDifference measured;  ///< from the exact picture
    Image exact;                 ///< the picture without tolerance
    std::uint64_t exactDeltas = 0;
    std::uint64_t exactStamps = 0;  ///< of the method delta
};

/// The four methods side by side on one volume.
struct BenchRun {
    glm::ivec3 dims{0};
    int threads = 1;
    int repeats = 0;
    RenderStats stats;  ///< of `delta`; what it says about the volume holds for all methods
    std::array<MethodRuns, kBenchMethods.size()> methods;
    Timing prepare;            ///< all methods taken together, since all prepare alike
    Image picture;             ///< of the first method's first round
    bool identical = true;     ///< whether all methods gave the same bits in every round
    double maxDifference = 0;  ///< largest absolute difference of a channel from `picture`
    std::optional<ToleranceRuns> tolerance;

    const MethodRuns& of(Method method) const;
    /// Returns how many times as long as `b` the method `a` takes, by medians of `render`; NaN if
    /// `b` took no time.
    double speedup(Method a, Method b) const;
    /// Returns how alike consecutive slices are, 1 - deltas / voxels; 1 for an empty volume.
    double comparability() const;
};

/// Renders a volume by all methods, round by round, in an order that moves on by one from round to
/// round; the first round only warms up. With a tolerance, renders the exact picture once more.
/// Reports progress between pictures only, so that showing it takes none of the time measured.
/// @param options  its `method` is without effect
/// @param repeats  rounds that count, at least 1
/// @throw as render
BenchRun measureMethods(const Volume& volume, const RenderOptions& options, int repeats,
                        const Listener& listener = {});

}  // namespace deltasplat
