// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ingest/vdb/vdb_walk.h"

namespace deltasplat {

/// What unpacking takes behind what is unpacked: OpenVDB 10 asks for 16.
inline constexpr std::size_t kUnpackBytes = 64;

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
