// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace deltasplat {

/// The bytes of a regular file, in any order. Several threads may read at once.
class FileBytes {
  public:
    /// @throw Error(kInput) if the file is missing, not regular or cannot be opened
    explicit FileBytes(const std::filesystem::path& file);
    /// Unpacks a gzip file into memory.
    /// @throw Error(kInput) if it is no sound gzip; Error(kFailed) if the bytes do not fit into
    /// memory
    static std::shared_ptr<const FileBytes> unpacked(const std::filesystem::path& file);
    /// Opens a file, or unpacks it if it begins as gzip does.
    static std::shared_ptr<const FileBytes> plain(const std::filesystem::path& file);
    ~FileBytes();
    FileBytes(const FileBytes&) = delete;
    FileBytes& operator=(const FileBytes&) = delete;

    const std::filesystem::path& path() const { return path_; }
    std::uint64_t size() const { return size_; }
    /// Reads up to `bytes` bytes from `place` on; returns the number read.
    /// @throw Error(kInput) if the file cannot be read
    std::size_t read(std::uint64_t place, void* to, std::size_t bytes) const;
    /// The same on all threads.
    std::size_t readInParts(std::uint64_t place, void* to, std::size_t bytes) const;
    /// @throw Error(kInput) if the file was written to after it was opened
    void requireUnchanged() const;
    /// Throws that error.
    [[noreturn]] void throwChanged() const;

  private:
    // The size, and the time of the last write in seconds and nanoseconds.
    using State = std::array<std::int64_t, 3>;
    std::optional<State> state() const;

    std::filesystem::path path_;
    int handle_ = -1;
    std::uint64_t size_ = 0;
    std::optional<State> opened_;            // state() when the file was opened
    std::optional<std::vector<char>> held_;  // the unpacked bytes, in place of the file's own
};

class Unpacker;

/// How the bytes of a file are packed.
enum class Packing {
    kNone,
    kGzip,  ///< gzip members up to the end of the file, zeros aside
    kZlib   ///< one zlib or gzip stream; bytes behind it are ignored
};

/// Returns kGzip for a file that begins as gzip does, whatever its name; else kNone.
/// @param start  place in the file where the packed bytes would begin
/// @throw Error(kInput) if the file is missing, not regular or cannot be opened
Packing packingOf(const std::filesystem::path& file, std::uint64_t start = 0);

/// The bytes of a plain or a packed file, front to back.
class ByteSource {
  public:
    /// @param start  place in the file of the first byte, plain or packed
    /// @throw Error(kInput) if the file is missing, not regular or cannot be opened
    ByteSource(const std::filesystem::path& file, Packing packing, std::uint64_t start = 0);
    /// The same for an open file.
    explicit ByteSource(std::shared_ptr<const FileBytes> file, std::uint64_t start = 0,
                        Packing packing = Packing::kNone);
    ~ByteSource();
    ByteSource(const ByteSource&) = delete;
    ByteSource& operator=(const ByteSource&) = delete;

    /// Reads the next `bytes` bytes, fewer only at the end; returns the number read. At the end the
    /// count and the checksum of packed bytes have been checked.
    /// @throw Error(kInput) if the file cannot be read, is corrupt or cut short, or goes on behind
    ///        the packed bytes
    std::size_t read(void* to, std::size_t bytes);
    /// Passes over up to `bytes` bytes and calls `step` now and then; returns the number passed.
    /// @throw as read, and what `step` throws
    std::uint64_t skip(std::uint64_t bytes, const std::function<void()>& step);

  private:
    std::shared_ptr<const FileBytes> file_;
    std::uint64_t place_;
    std::unique_ptr<Unpacker> unpacker_;  // null for a plain file
};

/// Rows of equal length that lie in a file one after the other, slice by slice.
class StoredRows {
  public:
    /// @param start        place in the file of the first row
    /// @param rowsOfSlice  rows per slice
    StoredRows(std::shared_ptr<const FileBytes> file, std::uint64_t start, std::size_t rowBytes,
               std::int64_t rowsOfSlice)
        : file_(std::move(file)), start_(start), rowBytes_(rowBytes), rowsOfSlice_(rowsOfSlice) {}

    /// Reads some rows of a slice. From any thread.
    /// @throw Error(kInput) if the file has become shorter
    void read(int slice, int firstRow, int rows, std::byte* to) const {
        const auto row = std::uint64_t(std::int64_t{slice} * rowsOfSlice_ + firstRow);
        const std::size_t wanted = std::size_t(rows) * rowBytes_;
        if (file_->read(start_ + row * rowBytes_, to, wanted) != wanted) file_->throwChanged();
    }
    /// @throw Error(kInput) if the file was written to after it was opened
    void requireUnchanged() const { file_->requireUnchanged(); }

  private:
    std::shared_ptr<const FileBytes> file_;
    std::uint64_t start_;
    std::size_t rowBytes_;
    std::int64_t rowsOfSlice_;
};

/// Owns a file descriptor of the system; -1: none.
class Descriptor {
  public:
    explicit Descriptor(int number = -1) : number_(number) {}
    ~Descriptor() { reset(); }
    Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
        std::swap(number_, other.number_);
        return *this;
    }

    int get() const { return number_; }
    explicit operator bool() const { return number_ >= 0; }
    /// Closes the descriptor; returns what close() returns, 0 if all is well.
    int reset() { return number_ >= 0 ? ::close(std::exchange(number_, -1)) : 0; }

  private:
    int number_;
};

/// Throws Error(kOutput) "<file>: cannot be written: <the system's text for `systemError`>".
[[noreturn]] void throwCannotWrite(const std::filesystem::path& file, int systemError);

/// Throws Error(kOutput) "<file>: cannot be written: there is no folder <folder>".
[[noreturn]] void throwNoFolder(const std::filesystem::path& file,
                                const std::filesystem::path& folder);

}  // namespace deltasplat
