// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <string>
#include <vector>

#include "deltasplat/ingest/volume.h"

namespace deltasplat {

/// Returns a place for messages: "(1, 2, 3)".
inline std::string placeText(const glm::ivec3& v) {
    return "(" + std::to_string(v.x) + ", " + std::to_string(v.y) + ", " + std::to_string(v.z) +
           ")";
}

/// Zigzag deltas (exact_slots.h) of 32 or 64 bits of a block of 8x8x8 voxels.
template <typename Number>
struct BlockDeltasOf {
    std::array<std::uint64_t, 8> changed;  ///< per slice: bit 8 u + v of each voxel with a delta
    /// Per slice: voxels with a number, which is 0 where `changed` has no bit.
    std::array<std::uint64_t, 8> given;
    const Number* numbers = nullptr;  ///< of the `given` voxels, by slice, u and v
};
using BlockDeltas = BlockDeltasOf<std::int32_t>;

/// Blocks with the same u and v.
struct DeltaColumn {
    glm::ivec2 place{0};    ///< u and v, divided by 8
    std::size_t begin = 0;  ///< range in the creator's own list
    std::size_t end = 0;
};

/// Visits the blocks of a column that have deltas, in the order of slices.
class DeltaWalker {
  public:
    static constexpr int kNoBlock = std::numeric_limits<int>::max();

    virtual ~DeltaWalker() = default;
    /// Goes to the first block. Returns whether the column is sound so far.
    virtual bool start(const DeltaColumn& column) = 0;
    /// Returns the next block's slice, divided by 8, or kNoBlock at the end.
    virtual int block() const = 0;
    /// Returns this block's deltas, valid until the next call, and advances; null for damage.
    virtual const BlockDeltas* take() = 0;
};

/// The blocks of one slab with the same u and v, and the codes that their deltas add up to.
struct DeltaPart {
    DeltaColumn column;
    int slab = 0;
    Code lowest = 0;  ///< of the active voxels
    Code highest = 0;
};

/// Statistics of a volume's codes.
struct CodesInUse {
    std::vector<std::uint64_t> histogram;  ///< as Volume::histogram
    IndexBox active;  ///< box of the active voxels, in the volume's index space
};

/// A file's own statement of the codes that its deltas add up to.
struct KnownCodes {
    std::vector<DeltaPart> parts;  ///< parts with deltas, by u, v and slab
    CodesInUse all;
};

}  // namespace deltasplat
