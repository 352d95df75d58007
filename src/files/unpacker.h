// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "files/file_bytes.h"

struct z_stream_s;

namespace deltasplat {

/// Unpacks gzip or zlib streams of a file. (zlib's gzread accepts a file whose checksum is cut off,
/// and reads a file that begins otherwise as plain bytes.)
class Unpacker {
  public:
    /// @param anyStream  true: one zlib or gzip stream, whatever follows it; false: gzip members,
    /// and
    ///                   nothing but zeros behind them
    /// @param start      place in the file
    Unpacker(const FileBytes& file, bool anyStream, std::uint64_t start);
    ~Unpacker();
    Unpacker(const Unpacker&) = delete;
    Unpacker& operator=(const Unpacker&) = delete;

    /// As ByteSource::read.
    std::size_t read(void* to, std::size_t bytes);

  private:
    [[noreturn]] void refuse(const std::string& got, const std::string& expected) const;
    bool fill();
    std::size_t inflateSome(void* to, std::size_t bytes);
    [[noreturn]] void refuseCorrupt() const;
    void passEnd();

    const FileBytes& file_;
    bool anyStream_;
    std::uint64_t place_;
    std::vector<unsigned char> packed_;
    std::unique_ptr<z_stream_s> stream_;
    int members_ = 0;  // gzip members that have ended
    bool done_ = false;
};

}  // namespace deltasplat
