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

/// Lines of sight beside each other.
struct SightLines {
    int sliceAxis;
    bool frontToBack;          ///< as Factorization
    glm::dvec2 shiftPerSlice;  ///< as Factorization
    /// Of each class, over a slice: premultiplied RGBA.
    std::span<const glm::dvec4> lights;
};

/// What becomes of light and opacity where slices, and voxels beside each other, become one.
struct JoinedChange {
    /// By how much more of each channel there is on average, as a share of the largest; below 0:
    /// less.
    glm::dvec4 gained{0.0};
    /// The root of the mean square of what patches gain or lose, of the channel that changes most,
    /// as a share of the largest channel that any of them has.
    double rms = 0;
};

/// Finds out what joining does to what pictures show, by some hundred patches of them: what lines
/// of sight see of single voxels, and of what these become. It does little to most things. What is
/// a voxel thin and goes on along lines of sight gets wider where slices lie beside each other that
/// become one, or narrower.
class JoinProbe {
  public:
    /// @param blocks       along `sliceAxis`, as listBlocks lists those that can be seen
    /// @param classOfSlot  [kSlotCount]
    JoinProbe(std::vector<CodeBlock> blocks, int sliceAxis, std::span<const Slot> classOfSlot);

    /// Returns the lines of sight that pass a voxel (x, y, z).
    using LinesThrough = std::function<SightLines(const glm::ivec3& voxel)>;

    /// Deterministic; multi-threaded.
    /// @return empty: too little is seen to know
    std::optional<JoinedChange> change(const JoinedVoxels& joined, const LinesThrough& lines) const;

  private:
    class Tracer;
    class Layer;

    const CodeBlock* find(const glm::ivec3& position) const;

    std::vector<CodeBlock> blocks_;
    int sliceAxis_;
    std::vector<Slot> classOfSlot_;
    std::vector<std::size_t> begins_;           // of columns among the blocks
    std::vector<std::pair<int, int>> columns_;  // where they are: u and v
    glm::ivec3 first_{0};                       // place of blocks, (slice, u, v)
    glm::ivec3 last_{0};
};

}  // namespace deltasplat
