// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

namespace deltasplat {

/// The bytes of a regular file, in any order. Several threads may read at once.
class FileBytes {
  public:
    /// @throw Error(kInput) if the file is missing, not regular or cannot be opened
    explicit FileBytes(const std::filesystem::path& file);
    /// Returns the bytes that a file holds under gzip, in memory.
    /// @throw Error(kInput) if it is no sound gzip; Error(kFailed) if they do not fit into memory
    static std::shared_ptr<const FileBytes> unpacked(const std::filesystem::path& file);
    /// Returns the bytes of a file, or if it begins as gzip does those that it holds.
    static std::shared_ptr<const FileBytes> plain(const std::filesystem::path& file);
    ~FileBytes();
    FileBytes(const FileBytes&) = delete;
    FileBytes& operator=(const FileBytes&) = delete;

    const std::filesystem::path& path() const { return path_; }
    std::uint64_t size() const { return size_; }
    /// Reads `bytes` bytes from `place` on; returns how many there were.
    /// @throw Error(kInput) if they cannot be read
    std::size_t read(std::uint64_t place, void* to, std::size_t bytes) const;
    /// Does the same on all threads.
    std::size_t readInParts(std::uint64_t place, void* to, std::size_t bytes) const;
    /// @throw Error(kInput) if the file was written to after it was opened
    void requireUnchanged() const;
    /// Says so.
    [[noreturn]] void throwChanged() const;

  private:
    // Its size, and when it was last written to, in seconds and nanoseconds.
    using State = std::array<std::int64_t, 3>;
    std::optional<State> state() const;

    std::filesystem::path path_;
    int handle_ = -1;
    std::uint64_t size_ = 0;
    std::optional<State> opened_;            // state() when it was opened
    std::optional<std::vector<char>> held_;  // in place of the file's own bytes
};

}  // namespace deltasplat
