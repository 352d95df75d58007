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

/// Largest values per cell, of a block or a power of two of scattered ones, for skipping.
class TopGrid {
  public:
    TopGrid() = default;
    /// @param blocks  with positions (x, y, z)
    /// @param tops    one per block
    TopGrid(std::span<const CodeBlock> blocks, std::span<const float> tops);

    /// Returns the largest top between two positions, or beyond; -infinity without blocks.
    float topBetween(glm::ivec3 low, glm::ivec3 high) const;

  private:
    glm::ivec3 first_{0};  // in cells
    glm::ivec3 size_{0};
    int shift_ = 0;  // a cell has 2^shift_ blocks per side
    std::vector<float> tops_;
};

/// The result of a line of sight.
enum class RayRule {
    kSum,        ///< sums of values; inactive voxels are 0
    kMax,        ///< the largest value met
    kMaxActive,  ///< likewise, read from active voxels only
    kMean        ///< the mean of the active values met
};

inline bool isExtreme(RayRule rule) {
    return rule == RayRule::kMax || rule == RayRule::kMaxActive;
}

struct ValueMap {
    double scale = 1;
    double offset = 0;
    double least = -std::numeric_limits<double>::infinity();

    double operator()(double value) const { return std::max(scale * value + offset, least); }
    bool operator==(const ValueMap&) const = default;
};

/// Values are clamped to this: hardly any reaches it, and differences of two stay finite.
inline constexpr double kLargestRayValue = double(std::numeric_limits<float>::max()) / 4;

/// Reads the 512 values of a block in the order of a slice axis; inactive voxels get any value.
using BlockValues =
    std::function<void(const CodeBlock& block, int sliceAxis, const ValuePlace& place)>;

/// Per axis, the numbers of layers that have blocks, in order.
using LayerNumbers = std::array<std::vector<int>, 3>;

/// Lists the layers of `count` blocks.
LayerNumbers layersOf(std::size_t count,
                      const std::function<const CodeBlock&(std::size_t)>& blockAt);

/// A volume as seen by rays: float values in indexed blocks.
struct RayVolume {
    IndexBox box;
    CodeValues values;
    /// Reads the source where codes are not exact and it is kept; else empty.
    BlockValues sourceValues;
    /// Value of inactive voxels: 0, or for kMax the smallest value if negative, so that emptiness
    /// never outshines a value.
    float empty = 0;
    float lowest = 0;           ///< of the active voxels' mapped values
    float highest = 0;          ///< likewise
    std::uint64_t visible = 0;  ///< active voxels; for kSum without value 0

    float valueOf(Code code) const {
        return values.direct ? float(code) + values.offset : table[code];
    }

    /// The blocks that matter, ordered by y, z and x, with positions (x, y, z).
    std::vector<CodeBlock> blocks;
    /// For largest values; for other rules 0 where there is a block.
    TopGrid tops;
    LayerNumbers layers;
    std::vector<float> table;  ///< [kCodeCount], unless values are direct
};

/// Lists what rays meet of a volume that is not empty. The volume must outlive the result.
RayVolume makeRayVolume(const Volume& volume, RayRule rule, const ValueMap& map = {});

/// Reads some slices of a block in the order of an axis, `[slice][u][v]`.
/// @param active  likewise 1 where a voxel is active, else 0; may be null
void readBlock(const RayVolume& volume, const CodeBlock& block, int axis, glm::ivec2 slices,
               float* values, float* active);

}  // namespace deltasplat
