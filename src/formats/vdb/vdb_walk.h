// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "volume/vdb_metadata.h"

namespace deltasplat {

/// OpenVDB 13's type of grids with halves in memory as well; such a grid becomes one of floats.
inline constexpr const char* kHalfType = "half";

/// How a grid's values lie in a .vdb file.
struct VdbValueFormat {
    std::uint32_t bytes = 4;   ///< of a value in the finished tree
    std::uint32_t stored = 4;  ///< of a value in a node's data: 2 for a half
    /// Size of a value by itself: the background, a root tile, a node's inactive value. Grids of
    /// halves store a half here; float grids kept as halves store a float.
    std::uint32_t alone = 4;
    bool real = true;  ///< float, double and their vectors
    enum class Leaf { kValues, kBools, kMask } leaf = Leaf::kValues;
    std::uint32_t compression = 0;  ///< flags of the grid itself, openvdb::io::COMPRESS_...

    /// Returns the size of a node's inactive values and of the mask that assigns them to places.
    /// @param kind  of the node: openvdb::io's NO_MASK_... or MASK_...
    /// @param mask  bytes of a mask of the node's places
    std::uint64_t inactiveBytes(int kind, std::uint64_t mask) const;
    /// Whether values are stored shorter than in the tree.
    bool areHalves() const { return stored != bytes; }
    /// Whether floats or doubles are kept as halves: then OpenVDB stores no size of empty data.
    bool areKeptAsHalves() const { return stored != alone; }
    /// Sets all but the compression; returns false for an unknown `type` ("float", "vec3s", ...).
    bool setType(const std::string& type, bool half);
};

struct VdbTreeSize {
    std::uint64_t leaves = 0;  ///< nodes of 8^3 voxels
    std::uint64_t lower = 0;   ///< nodes of 16^3 leaves
    std::uint64_t upper = 0;   ///< nodes of 32^3 lower nodes
    std::uint64_t tiles = 0;   ///< active ones, of all levels
    /// Returns the approximate bytes of the tree, a tree of one vector part, and a tree of codes.
    double memoryBytes(const VdbValueFormat& format) const;
    /// Returns the approximate bytes of the tree of codes alone.
    double codeBytes(const VdbValueFormat& format) const;
    /// Returns the approximate bytes of a tree without leaf values, and of its leaves' places.
    double nodeBytes() const;
};

/// The place of a leaf in a file.
struct VdbLeaf {
    using Mask = std::array<std::uint64_t, 8>;  ///< [x]: bit 8 y + z

    std::array<std::int32_t, 3> origin;  ///< of its first voxel
    std::uint32_t size = 0;              ///< bytes of its mask (64) and its values
    std::uint64_t begin = 0;
    /// Sum of the mask that precedes all values: the leaf repeats this mask.
    std::uint64_t maskSum = 0;

    /// Returns a hash that no file can make collide: its numbers are drawn anew in each process.
    static std::uint64_t sumOf(const Mask& mask);

    std::uint64_t end() const { return begin + size; }
};

/// The place of an inner node in a file: its two masks and its values. Or a root tile: its value.
struct VdbNode {
    std::array<std::int32_t, 3> origin;
    int level = 1;  ///< of its tiles. 1: of 8^3 voxels, 2: of 128^3, 3: of 4096^3, of the root
    std::uint64_t begin = 0;
    std::uint64_t size = 0;
    std::uint64_t tiles = 0;  ///< active ones
};

/// The places of a tree's values in a file.
struct VdbTreePlaces {
    std::uint64_t background = 0;  ///< offset of the background
    std::vector<VdbNode> nodes;    ///< in file order
    std::vector<VdbLeaf> leaves;   ///< in file order
    std::uint64_t activeVoxels = 0;
    openvdb::CoordBBox activeBox;  ///< of the active voxels
};

/// Walks a grid's tree from first byte to last without unpacking; moves `bytes` along. Checks what
/// OpenVDB trusts: counts, masks, places of nodes, and that each stored size is that of its values
/// (else OpenVDB 10 writes past its buffer). Only unpacking checks zipped leaf values.
/// @throw Error(kInput) at the first contradiction
VdbTreeSize walkTree(VdbBytes& bytes, const VdbValueFormat& format);

/// Walks the part before the leaf values likewise, and leaves `bytes` there: no leaf is found yet.
VdbTreeSize walkTopology(VdbBytes& bytes, const VdbValueFormat& format, VdbTreePlaces& places);

/// Walks all leaf values in the same way and notes their places.
/// @param bytes   where walkTopology left them
/// @param leaves  as walkTopology found them
void walkLeaves(VdbBytes& bytes, const VdbValueFormat& format, std::vector<VdbLeaf>& leaves);

}  // namespace deltasplat
