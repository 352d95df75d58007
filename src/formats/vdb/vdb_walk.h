// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "volume/vdb_metadata.h"

namespace deltasplat {

/// What OpenVDB 13 calls a grid whose values are halves in memory as well; it becomes one of
/// floats.
inline constexpr const char* kHalfType = "half";

/// How a grid's values lie in a .vdb file.
struct VdbValueFormat {
    std::uint32_t bytes = 4;   ///< of one value of the tree that is made of them
    std::uint32_t stored = 4;  ///< of one value within a node's data: 2 for a half
    /// Of one that stands alone: the background, a tile of the root, a node's inactive value. That
    /// of a grid of halves is one, that of a float kept as half is a float.
    std::uint32_t alone = 4;
    bool real = true;  ///< float, double and vectors of them
    enum class Leaf { kValues, kBools, kMask } leaf = Leaf::kValues;
    std::uint32_t compression = 0;  ///< the grid's own flags, openvdb::io::COMPRESS_...

    /// Returns how many bytes a node has of its inactive values, before its data: how many there
    /// are and which place has which.
    /// @param kind  of the node: openvdb::io's NO_MASK_... or MASK_...
    /// @param mask  bytes of a mask of the node's places
    std::uint64_t inactiveBytes(int kind, std::uint64_t mask) const;
    /// Whether values are stored shorter than the tree has them.
    bool areHalves() const { return stored != bytes; }
    /// Whether a node's data are none of the grid's own values: OpenVDB stores no size of none.
    bool areKeptAsHalves() const { return stored != alone; }
    /// Sets all but the compression; returns false if `type` ("float", "vec3s", ...) is not known.
    bool setType(const std::string& type, bool half);
};

/// What a tree is made of.
struct VdbTreeSize {
    std::uint64_t leaves = 0;  ///< nodes of 8^3 voxels
    std::uint64_t lower = 0;   ///< nodes of 16^3 leaves
    std::uint64_t upper = 0;   ///< nodes of 32^3 lower nodes
    std::uint64_t tiles = 0;   ///< active ones, of all levels
    /// Returns about how much memory the tree, one of a part of vectors, and one of codes take.
    double memoryBytes(const VdbValueFormat& format) const;
    /// Returns the same of the tree of codes alone.
    double codeBytes(const VdbValueFormat& format) const;
    /// Returns the same of a tree whose leaves have no values, and of where these lie in the file.
    double nodeBytes() const;
};

/// Where a leaf of values lies in a file.
struct VdbLeaf {
    using Mask = std::array<std::uint64_t, 8>;  ///< [x]: bit 8 y + z

    std::array<std::int32_t, 3> origin;  ///< of its first voxel
    std::uint32_t size = 0;              ///< bytes: its mask of 64, and its values
    std::uint64_t begin = 0;
    /// Of the mask that lies before all values: the leaf has it once more.
    std::uint64_t maskSum = 0;

    /// Masks of the same sum are the same: which others would have it is drawn anew in each
    /// process.
    static std::uint64_t sumOf(const Mask& mask);

    std::uint64_t end() const { return begin + size; }
};

/// Where a node that has nodes or leaves below lies in a file: its two masks, of children and of
/// tiles, and its values. Or a tile of the root: its value.
struct VdbNode {
    std::array<std::int32_t, 3> origin;
    int level = 1;  ///< of its tiles. 1: of 8^3 voxels, 2: of 128^3, 3: of 4096^3, of the root
    std::uint64_t begin = 0;
    std::uint64_t size = 0;
    std::uint64_t tiles = 0;  ///< active ones
};

/// What of a tree has values, and where these lie in a file.
struct VdbTreePlaces {
    std::uint64_t background = 0;  ///< where the background is
    std::vector<VdbNode> nodes;    ///< in file order
    std::vector<VdbLeaf> leaves;   ///< likewise
    std::uint64_t activeVoxels = 0;
    openvdb::CoordBBox activeBox;  ///< of these
};

/// Walks a grid's tree from its first byte to its last without unpacking it; `bytes` moves along.
/// Everything that OpenVDB takes on trust is checked: counts, masks, places of nodes, and that each
/// node's stored size is the size of its values (OpenVDB 10 writes past its buffer where it is
/// not). Whether zipped values of leaves are whole is left to who unpacks them.
/// @throw Error(kInput) at the first contradiction
VdbTreeSize walkTree(VdbBytes& bytes, const VdbValueFormat& format);

/// Walks what comes before the values of leaves, as walkTree does; `bytes` moves behind it. Where
/// leaves lie is not known then.
VdbTreeSize walkTopology(VdbBytes& bytes, const VdbValueFormat& format, VdbTreePlaces& places);

/// Walks the values of all leaves, as walkTree does, and notes where they lie.
/// @param bytes   where walkTopology left them
/// @param leaves  that it found
void walkLeaves(VdbBytes& bytes, const VdbValueFormat& format, std::vector<VdbLeaf>& leaves);

}  // namespace deltasplat
