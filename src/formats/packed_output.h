// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <zlib.h>

#include <cstddef>
#include <filesystem>
#include <vector>

#include "deltasplat/atomic_file.h"

namespace deltasplat {

/// An AtomicFile whose bytes pass through gzip from some point on. The same bytes in give the same
/// bytes out: the gzip header holds neither a time nor a name.
class PackedOutput {
  public:
    /// @throw Error(kOutput) as AtomicFile
    explicit PackedOutput(const std::filesystem::path& finalPath);
    ~PackedOutput();
    PackedOutput(const PackedOutput&) = delete;
    PackedOutput& operator=(const PackedOutput&) = delete;

    /// Packs all bytes from here on. To be called once.
    void beginGzip();
    /// @throw Error(kOutput) if not all bytes can be written
    void write(const void* bytes, std::size_t size);
    /// Ends writing, so that what is left to do in commit() is the renaming.
    /// @throw Error(kOutput) if not all bytes could be written
    void close();
    /// Gives the file its final name. close() comes first.
    void commit() { file_.commit(); }
    /// Gives a data file and this one, its header, their final names, as AtomicFile does.
    void commitWithData(PackedOutput& data) { file_.commitWithData(data.file_); }

  private:
    void deflateInput(int flush);

    AtomicFile file_;
    std::vector<unsigned char> packed_;  // empty: not packing
    z_stream stream_{};
};

}  // namespace deltasplat
