// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>

#include "ingest/files/file_bytes.h"

namespace deltasplat {

class Unpacker;

/// How the bytes of a file are packed.
enum class Packing {
    kNone,
    kGzip,  ///< one gzip member or several, up to the end of the file, zeros aside
    kZlib   ///< one zlib or gzip stream; what follows it is nobody's
};

/// Returns kGzip for a file that begins as gzip does, whatever its name; kNone for others.
/// @param start  place in the file to look at
/// @throw Error(kInput) if the file is missing, not regular or cannot be opened
Packing packingOf(const std::filesystem::path& file, std::uint64_t start = 0);

/// The bytes of a plain or a packed file, front to back.
class ByteSource {
  public:
    /// @param start  place in the file of the first byte, plain or packed
    /// @throw Error(kInput) if the file is missing, not regular or cannot be opened
    ByteSource(const std::filesystem::path& file, Packing packing, std::uint64_t start = 0);
    /// The same of a file that is open.
    explicit ByteSource(std::shared_ptr<const FileBytes> file, std::uint64_t start = 0,
                        Packing packing = Packing::kNone);
    ~ByteSource();
    ByteSource(const ByteSource&) = delete;
    ByteSource& operator=(const ByteSource&) = delete;

    /// Reads the next `bytes` bytes, fewer only at the end; returns how many. Packed bytes are
    /// known to be whole, by their count and checksum, once there were fewer.
    /// @throw Error(kInput) if the file cannot be read, or is corrupt, cut short, or goes on behind
    ///        what is packed
    std::size_t read(void* to, std::size_t bytes);
    /// Passes over up to `bytes` bytes, calling `step` now and then; returns how many there were.
    /// @throw as read, and what `step` throws
    std::uint64_t skip(std::uint64_t bytes, const std::function<void()>& step);

  private:
    std::shared_ptr<const FileBytes> file_;
    std::uint64_t place_;
    std::unique_ptr<Unpacker> unpacker_;  // if packed
};

}  // namespace deltasplat
