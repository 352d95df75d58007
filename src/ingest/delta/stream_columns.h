// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
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
class StreamColumns : public DeltaColumns {
  public:
    /// Reads the words, on all threads.
    /// @param leaves  of int64
    /// @param header  outlives this
    /// @param slices  blocks of 8 slices, first and last, of which the first begins a slab: no more
    ///                of the file is read than where its deltas lie and the slabs that hold these.
    ///                None: all.
    /// @return nothing if the words have gaps
    /// @throw Error(kInput) if the stream says what it cannot; Error(kFailed) if memory does not
    ///        hold it
    static std::optional<StreamColumns> read(const VdbLeaves& leaves, const DeltaHeader& header,
                                             const std::optional<glm::ivec2>& slices,
                                             const std::string& where);

    const std::vector<DeltaColumn>& columns() const override { return columns_; }
    std::size_t blocks() const override { return blocks_; }
    const KnownCodes* knownCodes() const override { return knownCodes_ ? &*knownCodes_ : nullptr; }
    std::unique_ptr<DeltaWalker> walker() const override;

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
