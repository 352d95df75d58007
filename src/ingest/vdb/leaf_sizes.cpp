// SPDX-License-Identifier: Apache-2.0
// Based on: the OpenVDB file format, as OpenVDB 10 reads it (io/DelayedLoadMetadata.h).
#include "ingest/vdb/leaf_sizes.h"

#include <algorithm>
#include <cstring>
#include <span>

#include "ingest/vdb/packed_values.h"

namespace deltasplat {
namespace {

// OpenVDB packs no less than this: shorter arrays have zeros behind them.
constexpr std::size_t kLeastPacked = 128;

// Takes an array from `place` on as OpenVDB writes one: how many bytes it is packed in, 0 if it is
// not, and those. Moves `place` behind it; returns whether it is there.
// @param values  of `bytes`, or kLeastPacked if that is more, and room for unpacking
bool takeArray(const std::string& stored, std::size_t bytes, std::span<char> values,
               std::uint64_t& place) {
    std::uint32_t packed = 0;
    if (stored.size() - place < sizeof packed) return false;
    std::memcpy(&packed, stored.data() + place, sizeof packed);
    place += sizeof packed;
    const std::uint64_t size = packed > 0 ? packed : bytes;
    if (stored.size() - place < size) return false;
    const std::span<const char> data(stored.data() + place, size);
    place += size;
    if (packed > 0) return unpackBlosc(data, values, std::max(bytes, kLeastPacked));
    std::memcpy(values.data(), data.data(), size);
    return true;
}

}  // namespace

std::optional<std::vector<std::uint64_t>> leafSizesOf(const std::string& stored, std::size_t leaves,
                                                      const VdbValueFormat& format) {
    constexpr std::uint64_t kLeafMask = 64;
    std::uint32_t count = 0;
    if (stored.size() < sizeof count) return std::nullopt;
    std::memcpy(&count, stored.data(), sizeof count);
    if (count != leaves) return std::nullopt;
    std::uint64_t place = sizeof count;
    const auto take = [&](auto& values) {
        const std::size_t bytes = leaves * sizeof values[0];
        values.resize((std::max(bytes, kLeastPacked) + kUnpackBytes) / sizeof values[0]);
        const bool isThere = takeArray(
            stored, bytes,
            {reinterpret_cast<char*>(values.data()), values.size() * sizeof values[0]}, place);
        values.resize(leaves);
        return isThere;
    };
    std::vector<std::uint8_t> kinds;
    std::vector<std::uint64_t> sizes;
    if (!take(kinds) || !take(sizes)) return std::nullopt;
    for (std::size_t i = 0; i < leaves; ++i) {
        if (sizes[i] > std::uint64_t{1} << 20) return std::nullopt;
        // A byte that says what inactive values are like, those, and which voxel has which.
        sizes[i] += 1 + format.inactiveBytes(kinds[i], kLeafMask);
    }
    return sizes;
}

}  // namespace deltasplat
