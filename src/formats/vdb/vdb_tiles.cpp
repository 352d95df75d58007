// SPDX-License-Identifier: Apache-2.0
#include "formats/vdb/vdb_tiles.h"

#include <openvdb/Types.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstring>

#include "base/parallel.h"
#include "formats/vdb/packed_values.h"

namespace deltasplat {
namespace {

// A node's children lie along each axis, 2^log2 of them, each of 2^childLog2 voxels.
struct NodeShape {
    int log2;
    int childLog2;
};

constexpr NodeShape shapeOf(int level) {
    return level == 1 ? NodeShape{4, 3} : NodeShape{5, 7};
}

openvdb::Coord placeOf(const VdbNode& node, int child) {
    const auto [log2, childLog2] = shapeOf(node.level);
    const int mask = (1 << log2) - 1;
    return openvdb::Coord(node.origin.data())
        .offsetBy((child >> (2 * log2)) << childLog2, (child >> log2 & mask) << childLog2,
                  (child & mask) << childLog2);
}

// Writes a stored value as the grid has it.
void writeValue(const char* stored, const VdbValueFormat& format, char* to) {
    if (!format.areHalves()) {
        std::memcpy(to, stored, format.bytes);
        return;
    }
    openvdb::math::half half;
    std::memcpy(&half, stored, sizeof half);
    const auto single = float(half);
    const auto wide = double(single);
    std::memcpy(to, format.bytes == sizeof wide ? static_cast<const void*>(&wide) : &single,
                format.bytes);
}

// Writes the places and values of a node's tiles; returns whether it is sound.
bool readNode(const FileBytes& file, const VdbValueFormat& format, const VdbNode& node,
              TilePlace* places, char* values) {
    std::vector<char> bytes(node.size);
    if (file.read(node.begin, bytes.data(), node.size) != node.size) return false;
    if (node.level == 3) {
        *places = {openvdb::Coord(node.origin.data()), 3};
        if (format.alone == format.bytes) {
            std::copy(bytes.begin(), bytes.end(), values);
        } else {
            writeValue(bytes.data(), format, values);
        }
        return true;
    }
    const std::size_t children = std::size_t{1} << (3 * shapeOf(node.level).log2);
    std::vector<std::uint64_t> mask(children / 64);
    const std::span<const std::uint64_t> active(mask);
    if (bytes.size() < 2 * active.size_bytes()) return false;
    std::memcpy(mask.data(), bytes.data() + active.size_bytes(), active.size_bytes());
    const auto packed =
        packedValues(std::span<const char>(bytes).subspan(2 * active.size_bytes()), active, format);
    if (!packed) return false;
    std::vector<char> stored(children * format.stored + kUnpackBytes);
    if (!unpack(*packed, format, stored)) return false;
    const bool haveAll = packed->count == children;
    std::size_t next = 0;
    for (std::size_t word = 0; word < mask.size(); ++word) {
        for (std::uint64_t left = mask[word]; left != 0; left &= left - 1, ++next) {
            // The file is another one than it was.
            if (next == node.tiles) return false;
            const std::size_t child = 64 * word + std::size_t(std::countr_zero(left));
            places[next] = {placeOf(node, int(child)), openvdb::Index(node.level)};
            writeValue(stored.data() + format.stored * (haveAll ? child : next), format,
                       values + format.bytes * next);
        }
    }
    return next == node.tiles;
}

}  // namespace

std::optional<VdbTiles> VdbTiles::read(const FileBytes& file, const VdbValueFormat& format,
                                       const std::vector<VdbNode>& nodes) {
    std::vector<std::size_t> begins;
    std::size_t count = 0;
    for (const VdbNode& node : nodes) {
        begins.push_back(count);
        count += node.tiles;
    }
    VdbTiles tiles;
    tiles.places_.resize(count);
    tiles.values_.resize(count * format.bytes);
    std::atomic<bool> areSound = true;
    parallelFor(nodes.size(), [&](std::size_t i) {
        if (nodes[i].tiles == 0) return;
        if (!readNode(file, format, nodes[i], &tiles.places_[begins[i]],
                      &tiles.values_[begins[i] * format.bytes]))
            areSound = false;
    });
    if (!areSound) return std::nullopt;
    return tiles;
}

}  // namespace deltasplat
