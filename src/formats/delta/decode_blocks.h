// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "deltasplat/ingest/volume.h"
#include "deltasplat/progress.h"
#include "formats/delta/delta_format.h"
#include "formats/delta/delta_stream.h"
#include "volume/slot_blocks.h"

namespace deltasplat {

/// What the deltas of a volume add up to, as blocks along the slices.
struct DecodedBlocks {
    std::shared_ptr<SlotBlocks> blocks;
    std::vector<std::uint64_t> histogram;  ///< as Volume::histogram
    IndexBox active;                       ///< of the active voxels, in the volume's index space
};

/// Whether decodeBlocks reads what most delta grids are: of 16-bit codes,
/// with less than 65536 codes in use, and without inactive values if what rests is active.
bool mayDecodeBlocks(const DeltaHeader& header);

/// Adds up deltas along the slices straight from a file: each block is unpacked where it is added,
/// and no trees are made of deltas or codes. Multi-threaded; deterministic.
/// @param header  as mayDecodeBlocks says
/// @return nothing where the grid is not sound, or has little in a large box that rests active:
///         decodeDeltas then reads it, or says what is wrong
/// @throw Error(kInput) if codes are not what StreamColumns::knownCodes says; Error(kFailed) if
/// they
///        do not fit into memory; whatever the listener throws
std::optional<DecodedBlocks> decodeBlocks(const StreamColumns& deltas, const DeltaHeader& header,
                                          const std::string& where, const Listener& listener);

/// Returns blocks that are decoded when they are first asked for: of each slab's columns, those
/// that have codes which are seen.
/// @return null where the file does not say which codes there are, or decodeBlocks would return
///         nothing without looking at deltas
/// @throw Error(kFailed) if what the file says does not fit into memory
std::shared_ptr<SlotBlocks> decodeLater(std::shared_ptr<const DeltaHeader> header,
                                        std::unique_ptr<const StreamColumns> deltas,
                                        const std::string& where);

/// Refuses deltas that do not add up to what a stream says, which who unpacks some of them relies
/// on.
/// @throw Error(kInput)
void requireKnownCodes(const CodesInUse& said, const CodesInUse& found, const std::string& where);

}  // namespace deltasplat
