// SPDX-License-Identifier: Apache-2.0
#include "volume/tree_types.h"

DELTASPLAT_LEAF_TEXT(openvdb::Vec3f) {
    return "a leaf";
}
DELTASPLAT_LEAF_TEXT(openvdb::Vec3d) {
    return "a leaf";
}
DELTASPLAT_LEAF_TEXT(openvdb::Vec3i) {
    return "a leaf";
}
DELTASPLAT_TREE(template, openvdb::Vec3f)
DELTASPLAT_TREE(template, openvdb::Vec3d)
DELTASPLAT_TREE(template, openvdb::Vec3i)
