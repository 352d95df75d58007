// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "deltasplat/progress.h"
#include "formats/vdb/vdb_leaves.h"
#include "formats/vdb/vdb_tree.h"
#include "volume/tree_grid.h"
#include "volume/vdb_metadata.h"

namespace deltasplat {

/// A grid in the directory of a .vdb file.
struct VdbGrid {
    std::string name;   ///< unique in the file: "density", or "density[1]" for repeated names
    std::string type;   ///< value type: "float", "double", "half", "int32", "vec3s", ...; or the
                        ///< type of the whole tree as stored, if its layout is not the standard one
    bool half = false;  ///< real values are stored as binary16 (writers set it for integers too)
    bool supported = true;  ///< has OpenVDB's standard tree layout
    bool numeric = false;   ///< has numbers in any layout, unreadable types included
    bool vector = false;    ///< has vectors, points or strings

    std::string uniqueName;  ///< name as stored
    std::string parentName;  ///< name of the grid whose tree it shares, as stored; or empty
    std::uint64_t data = 0;  ///< offset of the grid itself
    std::uint64_t end = 0;   ///< offset behind its last byte
    std::optional<std::size_t> owner;  ///< index of the grid whose tree it has, which may be itself

    /// Whether the value type can be read.
    bool isScalar() const;
    /// Returns `type`, or "half" for real values stored as halves.
    std::string valueType() const;
    std::string describe() const {
        return (name.empty() ? "\"\"" : name) + " (" + valueType() + ")";
    }
    /// Returns the name without the suffix that separates grids of the same name.
    std::string plainName() const;
    /// Returns the name as OpenVDB shows it: "density[1]" even for a single grid.
    std::string numberedName() const;
};

/// A grid of numbers whose leaves are still packed.
struct VdbValues {
    /// In the grid's value type.
    using Number = std::variant<float, double, std::int32_t, std::int64_t>;

    VdbMetadata metadata;
    Number background;
    VdbTiles tiles;
    VdbLeaves leaves;  ///< in the tree's order
    bool areHalves;    ///< whether floats are stored as binary16
    bool byNotes;      ///< leaves were found by the file's notes, which may be wrong
};

/// A .vdb file. Parsed here on all threads, because OpenVDB 10 crashes on damaged files and its
/// library takes longer to load than small grids take to read; only frustum transforms need it.
/// Grids are in file order. Types unknown to OpenVDB do no harm.
class VdbFile {
  public:
    /// @throw Error(kInput) if the file is not a complete .vdb file
    explicit VdbFile(std::filesystem::path file);

    const std::vector<VdbGrid>& grids() const { return grids_; }
    const VdbMetadata& metadata() const { return metadata_; }
    /// Returns the metadata of a grid of grids(), whatever its type.
    /// @throw Error(kInput) if the bytes are not a sound grid
    VdbMetadata metadata(const VdbGrid& grid) const;
    /// Facts about a grid that are known before its voxels are read.
    struct Summary {
        VdbMetadata metadata;
        std::string obstacle;  ///< why numbers cannot be read: "type uint32"; or empty
    };
    /// @param bytes  from bytes(), so that many grids can share one reader
    /// @throw as metadata()
    Summary summary(const VdbGrid& grid, VdbBytes& bytes) const;
    VdbBytes bytes() const { return VdbBytes(bytes_); }
    /// Reads a grid of grids(), scalar or of vectors.
    /// @throw Error(kInput) for an unsound grid; Error(kFailed) if memory is too small; whatever
    ///        the listener throws
    TreeGrid read(const VdbGrid& grid, const Listener& listener) const;

    /// How to find leaves: by the file's notes of their sizes ("file_delayed_load"), or by walking
    /// over them. `kByNotes` walks if notes are missing. Wrong notes make leaves look damaged.
    enum class Find { kByNotes, kByWalking };
    /// Finds the leaves of a grid of int32 or int64 with background 0 and no active tiles; nothing
    /// for other grids. Leaf values are read when they are unpacked.
    /// @throw as read()
    std::optional<VdbLeaves> readLeaves(const VdbGrid& grid, Find how) const;
    /// Reads a grid of numbers without making a tree. Leaf values are read when they are unpacked.
    /// @param listener  hears how far the search for leaves is
    /// @throw as read()
    std::optional<VdbValues> readValues(const VdbGrid& grid, Find how,
                                        const Listener& listener = {}) const;

    /// A grid of numbers whose values stay in the file, and the other facts of its volume.
    struct Packed {
        VdbMetadata metadata;
        std::uint64_t activeVoxels;
        openvdb::CoordBBox activeBox;
        PackedGrid grid;
    };
    /// Reads a grid of numbers without its leaf values, which may prove damaged later.
    /// @throw as read()
    std::optional<Packed> readPacked(const VdbGrid& grid) const;

  private:
    struct Found;
    std::optional<Found> find(const VdbGrid& grid, Find how, const Listener& listener) const;
    void readDirectory();
    void findEnd(VdbBytes& bytes, VdbGrid& grid) const;
    void nameGrids();
    void findOwners();
    const VdbGrid& ownerOf(const VdbGrid& grid) const;

    std::filesystem::path file_;
    std::shared_ptr<const FileBytes> bytes_;  // unpacked, if the file is gzipped
    VdbMetadata metadata_;
    std::vector<VdbGrid> grids_;
};

}  // namespace deltasplat
