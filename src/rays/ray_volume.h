// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <vector>

#include "deltasplat/ingest/volume.h"
#include "rays/block_kernels.h"
#include "volume/code_blocks.h"

namespace deltasplat {

/// What blocks hold at most, in cells as large as a block or, where blocks lie far apart, a power
/// of two times that: lines of sight ask it what they need not read.
class TopGrid {
  public:
    TopGrid() = default;
    /// @param blocks  whose positions are (x, y, z)
    /// @param tops    of each block
    TopGrid(std::span<const CodeBlock> blocks, std::span<const float> tops);

    /// Returns the largest top of the blocks between two positions, or of more; -infinity where
    /// there are none.
    float topBetween(glm::ivec3 low, glm::ivec3 high) const;

  private:
    glm::ivec3 first_{0};  // in cells
    glm::ivec3 size_{0};
    int shift_ = 0;  // a cell has 2^shift_ blocks along each axis
    std::vector<float> tops_;
};

/// What is looked for along the lines of sight.
enum class RayRule {
    kSum,        ///< sums of values; where there is no active voxel there is 0
    kMax,        ///< the largest value that is met
    kMaxActive,  ///< likewise, but only active voxels take part in what is read
    kMean        ///< the mean of the active values that are met
};

inline bool isExtreme(RayRule rule) {
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

/// Reads the 512 values of a block in the order of a slice axis; of places that are not active
/// anything.
using BlockValues =
    std::function<void(const CodeBlock& block, int sliceAxis, const ValuePlace& place)>;

/// Along each axis the numbers of blocks, in order, at which there are any.
using LayerNumbers = std::array<std::vector<int>, 3>;

/// Lists where some blocks lie.
/// @param blockAt  returns each of `count`
LayerNumbers layersOf(std::size_t count,
                      const std::function<const CodeBlock&(std::size_t)>& blockAt);

/// A volume as rays see it: float values, in blocks that can be found.
struct RayVolume {
    IndexBox box;
    CodeValues values;
    /// Where codes are not exact and the source is at hand: reads that. Otherwise empty.
    BlockValues sourceValues;
    /// What voxels hold that are not active: 0, or under kMax the smallest value where that is
    /// negative, so that nothing never outshines something.
    float empty = 0;
    float lowest = 0;           ///< of the active voxels' values, as mapped
    float highest = 0;          ///< likewise
    std::uint64_t visible = 0;  ///< active voxels, under kSum but for those of value 0

    float valueOf(Code code) const {
        return values.direct ? float(code) + values.offset : table[code];
    }

    /// The blocks that matter, ordered by y, z and x; their positions are (x, y, z).
    std::vector<CodeBlock> blocks;
    /// What blocks hold at most, for largest values; else 0 where there is one.
    TopGrid tops;
    LayerNumbers layers;
    std::vector<float> table;  ///< [kCodeCount], unless values are direct
};

/// Lists what rays meet of a volume that is not empty. The volume must outlive what is returned.
RayVolume makeRayVolume(const Volume& volume, RayRule rule, const ValueMap& map = {});

/// Reads the values of some of a block's slices in the order of an axis, `[slice][u][v]`.
/// @param active  likewise 1 where a voxel is active, else 0; may be null
void readBlock(const RayVolume& volume, const CodeBlock& block, int axis, glm::ivec2 slices,
               float* values, float* active);

}  // namespace deltasplat
