// SPDX-License-Identifier: Apache-2.0
#include "ingest/vdb_bytes.h"

#include <array>
#include <string_view>

#include "deltasplat/error.h"

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

std::uint64_t littleEndian(const std::string& bytes) {
    std::uint64_t value = 0;
    for (std::size_t i = bytes.size(); i-- > 0;) {
        value = value * 256 + static_cast<unsigned char>(bytes[i]);
    }
    return value;
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
    file_.seekg(0);
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
    file_.seekg(std::streamoff(position));
}

std::string VdbBytes::bytes(std::uint64_t count) {
    require(count);
    std::string text(std::size_t(count), '\0');
    file_.read(text.data(), std::streamsize(count));
    if (!file_) failCorrupt("a read error", "a readable file");
    position_ += count;
    return text;
}

std::uint8_t VdbBytes::u8() {
    return std::uint8_t(littleEndian(bytes(1)));
}
std::uint32_t VdbBytes::u32() {
    return std::uint32_t(littleEndian(bytes(4)));
}
std::int64_t VdbBytes::i64() {
    return std::int64_t(littleEndian(bytes(8)));
}

std::string VdbBytes::text(std::uint32_t most) {
    const std::uint32_t length = u32();
    if (length > most) {
        failCorrupt("a name of " + std::to_string(length) + " bytes",
                    "at most " + std::to_string(most) + " (a corrupt .vdb file)");
    }
    return bytes(length);
}

VdbMetadata readMetadata(VdbBytes& bytes) {
    const std::uint32_t count = bytes.u32();
    std::uint32_t kept = 0;
    std::string entries;
    VdbMetadata metadata;
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::string name = bytes.text();
        const std::string type = bytes.text();
        const std::uint32_t size = bytes.u32();
        if (!isKnown(type, size)) {
            bytes.seek(bytes.position() + size);
            continue;
        }
        const std::string value = bytes.bytes(size);
        if (name == "file_mem_bytes" && type == "int64") {
            metadata.memoryBytes = std::int64_t(littleEndian(value));
        }
        appendText(entries, name);
        appendText(entries, type);
        appendText(entries, value);
        ++kept;
    }
    appendU32(metadata.kept, kept);
    metadata.kept += entries;
    return metadata;
}

void appendU32(std::string& text, std::uint32_t value) {
    for (int i = 0; i < 4; ++i) text += char(value >> (8 * i) & 0xff);
}

}  // namespace deltasplat
