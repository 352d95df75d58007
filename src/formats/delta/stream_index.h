// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "deltasplat/ingest/code_book.h"
#include "deltasplat/ingest/volume.h"
#include "formats/delta/delta_columns.h"

namespace deltasplat {

struct DeltaHeader;

/// The deltas of one slab with the same u and v in a stream: a "column" in docs/delta-grid.md.
struct StreamPart {
    glm::ivec3 first{0};    ///< the slab's first block, in (slice, u, v) order, divided by 8
    std::size_t begin = 0;  ///< range of its words
    std::size_t end = 0;
    /// Range of the active voxels' codes, if the stream states its codes.
    Code lowest = 0;
    Code highest = 0;
};

/// The front of a stream.
struct StreamIndex {
    std::vector<StreamPart> parts;  ///< by slab, u and v
    /// As Volume::histogram; empty if the stream does not state its codes.
    std::vector<std::uint64_t> histogram;
    /// Box of the active voxels in (slice, u, v) order, if stated.
    IndexBox active;
};

/// More words than any block has (512 numbers of 8 + 64 bits): damaged words end within memory.
inline constexpr std::size_t kStreamPadding = 1024;

/// @param words  all `count` words of the stream, with kStreamPadding behind them
/// @throw Error(kInput) if the index is impossible; Error(kFailed) if memory is too small
StreamIndex readStreamIndex(const std::uint64_t* words, std::size_t count,
                            const DeltaHeader& header, const std::string& where);

/// Returns a stream's own statement of its codes.
CodesInUse codesInUse(const StreamIndex& index, const DeltaHeader& header);

/// Returns the CRC-32 of words, lowest byte first, with which an index that states codes ends.
std::uint64_t streamSum(const std::uint64_t* words, std::size_t count);

/// Returns how many blocks parts claim, at most what their words can hold. Multi-threaded.
/// @param words  of the stream, with kStreamPadding behind them
std::size_t countBlocks(const std::uint64_t* words, const std::vector<StreamPart>& parts);

}  // namespace deltasplat
