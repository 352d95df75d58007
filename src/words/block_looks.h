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

/// Takes the gradients of a volume block by block, as central differences: half of what a value
/// grows from the voxel before to the one behind. Where only one of them is there, it is the
/// difference to that one; where none is, 0. Those of divided voxels are mixed as values are
/// (ValueMixer), which is what differences of mixed values would be. Not for several threads at
/// once.
class GradientReader {
  public:
    /// @param scale  must outlive the reader, as `codes`
    GradientReader(const CodeTree& codes, int sliceAxis, const Subdivision& parts,
                   const GradientScale& scale);

    /// Returns the gradients of a block, and its values if they are wanted, or those of all that it
    /// becomes:
    /// `[parts.within along u][parts.slices][parts.within along v]`.
    std::span<const BlockField> read(const CodeBlock& block);

  private:
    // Of a block, two voxels around it: gradients are mixed from those of neighbours.
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
    std::array<float, kSide * kSide * kSide> values_;  // [slice][u][v], NaN where nothing is
    std::vector<BlockField> fields_;
};

/// Looks that voxels have of their own, of one block after the other of a column: those of the
/// block in hand, and what the slice before it had. A block may be divided; each of what it becomes
/// is painted by itself.
class BlockLooks {
  public:
    using Slice = std::array<OwnLook, 64>;

    /// @param box    of all voxels that there are, (slice, u, v), thin ones if they are divided
    /// @param codes  of the volume; must outlive this, as the painter
    BlockLooks(const VoxelPainter& painter, const CodeTree& codes, int sliceAxis,
               const Subdivision& parts, const IndexBox& box);

    /// Forgets what was before.
    void beginColumn();
    void beginBlock(const CodeBlock& block);
    /// Paints the voxels of the block in hand, or of one that it becomes.
    /// @param position  of that, (slice, u, v) / 8
    /// @param number    of that, as GradientReader counts
    /// @param classes   changed if the painter chooses them
    void paint(const glm::ivec3& position, int number, std::span<ClassIndex, 512> classes);

    /// [slice][u][v]: of what was painted last.
    std::array<OwnLook, 512>& block() { return block_; }
    /// Of a part of the column: what voxels go on as.
    Slice& held(std::size_t part) { return held_[part]; }
    /// Adds to changes where what is seen has another look than in the slice before.
    void compare(std::size_t part, BlockChanges& changes) const;
    /// Takes the last slice for what comes before the next block.
    void endBlock(std::size_t part);

  private:
    void keepInBox(const glm::ivec3& position, std::span<ClassIndex, 512> classes) const;

    const VoxelPainter& painter_;
    glm::dmat4 indexFromThin_;
    IndexBox box_;
    std::optional<GradientReader> reader_;
    const CodeBlock* inHand_ = nullptr;
    std::span<const BlockField> fields_;  // of it, once they are asked for
    std::array<OwnLook, 512> block_{};
    std::array<Slice, 4> before_{};  // [part]: of the slice before it
    std::array<Slice, 4> held_{};    // [part]
};

}  // namespace deltasplat
