// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "deltasplat/progress.h"
#include "formats/vdb/written_grid.h"
#include "volume/vdb_metadata.h"

namespace deltasplat {

/// Makes the tag of a file from its content, so that the same content has the same tag.
class ContentTag {
  public:
    /// Takes the bytes that follow.
    void add(const char* bytes, std::size_t count);
    /// Returns a UUID of version 8 (free use, RFC 9562) that stands for all bytes.
    std::string text();

  private:
    void hashBlock();

    std::uint64_t hash_ = 0xcbf29ce484222325u;
    std::vector<char> block_;  // of the bytes that are not hashed yet
};

/// Writes grids into one `.vdb`: Blosc and active-mask compression, grid offsets, statistics in the
/// metadata, the same bytes as openvdb::io::File writes, with two differences. The file appears
/// only when it is whole (io::File does not notice a full disk). And its 128-bit tag, random
/// otherwise, is made from the content, so that the same grids give the same bytes (where the file
/// is a device, from what comes before voxels). On all threads; OpenVDB's library is not needed.
/// @throw Error(kOutput) if it cannot be written; whatever `listener.progress` throws
void writeVdb(const std::filesystem::path& file, const std::vector<WrittenGrid>& grids,
              const VdbMetadata& fileMetadata = {}, const Listener& listener = {});

/// Returns how many bytes a file of this grid alone has.
std::uint64_t writtenBytes(const WrittenGrid& grid);

/// Returns the value of a grid's metadata "file_delayed_load" as a file has it, which leafSizesOf
/// reads.
/// @param kinds    of leaves in the order of the file, as PackedLeaves has them
/// @param sizes    likewise
/// @param mayPack  whether they are packed by Blosc where that makes them smaller
std::string leafNotes(const std::vector<std::int8_t>& kinds, const std::vector<std::int64_t>& sizes,
                      bool mayPack);

/// The leaves of a tree, packed on all threads. A file has to say how large they are before it has
/// them: so all are packed, and those for which there is no room are packed once more when they are
/// written.
class LeafPieces {
  public:
    /// @param tree  must live as long
    LeafPieces(const WrittenTree& tree, bool half);

    /// Packs all leaves.
    /// @param room  how many bytes may be kept in memory; becomes what is left
    /// @param step  hears of the share that is done; may throw
    void pack(std::uint64_t& room, const std::function<void(double)>& step);
    std::uint64_t bytes() const { return bytes_; }
    /// Returns OpenVDB's notes of all leaves, as leafNotes() has them.
    std::string notes(bool mayPack) const;
    /// Calls use(bytes) for what pack() has packed, in order, and lets go of it.
    void take(const std::function<void(const std::string&)>& use);

  private:
    std::size_t count() const;
    PackedLeaves packPiece(std::size_t piece) const;
    void forBatches(std::size_t begin, const std::function<void(PackedLeaves)>& use) const;

    const WrittenTree& tree_;
    bool half_;
    std::uint64_t bytes_ = 0;
    std::vector<std::string> kept_;  // the first ones
    std::vector<std::int8_t> kinds_;
    std::vector<std::int64_t> sizes_;
};

}  // namespace deltasplat
