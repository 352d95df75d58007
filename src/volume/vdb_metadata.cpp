// SPDX-License-Identifier: Apache-2.0
#include "volume/vdb_metadata.h"

#include <openvdb/Grid.h>

#include <algorithm>
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

// OpenVDB ignores the stored size of these types, so the size must be right.
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
        own->second->write(stream);  // size and value
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

VdbBytes::VdbBytes(std::shared_ptr<const FileBytes> file)
    : file_(std::move(file)), name_(file_->path().string()), size_(file_->size()) {}

void VdbBytes::failCorrupt(const std::string& got, const std::string& expected) const {
    throw Error(ErrorCode::kInput, name_, got, expected);
}

void VdbBytes::require(std::uint64_t count) const {
    if (count > size_ - position_) {
        failCorrupt(std::to_string(size_) + " bytes",
                    "at least " + std::to_string(position_) + " + " + std::to_string(count) +
                        " (a .vdb file that is cut short or corrupt)");
    }
}

void VdbBytes::seek(std::uint64_t position) {
    if (position > size_) {
        failCorrupt(
            std::to_string(size_) + " bytes",
            "at least " + std::to_string(position) + " (a .vdb file that is cut short or corrupt)");
    }
    position_ = position;
}

void VdbBytes::skip(std::uint64_t count) {
    require(count);
    position_ += count;
}

void VdbBytes::read(void* to, std::uint64_t count) {
    require(count);
    // Reads grow, so that a few small fields cost little.
    constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 16;
    auto* out = static_cast<char*>(to);
    while (count > 0) {
        if (position_ < bufferBegin_ || position_ >= bufferBegin_ + buffer_.size()) {
            fill(position_, std::min(nextBytes_, size_ - position_));
            nextBytes_ = std::min(2 * nextBytes_, kMostBytes);
        }
        const std::uint64_t offset = position_ - bufferBegin_;
        const std::uint64_t part = std::min(count, buffer_.size() - offset);
        std::memcpy(out, buffer_.data() + offset, std::size_t(part));
        out += part;
        position_ += part;
        count -= part;
    }
}

void VdbBytes::fill(std::uint64_t begin, std::uint64_t count) {
    bufferBegin_ = begin;
    buffer_.resize(std::size_t(count));
    if (file_->read(begin, buffer_.data(), std::size_t(count)) != count) file_->throwChanged();
    constexpr std::uint64_t kStepBytes = std::uint64_t{4} << 20;
    untold_ += count;
    if (!step_ || untold_ < kStepBytes) return;
    untold_ = 0;
    step_(begin);
}

std::string VdbBytes::bytes(std::uint64_t count) {
    require(count);
    std::string text(std::size_t(count), '\0');
    read(text.data(), count);
    return text;
}

// OpenVDB itself reads its files only on little-endian machines.
template <typename T>
T VdbBytes::number() {
    T value;
    read(&value, sizeof value);
    return value;
}

std::uint8_t VdbBytes::u8() {
    return number<std::uint8_t>();
}
std::uint32_t VdbBytes::u32() {
    return number<std::uint32_t>();
}
std::int64_t VdbBytes::i64() {
    return number<std::int64_t>();
}

std::string VdbBytes::text(std::uint32_t most) {
    const std::uint32_t length = u32();
    if (length > most) {
        failCorrupt("a name of " + std::to_string(length) + " bytes",
                    "at most " + std::to_string(most) + " (a corrupt .vdb file)");
    }
    return bytes(length);
}

void appendU32(std::string& text, std::uint32_t value) {
    for (int i = 0; i < 4; ++i) text += char(value >> (8 * i) & 0xff);
}

}  // namespace deltasplat
