// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/MetaMap.h>

#include <cstdint>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <string>

#include "volume/vdb_bytes.h"

namespace deltasplat {

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
