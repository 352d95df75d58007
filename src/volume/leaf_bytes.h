// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace deltasplat {

/// Returns what a leaf of an OpenVDB tree takes, its values included.
template <typename Leaf>
constexpr double leafBytes() {
    return sizeof(Leaf) + Leaf::NUM_VALUES * sizeof(typename Leaf::ValueType);
}

}  // namespace deltasplat
