// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "formats/dense/dense_source.h"
#include "volume/code_tree.h"
#include "volume/slot_blocks.h"

namespace deltasplat {

/// The codes of a dense volume whose leaves are read from the file on demand, and their counts.
struct CodesOnDemand {
    std::shared_ptr<CodeTree> tree;
    std::vector<std::uint64_t> histogram;  // [65536]
};

/// Scans a dense volume once for uniform blocks and the code ranges of the others.
/// @param source  has rows of whole numbers of at most 16 bits
/// @param book    of whole numbers, from the type's least on
/// @param wanted  codes whose leaves are read at once; null: none
/// @throw Error(kInput) if the file changes meanwhile
CodesOnDemand codesOnDemand(const DenseSource& source, const CodeBook& book,
                            const SeenCodes* wanted, const Listener& listener);

}  // namespace deltasplat
