// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
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

}  // namespace deltasplat
