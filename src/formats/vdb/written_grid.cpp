// SPDX-License-Identifier: Apache-2.0
#include "formats/vdb/written_grid.h"

#include <type_traits>

#include "deltasplat/error.h"
#include "volume/tree_types.h"

namespace deltasplat {

namespace {

template <typename Values>
std::shared_ptr<const WrittenTree> writerOf(const std::shared_ptr<openvdb::TreeBase>& tree) {
    return std::make_shared<const TreeWriter<Values>>(
        Values(std::static_pointer_cast<const typename Values::Tree>(tree)));
}

}  // namespace

bool WrittenGrid::isHalf() const {
    return metadata.get<bool>(openvdb::GridBase::META_SAVE_HALF_FLOAT).value_or(false);
}

WrittenGrid writtenGrid(const TreeGrid& grid) {
    WrittenGrid written{grid.name(), grid.metadata, grid.map, nullptr};
    const auto take = [&](const auto& tree) {
        written.tree = writerOf<OwnValues<std::decay_t<decltype(tree)>>>(grid.tree);
    };
    // Vectors hold the colours of samples.
    const bool isKnown =
        grid.apply<ScalarTrees>(take) || grid.apply<TreeTypes<openvdb::Vec3STree>>(take);
    if (!isKnown)
        throw Error(ErrorCode::kFailed, "grid to write", "type " + grid.type(),
                    "a scalar grid, or one of vec3s");
    return written;
}

WrittenGrid writtenWords(const TreeGrid& grid) {
    WrittenGrid written = writtenGrid(grid);
    written.packsNotes = false;
    return written;
}

WrittenGrid writtenDeltas(const TreeGrid& grid) {
    WrittenGrid written{grid.name(), grid.metadata, grid.map, nullptr};
    grid.apply<TreeTypes<openvdb::Int32Tree, openvdb::Int64Tree>>([&](const auto& tree) {
        written.tree = writerOf<DeltaValues<std::decay_t<decltype(tree)>>>(grid.tree);
    });
    return written;
}

}  // namespace deltasplat
