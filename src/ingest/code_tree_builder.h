// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "ingest/code_tree.h"

namespace deltasplat {

/// Builds the tree of a dense volume, one layer of 8 slices at a time. Every voxel of the volume is
/// active; a whole block of one code becomes a tile. Deterministic whatever the thread count.
class CodeTreeBuilder {
  public:
    /// Writes the codes of the block at voxel (x, y) of the layer into codes[512], in leaf order.
    using FillBlock = std::function<void(const glm::ivec2& corner, const glm::ivec2& size, Code*)>;

    /// @param dims  voxels along x, y and z
    explicit CodeTreeBuilder(const glm::ivec3& dims);
    /// Adds the slices firstSlice .. firstSlice + 7, or to the last; firstSlice is a multiple of 8.
    /// `fill` is called from all threads.
    void addLayer(int firstSlice, const FillBlock& fill);
    /// Returns the tree; nothing can be added after.
    std::shared_ptr<const CodeTree> takeTree() { return std::move(tree_); }
    /// Returns how many voxels have each code, [65536].
    std::vector<std::uint64_t> histogram() const;
    /// Returns the most bytes that one layer can add to the tree.
    double worstLayerBytes() const;

  private:
    struct Block;
    Block makeBlock(const glm::ivec3& corner, const FillBlock& fill, std::uint64_t* counts) const;

    glm::ivec3 dims_;
    glm::ivec2 blocks_;
    std::shared_ptr<CodeTree> tree_;
    std::vector<std::vector<std::uint64_t>> counts_;  // one histogram a strip of blocks
};

}  // namespace deltasplat
