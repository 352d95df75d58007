// SPDX-License-Identifier: Apache-2.0
#include "ingest/vdb/vdb_bytes.h"

#include <openvdb/Grid.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <string_view>
#include <utility>

#include "deltasplat/error.h"
#include "printable.h"

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

bool isKnown(const std::string& type, std::uint32_t bytes) {
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

}  // namespace

VdbBytes::VdbBytes(const std::filesystem::path& file)
    : name_(file.string()), file_(file, std::ios::in | std::ios::binary) {
    if (!file_) {
        throw Error(ErrorCode::kInput,
                    gotExpected(name_, "a file that cannot be opened", "a readable file"));
    }
    file_.seekg(0, std::ios::end);
    size_ = std::uint64_t(file_.tellg());
}

void VdbBytes::failCorrupt(const std::string& got, const std::string& expected) const {
    throw Error(ErrorCode::kInput, gotExpected(name_, got, expected));
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
    // More and more, so that a few small fields take little.
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
    file_.seekg(std::streamoff(begin));
    file_.read(buffer_.data(), std::streamsize(count));
    if (!file_) failCorrupt("a read error", "a readable file");
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

// OpenVDB itself reads its files only on little endian machines.
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

std::string readMetadata(VdbBytes& bytes, bool half, VdbRange* leafSizes) {
    const std::string kHalf = openvdb::GridBase::META_SAVE_HALF_FLOAT;
    const std::uint32_t count = bytes.u32();
    std::uint32_t kept = 0;
    std::string entries;
    std::map<std::string, std::string> types;  // by names
    const auto add = [&](const std::string& name, const std::string& type,
                         const std::string& value) {
        appendText(entries, name);
        appendText(entries, type);
        appendText(entries, value);
        ++kept;
    };
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::string name = bytes.text();
        const std::string type = bytes.text();
        const std::uint32_t size = bytes.u32();
        if (!isKnown(type, size)) {
            if (leafSizes && type == "__delayedload") *leafSizes = {bytes.position(), size};
            bytes.skip(size);
            continue;
        }
        const std::string value = bytes.bytes(size);
        if (name == kHalf) continue;
        if (types.try_emplace(name, type).first->second != type) {
            bytes.failCorrupt("metadata \"" + printable(name) + "\" of two types",
                              "a sound OpenVDB file");
        }
        add(name, type, value);
    }
    if (half) add(kHalf, "bool", "\1");
    std::string metadata;
    appendU32(metadata, kept);
    return metadata + entries;
}

void appendU32(std::string& text, std::uint32_t value) {
    for (int i = 0; i < 4; ++i) text += char(value >> (8 * i) & 0xff);
}

}  // namespace deltasplat
