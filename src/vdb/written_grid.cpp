// SPDX-License-Identifier: Apache-2.0
#include "vdb/written_grid.h"

#include <openvdb/openvdb.h>

#include <type_traits>

#include "deltasplat/error.h"
#include "ingest/grids/scalar_grids.h"
#include "vdb/tree_writer.h"

namespace deltasplat {
namespace {

// Volumes and, of samples, colours.
using WrittenGrids = ScalarGrids::Append<openvdb::Vec3SGrid>;

}  // namespace

bool WrittenGrid::isHalf() const {
    return metadata.get<bool>(openvdb::GridBase::META_SAVE_HALF_FLOAT).value_or(false);
}

WrittenGrid writtenGrid(const openvdb::GridBase::ConstPtr& grid) {
    WrittenGrid written{grid->getName(), *grid, grid->constTransform().baseMap(), nullptr};
    const bool isKnown = grid->apply<WrittenGrids>([&](const auto& typed) {
        using Tree = typename std::decay_t<decltype(typed)>::TreeType;
        written.tree =
            std::make_shared<const TreeWriter<OwnValues<Tree>>>(OwnValues<Tree>(typed.treePtr()));
    });
    if (!isKnown)
        throw Error(ErrorCode::kFailed, gotExpected("grid to write", "type " + grid->valueType(),
                                                    "a scalar grid, or one of vec3s"));
    return written;
}

}  // namespace deltasplat
