// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <glm/vec3.hpp>
#include <string>
#include <type_traits>

#include "deltasplat/ingest/read_volume.h"

namespace deltasplat {

/// Value types without empty places. 64-bit integers need a file that names its type, unlike .raw.
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
int rawTypeBytes(RawType type);

/// The complete, checked layout of a raw file's bytes.
struct RawLayout {
    glm::i64vec3 dims{1};  ///< each 1..2^30; the product of dims and bytes fits into 63 bits
    RawType type = RawType::kUint8;
    bool bigEndian = false;
    std::uint64_t skipBytes = 0;

    std::uint64_t voxels() const { return std::uint64_t(dims.x * dims.y * dims.z); }
    std::uint64_t dataBytes() const { return voxels() * std::uint64_t(rawTypeBytes(type)); }
    /// Returns the bytes that a file must hold, for example "8388608 (256x256x128 uint8)".
    std::string expectedSize() const;
};

/// @throw Error(kUsage) if spacing or origin is out of the range that readers accept in files
void requireGeometry(const RawFormat& format);

/// Completes `format` from the file's name; options override the name.
/// @throw Error(kUsage) if dims or type are missing, unknown or out of range
RawLayout resolveRawLayout(const std::filesystem::path& file, const RawFormat& format);

/// Returns whether the name of an output gives its layout; false if a reader would find none in it.
/// @throw Error(kUsage) "<file>: got a name that says 4x4x4 uint8; expected 4x4x8 uint8"
bool saysLayout(const std::filesystem::path& file, const RawLayout& layout);

template <std::size_t kBytes>
using BitsOf = std::conditional_t<
    kBytes == 1, std::uint8_t,
    std::conditional_t<kBytes == 2, std::uint16_t,
                       std::conditional_t<kBytes == 4, std::uint32_t, std::uint64_t>>>;

/// Returns the value whose bytes are at `from`, reversed if `swap`.
template <typename T>
inline T loadValue(const std::byte* from, bool swap) {
    using Bits = BitsOf<sizeof(T)>;
    Bits bits;
    std::memcpy(&bits, from, sizeof(T));
    if (swap) {
        // Compilers turn this loop into one instruction.
        Bits turned = 0;
        for (std::size_t i = 0; i < sizeof(T); ++i) {
            turned = Bits(turned | Bits(bits >> (8 * i) & 0xff) << (8 * (sizeof(T) - 1 - i)));
        }
        bits = turned;
    }
    return std::bit_cast<T>(bits);
}

/// Whether bytes of this order differ from the processor's.
constexpr bool mustSwap(bool bigEndian) {
    return bigEndian != (std::endian::native == std::endian::big);
}

/// Calls use(T{}) with the C++ type of `type`.
template <typename Use>
auto withRawType(RawType type, const Use& use) {
    switch (type) {
        case RawType::kUint8:
            return use(std::uint8_t{});
        case RawType::kInt8:
            return use(std::int8_t{});
        case RawType::kUint16:
            return use(std::uint16_t{});
        case RawType::kInt16:
            return use(std::int16_t{});
        case RawType::kUint32:
            return use(std::uint32_t{});
        case RawType::kInt32:
            return use(std::int32_t{});
        case RawType::kUint64:
            return use(std::uint64_t{});
        case RawType::kInt64:
            return use(std::int64_t{});
        case RawType::kFloat32:
            return use(float{});
        case RawType::kFloat64:
            break;
    }
    return use(double{});
}

}  // namespace deltasplat
