// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "formats/dense/dense_source.h"

namespace deltasplat {

/// Reads a dense volume once to count the 8x8x8 blocks that are not uniform: what it takes in
/// memory depends on little else.
std::uint64_t countMixedBlocks(const DenseSource& source, const Listener& listener);

}  // namespace deltasplat
