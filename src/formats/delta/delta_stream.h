// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "base/sorting.h"
#include "base/uncleared.h"
#include "deltasplat/progress.h"
#include "formats/delta/delta_columns.h"
#include "formats/delta/delta_format.h"
#include "formats/delta/stream_index.h"
#include "formats/vdb/vdb_leaves.h"
#include "volume/tree_grid.h"

namespace deltasplat {

struct DeltaHeader;

/// How the 64 voxels of a slice of a block are written.
enum class SliceForm {
    kAll = 0,   ///< every number
    kMask = 1,  ///< 64 bits that say which numbers are not 0, and those less 1
    kRows = 2   ///< the same with 8 bits for rows and 8 for each row that is not empty
};

/// Deltas as voxels.
struct UnpackedDeltas {
    TreeGrid grid;
    CodesInUse said;  ///< what they are to add up to; without a histogram if that is not known
};

/// Unpacks a delta grid whose voxels are the words of a stream: numbers of few bits, first
/// where its columns are, then the columns; docs/delta-grid.md specifies them.
/// Multi-threaded.
/// @param grid  of type int64
/// @return a grid with the same metadata and transform whose voxels are deltas, as version 4 has
///         them, within the header's box; what they say may contradict the header
/// @throw Error(kInput) if the words have gaps, or the stream ends early or late or says what it
///        cannot; Error(kFailed) if memory does not hold the deltas
UnpackedDeltas unpackDeltas(const TreeGrid& grid, const DeltaHeader& header,
                            const std::string& where, const Listener& listener);
/// Returns how many bits a delta without sign takes at most.
int deltaWidth(const DeltaHeader& header);

/// Sorts items by u, v and slice, and returns the columns that they make.
/// @param blockOf  where an item is, (slice, u, v) divided by 8
template <typename T, typename BlockOf>
std::vector<DeltaColumn> orderByColumns(std::vector<T>& items, const BlockOf& blockOf) {
    parallelSort(items, [&](const T& a, const T& b) {
        const glm::ivec3 p = blockOf(a), q = blockOf(b);
        return std::tie(p.y, p.z, p.x) < std::tie(q.y, q.z, q.x);
    });
    const std::vector<std::size_t> begins = runBegins(items, [&](const T& a, const T& b) {
        const glm::ivec3 p = blockOf(a), q = blockOf(b);
        return p.y == q.y && p.z == q.z;
    });
    std::vector<DeltaColumn> columns;
    for (std::size_t i = 0; i + 1 < begins.size(); ++i) {
        const glm::ivec3 first = blockOf(items[begins[i]]);
        columns.push_back({{first.y, first.z}, begins[i], begins[i + 1]});
    }
    return columns;
}

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
