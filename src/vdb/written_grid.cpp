// SPDX-License-Identifier: Apache-2.0
#include "vdb/written_grid.h"

#include <openvdb/openvdb.h>

#include <type_traits>

#include "deltasplat/error.h"
#include "vdb/tree_writer.h"

namespace deltasplat {
namespace {

template <typename Tree>
std::shared_ptr<const WrittenTree> writerOf(const std::shared_ptr<openvdb::TreeBase>& tree) {
    return std::make_shared<const TreeWriter<OwnValues<Tree>>>(
        OwnValues<Tree>(std::static_pointer_cast<const Tree>(tree)));
}

}  // namespace

bool WrittenGrid::isHalf() const {
    return metadata.get<bool>(openvdb::GridBase::META_SAVE_HALF_FLOAT).value_or(false);
}

WrittenGrid writtenGrid(const TreeGrid& grid) {
    WrittenGrid written{grid.name(), grid.metadata, grid.map, nullptr};
    const auto take = [&](const auto& tree) {
        written.tree = writerOf<std::decay_t<decltype(tree)>>(grid.tree);
    };
    // Volumes and, of samples, colours.
    const bool isKnown =
        grid.apply<ScalarTrees>(take) || grid.apply<TreeTypes<openvdb::Vec3STree>>(take);
    if (!isKnown)
        throw Error(ErrorCode::kFailed, gotExpected("grid to write", "type " + grid.type(),
                                                    "a scalar grid, or one of vec3s"));
    return written;
}

}  // namespace deltasplat
