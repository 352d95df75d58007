// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ingest/delta/delta_columns.h"
#include "ingest/delta/delta_format.h"
#include "ingest/delta/stream_index.h"
#include "ingest/vdb/vdb_leaves.h"
#include "uncleared_vector.h"

namespace deltasplat {

/// Packed deltas of 32 bits: a stream whose words are the voxels of a file's leaves.
class StreamColumns {
  public:
    /// Reads the words, on all threads.
    /// @param leaves  of int64
    /// @param header  outlives this
    /// @return nothing if the words have gaps
    /// @throw Error(kInput) if the stream says what it cannot; Error(kFailed) if memory does not
    ///        hold it
    static std::optional<StreamColumns> read(const VdbLeaves& leaves, const DeltaHeader& header,
                                             const std::string& where);

    /// Those that have deltas, by u and v.
    const std::vector<DeltaColumn>& columns() const { return columns_; }
    /// How many blocks have deltas, at most.
    std::size_t blocks() const { return blocks_; }
    /// Null if the file does not say which codes there are.
    const KnownCodes* knownCodes() const { return knownCodes_ ? &*knownCodes_ : nullptr; }
    /// Returns what one thread unpacks columns with. Thread-safe.
    std::unique_ptr<DeltaWalker> walker() const;

  private:
    StreamColumns(UnclearedVector<std::uint64_t> words, StreamIndex index,
                  const DeltaHeader& header);

    const DeltaHeader* header_;
    UnclearedVector<std::uint64_t> words_;
    std::vector<StreamPart> parts_;  // by u, v and slab
    std::vector<DeltaColumn> columns_;
    std::size_t blocks_ = 0;
    std::optional<KnownCodes> knownCodes_;
};

}  // namespace deltasplat
