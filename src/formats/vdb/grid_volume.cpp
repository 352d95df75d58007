// SPDX-License-Identifier: Apache-2.0
#include "formats/vdb/grid_volume.h"

#include <cmath>
#include <memory>
#include <utility>

#include "base/memory.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "formats/vdb/grid_metadata.h"
#include "volume/code_tree.h"
#include "volume/leaf_slices.h"
#include "volume/placement.h"
#include "volume/tree_grid.h"
#include "volume/vdb_transform.h"

namespace deltasplat {

void settleUnit(const std::string& where, VolumeData& volume) {
    const double millimetres = millimetresIn(volume.lengthUnit);
    if (volume.space.empty() || millimetres == 0 || millimetres == 1) return;
    scaleLengths(volume.worldFromIndex, millimetres);
    volume.lengthUnit = "mm";
    requirePlacement(where, "lengths in millimetres", volume.worldFromIndex);
}

VolumeData placedVolume(const openvdb::math::MapBase& map, const VdbMetadata& metadata,
                        const GridCodesOptions& options) {
    VolumeData volume;
    volume.worldFromIndex = worldFromIndexOf(map, options.where);
    const std::string space = metadata.text(kSpaceKey);
    if (space == "RAS" || space == "LPS") volume.space = space;
    volume.lengthUnit = lengthUnitNamed(metadata.text(kLengthUnitKey));
    volume.labels = labelsIn(metadata);
    settleUnit(options.where, volume);
    return volume;
}

void settleEmpty(VolumeData& volume, const GridCodesOptions& options) {
    if (!std::isfinite(volume.background)) {
        const double replacement = options.reading.nanValue.value_or(0);
        options.listener.warn(options.where + ": background " + numberText(volume.background) +
                              " taken as " + numberText(replacement));
        volume.background = replacement;
    }
    if (volume.empty()) options.listener.warn(options.where + ": no active voxels");
}

VolumeData volumeOfGrid(TreeGrid grid, const GridCodesOptions& options,
                        const VdbMetadata& fileMetadata) {
    VolumeData volume = placedVolume(*grid.map, grid.metadata, options);
    requireMemory(options.where, double(grid.tree->leafCount()) * leafBytes<CodeTree::Leaf>());
    fillFromGrid(grid, options, volume);
    const ReadOptions& reading = options.reading;
    if (reading.keepSource || (reading.keepInexact && !volume.codeBook.isExact())) {
        volume.source =
            std::make_shared<const SourceGrid>(SourceGrid{std::move(grid), fileMetadata});
    }
    settleEmpty(volume, options);
    return volume;
}

std::optional<VolumeData> volumeOfLeaves(const VdbValues& values, const GridCodesOptions& options) {
    VolumeData volume = placedVolume(values.leaves.transform(), values.metadata, options);
    if (!fillFromLeaves(values, options, volume)) return std::nullopt;
    settleEmpty(volume, options);
    return volume;
}

}  // namespace deltasplat
