// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <span>

#include "delta/class_reader.h"
#include "delta/slice_joiner.h"

namespace deltasplat {

/// What a block of joined slices is made of: the blocks of its first half and of its second one, as
/// JoinedColumn::sources has them; null where there are none.
using JoinedSources = std::array<std::array<const CodeBlock*, 4>, 2>;

/// Reads what the voxels of blocks of joined slices are.
class JoinedClassReader {
  public:
    /// @param classes,joiner  must outlive this
    /// @param slant          as Subdivision::slant
    JoinedClassReader(const ClassReader& classes, const SliceJoiner& joiner,
                      const glm::ivec2& slant)
        : classes_(classes), joiner_(joiner), slant_(slant) {}

    /// @param out  [slice][u][v]
    void read(const JoinedSources& sources, std::span<ClassIndex, 512> out) const;

  private:
    struct OpenBlock;

    OpenBlock open(const CodeBlock& block) const;
    ClassIndex classAt(const OpenBlock& block, const glm::ivec3& at) const;
    void readLine(const OpenBlock& block, const glm::ivec3& first, const glm::ivec3& step,
                  std::span<ClassIndex, 8> out) const;
    void slantSlice(const std::array<OpenBlock, 4>& beside, const ClassIndex* own, int slice,
                    ClassIndex* out) const;

    const ClassReader& classes_;
    const SliceJoiner& joiner_;
    glm::ivec2 slant_;
};

}  // namespace deltasplat
