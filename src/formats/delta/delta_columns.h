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

/// Returns a place as messages have it: "(1, 2, 3)".
inline std::string placeText(const glm::ivec3& v) {
    return "(" + std::to_string(v.x) + ", " + std::to_string(v.y) + ", " + std::to_string(v.z) +
           ")";
}

/// Deltas of a block of 8x8x8 voxels, as numbers without sign (zigzag.h).
/// @tparam Number  of 32 or 64 bits
template <typename Number>
struct BlockDeltasOf {
    std::array<std::uint64_t, 8> changed;  ///< by slice: bit 8 u + v of each voxel with a delta
    /// Likewise those that have a number: others than `changed` have 0.
    std::array<std::uint64_t, 8> given;
    const Number* numbers = nullptr;  ///< of those given, by slice, u and v
};
using BlockDeltas = BlockDeltasOf<std::int32_t>;

/// Blocks with the same u and v.
struct DeltaColumn {
    glm::ivec2 place{0};    ///< u and v, divided by 8
    std::size_t begin = 0;  ///< of what it is made of: who has it knows what that is
    std::size_t end = 0;
};

/// Goes over the blocks of a column that have deltas, in the order of slices.
class DeltaWalker {
  public:
    static constexpr int kNoBlock = std::numeric_limits<int>::max();

    virtual ~DeltaWalker() = default;
    /// Goes to the first block; returns whether the column is sound so far.
    virtual bool start(const DeltaColumn& column) = 0;
    /// Returns the slice of the next block, divided by 8; kNoBlock behind the last.
    virtual int block() const = 0;
    /// Returns its deltas, until the next is taken, and goes on; null if they are damaged.
    virtual const BlockDeltas* take() = 0;
};

/// The blocks of one slab with the same u and v, and which codes their deltas add up to.
struct DeltaPart {
    DeltaColumn column;
    int slab = 0;
    Code lowest = 0;  ///< of the active voxels
    Code highest = 0;
};

/// Which codes the voxels of a volume have, and where these are.
struct CodesInUse {
    std::vector<std::uint64_t> histogram;  ///< as Volume::histogram
    IndexBox active;  ///< box of the active voxels, in the volume's index space
};

/// What a file says of the codes that its deltas add up to.
struct KnownCodes {
    std::vector<DeltaPart> parts;  ///< those that have deltas, by u, v and slab
    CodesInUse all;
};

}  // namespace deltasplat
