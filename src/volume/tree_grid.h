// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Grid.h>
#include <openvdb/math/Maps.h>

#include <memory>
#include <string>
#include <type_traits>

#include "deltasplat/error.h"
#include "deltasplat/ingest/volume.h"
#include "volume/tree_types.h"
#include "volume/vdb_metadata.h"

namespace deltasplat {

template <typename... Trees>
struct TreeTypes {};

using ScalarTrees = TreeTypes<openvdb::FloatTree, openvdb::DoubleTree, openvdb::Int32Tree,
                              openvdb::Int64Tree, openvdb::BoolTree, openvdb::MaskTree>;

/// Returns the type name in a .vdb file of a tree's values: "float", "mask", ...
template <typename Tree>
std::string typeOf() {
    // OpenVDB calls the values of masks bool.
    const bool isMask = std::is_same_v<Tree, openvdb::MaskTree>;
    return isMask ? "mask" : openvdb::typeNameAsString<typename Tree::ValueType>();
}

/// Calls use(std::type_identity<Tree>()) with the tree of typeOf() `type`, or returns false.
template <typename... Trees, typename Use>
bool applyType(TreeTypes<Trees...>, const std::string& type, const Use& use) {
    const auto tryOne = [&]<typename Tree>(std::type_identity<Tree> one) {
        if (type != typeOf<Tree>()) return false;
        use(one);
        return true;
    };
    return (tryOne(std::type_identity<Trees>()) || ...);
}

/// A grid: a tree of OpenVDB and the other data that a .vdb file has. Unlike OpenVDB's own grids it
/// works without OpenVDB's library, which takes longer to load than a small grid takes to read.
struct TreeGrid {
    std::shared_ptr<openvdb::TreeBase> tree;
    VdbMetadata metadata;                       ///< includes name and class
    openvdb::math::MapBase::ConstPtr map = {};  ///< world from index

    std::string name() const;
    std::string type() const;

    /// Returns the tree as type `Tree`, or null if it has another type.
    template <typename Tree>
    const Tree* as() const {
        return tree->type() == Tree::treeType() ? static_cast<const Tree*>(tree.get()) : nullptr;
    }
    template <typename Tree>
    Tree* as() {
        return const_cast<Tree*>(static_cast<const TreeGrid&>(*this).as<Tree>());
    }

    /// Calls use(tree) with the typed tree, or returns false if `Types`, a TreeTypes, lacks it.
    template <typename Types, typename Use>
    bool apply(const Use& use) const {
        return applyAs(*this, Types(), use);
    }
    template <typename Types, typename Use>
    bool apply(const Use& use) {
        return applyAs(*this, Types(), use);
    }

  private:
    template <typename Grid, typename... Trees, typename Use>
    static bool applyAs(Grid& grid, TreeTypes<Trees...>, const Use& use) {
        const auto tryOne = [&](auto* typed) {
            if (typed) use(*typed);
            return typed != nullptr;
        };
        return (tryOne(grid.template as<Trees>()) || ...);
    }
};

TreeGrid fromOpenVdb(const openvdb::GridBase::ConstPtr& grid);

/// Returns an OpenVDB grid that shares the tree. Needs OpenVDB's library.
/// @throw Error(kFailed) if the grid is not scalar; Error(kInput) if OpenVDB rejects the metadata
openvdb::GridBase::Ptr toOpenVdb(const TreeGrid& grid);

struct PackedGrid;

/// A volume's own grid in its own type: all values, background, transform, class and metadata.
struct SourceGrid {
    TreeGrid grid;  ///< has no tree if `packed` is set
    /// .vdb: metadata of the whole file, the same for all of its grids.
    VdbMetadata fileMetadata = {};
    /// Values that are still in their file, if the volume is read only for a comparison.
    std::shared_ptr<const PackedGrid> packed = nullptr;
    /// The grid that makeVolume() was given, else null.
    openvdb::GridBase::ConstPtr given = nullptr;
};

/// Whether the source's 64-bit integers are unsigned. Its type tells; no .vdb has this type.
inline bool holdsUnsigned(const Volume& volume) {
    return volume.source() && volume.type() == "uint64" &&
           volume.source()->grid.as<openvdb::Int64Tree>();
}

/// A sound grid holds values that are NaN or infinite.
struct NotFinite : Error {
    using Error::Error;
};

/// A sound grid is of a kind that cannot be read. `obstacle` names the cause.
struct UnreadableGrid : Error {
    /// @param where  file and grid
    /// @param which  "a NonlinearFrustumMap transform"
    UnreadableGrid(const std::string& where, const std::string& which, const std::string& expected)
        : Error(ErrorCode::kInput, where, which, expected), obstacle(which) {}

    std::string obstacle;
};

/// Leaves of a grid cannot be unpacked.
struct DamagedLeaves : Error {
    /// @param where  file and grid
    explicit DamagedLeaves(const std::string& where)
        : Error(ErrorCode::kInput, where, "leaves that are damaged", "a sound OpenVDB grid") {}
};

}  // namespace deltasplat
