// SPDX-License-Identifier: Apache-2.0
#include "volume/tree_grid.h"

#include <cstdint>
#include <type_traits>

#include "deltasplat/error.h"
#include "volume/vdb_transform.h"

namespace deltasplat {

std::string TreeGrid::name() const {
    const std::string key = openvdb::GridBase::META_GRID_NAME;
    // OpenVDB accepts numbers as names.
    if (const auto number = metadata.get<std::int32_t>(key)) return std::to_string(*number);
    if (const auto number = metadata.get<std::int64_t>(key)) return std::to_string(*number);
    if (const auto flag = metadata.get<bool>(key)) return *flag ? "true" : "false";
    return metadata.text(key);
}

std::string TreeGrid::type() const {
    return as<openvdb::MaskTree>() ? typeOf<openvdb::MaskTree>() : tree->valueType();
}

TreeGrid fromOpenVdb(const openvdb::GridBase::ConstPtr& grid) {
    return {openvdb::ConstPtrCast<openvdb::GridBase>(grid)->baseTreePtr(), *grid,
            grid->constTransform().baseMap()};
}

openvdb::GridBase::Ptr toOpenVdb(const TreeGrid& grid) {
    openvdb::initialize();
    openvdb::GridBase::Ptr made;
    grid.apply<ScalarTrees>([&](const auto& tree) {
        using Tree = std::decay_t<decltype(tree)>;
        made = openvdb::Grid<Tree>::create(std::static_pointer_cast<Tree>(grid.tree));
    });
    if (!made) {
        throw Error(ErrorCode::kFailed, "grid \"" + grid.name() + "\"", "type " + grid.type(),
                    "a scalar grid");
    }
    made->insertMeta(*grid.metadata.toMetaMap(grid.name()));
    made->setTransform(transformOf(*grid.map));
    return made;
}

}  // namespace deltasplat
