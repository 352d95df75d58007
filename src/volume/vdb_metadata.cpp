// SPDX-License-Identifier: Apache-2.0
#include "volume/vdb_metadata.h"

#include <openvdb/Grid.h>

#include <array>
#include <cstring>
#include <memory>
#include <sstream>
#include <string_view>
#include <type_traits>
#include <utility>

#include "base/text.h"
#include "deltasplat/error.h"
#include "volume/tree_types.h"

namespace deltasplat {
namespace {

struct MetadataType {
    std::string_view name;
    std::uint32_t bytes;
};

// OpenVDB reads these without looking at the stored size, so the size must be right.
constexpr std::array<MetadataType, 16> kFixedTypes{{{"bool", 1},
                                                    {"int32", 4},
                                                    {"float", 4},
                                                    {"int64", 8},
                                                    {"double", 8},
                                                    {"vec2i", 8},
                                                    {"vec2s", 8},
                                                    {"vec2d", 16},
                                                    {"vec3i", 12},
                                                    {"vec3s", 12},
                                                    {"vec3d", 24},
                                                    {"vec4i", 16},
                                                    {"vec4s", 16},
                                                    {"vec4d", 32},
                                                    {"mat4s", 64},
                                                    {"mat4d", 128}}};

bool isKnown(const std::string& type, std::size_t bytes) {
    if (type == "string") return true;
    for (const MetadataType& known : kFixedTypes) {
        if (type == known.name) return bytes == known.bytes;
    }
    return false;
}

void appendText(std::string& to, const std::string& text) {
    appendU32(to, std::uint32_t(text.size()));
    to += text;
}

template <typename T>
constexpr const char* kTypeName = nullptr;
template <>
constexpr const char* kTypeName<std::string> = "string";
template <>
constexpr const char* kTypeName<bool> = "bool";
template <>
constexpr const char* kTypeName<std::int32_t> = "int32";
template <>
constexpr const char* kTypeName<std::int64_t> = "int64";
template <>
constexpr const char* kTypeName<double> = "double";
template <>
constexpr const char* kTypeName<glm::ivec3> = "vec3i";

}  // namespace

VdbMetadata::VdbMetadata(const openvdb::MetaMap& metadata) {
    for (auto own = metadata.beginMeta(); own != metadata.endMeta(); ++own) {
        std::ostringstream stream;
        own->second->write(stream);  // its size, and its value
        Entry entry{own->second->typeName(), stream.str().substr(sizeof(std::uint32_t))};
        if (isKnown(entry.type, entry.value.size())) insert(own->first, std::move(entry));
    }
}

const VdbMetadata::Entry* VdbMetadata::find(const std::string& name) const {
    const auto found = entries_.find(name);
    return found == entries_.end() ? nullptr : &found->second;
}

template <typename T>
std::optional<T> VdbMetadata::get(const std::string& name) const {
    const Entry* const entry = find(name);
    if (!entry || entry->type != kTypeName<T>) return std::nullopt;
    if constexpr (std::is_same_v<T, std::string>) {
        return entry->value;
    } else if constexpr (std::is_same_v<T, bool>) {
        return entry->value[0] != '\0';
    } else {
        T value;
        std::memcpy(&value, entry->value.data(), sizeof value);
        return value;
    }
}

template <typename T>
void VdbMetadata::insert(const std::string& name, const T& value) {
    Entry entry{kTypeName<T>, {}};
    if constexpr (std::is_same_v<T, std::string>) {
        entry.value = value;
    } else {
        entry.value.assign(reinterpret_cast<const char*>(&value), sizeof value);
    }
    insert(name, std::move(entry));
}

template std::optional<std::string> VdbMetadata::get(const std::string&) const;
template std::optional<bool> VdbMetadata::get(const std::string&) const;
template std::optional<std::int32_t> VdbMetadata::get(const std::string&) const;
template std::optional<std::int64_t> VdbMetadata::get(const std::string&) const;
template std::optional<double> VdbMetadata::get(const std::string&) const;
template std::optional<glm::ivec3> VdbMetadata::get(const std::string&) const;
template void VdbMetadata::insert(const std::string&, const std::string&);
template void VdbMetadata::insert(const std::string&, const bool&);
template void VdbMetadata::insert(const std::string&, const std::int32_t&);
template void VdbMetadata::insert(const std::string&, const std::int64_t&);
template void VdbMetadata::insert(const std::string&, const double&);
template void VdbMetadata::insert(const std::string&, const glm::ivec3&);

std::string VdbMetadata::text(const std::string& name) const {
    return get<std::string>(name).value_or("");
}

std::string VdbMetadata::bytes() const {
    std::string bytes;
    appendU32(bytes, std::uint32_t(entries_.size()));
    for (const auto& [name, entry] : entries_) {
        appendText(bytes, name);
        appendText(bytes, entry.type);
        appendText(bytes, entry.value);
    }
    return bytes;
}

openvdb::MetaMap::Ptr VdbMetadata::toMetaMap(const std::string& where) const {
    openvdb::initialize();
    std::istringstream stream(bytes());
    auto metadata = std::make_shared<openvdb::MetaMap>();
    try {
        metadata->readMeta(stream);
    } catch (const openvdb::Exception& error) {
        throw Error(ErrorCode::kInput, where, printable(error.what()),
                    "metadata that OpenVDB can read");
    }
    return metadata;
}

VdbMetadata readMetadata(VdbBytes& bytes, bool half, VdbRange* leafSizes) {
    const std::string kHalf = openvdb::GridBase::META_SAVE_HALF_FLOAT;
    const std::uint32_t count = bytes.u32();
    VdbMetadata metadata;
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::string name = bytes.text();
        const std::string type = bytes.text();
        const std::uint32_t size = bytes.u32();
        if (!isKnown(type, size)) {
            if (leafSizes && type == "__delayedload") *leafSizes = {bytes.position(), size};
            bytes.skip(size);
            continue;
        }
        std::string value = bytes.bytes(size);
        if (name.empty() || name == kHalf) continue;
        const VdbMetadata::Entry* const other = metadata.find(name);
        if (other && other->type != type) {
            bytes.failCorrupt("metadata \"" + printable(name) + "\" of two types",
                              "a sound OpenVDB file");
        }
        metadata.insert(name, {type, std::move(value)});
    }
    if (half) metadata.insert(kHalf, {"bool", "\1"});
    return metadata;
}

}  // namespace deltasplat
