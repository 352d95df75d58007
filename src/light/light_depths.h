// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory_resource>
#include <vector>

#include "deltasplat/optics/shading.h"
#include "light/lit_blocks.h"
#include "uncleared_array.h"

namespace deltasplat {

/// What the light of each of several lights comes through on its way to the voxels of a volume.
class LightDepths {
  public:
    /// Sweeps the volume from each light on. Multi-threaded.
    /// @param classes  must outlive this, as `volume`
    /// @param octaves  of light that are to be told from it (Scattering): the more, the less is
    ///                 taken for nothing
    /// @throw Error(kFailed) if there is not enough memory
    LightDepths(const Volume& volume, const ClassTable& classes, const std::vector<Light>& lights,
                int octaves);

    const LitBlocks& blocks() const { return blocks_; }
    /// Returns how far voxels are from a point light; of light from far away nothing is known.
    const LitBlocks::Reach& reach(std::size_t light) const { return reaches_[light]; }
    /// Returns a block's, `[x][y][z]`: the square root of extinction, in 1 / kDepthSteps.
    /// @param number  of the block (LitBlocks::find)
    const std::uint16_t* of(std::size_t light, std::int64_t number) const {
        return &depths_[512 * (light * blocks_.size() + std::size_t(number))];
    }

  private:
    LitBlocks blocks_;
    std::vector<LitBlocks::Reach> reaches_;  // [lights]
    UnclearedArray<std::uint16_t> depths_;   // [light][block][512]
};

}  // namespace deltasplat
