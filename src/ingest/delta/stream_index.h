// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

namespace deltasplat {

struct DeltaHeader;

/// The deltas of one slab with the same u and v, as they lie in a stream of packed deltas
/// (docs/delta-grid.md, "Packed deltas": there it is a column).
struct StreamPart {
    glm::ivec3 first{0};    ///< the slab's first block, in (slice, u, v) order, divided by 8
    std::size_t begin = 0;  ///< of its words
    std::size_t end = 0;
};

/// More words than any block takes, of 512 numbers of 8 + 64 bits: so what is read behind the end
/// of damaged words is there.
inline constexpr std::size_t kStreamPadding = 1024;

/// Reads where the parts of a stream are, by slab, u and v: what it begins with.
/// @param words   the first of the stream, `some` of them, with kStreamPadding behind them
/// @param count   of all words
/// @return nothing if it goes on behind these words
/// @throw Error(kInput) if the stream says what it cannot; Error(kFailed) if memory does not hold
/// it
std::optional<std::vector<StreamPart>> readStreamIndex(const std::uint64_t* words, std::size_t some,
                                                       std::size_t count, const DeltaHeader& header,
                                                       const std::string& where);

/// Returns how many blocks parts say that they have, at most as many as their words can hold.
/// Multi-threaded.
/// @param words  that the parts' places count from, with kStreamPadding behind them
std::size_t countBlocks(const std::uint64_t* words, const std::vector<StreamPart>& parts);

}  // namespace deltasplat
