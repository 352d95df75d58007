// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "deltasplat/ingest/volume.h"
#include "deltasplat/progress.h"
#include "ingest/codes/slot_blocks.h"
#include "ingest/delta/delta_columns.h"
#include "ingest/delta/delta_format.h"

namespace deltasplat {

/// What the deltas of a volume add up to, as blocks along the slices.
struct DecodedBlocks {
    std::shared_ptr<SlotBlocks> blocks;
    std::vector<std::uint64_t> histogram;  ///< as Volume::histogram
    IndexBox active;                       ///< of the active voxels, in the volume's index space
};

/// Whether decodeBlocks reads what most delta grids are: of 16-bit codes, of versions from 3 on,
/// with less than 65536 codes in use, and without inactive values if what rests is active.
bool mayDecodeBlocks(const DeltaHeader& header);

/// Adds up deltas along the slices straight from a file: each block is unpacked where it is added,
/// and no trees are made of deltas or codes. Multi-threaded; deterministic.
/// @param header  as mayDecodeBlocks says
/// @param wanted  blocks of 8 slices, first and last, which `deltas` has all of from the first's
///                slabStart() on; none: all. Of some, what is found is theirs, and less can be
///                checked.
/// @return nothing where the grid is not sound, or has little in a large box that rests active:
///         decodeDeltas then reads it, or says what is wrong
/// @throw Error(kInput) if codes are not what DeltaColumns::knownCodes says; Error(kFailed) if they
/// do not
///        fit into memory; whatever the listener throws
std::optional<DecodedBlocks> decodeBlocks(const DeltaColumns& deltas, const DeltaHeader& header,
                                          const std::string& where,
                                          const std::optional<glm::ivec2>& wanted,
                                          const Listener& listener);

/// Returns blocks that are decoded when they are first asked for: of each slab's columns, those
/// that have codes which are seen.
/// @return null where the file does not say which codes there are, or decodeBlocks would return
///         nothing without looking at deltas
/// @throw Error(kFailed) if what the file says does not fit into memory
std::shared_ptr<SlotBlocks> decodeLater(std::shared_ptr<const DeltaHeader> header,
                                        std::unique_ptr<const DeltaColumns> deltas,
                                        const std::string& where);

/// Refuses deltas that do not add up to what a stream says, which who unpacks some of them relies
/// on.
/// @throw Error(kInput)
void requireKnownCodes(const CodesInUse& said, const CodesInUse& found, const std::string& where);

/// Returns the block of 8 slices that the slab of one begins with; within the box.
int slabStart(const DeltaHeader& header, int block);

}  // namespace deltasplat
