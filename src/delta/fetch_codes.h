// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "hwy/cache_control.h"
#include "ingest/codes/code_tree.h"

namespace deltasplat {

/// Brings the codes of a leaf nearer that will be read next: leaves lie anywhere, and nobody else
/// can tell where.
inline void fetchCodes(const CodeTree::Leaf& leaf) {
    constexpr std::size_t kLineBytes = 64;
    const Code* const codes = leaf.buffer().data();
    for (std::size_t i = 0; i < 512; i += kLineBytes / sizeof(Code)) hwy::Prefetch(codes + i);
}

}  // namespace deltasplat
