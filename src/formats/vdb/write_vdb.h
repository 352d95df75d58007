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

/// Makes a file's tag from its content, so that equal content gets equal tags.
class ContentTag {
  public:
    void add(const char* bytes, std::size_t count);
    /// Returns a UUID of version 8 (free use, RFC 9562) of all bytes.
    std::string text();

  private:
    void hashBlock();

    std::uint64_t hash_ = 0xcbf29ce484222325u;
    std::vector<char> block_;  // bytes not hashed yet
};

/// Writes grids into one `.vdb` on all threads, without OpenVDB's library: Blosc and active-mask
/// compression, grid offsets, statistics in the metadata. The bytes equal those of
/// openvdb::io::File, with two exceptions. The file appears only once complete (io::File does not
/// notice a full disk). The 128-bit tag, random in OpenVDB, is made from the content, so equal
/// grids give equal bytes; on a device the tag covers only the bytes before voxels.
/// @throw Error(kOutput) if the file cannot be written; whatever `listener.progress` throws
void writeVdb(const std::filesystem::path& file, const std::vector<WrittenGrid>& grids,
              const VdbMetadata& fileMetadata = {}, const Listener& listener = {});

/// Returns the size of a file with this grid alone.
std::uint64_t writtenBytes(const WrittenGrid& grid);

/// Returns the value of the metadata "file_delayed_load", which leafSizesOf reads.
/// @param kinds    per leaf in file order, as in PackedLeaves
/// @param sizes    likewise
/// @param mayPack  whether Blosc packs the notes if that makes them smaller
std::string leafNotes(const std::vector<std::int8_t>& kinds, const std::vector<std::int64_t>& sizes,
                      bool mayPack);

/// The leaves of a tree, packed on all threads. A file states their sizes before the leaves, so all
/// leaves are packed first. Leaves without room in memory are packed again on writing.
class LeafPieces {
  public:
    /// @param tree  outlives this object
    LeafPieces(const WrittenTree& tree, bool half);

    /// @param room  bytes of memory for packed leaves; reduced by those used
    /// @param step  hears the finished share; may throw
    void pack(std::uint64_t& room, const std::function<void(double)>& step);
    std::uint64_t bytes() const { return bytes_; }
    /// Returns the leafNotes() of all leaves.
    std::string notes(bool mayPack) const;
    /// Calls use(bytes) for all packed leaves in order, and releases them.
    void take(const std::function<void(const std::string&)>& use);

  private:
    std::size_t count() const;
    PackedLeaves packPiece(std::size_t piece) const;
    void forBatches(std::size_t begin, const std::function<void(PackedLeaves)>& use) const;

    const WrittenTree& tree_;
    bool half_;
    std::uint64_t bytes_ = 0;
    std::vector<std::string> kept_;  // the first pieces
    std::vector<std::int8_t> kinds_;
    std::vector<std::int64_t> sizes_;
};

}  // namespace deltasplat
