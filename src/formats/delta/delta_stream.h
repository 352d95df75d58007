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

/// How the 64 voxels of a block's slice are written.
enum class SliceForm {
    kAll = 0,   ///< every number
    kMask = 1,  ///< a mask of 64 bits, then the numbers other than 0, less 1
    kRows = 2   ///< the same with 8 bits for rows, and 8 per row that is not empty
};

struct UnpackedDeltas {
    TreeGrid grid;
    CodesInUse said;  ///< the stream's own statement; no histogram if unknown
};

/// Unpacks a delta grid whose voxels are the words of a stream, specified in docs/delta-grid.md: an
/// index of columns, then the columns. Multi-threaded.
/// @param grid  of type int64
/// @return the same grid with deltas as voxels in the header's box; may contradict the header
/// @throw Error(kInput) for gaps, a wrong end or an impossible index; Error(kFailed) without memory
UnpackedDeltas unpackDeltas(const TreeGrid& grid, const DeltaHeader& header,
                            const std::string& where, const Listener& listener);
/// Returns the most bits of a zigzag delta.
int deltaWidth(const DeltaHeader& header);

/// Sorts items by u, v and slice, and returns their columns.
/// @param blockOf  returns an item's block: (slice, u, v) divided by 8
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

/// Packed deltas of 32 bits: a stream of words from the leaves of a file.
class StreamColumns {
  public:
    /// Reads the words on all threads.
    /// @param leaves  of int64
    /// @param header  outlives this object
    /// @return nothing if the words have gaps
    /// @throw Error(kInput) if the index is impossible; Error(kFailed) if memory is too small
    static std::optional<StreamColumns> read(const VdbLeaves& leaves, const DeltaHeader& header,
                                             const std::string& where);

    /// Columns with deltas, by u and v.
    const std::vector<DeltaColumn>& columns() const { return columns_; }
    /// Upper bound of the number of blocks with deltas.
    std::size_t blocks() const { return blocks_; }
    /// Null if the file does not state its codes.
    const KnownCodes* knownCodes() const { return knownCodes_ ? &*knownCodes_ : nullptr; }
    /// Returns a walker for one thread. Thread-safe.
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
