// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "view/base_plane.h"
#include "volume/code_blocks.h"

namespace deltasplat {

/// Parallel neighbouring lines of sight.
struct SightLines {
    int sliceAxis;
    bool frontToBack;          ///< as in Factorization
    glm::dvec2 shiftPerSlice;  ///< as in Factorization
    /// [class]: premultiplied RGBA over a slice.
    std::span<const glm::dvec4> lights;
};

/// Change of light and opacity by joining slices, and neighbouring voxels within them.
struct JoinedChange {
    /// Mean gain of each channel as a share of the largest channel; negative: loss.
    glm::dvec4 gained{0.0};
    /// Root mean square change of patches in the worst channel, as a share of the largest channel.
    double rms = 0;
};

/// Estimates how joining changes a picture, from some hundred patches. Most volumes change little.
/// Structures one voxel thin along the lines of sight can get wider or narrower.
class JoinProbe {
  public:
    /// @param blocks       visible blocks along `sliceAxis`, as from listBlocks
    /// @param classOfSlot  [kSlotCount]
    JoinProbe(std::vector<CodeBlock> blocks, int sliceAxis, std::span<const Slot> classOfSlot);

    /// Returns the lines of sight through a voxel (x, y, z).
    using LinesThrough = std::function<SightLines(const glm::ivec3& voxel)>;

    /// Deterministic; multi-threaded.
    /// @return nothing if too little is visible for an estimate
    std::optional<JoinedChange> change(const JoinedVoxels& joined, const LinesThrough& lines) const;

  private:
    class Tracer;
    class Layer;

    const CodeBlock* find(const glm::ivec3& position) const;

    std::vector<CodeBlock> blocks_;
    int sliceAxis_;
    std::vector<Slot> classOfSlot_;
    std::vector<std::size_t> begins_;           // of columns in blocks_
    std::vector<std::pair<int, int>> columns_;  // u and v
    glm::ivec3 first_{0};                       // range of block positions, (slice, u, v)
    glm::ivec3 last_{0};
};

}  // namespace deltasplat
