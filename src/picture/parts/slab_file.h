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

/// Writes a file of layers of slabs: a line that says what it is, a header of text, and the layers
/// in bands of rows, each packed by zlib and with a checksum. All numbers are little-endian.
///
///     "deltasplat slabs 1\n"
///     bytes of the header, its CRC-32 (4 bytes each), the header
///     for each slab, for each band of bandRows() rows from the top on:
///         words, bytes that they are packed into, CRC-32 of these (4 bytes each), these
///     "end\n"
///
/// The words of a band are the two ends of each row's span, then the floats within spans; packed
/// are the first bytes of all words, then the second ones, and so on.
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

/// Reads such a file, which may have come from anywhere.
class SlabFileReader {
  public:
    /// Reads all before the layers.
    /// @throw Error(kInput) if that is none, or another version's
    explicit SlabFileReader(const std::filesystem::path& file);

    const std::string& header() const { return header_; }
    /// Reads the next layer, of this box and as many channels as `merged`, and puts it behind that,
    /// which holds the box. Multi-threaded.
    /// @throw Error(kInput) if it is damaged or cut short
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

/// How many rows of a layer are packed together.
int bandRows(const PlaneBox& box, int channels);

}  // namespace deltasplat
