// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <string>

#include "deltasplat/ingest/read_volume.h"

namespace deltasplat {

/// The types of values in files without empty places. Those of 64 whole bits come only from files
/// that name their type themselves, and not from .raw files.
enum class RawType {
    kUint8,
    kInt8,
    kUint16,
    kInt16,
    kUint32,
    kInt32,
    kFloat32,
    kFloat64,
    kUint64,
    kInt64
};

/// Returns "uint8", ..., "float64".
const char* rawTypeName(RawType type);
/// Returns 1, 2, 4 or 8.
int rawTypeBytes(RawType type);

/// What the bytes of a raw file are, complete and checked.
struct RawLayout {
    glm::i64vec3 dims{1};  ///< each 1..2^30; the product of dims and bytes fits into 63 bits
    RawType type = RawType::kUint8;
    bool bigEndian = false;
    std::uint64_t skipBytes = 0;

    std::uint64_t voxels() const { return std::uint64_t(dims.x * dims.y * dims.z); }
    std::uint64_t dataBytes() const { return voxels() * std::uint64_t(rawTypeBytes(type)); }
    /// Returns what a file of this layout must hold, for example "8388608 (256x256x128 uint8)".
    std::string expectedSize() const;
};

/// @throw Error(kUsage) if the spacing or the origin is one that no file could hold: a reader would
///        refuse it
void requireGeometry(const RawFormat& format);

/// Completes `format` from the name of `file`; what the options say wins over the name.
/// @throw Error(kUsage) if dims or type are missing, unknown or out of range
RawLayout resolveRawLayout(const std::filesystem::path& file, const RawFormat& format);

/// Returns whether the name of a file to be written says its layout; false if it says nothing that
/// a reader would take.
/// @throw Error(kUsage) "<file>: got a name that says 4x4x4 uint8; expected 4x4x8 uint8"
bool saysLayout(const std::filesystem::path& file, const RawLayout& layout);

}  // namespace deltasplat
