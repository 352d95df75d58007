// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "rays/picture_lines.h"
#include "rays/ray_kernels.h"
#include "rays/ray_volume.h"

namespace deltasplat {

/// Positions of axes: (slice, u, v).
struct PatchBox {
    glm::ivec3 first{0};
    glm::ivec3 size{0};
};

/// Reads parts of a volume, in the order and directions of lines. Not thread-safe.
class PatchReader {
  public:
    PatchReader(const RayVolume& volume, RayRule rule) : volume_(volume), rule_(rule) {}

    /// Whether a part has any block; finds its blocks.
    bool find(const RayAxes& axes, const PatchBox& box);
    /// Reads the part of find(); voxels outside the volume are not active.
    const RayPatch& read(const RayAxes& axes, const PatchBox& box);
    const RayPatch& patch() const { return patch_; }

  private:
    void addBlock(const RayAxes& axes, const PatchBox& box, const CodeBlock& block,
                  bool asksActive);
    void findTops(const PatchBox& box);

    const RayVolume& volume_;
    RayRule rule_;
    std::vector<const CodeBlock*> found_;
    std::vector<float> values_;
    std::vector<float> active_;
    std::vector<float> rowTops_, sliceTops_, tops_;
    std::array<float, 512> block_{};
    std::array<float, 512> blockActive_{};
    RayPatch patch_{};
};

}  // namespace deltasplat
