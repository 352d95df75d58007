// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

namespace deltasplat {

/// Reads the small fields of a .vdb file (little endian), each checked against the file's size.
class VdbBytes {
  public:
    /// @throw Error(kInput) if the file cannot be opened
    explicit VdbBytes(const std::filesystem::path& file);

    std::uint64_t size() const { return size_; }
    std::uint64_t position() const { return position_; }
    /// All of these throw Error(kInput) where the file ends too early.
    void seek(std::uint64_t position);
    std::uint8_t u8();
    std::uint32_t u32();
    std::int64_t i64();
    std::string bytes(std::uint64_t count);
    /// A 32-bit length and that many bytes, at most `most`.
    std::string text(std::uint32_t most = 65536);

    [[noreturn]] void failCorrupt(const std::string& got, const std::string& expected) const;

  private:
    void require(std::uint64_t count) const;

    std::string name_;
    std::ifstream file_;
    std::uint64_t size_ = 0;
    std::uint64_t position_ = 0;
};

/// What matters of a grid's metadata.
struct VdbMetadata {
    std::string kept;              ///< in the file's form, entries of known types and sizes only
    std::int64_t memoryBytes = 0;  ///< what the grid's tree takes in memory, where the file says so
};

/// Reads the metadata at the current position, which moves behind it.
VdbMetadata readMetadata(VdbBytes& bytes);

/// Appends `value` to `text` as four bytes, little endian.
void appendU32(std::string& text, std::uint32_t value);

}  // namespace deltasplat
