// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "deltasplat/view/factorization.h"
#include "formats/delta/delta_grid.h"
#include "optics/voxel_painter.h"
#include "words/mix_window.h"
#include "words/packed_deltas.h"

namespace deltasplat {

/// Reads the gradients of a volume block by block, as central differences: half the change from the
/// voxel before to the voxel behind. At a voxel with only one neighbour, the difference to that
/// neighbour; without neighbours, 0. Gradients of divided voxels are mixed like values
/// (ValueMixer), which equals differences of mixed values. Not thread-safe.
class GradientReader {
  public:
    /// @param codes,scale  must outlive the reader
    GradientReader(const CodeTree& codes, int sliceAxis, const Subdivision& parts,
                   const GradientScale& scale);

    /// Returns the gradients of a block, or of the blocks that it is divided into, with values if
    /// the scale wants them: `[parts.within along u][parts.slices][parts.within along v]`.
    std::span<const BlockField> read(const CodeBlock& block);

  private:
    // Two voxels around a block, because gradients are mixed from those of neighbours.
    static constexpr int kRim = 2;
    static constexpr int kSide = 8 + 2 * kRim;

    void readValues(const CodeBlock& block);
    void readPart(const CodeBlock* block, const glm::ivec3& side);
    void readSlots(const ShortSlot* slots, const glm::ivec3& side, const glm::ivec3& first,
                   const glm::ivec3& last);
    template <typename Take, typename ArrayOf>
    void fill(const Take& take, const ArrayOf& arrayOf);
    void takeDifferences(int axis, int rim, float* out) const;
    void takeValues(int rim, float* out) const;

    BlockFinder finder_;
    int sliceAxis_;
    Subdivision parts_;
    const GradientScale& scale_;
    std::array<float, kSide * kSide * kSide> values_;  // [slice][u][v], NaN without a value
    std::vector<BlockField> fields_;
};

/// Own looks of the voxels of a column, block by block: the looks of the current block, and those
/// of the slice before it. Each part of a divided block is painted by itself.
class BlockLooks {
  public:
    using Slice = std::array<OwnLook, 64>;

    /// @param box            of all voxels, (slice, u, v); of thin voxels if they are divided
    /// @param painter,codes  must outlive this object
    BlockLooks(const VoxelPainter& painter, const CodeTree& codes, int sliceAxis,
               const Subdivision& parts, const IndexBox& box);

    /// Forgets the slice before.
    void beginColumn();
    void beginBlock(const CodeBlock& block);
    /// Paints the voxels of the current block, or of one of its parts.
    /// @param position  of this block or part, (slice, u, v) / 8
    /// @param number    of the part, in GradientReader's order
    /// @param classes   changed if the painter chooses classes
    void paint(const glm::ivec3& position, int number, std::span<ClassIndex, 512> classes);

    /// [slice][u][v]: the looks painted last.
    std::array<OwnLook, 512>& block() { return block_; }
    /// The looks that the voxels of a part of the column currently hold.
    Slice& held(std::size_t part) { return held_[part]; }
    /// Marks visible voxels as changed if their look differs from the slice before.
    void compare(std::size_t part, BlockChanges& changes) const;
    /// Keeps the last slice for the comparison with the next block.
    void endBlock(std::size_t part);

  private:
    void keepInBox(const glm::ivec3& position, std::span<ClassIndex, 512> classes) const;

    const VoxelPainter& painter_;
    glm::dmat4 indexFromThin_;
    IndexBox box_;
    std::optional<GradientReader> reader_;
    const CodeBlock* inHand_ = nullptr;
    std::span<const BlockField> fields_;  // of the current block, read on demand
    std::array<OwnLook, 512> block_{};
    std::array<Slice, 4> before_{};  // [part]: the slice before
    std::array<Slice, 4> held_{};    // [part]
};

}  // namespace deltasplat
