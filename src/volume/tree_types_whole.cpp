// SPDX-License-Identifier: Apache-2.0
#include "volume/tree_types.h"

DELTASPLAT_LEAF_TEXT(std::int32_t) {
    return "a leaf";
}
DELTASPLAT_LEAF_TEXT(std::int64_t) {
    return "a leaf";
}
DELTASPLAT_TREE(template, std::int32_t)
DELTASPLAT_TREE(template, std::int64_t)
DELTASPLAT_TREE_ABOVE(template, bool)
