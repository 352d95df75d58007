// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "composite/layer.h"
#include "deltasplat/atomic_file.h"
#include "files/file_bytes.h"

namespace deltasplat {

/// Writes a file of layers of slabs: a line that names the format, a text header, and the layers in
/// bands of rows, each packed by zlib and with a checksum. All numbers are little-endian.
///
///     "deltasplat slabs 1\n"
///     bytes of the header, its CRC-32 (4 bytes each), the header
///     for each slab, for each band of bandRows() rows from the top on:
///         number of words, number of packed bytes, their CRC-32 (4 bytes each), packed bytes
///     "end\n"
///
/// The words of a band are the two ends of each row's span, then the floats within spans. Packed
/// are first the first bytes of all words, then the second bytes, and so on.
class SlabFileWriter {
  public:
    SlabFileWriter(const std::filesystem::path& file, std::string_view header);

    /// Multi-threaded.
    void write(const Layer& layer);
    /// Gives the file its final name.
    void finish();

  private:
    void writeNumbers(std::span<const std::uint32_t> numbers);

    AtomicFile file_;
};

/// Reads such a file. The file is not trusted.
class SlabFileReader {
  public:
    /// Reads everything before the layers.
    /// @throw Error(kInput) if the format or its version is another
    explicit SlabFileReader(const std::filesystem::path& file);

    const std::string& header() const { return header_; }
    /// Reads the next layer, with the given box and the channels of `merged`, and puts it behind
    /// `merged`, whose box includes it. Multi-threaded.
    /// @throw Error(kInput) if the layer is damaged or cut short
    void mergeNext(const PlaneBox& box, Layer& merged);
    /// @throw Error(kInput) if the file does not end here
    void finish();
    [[noreturn]] void refuse(const std::string& got, const std::string& expected) const;

  private:
    std::uint32_t readNumber();
    void readBytes(void* to, std::size_t bytes);

    std::unique_ptr<const FileBytes> file_;
    std::uint64_t place_ = 0;
    std::string header_;
};

/// Rows of a layer that are packed together.
int bandRows(const PlaneBox& box, int channels);

}  // namespace deltasplat
