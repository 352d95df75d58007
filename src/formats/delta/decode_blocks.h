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

/// The sum of a volume's deltas, as blocks along the slices.
struct DecodedBlocks {
    std::shared_ptr<SlotBlocks> blocks;
    std::vector<std::uint64_t> histogram;  ///< as Volume::histogram
    IndexBox active;  ///< box of the active voxels, in the volume's index space
};

/// Whether decodeBlocks reads this kind of grid: 16-bit codes, fewer than 65536 codes in use, and
/// no inactive values if resting voxels are active. Most delta grids are of this kind.
bool mayDecodeBlocks(const DeltaHeader& header);

/// Adds up deltas straight from a file, without trees. Multi-threaded; deterministic.
/// @param header  passes mayDecodeBlocks
/// @return nothing for unsound grids, or few deltas in a large resting box: decodeDeltas takes over
/// @throw Error(kInput) if codes differ from StreamColumns::knownCodes; Error(kFailed) if memory is
///        too small; whatever the listener throws
std::optional<DecodedBlocks> decodeBlocks(const StreamColumns& deltas, const DeltaHeader& header,
                                          const std::string& where, const Listener& listener);

/// Returns blocks that are decoded on first use: only a slab's columns with visible codes.
/// @return null if the file does not state its codes, or decodeBlocks would refuse its header
/// @throw Error(kFailed) if the file's index does not fit into memory
std::shared_ptr<SlotBlocks> decodeLater(std::shared_ptr<const DeltaHeader> header,
                                        std::unique_ptr<const StreamColumns> deltas,
                                        const std::string& where);

/// Refuses deltas that contradict the stream's own codes, on which partial unpacking relies.
/// @throw Error(kInput)
void requireKnownCodes(const CodesInUse& said, const CodesInUse& found, const std::string& where);

}  // namespace deltasplat
