// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "delta/code_blocks.h"

namespace deltasplat {

/// Finds single blocks of a code tree by their place. Not for several threads at once.
class BlockFinder {
  public:
    BlockFinder(const CodeTree& codes, int sliceAxis);

    /// Returns a block, slots of tiles being code + 1, if any of it is active. Its range of codes
    /// is left out, unless it is one of SlotBlocks.
    std::optional<CodeBlock> find(const glm::ivec3& position) const;

  private:
    const SlotBlocks* blocks_;  // null: the tree is searched
    std::optional<openvdb::tree::ValueAccessor<const CodeTree::Tree>> accessor_;
    int sliceAxis_;
};

}  // namespace deltasplat
