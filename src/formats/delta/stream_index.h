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

/// The deltas of one slab with the same u and v, as they lie in a stream of packed deltas
/// (docs/delta-grid.md, "Packed deltas": there it is a column).
struct StreamPart {
    glm::ivec3 first{0};    ///< the slab's first block, in (slice, u, v) order, divided by 8
    std::size_t begin = 0;  ///< of its words
    std::size_t end = 0;
    /// Range of the active voxels' codes, if the stream says which there are.
    Code lowest = 0;
    Code highest = 0;
};

/// What a stream begins with.
struct StreamIndex {
    std::vector<StreamPart> parts;  ///< by slab, u and v
    /// As Volume::histogram; empty if the stream does not say which codes there are.
    std::vector<std::uint64_t> histogram;
    /// Of the active voxels, in (slice, u, v) order, if it says so.
    IndexBox active;
};

/// More words than any block takes, of 512 numbers of 8 + 64 bits: so what is read behind the end
/// of damaged words is there.
inline constexpr std::size_t kStreamPadding = 1024;

/// Reads what a stream begins with.
/// @param words  all of the stream, `count` of them, with kStreamPadding behind them
/// @throw Error(kInput) if the stream says what it cannot; Error(kFailed) if memory does not hold
///        the parts
StreamIndex readStreamIndex(const std::uint64_t* words, std::size_t count,
                            const DeltaHeader& header, const std::string& where);

/// Returns what a stream says of all its codes.
CodesInUse codesInUse(const StreamIndex& index, const DeltaHeader& header);

/// Returns the CRC-32 of words, each from its lowest byte on: what a stream that says which codes
/// there are has behind that.
std::uint64_t streamSum(const std::uint64_t* words, std::size_t count);

/// Returns how many blocks parts say that they have, at most as many as their words can hold.
/// Multi-threaded.
/// @param words  that the parts' places count from, with kStreamPadding behind them
std::size_t countBlocks(const std::uint64_t* words, const std::vector<StreamPart>& parts);

}  // namespace deltasplat
