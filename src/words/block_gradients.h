// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "deltasplat/view/factorization.h"
#include "optics/voxel_painter.h"
#include "words/mix_window.h"

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

}  // namespace deltasplat
