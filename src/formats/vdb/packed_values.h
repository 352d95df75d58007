// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "formats/vdb/vdb_walk.h"

namespace deltasplat {

/// Unpacks what zlib has packed; returns whether it is whole, by its checksum, and `size` bytes.
/// OpenVDB 10 asks for the size alone.
/// @param values  takes as many at least
bool unpackZip(std::span<const char> chunk, std::span<char> values, std::size_t size);

/// What unpacking takes behind what is unpacked: OpenVDB 10 asks for 16.
inline constexpr std::size_t kUnpackBytes = 64;

/// Returns a value that stands alone in a .vdb file: the background, a tile of the root, ...
/// @tparam T       the grid's value type; for bools the std::uint8_t that one is stored as
/// @param  stored  of the format's `alone` bytes
template <typename T>
T valueAlone(const char* stored, const VdbValueFormat& format) {
    if constexpr (std::is_floating_point_v<T>) {
        if (format.alone == sizeof(openvdb::math::half)) {
            openvdb::math::half half;
            std::memcpy(&half, stored, sizeof half);
            return T(float(half));
        }
    }
    T value;
    std::memcpy(static_cast<void*>(&value), stored, sizeof value);
    return value;
}

/// The values of a node of a .vdb file, as its bytes have them.
struct PackedValues {
    std::uint32_t count;  ///< of all places of the node, or of the active ones
    std::span<const char> data;
    bool isPacked;
};

/// @param bytes  from what follows the node's masks to its end
/// @param mask   which of its places are active
/// @return nothing if there are more bytes or fewer
std::optional<PackedValues> packedValues(std::span<const char> bytes,
                                         std::span<const std::uint64_t> mask,
                                         const VdbValueFormat& format);

/// Writes the values as they are stored; returns whether they are whole.
/// @param values  takes them and kUnpackBytes
bool unpack(const PackedValues& packed, const VdbValueFormat& format, std::span<char> values);

/// Writes the values of all places of a node, inactive ones too, as the grid has them; returns
/// whether they are whole.
/// @tparam T      the grid's value type: a number, or openvdb::Vec3f, Vec3d or Vec3i of them; for
///                bools the std::uint8_t that one is stored as
/// @param bytes   as packedValues
/// @param stored  room that is kept from node to node
/// @param values  one for each place
template <typename T>
bool unpackAll(std::span<const char> bytes, std::span<const std::uint64_t> mask,
               const VdbValueFormat& format, T background, std::vector<char>& stored, T* values);

/// Unpacks a chunk of Blosc's; returns whether it is whole, and of `size` bytes.
/// @param values  takes them and kUnpackBytes
bool unpackBlosc(std::span<const char> chunk, std::span<char> values, std::size_t size);

}  // namespace deltasplat
