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

/// Reads small little-endian fields of a .vdb file and checks each against the file's size.
class VdbBytes {
  public:
    explicit VdbBytes(std::shared_ptr<const FileBytes> file);

    std::uint64_t size() const { return size_; }
    std::uint64_t position() const { return position_; }
    /// All readers throw Error(kInput) if the file ends too early.
    void seek(std::uint64_t position);
    std::uint8_t u8();
    std::uint32_t u32();
    std::int64_t i64();
    void read(void* to, std::uint64_t count);
    void skip(std::uint64_t count);
    std::string bytes(std::uint64_t count);
    /// Reads a 32-bit length, at most `most`, and that many bytes.
    std::string text(std::uint32_t most = 65536);

    /// Sets a function that is called with the position every few megabytes. It may throw.
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
    std::vector<char> buffer_;                          // the file's bytes from bufferBegin_ on
    std::uint64_t nextBytes_ = std::uint64_t{1} << 14;  // size of the next read
    std::uint64_t bufferBegin_ = 0;
    std::function<void(std::uint64_t)> step_;
    std::uint64_t untold_ = 0;  // bytes read since the last call of step_
};

struct VdbRange {
    std::uint64_t begin = 0;
    std::uint64_t size = 0;
};

/// Appends four bytes, little endian.
void appendU32(std::string& text, std::uint32_t value);

/// Metadata of a grid or a file: entries of types known to OpenVDB. Needs no OpenVDB library.
class VdbMetadata {
  public:
    struct Entry {
        std::string type;   ///< "string", "int32", ...
        std::string value;  ///< bytes as in a file

        bool operator==(const Entry&) const = default;
    };
    using Entries = std::map<std::string, Entry>;  // by name

    VdbMetadata() = default;
    /// Takes the entries whose types are known.
    VdbMetadata(const openvdb::MetaMap& metadata);

    const Entries& entries() const { return entries_; }
    /// Returns null if there is no such entry.
    const Entry* find(const std::string& name) const;
    /// Returns an entry's value; nothing if there is no entry of this name and type.
    /// @tparam T  std::string, bool, std::int32_t, std::int64_t, double or glm::ivec3
    template <typename T>
    std::optional<T> get(const std::string& name) const;
    /// Returns the text of an entry; empty if there is none.
    std::string text(const std::string& name) const;
    void insert(const std::string& name, Entry entry) { entries_[name] = std::move(entry); }
    template <typename T>
    void insert(const std::string& name, const T& value);
    void erase(const std::string& name) { entries_.erase(name); }

    /// Returns the entries as in a file.
    std::string bytes() const;
    /// Returns the entries in OpenVDB's type.
    /// @param where  for messages
    /// @throw Error(kInput) if OpenVDB rejects the entries
    openvdb::MetaMap::Ptr toMetaMap(const std::string& where) const;

  private:
    Entries entries_;
};

/// Reads the metadata at the current position, and moves behind it. Leaves out entries without a
/// name and entries of types or sizes that OpenVDB cannot handle safely.
/// @param half       value of "is_saved_as_half_float", because OpenVDB believes it even against
///                   the grid's type
/// @param leafSizes  null, or receives where the value of "file_delayed_load" lies, if there is
///                   one: not read, and not to be trusted
VdbMetadata readMetadata(VdbBytes& bytes, bool half = false, VdbRange* leafSizes = nullptr);

}  // namespace deltasplat
