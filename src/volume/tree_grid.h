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

/// Trees, for TreeGrid::apply.
template <typename... Trees>
struct TreeTypes {};

/// The trees that are volumes here.
using ScalarTrees = TreeTypes<openvdb::FloatTree, openvdb::DoubleTree, openvdb::Int32Tree,
                              openvdb::Int64Tree, openvdb::BoolTree, openvdb::MaskTree>;

/// Returns what a .vdb file calls the type of a tree's values: "float", "mask", ...
template <typename Tree>
std::string typeOf() {
    // Masks call their values bool.
    const bool isMask = std::is_same_v<Tree, openvdb::MaskTree>;
    return isMask ? "mask" : openvdb::typeNameAsString<typename Tree::ValueType>();
}

/// Calls use(std::type_identity<Tree>()) with the one of `Trees` that has values of `type`, a
/// typeOf(); returns false, and does not, if there is none.
template <typename... Trees, typename Use>
bool applyType(TreeTypes<Trees...>, const std::string& type, const Use& use) {
    const auto tryOne = [&]<typename Tree>(std::type_identity<Tree> one) {
        if (type != typeOf<Tree>()) return false;
        use(one);
        return true;
    };
    return (tryOne(std::type_identity<Trees>()) || ...);
}

/// A grid: a tree of OpenVDB's, and what a .vdb file says besides. OpenVDB's own grids need its
/// library, which takes longer to load than small grids to read; this one does not.
struct TreeGrid {
    std::shared_ptr<openvdb::TreeBase> tree;
    VdbMetadata metadata;                       ///< name and class among them
    openvdb::math::MapBase::ConstPtr map = {};  ///< world from index

    std::string name() const;
    /// Returns typeOf() the tree.
    std::string type() const;

    /// Returns the tree as what it is; null if it is another.
    template <typename Tree>
    const Tree* as() const {
        return tree->type() == Tree::treeType() ? static_cast<const Tree*>(tree.get()) : nullptr;
    }
    template <typename Tree>
    Tree* as() {
        return const_cast<Tree*>(static_cast<const TreeGrid&>(*this).as<Tree>());
    }

    /// Calls use(tree) with the tree as what it is; returns false, and does not, if it is none of
    /// `Types`, a TreeTypes.
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

/// Returns a grid of the same tree.
TreeGrid fromOpenVdb(const openvdb::GridBase::ConstPtr& grid);

/// Returns a grid of OpenVDB's, of the same tree. It needs OpenVDB's library.
/// @throw Error(kFailed) if it is not a scalar grid; Error(kInput) if OpenVDB does not take the
///        metadata
openvdb::GridBase::Ptr toOpenVdb(const TreeGrid& grid);

struct PackedGrid;

/// A volume's own grid, in its own value type: every value, inactive ones included, background,
/// transform, class and metadata.
struct SourceGrid {
    TreeGrid grid;  ///< without a tree if `packed` is there
    /// .vdb: the metadata of the file itself, the same for all of its grids.
    VdbMetadata fileMetadata = {};
    /// Of a volume that is read to be compared alone: values that are still in their file.
    std::shared_ptr<const PackedGrid> packed = nullptr;
    /// The grid that makeVolume() was given; null of others.
    openvdb::GridBase::ConstPtr given = nullptr;
};

/// Whether integers of the source are unsigned ones by their bits. Their type says so: no .vdb has
/// it.
inline bool holdsUnsigned(const Volume& volume) {
    return volume.source && volume.type == "uint64" && volume.source->grid.as<openvdb::Int64Tree>();
}

/// Says that a sound grid holds values that are NaN or infinite.
struct NotFinite : Error {
    using Error::Error;
};

/// Says that a sound grid is of a kind that is not read: which says what is in the way.
struct UnreadableGrid : Error {
    /// @param where  file and grid
    /// @param which  "a NonlinearFrustumMap transform"
    UnreadableGrid(const std::string& where, const std::string& which, const std::string& expected)
        : Error(ErrorCode::kInput, where, which, expected), obstacle(which) {}

    std::string obstacle;
};

/// Says that leaves of a grid cannot be unpacked where they were looked for.
struct DamagedLeaves : Error {
    /// @param where  file and grid
    explicit DamagedLeaves(const std::string& where)
        : Error(ErrorCode::kInput, where, "leaves that are damaged", "a sound OpenVDB grid") {}
};

}  // namespace deltasplat
