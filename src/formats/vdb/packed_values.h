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

/// Unpacks a zlib chunk. Returns whether size and checksum are right; OpenVDB 10 checks only size.
/// @param values  room for at least `size` bytes
bool unpackZip(std::span<const char> chunk, std::span<char> values, std::size_t size);

/// Spare room for unpacking behind the values: OpenVDB 10 asks for 16 bytes.
inline constexpr std::size_t kUnpackBytes = 64;

/// Returns a value that a .vdb file stores by itself: the background, a tile of the root, ...
/// @tparam T       the grid's value type; std::uint8_t for bools
/// @param  stored  `format.alone` bytes
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

struct PackedValues {
    std::uint32_t count;  ///< of all places of the node, or of its active places
    std::span<const char> data;
    bool isPacked;
};

/// @param bytes  the node's bytes behind its masks
/// @param mask   active places of the node
/// @return nothing if the size of `bytes` is wrong
std::optional<PackedValues> packedValues(std::span<const char> bytes,
                                         std::span<const std::uint64_t> mask,
                                         const VdbValueFormat& format);

/// Writes the values as stored. Returns whether they are intact.
/// @param values  room for the values and kUnpackBytes
bool unpack(const PackedValues& packed, const VdbValueFormat& format, std::span<char> values);

/// Writes all values of a node in the grid's type, inactive ones too. Returns whether it is intact.
/// @tparam T      number, openvdb::Vec3f, Vec3d or Vec3i; std::uint8_t for bools
/// @param bytes   as packedValues
/// @param stored  scratch room, reused from node to node
/// @param values  room for one value per place
template <typename T>
bool unpackAll(std::span<const char> bytes, std::span<const std::uint64_t> mask,
               const VdbValueFormat& format, T background, std::vector<char>& stored, T* values);

/// Unpacks a Blosc chunk. Returns whether it is intact and has `size` bytes.
/// @param values  room for the values and kUnpackBytes
bool unpackBlosc(std::span<const char> chunk, std::span<char> values, std::size_t size);

template <typename T>
void appendBytes(const T& value, std::string& to) {
    to.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// Appends a Blosc chunk as OpenVDB makes it. Returns its size, or 0 on failure.
std::int64_t appendBlosc(const void* values, std::size_t bytes, std::string& to);

/// Appends a size and the values, packed by Blosc; the size is negative if packing saves nothing.
/// @return number of bytes of the values
std::int64_t appendPacked(const void* values, std::size_t bytes, std::string& to);

/// Appends values, or halves if `half` is set, as they are. Returns the size that OpenVDB notes.
template <typename T>
std::int64_t appendStored(const T* values, std::size_t count, bool half, std::string& to) {
    constexpr std::int64_t kSize = sizeof(std::int64_t);
    if (half && count == 0) return kSize;  // noted, although no size is stored
    return kSize + appendPacked(values, count * sizeof(T), to);
}

/// Appends values as appendStored does; real ones as halves if `half` is set.
template <typename T>
std::int64_t appendValues(const T* values, std::size_t count, bool half, std::string& to) {
    using ToHalf = openvdb::io::RealToHalf<T>;
    if (!ToHalf::isReal || !half) return appendStored(values, count, false, to);
    const auto halves = std::make_unique_for_overwrite<typename ToHalf::HalfT[]>(count);
    std::transform(values, values + count, halves.get(), ToHalf::convert);
    return appendStored(halves.get(), count, true, to);
}

/// Calls use(i) for each set bit of a mask.
template <typename Mask, typename Use>
void forBits(const Mask& mask, const Use& use) {
    for (openvdb::Index word = 0; word < Mask::WORD_COUNT; ++word) {
        for (auto left = mask.template getWord<std::uint64_t>(word); left != 0; left &= left - 1)
            use(std::size_t{64} * word + std::size_t(std::countr_zero(left)));
    }
}

/// Notes of "file_delayed_load" on one leaf.
struct LeafNote {
    std::int8_t kind;
    std::int64_t size;
};

/// Appends the values of a node; inactive values only if there are more than two different ones.
/// @param values    of all places
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
