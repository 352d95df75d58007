// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/openvdb.h>

#include <cstdint>
#include <string>

// Code for OpenVDB's trees of the usual values is generated once, in tree_types_*.cpp. A file that
// includes this header compiles in half the time. The root stays out because an unused member of
// OpenVDB 10 does not compile; LeafNode::str has the same fault and is replaced.
// NOLINTBEGIN(bugprone-macro-parentheses): types in template arguments
#define DELTASPLAT_LEAF_TEXT(T) \
    template <>                 \
    std::string openvdb::tree::LeafNode<T, 3>::str() const
#define DELTASPLAT_TREE(INSTANCE, T)              \
    INSTANCE class openvdb::tree::LeafNode<T, 3>; \
    DELTASPLAT_TREE_ABOVE(INSTANCE, T)
#define DELTASPLAT_TREE_ABOVE(INSTANCE, T)                                                  \
    INSTANCE class openvdb::tree::InternalNode<openvdb::tree::LeafNode<T, 3>, 4>;           \
    INSTANCE class openvdb::tree::InternalNode<                                             \
        openvdb::tree::InternalNode<openvdb::tree::LeafNode<T, 3>, 4>, 5>;                  \
    INSTANCE class openvdb::tree::Tree<openvdb::tree::RootNode<openvdb::tree::InternalNode< \
        openvdb::tree::InternalNode<openvdb::tree::LeafNode<T, 3>, 4>, 5>>>;                \
    INSTANCE class openvdb::Grid<                                                           \
        openvdb::tree::Tree<openvdb::tree::RootNode<openvdb::tree::InternalNode<            \
            openvdb::tree::InternalNode<openvdb::tree::LeafNode<T, 3>, 4>, 5>>>>;
// NOLINTEND(bugprone-macro-parentheses)
DELTASPLAT_LEAF_TEXT(float);
DELTASPLAT_LEAF_TEXT(double);
DELTASPLAT_LEAF_TEXT(std::int32_t);
DELTASPLAT_LEAF_TEXT(std::int64_t);
DELTASPLAT_LEAF_TEXT(openvdb::Vec3f);
DELTASPLAT_LEAF_TEXT(openvdb::Vec3d);
DELTASPLAT_LEAF_TEXT(openvdb::Vec3i);
DELTASPLAT_TREE(extern template, float)
DELTASPLAT_TREE(extern template, double)
DELTASPLAT_TREE(extern template, std::int32_t)
DELTASPLAT_TREE(extern template, std::int64_t)
DELTASPLAT_TREE(extern template, openvdb::Vec3f)
DELTASPLAT_TREE(extern template, openvdb::Vec3d)
DELTASPLAT_TREE(extern template, openvdb::Vec3i)
DELTASPLAT_TREE_ABOVE(extern template, bool)
