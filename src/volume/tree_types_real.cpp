// SPDX-License-Identifier: Apache-2.0
#include "volume/tree_types.h"

DELTASPLAT_LEAF_TEXT(float) {
    return "a leaf";
}
DELTASPLAT_LEAF_TEXT(double) {
    return "a leaf";
}
DELTASPLAT_TREE(template, float)
DELTASPLAT_TREE(template, double)
