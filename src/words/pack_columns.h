// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "words/block_source.h"
#include "words/joined_tiles.h"
#include "words/word_writer.h"

namespace deltasplat {

/// Consecutive columns of blocks (same u and v), slices in increasing order.
struct Columns {
    const CodeBlock* begin;
    const CodeBlock* end;
};

/// Makes the words of some columns.
/// @param room  as for WordWriter::begin
void packColumns(const Columns& columns, BlockSource& source, WordWriter& writer,
                 std::vector<PackedColumns>& room);

/// Makes the words of a run of tiles with joined slices.
/// @param descending  slices are walked from last to first
void packTiles(const JoinedTiles& tiles, std::size_t run, const ClassReader& classes,
               const SliceJoiner& joiner, bool descending, WordWriter& writer,
               std::vector<PackedColumns>& room);

}  // namespace deltasplat
