// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "files/file_bytes.h"

namespace deltasplat {

/// Reads the small fields of a .vdb file (little endian), each checked against the file's size.
class VdbBytes {
  public:
    explicit VdbBytes(std::shared_ptr<const FileBytes> file);

    std::uint64_t size() const { return size_; }
    std::uint64_t position() const { return position_; }
    /// All of these throw Error(kInput) where the file ends too early.
    void seek(std::uint64_t position);
    std::uint8_t u8();
    std::uint32_t u32();
    std::int64_t i64();
    void read(void* to, std::uint64_t count);
    void skip(std::uint64_t count);
    std::string bytes(std::uint64_t count);
    /// A 32-bit length and that many bytes, at most `most`.
    std::string text(std::uint32_t most = 65536);

    /// Calls `step` with the position, every few megabytes that are read; it may throw.
    void onProgress(std::function<void(std::uint64_t)> step) { step_ = std::move(step); }

    [[noreturn]] void failCorrupt(const std::string& got, const std::string& expected) const;

  private:
    void require(std::uint64_t count) const;
    void fill(std::uint64_t begin, std::uint64_t count);
    template <typename T>
    T number();

    std::shared_ptr<const FileBytes> file_;
    std::string name_;
    std::uint64_t size_ = 0;
    std::uint64_t position_ = 0;
    std::vector<char> buffer_;                          // what the file holds from bufferBegin_ on
    std::uint64_t nextBytes_ = std::uint64_t{1} << 14;  // that are read at once
    std::uint64_t bufferBegin_ = 0;
    std::function<void(std::uint64_t)> step_;
    std::uint64_t untold_ = 0;  // bytes read since it was called
};

/// A part of a file.
struct VdbRange {
    std::uint64_t begin = 0;
    std::uint64_t size = 0;
};

/// Appends `value` to `text` as four bytes, little endian.
void appendU32(std::string& text, std::uint32_t value);

}  // namespace deltasplat
