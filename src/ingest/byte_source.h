// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>

namespace deltasplat {

/// The bytes of a plain or a gzip file, front to back.
class ByteSource {
  public:
    /// @throw Error(kInput) if the file is missing, not regular or cannot be opened
    ByteSource(const std::filesystem::path& file, bool gzip);
    ~ByteSource();
    ByteSource(const ByteSource&) = delete;
    ByteSource& operator=(const ByteSource&) = delete;

    /// Reads the next `bytes` bytes, fewer only at the end; returns how many.
    /// @throw Error(kInput) if the file cannot be read or its gzip stream is corrupt or cut short
    std::size_t read(void* to, std::size_t bytes);
    /// Passes over up to `bytes` bytes, calling `step` now and then; returns how many there were.
    /// @throw as read, and what `step` throws
    std::uint64_t skip(std::uint64_t bytes, const std::function<void()>& step);

  private:
    std::size_t readSome(void* to, unsigned bytes);

    std::filesystem::path file_;
    bool gzip_;
    void* handle_ = nullptr;
};

}  // namespace deltasplat
