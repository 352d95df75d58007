// SPDX-License-Identifier: Apache-2.0
#include "ingest/vdb/vdb_tiles.h"

#include <openvdb/Types.h>

#include <atomic>
#include <bit>
#include <cstring>

#include "ingest/vdb/packed_values.h"
#include "parallel.h"

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

struct NodeTiles {
    std::vector<TilePlace> places;
    std::vector<char> values;
};

openvdb::Coord placeOf(const VdbTileNode& node, int child) {
    const auto [log2, childLog2] = shapeOf(node.level);
    const int mask = (1 << log2) - 1;
    return openvdb::Coord(node.origin.data())
        .offsetBy((child >> (2 * log2)) << childLog2, (child >> log2 & mask) << childLog2,
                  (child & mask) << childLog2);
}

// Appends a stored value as the grid has it.
void append(const char* stored, const VdbValueFormat& format, std::vector<char>& values) {
    const std::size_t place = values.size();
    values.resize(place + format.bytes);
    char* const to = values.data() + place;
    if (format.stored == format.bytes) {
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

// Returns whether the node is sound.
bool readNode(const FileBytes& file, const VdbValueFormat& format, const VdbTileNode& node,
              NodeTiles& tiles) {
    std::vector<char> bytes(node.size);
    if (file.read(node.begin, bytes.data(), node.size) != node.size) return false;
    if (node.level == 3) {
        tiles.places.push_back({openvdb::Coord(node.origin.data()), 3});
        tiles.values = std::move(bytes);
        return tiles.values.size() == format.bytes;
    }
    const std::size_t places = std::size_t{1} << (3 * shapeOf(node.level).log2);
    std::vector<std::uint64_t> mask(places / 64);
    const std::span<const std::uint64_t> active(mask);
    if (bytes.size() < 2 * active.size_bytes()) return false;
    std::memcpy(mask.data(), bytes.data() + active.size_bytes(), active.size_bytes());
    const std::span<const char> rest =
        std::span<const char>(bytes).subspan(2 * active.size_bytes());
    const auto packed = packedValues(rest, active, format);
    if (!packed) return false;
    std::vector<char> stored(places * format.stored + kUnpackBytes);
    if (!unpack(*packed, format, stored)) return false;
    const bool haveAll = packed->count == places;
    std::size_t next = 0;
    for (std::size_t word = 0; word < mask.size(); ++word) {
        for (std::uint64_t left = mask[word]; left != 0; left &= left - 1) {
            const std::size_t child = 64 * word + std::size_t(std::countr_zero(left));
            tiles.places.push_back({placeOf(node, int(child)), openvdb::Index(node.level)});
            append(stored.data() + format.stored * (haveAll ? child : next), format, tiles.values);
            ++next;
        }
    }
    return true;
}

}  // namespace

std::optional<VdbTiles> VdbTiles::read(const FileBytes& file, const VdbValueFormat& format,
                                       const std::vector<VdbTileNode>& nodes) {
    std::vector<NodeTiles> parts(nodes.size());
    std::atomic<bool> areSound = true;
    parallelFor(nodes.size(), [&](std::size_t i) {
        if (!readNode(file, format, nodes[i], parts[i])) areSound = false;
    });
    if (!areSound) return std::nullopt;
    VdbTiles tiles;
    for (const NodeTiles& part : parts) {
        tiles.places_.insert(tiles.places_.end(), part.places.begin(), part.places.end());
        tiles.values_.insert(tiles.values_.end(), part.values.begin(), part.values.end());
    }
    return tiles;
}

}  // namespace deltasplat
