// SPDX-License-Identifier: Apache-2.0
#include "formats/raw/raw_format.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <glm/geometric.hpp>
#include <limits>

#include "base/refuse.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "files/file_name.h"
#include "volume/placement.h"

namespace deltasplat {
namespace {

struct TypeInfo {
    RawType type;
    const char* name;
    int bytes;
};

constexpr std::array<TypeInfo, 10> kTypes{{{RawType::kUint8, "uint8", 1},
                                           {RawType::kInt8, "int8", 1},
                                           {RawType::kUint16, "uint16", 2},
                                           {RawType::kInt16, "int16", 2},
                                           {RawType::kUint32, "uint32", 4},
                                           {RawType::kInt32, "int32", 4},
                                           {RawType::kFloat32, "float32", 4},
                                           {RawType::kFloat64, "float64", 8},
                                           {RawType::kUint64, "uint64", 8},
                                           {RawType::kInt64, "int64", 8}}};
// The remaining types are not allowed in .raw files.
constexpr std::size_t kRawNames = 8;

constexpr const char* kKnownTypes =
    "one of uint8, int8, uint16, int16, uint32, int32, float32, float64";
constexpr std::int64_t kMaxDim = std::int64_t{1} << 30;

// Parts of a name such as engine_256x256x128_uint8be.raw; empty text if absent.
struct NameParts {
    std::array<std::string, 3> dims;
    std::string type;
    std::optional<bool> bigEndian;
};

const TypeInfo* findType(const std::string& name) {
    for (std::size_t i = 0; i < kRawNames; ++i) {
        if (name == kTypes[i].name) return &kTypes[i];
    }
    return nullptr;
}

bool isDigit(char c) {
    return c >= '0' && c <= '9';
}

bool isLetterOrDigit(char c) {
    return isDigit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

// Parses a text such as 256x256x128.
std::optional<std::array<std::string, 3>> dimsIn(const std::string& text) {
    std::array<std::string, 3> dims;
    std::size_t axis = 0;
    for (const char c : text) {
        if (c == 'x' && !dims[axis].empty() && axis < 2) {
            ++axis;
        } else if (isDigit(c)) {
            dims[axis] += c;
        } else {
            return {};
        }
    }
    if (dims[2].empty()) return {};
    return dims;
}

NameParts parseName(const std::filesystem::path& file) {
    NameParts parts;
    const std::string stem = nameWithoutExtensions(file);
    const std::size_t second = stem.rfind('_');
    if (second == std::string::npos || second == 0) return parts;
    if (const auto dims = dimsIn(stem.substr(second + 1))) {
        parts.dims = *dims;
        return parts;
    }
    const std::size_t first = stem.rfind('_', second - 1);
    if (first == std::string::npos) return parts;
    const std::string type = stem.substr(second + 1);
    const auto dims = dimsIn(stem.substr(first + 1, second - first - 1));
    if (!dims || type.empty() || !std::all_of(type.begin(), type.end(), isLetterOrDigit))
        return parts;
    parts.dims = *dims;
    parts.type = type;

    // "uint16be" is a type followed by a byte order.
    const std::size_t size = parts.type.size();
    const std::string order = size > 2 ? parts.type.substr(size - 2) : "";
    if ((order == "be" || order == "le") && findType(parts.type.substr(0, size - 2))) {
        parts.type.resize(size - 2);
        parts.bigEndian = order == "be";
    }
    return parts;
}

glm::i64vec3 dimsFromName(const std::string& file, const NameParts& parts) {
    glm::i64vec3 dims{0};
    for (int axis = 0; axis < 3; ++axis) {
        const std::string& digits = parts.dims[std::size_t(axis)];
        const auto result =
            std::from_chars(digits.data(), digits.data() + digits.size(), dims[axis]);
        if (result.ec != std::errc{}) {
            refuseUsage(file, "dims " + parts.dims[0] + "x" + parts.dims[1] + "x" + parts.dims[2],
                        "each 1.." + std::to_string(kMaxDim));
        }
    }
    return dims;
}

glm::i64vec3 resolveDims(const std::filesystem::path& file, const RawFormat& format,
                         const NameParts& parts) {
    if (!format.dims && parts.dims[0].empty()) {
        refuseUsage(file.string(), "no dimensions",
                    "`dims` XxYxZ and `type` TYPE, or a name such as volume_256x256x128_uint8.raw");
    }
    const std::string where = format.dims ? "`dims`" : file.string();
    const glm::i64vec3 dims = format.dims ? *format.dims : dimsFromName(where, parts);
    for (int axis = 0; axis < 3; ++axis) {
        if (dims[axis] < 1 || dims[axis] > kMaxDim) {
            refuseUsage(where, (format.dims ? "" : "dims ") + dimsText(dims),
                        "each 1.." + std::to_string(kMaxDim));
        }
    }
    return dims;
}

const TypeInfo& resolveType(const std::filesystem::path& file, const RawFormat& format,
                            const NameParts& parts) {
    if (!format.type && parts.type.empty()) {
        refuseUsage(file.string(), "no value type",
                    "`type` TYPE, or a name such as volume_256x256x128_uint8.raw");
    }
    const std::string& name = format.type ? *format.type : parts.type;
    const TypeInfo* info = findType(name);
    if (info == nullptr && format.type) refuseUsage("`type`", name, kKnownTypes);
    if (info == nullptr) refuseUsage(file.string(), "value type " + name, kKnownTypes);
    return *info;
}

// Each dim is at most 2^30, so only products can exceed 63 bits.
void checkSize(const std::string& where, const RawLayout& layout) {
    const std::int64_t limit = std::numeric_limits<std::int64_t>::max();
    const std::int64_t slice = layout.dims.x * layout.dims.y;
    const std::int64_t bytes = rawTypeBytes(layout.type);
    if (layout.dims.z > limit / slice / bytes) {
        refuseUsage(where, dimsText(layout.dims) + " " + rawTypeName(layout.type),
                    "at most 9223372036854775807 bytes");
    }
    if (layout.skipBytes > std::uint64_t(limit) - layout.dataBytes()) {
        refuseUsage("`skipBytes`", std::to_string(layout.skipBytes),
                    "less than 9223372036854775807 bytes together with the voxels");
    }
}

}  // namespace

const char* rawTypeName(RawType type) {
    return kTypes[std::size_t(type)].name;
}

int rawTypeBytes(RawType type) {
    return kTypes[std::size_t(type)].bytes;
}

std::string RawLayout::expectedSize() const {
    const std::string skip = skipBytes == 0 ? "" : std::to_string(skipBytes) + " skipped + ";
    return std::to_string(skipBytes + dataBytes()) + " (" + skip + dimsText(dims) + " " +
           rawTypeName(type) + ")";
}

void requireGeometry(const RawFormat& format) {
    const std::string most = numberText(kMostLength);
    for (int axis = 0; axis < 3; ++axis) {
        const double spacing = format.spacing.value_or(glm::dvec3(1))[axis];
        if (spacing >= 1 / kMostLength && spacing <= kMostLength) continue;
        refuseUsage("`spacing`", numberText(spacing),
                    "three numbers from " + numberText(1 / kMostLength) + " to " + most);
    }
    if (glm::length(format.origin) <= kMostLength) return;
    refuseUsage("`origin`", numberText(format.origin), "a place within " + most + " of 0,0,0");
}

RawLayout resolveRawLayout(const std::filesystem::path& file, const RawFormat& format) {
    const NameParts parts = parseName(file);
    RawLayout layout;
    layout.dims = resolveDims(file, format, parts);
    layout.type = resolveType(file, format, parts).type;
    layout.bigEndian = format.bigEndian.value_or(parts.bigEndian.value_or(false));
    layout.skipBytes = format.skipBytes;
    requireGeometry(format);
    checkSize(format.dims ? "`dims`" : file.string(), layout);
    return layout;
}

bool saysLayout(const std::filesystem::path& file, const RawLayout& layout) {
    RawLayout said;
    try {
        said = resolveRawLayout(file, {});
    } catch (const Error&) {
        return false;  // the name says nothing useful
    }
    const auto text = [](const RawLayout& one) {
        const bool ordered = rawTypeBytes(one.type) > 1 && one.bigEndian;
        return dimsText(one.dims) + " " + rawTypeName(one.type) + (ordered ? "be" : "");
    };
    if (text(said) == text(layout)) return true;
    refuseUsage(file.string(), "a name that says " + text(said),
                text(layout) + ", or a name that says nothing");
}

}  // namespace deltasplat
