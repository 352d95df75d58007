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

/// One grid of a .vdb file as the file's directory lists it.
struct VdbGrid {
    std::string name;   ///< unique in the file: "density", or "density[1]" where names repeat
    std::string type;   ///< value type: "float", "double", "half", "int32", "vec3s", ...; or the
                        ///< whole tree's, as stored, of another layout
    bool half = false;  ///< real values are stored as binary16 (writers set it for integers too)
    bool supported = true;  ///< in OpenVDB's standard tree layout
    bool numeric = false;   ///< has numbers in any layout, also of types that are not read
    bool vector = false;    ///< has vectors, points or texts

    std::string uniqueName;  ///< name as stored
    std::string parentName;  ///< as stored, of the grid whose tree it shares; or empty
    std::uint64_t data = 0;  ///< where the grid itself starts
    std::uint64_t end = 0;   ///< one past its last byte
    std::optional<std::size_t>
        owner;  ///< of the file's grids the one whose tree it has, or its own

    /// Whether it is of a type that is read.
    bool isScalar() const;
    /// Returns `type`, or "half" for real values stored so.
    std::string valueType() const;
    /// Returns for example `density (float)`.
    std::string describe() const {
        return (name.empty() ? "\"\"" : name) + " (" + valueType() + ")";
    }
    /// Returns the name without what tells grids of one name apart.
    std::string plainName() const;
    /// Returns the name as OpenVDB shows it: "density[1]" even where there is no other.
    std::string numberedName() const;
};

/// A grid of numbers whose leaves are still packed.
struct VdbValues {
    /// Of the grid's value type.
    using Number = std::variant<float, double, std::int32_t, std::int64_t>;

    VdbMetadata metadata;
    Number background;
    VdbTiles tiles;
    VdbLeaves leaves;  ///< in the tree's order
    bool areHalves;    ///< whether floats are stored as binary16
    bool byNotes;      ///< whether leaves were found by the file's notes, which may be wrong
};

/// A .vdb file, which is read here, on all threads, for OpenVDB 10 crashes on damaged ones and its
/// library takes longer to load than small grids to read; only transforms that are frustums need
/// it. Grids are in file order; types that OpenVDB does not know do no harm.
class VdbFile {
  public:
    /// @throw Error(kInput) if this is no whole .vdb file
    explicit VdbFile(std::filesystem::path file);

    const std::vector<VdbGrid>& grids() const { return grids_; }
    /// Returns the metadata of the file itself.
    const VdbMetadata& metadata() const { return metadata_; }
    /// Returns the metadata of a grid of grids(), of whatever type.
    /// @throw Error(kInput) if its bytes are not a sound grid
    VdbMetadata metadata(const VdbGrid& grid) const;
    /// What is to be known of a grid before its voxels are read.
    struct Summary {
        VdbMetadata metadata;
        std::string obstacle;  ///< "type uint32": why a grid of numbers cannot be read; or empty
    };
    /// @param bytes  of this file, for who asks about many grids
    /// @throw as metadata()
    Summary summary(const VdbGrid& grid, VdbBytes& bytes) const;
    VdbBytes bytes() const { return VdbBytes(bytes_); }
    /// Reads a scalar grid of grids(), or one of vectors.
    /// @throw Error(kInput) if its bytes are not a sound grid, Error(kFailed) if it does not fit
    ///        into memory, whatever the listener throws
    TreeGrid read(const VdbGrid& grid, const Listener& listener) const;

    /// How to find where leaves lie: by what the file notes of their sizes (OpenVDB's
    /// "file_delayed_load"), or by walking over all of them, which `kByNotes` does where there are
    /// no notes. WriteNotes may be wrong: then leaves look damaged.
    enum class Find { kByNotes, kByWalking };
    /// Finds the leaves of a grid of int32 or int64 with background 0, unless there are active
    /// tiles beside them. Their values are read when they are unpacked.
    /// @throw as read()
    std::optional<VdbLeaves> readLeaves(const VdbGrid& grid, Find how) const;
    /// Reads a grid of numbers without making a tree of them.
    /// @param listener  hears how far the file is read here; leaves are read when they are unpacked
    /// @throw as read()
    std::optional<VdbValues> readValues(const VdbGrid& grid, Find how,
                                        const Listener& listener = {}) const;

    /// A grid of numbers whose values stay in the file, and what its volume has besides.
    struct Packed {
        VdbMetadata metadata;
        std::uint64_t activeVoxels;
        openvdb::CoordBBox activeBox;
        PackedGrid grid;
    };
    /// Reads a grid of numbers but for the values of its leaves, which may turn out to be damaged.
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
    std::shared_ptr<const FileBytes> bytes_;  // unpacked, if it lies under gzip
    VdbMetadata metadata_;
    std::vector<VdbGrid> grids_;
};

}  // namespace deltasplat
