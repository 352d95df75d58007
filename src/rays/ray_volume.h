// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "delta/code_blocks.h"
#include "deltasplat/ingest/volume.h"
#include "rays/ray_kernels.h"

namespace deltasplat {

/// What is looked for along the lines of sight.
enum class RayRule {
    kSum,        ///< sums of values; where there is no active voxel there is 0
    kMax,        ///< the largest value that is met
    kMaxActive,  ///< likewise, but only active voxels take part in what is read
    kMean        ///< the mean of the active values that are met; only from an eye
};

/// Whether a rule keeps the largest of what slices give, in place of adding them up.
constexpr bool keepsLargest(RayRule rule) {
    return rule == RayRule::kMax || rule == RayRule::kMaxActive;
}

/// What rays meet in place of a value.
struct ValueMap {
    double scale = 1;
    double offset = 0;
    double least = -std::numeric_limits<double>::infinity();

    double operator()(double value) const { return std::max(scale * value + offset, least); }
    bool operator==(const ValueMap&) const = default;
};

/// So large that hardly a volume has it, and so small that differences of two are finite floats:
/// what is beyond is taken for it.
inline constexpr double kLargestRayValue = double(std::numeric_limits<float>::max()) / 4;

/// Reads the 512 values of a block in (slice, u, v) order; of places that are not active anything.
using BlockValues = std::function<void(const CodeBlock& block, const BlockPlace& place)>;

/// A volume as rays see it: float values, in blocks ordered by slice.
struct RayVolume {
    IndexBox box;  ///< in (slice, u, v) order
    int sliceAxis = 2;
    CodeValues values;
    /// Where codes are not exact and the source is at hand: reads that. Otherwise empty.
    BlockValues sourceValues;
    /// What voxels hold that are not active: 0, or under kMax the smallest value where that is
    /// negative, so that nothing never outshines something; NaN under kMaxActive.
    float empty = 0;
    float lowest = 0;           ///< of the active voxels' values, as mapped
    float highest = 0;          ///< likewise
    std::uint64_t visible = 0;  ///< active voxels, under kSum but for those of value 0

    /// The blocks that matter of 8 slices from 8 * layer on, ordered by u, then v.
    std::span<const CodeBlock> layer(int layer) const {
        const auto i = std::size_t(layer - (box.min.x >> 3));
        return std::span(blocks).subspan(begins[i], begins[i + 1] - begins[i]);
    }

    float valueOf(Code code) const {
        return values.direct ? float(code) + values.offset : table[code];
    }

    std::vector<CodeBlock> blocks;
    std::vector<std::size_t> begins;  ///< [layers + 1]: the first of each layer's blocks
    std::vector<float> table;         ///< [kCodeCount], unless values are direct
};

/// Lists what rays meet of a volume that is not empty. The volume must outlive what is returned.
RayVolume makeRayVolume(const Volume& volume, int sliceAxis, RayRule rule,
                        const ValueMap& map = {});

}  // namespace deltasplat
