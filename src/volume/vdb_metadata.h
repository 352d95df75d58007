// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/MetaMap.h>

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <map>
#include <memory>
#include <optional>
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

/// What a .vdb file says of a grid, or of itself, beside voxels: entries of the types that OpenVDB
/// knows. It is read without OpenVDB's library.
class VdbMetadata {
  public:
    struct Entry {
        std::string type;   ///< "string", "int32", ...
        std::string value;  ///< bytes as a file has them

        bool operator==(const Entry&) const = default;
    };
    using Entries = std::map<std::string, Entry>;  // by name

    VdbMetadata() = default;
    /// Those of OpenVDB's that are of types known.
    VdbMetadata(const openvdb::MetaMap& metadata);

    const Entries& entries() const { return entries_; }
    /// Returns null if there is none of that name.
    const Entry* find(const std::string& name) const;
    /// Returns the value of a name that has one of this type.
    /// @tparam T  std::string, bool, std::int32_t, std::int64_t, double or glm::ivec3
    template <typename T>
    std::optional<T> get(const std::string& name) const;
    /// Returns the text of a name; empty if there is none.
    std::string text(const std::string& name) const;
    void insert(const std::string& name, Entry entry) { entries_[name] = std::move(entry); }
    template <typename T>
    void insert(const std::string& name, const T& value);
    void erase(const std::string& name) { entries_.erase(name); }

    /// Returns them as a file has them.
    std::string bytes() const;
    /// Returns them as OpenVDB has them.
    /// @param where  for messages
    /// @throw Error(kInput) if OpenVDB does not take them
    openvdb::MetaMap::Ptr toMetaMap(const std::string& where) const;

  private:
    Entries entries_;
};

/// Reads the metadata at the current position, which moves behind it; entries whose types and sizes
/// OpenVDB cannot be trusted with are left out, as are those without a name.
/// @param half       what "is_saved_as_half_float" shall say: OpenVDB believes it where the grid's
///                   type says otherwise
/// @param leafSizes  null, or where to put where the value of OpenVDB's "file_delayed_load" lies,
///                   if there is one; not read, and not to be trusted
VdbMetadata readMetadata(VdbBytes& bytes, bool half = false, VdbRange* leafSizes = nullptr);

}  // namespace deltasplat
