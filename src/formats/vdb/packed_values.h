// SPDX-License-Identifier: Apache-2.0
// Based on: the OpenVDB file format, as OpenVDB 10's headers write it (io/Compression.h).
#pragma once

#include <openvdb/Types.h>
#include <openvdb/io/Compression.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <string>
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

/// Appends the bytes of a number, or of several.
template <typename T>
void appendBytes(const T& value, std::string& to) {
    to.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// Appends a chunk of Blosc's as OpenVDB makes them; returns its bytes, 0 if it cannot be made.
std::int64_t appendBlosc(const void* values, std::size_t bytes, std::string& to);

/// Appends values packed by Blosc, or as they are where that makes them no smaller: their number of
/// bytes, negative if they are not packed, and they themselves.
/// @return how many bytes they have
std::int64_t appendPacked(const void* values, std::size_t bytes, std::string& to);

/// Appends values as they are stored.
/// @param half  whether they are halves
/// @return what OpenVDB notes of their size
template <typename T>
std::int64_t appendStored(const T* values, std::size_t count, bool half, std::string& to) {
    constexpr std::int64_t kSize = sizeof(std::int64_t);
    if (half && count == 0) return kSize;  // which is noted, but not there
    return kSize + appendPacked(values, count * sizeof(T), to);
}

/// Appends values, as halves if `half` says so and they are real.
/// @return as appendStored
template <typename T>
std::int64_t appendValues(const T* values, std::size_t count, bool half, std::string& to) {
    using ToHalf = openvdb::io::RealToHalf<T>;
    if (!ToHalf::isReal || !half) return appendStored(values, count, false, to);
    const auto halves = std::make_unique_for_overwrite<typename ToHalf::HalfT[]>(count);
    std::transform(values, values + count, halves.get(), ToHalf::convert);
    return appendStored(halves.get(), count, true, to);
}

/// Calls use(i) for the bits of a mask that are set.
template <typename Mask, typename Use>
void forBits(const Mask& mask, const Use& use) {
    for (openvdb::Index word = 0; word < Mask::WORD_COUNT; ++word) {
        for (auto left = mask.template getWord<std::uint64_t>(word); left != 0; left &= left - 1)
            use(std::size_t{64} * word + std::size_t(std::countr_zero(left)));
    }
}

/// What "file_delayed_load" has of a leaf.
struct LeafNote {
    std::int8_t kind;
    std::int64_t size;
};

/// Appends the values of a node, inactive ones only where they are of more than two kinds.
/// @param values    of all of its places
/// @param children  places of child nodes, which have no values
template <typename T, typename Mask>
LeafNote appendNode(const T* values, const Mask& active, const Mask& children, const T& background,
                    bool half, std::string& to) {
    using namespace openvdb::io;
    const MaskCompress<T, Mask> inactive(active, children, values, background);
    const std::int8_t kind = inactive.metadata;
    appendBytes(kind, to);
    const auto appendInactive = [&](const T& value) {
        appendBytes(half ? T(truncateRealToHalf(value)) : value, to);
    };
    const bool hasTwo = kind == MASK_AND_TWO_INACTIVE_VALS;
    if (kind == NO_MASK_AND_ONE_INACTIVE_VAL || kind == MASK_AND_ONE_INACTIVE_VAL || hasTwo)
        appendInactive(inactive.inactiveVal[0]);
    if (hasTwo) appendInactive(inactive.inactiveVal[1]);
    if (kind == NO_MASK_AND_ALL_VALS) return {kind, appendValues(values, Mask::SIZE, half, to)};
    if (hasTwo || kind == MASK_AND_ONE_INACTIVE_VAL || kind == MASK_AND_NO_INACTIVE_VALS) {
        Mask second;
        Mask others = active;
        others.toggle();
        forBits(others, [&](std::size_t i) {
            if (MaskCompress<T, Mask>::eq(values[i], inactive.inactiveVal[1]))
                second.setOn(openvdb::Index(i));
        });
        appendBytes(second, to);
    }
    if (active.isOn()) return {kind, appendValues(values, Mask::SIZE, half, to)};
    const auto kept = std::make_unique_for_overwrite<T[]>(Mask::SIZE);
    std::size_t count = 0;
    forBits(active, [&](std::size_t i) { kept[count++] = values[i]; });
    return {kind, appendValues(kept.get(), count, half, to)};
}

}  // namespace deltasplat
