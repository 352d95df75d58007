// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/openvdb_grid.h"

#include "base/default_floats.h"
#include "base/memory.h"
#include "deltasplat/error.h"
#include "formats/delta/delta_format.h"
#include "formats/readers.h"
#include "formats/vdb/grid_volume.h"
#include "formats/vdb/volume_grid.h"
#include "volume/tree_grid.h"

namespace deltasplat {
namespace {

// Whether reading writes to a grid: level sets become fog, or get what a surface needs, and NaN
// what replaces it.
bool isChanged(const openvdb::GridBase& grid, const ReadOptions& options) {
    const bool isReal = grid.isType<openvdb::FloatGrid>() || grid.isType<openvdb::DoubleGrid>();
    const bool isLevelSet = grid.getGridClass() == openvdb::GRID_LEVEL_SET;
    const bool becomesOther = isLevelSet && (options.levelSetToFog || options.levelSetSurface);
    return isReal && (options.nanValue || becomesOther);
}

}  // namespace

Volume makeVolume(const openvdb::GridBase::ConstPtr& grid, const ReadOptions& options,
                  const Listener& listener) {
    const DefaultFloats floats;
    const std::string where = "OpenVDB grid";
    if (!grid) throw Error(ErrorCode::kUsage, where, "none", "a grid");
    openvdb::initialize();
    requireFiniteNan(options);
    const TreeGrid given = fromOpenVdb(grid);
    if (isDeltaGrid(given)) {
        throw Error(ErrorCode::kUsage, where, "the differences of a delta grid",
                    "the volume itself: readVolume reads a delta grid's file");
    }
    const bool changes = isChanged(*grid, options);
    if (changes) requireMemory(where, double(grid->memUsage()));
    TreeGrid own = given;
    if (changes) own.tree = own.tree->copy();
    Volume volume = volumeOfGrid(std::move(own), {listener, where, given.type(), options});
    volume.name = given.name();
    if (volume.source && !changes) {
        SourceGrid source = *volume.source;
        source.given = grid;
        volume.source = std::make_shared<const SourceGrid>(std::move(source));
    }
    listener.report(1);
    return volume;
}

openvdb::GridBase::ConstPtr makeGrid(const Volume& volume) {
    const DefaultFloats floats;
    if (!volume.codes) {
        throw Error(ErrorCode::kUsage, "OpenVDB grid to make", "a volume without voxels",
                    "one that was read or made");
    }
    const bool wasGiven = volume.source && volume.source->given && volume.hasBackground;
    return wasGiven ? volume.source->given : toOpenVdb(gridOf(volume));
}

}  // namespace deltasplat
