// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/tree/Tree.h>

#include "deltasplat/ingest/volume.h"

namespace deltasplat {

/// Codes in OpenVDB's standard layout (leaves of 8x8x8 voxels, x slowest, z fastest). A uniform
/// active 8x8x8 block may be an active tile at any level, so a large constant region costs no
/// memory.
struct CodeTree {
    using Tree = openvdb::tree::Tree4<Code, 5, 4, 3>::Type;
    using Leaf = Tree::LeafNodeType;
    Tree tree{Code{0}};
};

}  // namespace deltasplat
