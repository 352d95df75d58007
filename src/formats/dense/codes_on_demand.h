// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "formats/dense/dense_source.h"
#include "volume/code_tree.h"
#include "volume/slot_blocks.h"

namespace deltasplat {

/// The codes of a dense volume whose leaves are read from its file when they are asked for, and how
/// many voxels have each code.
struct CodesOnDemand {
    std::shared_ptr<CodeTree> tree;
    std::vector<std::uint64_t> histogram;  // [65536]
};

/// Goes over a dense volume once for the ranges of codes in its blocks, and for what is uniform.
/// @param source  one with rows, of whole numbers of at most 16 bits
/// @param book    of its codes; it counts whole numbers from the least that the type has
/// @param wanted  which codes' leaves are read at once; null: none
/// @throw Error(kInput) if the file is written to meanwhile
CodesOnDemand codesOnDemand(const DenseSource& source, const CodeBook& book,
                            const SeenCodes* wanted, const Listener& listener);

}  // namespace deltasplat
