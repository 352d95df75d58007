// SPDX-License-Identifier: Apache-2.0
#include "ingest/grids/grid_volume.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <memory>
#include <utility>

#include "deltasplat/error.h"
#include "ingest/codes/code_tree.h"
#include "ingest/grids/grid_metadata.h"
#include "ingest/grids/leaf_bytes.h"
#include "ingest/grids/source_grid.h"
#include "ingest/vdb/vdb_transform.h"
#include "memory.h"
#include "number_text.h"

namespace deltasplat {
namespace {

std::string spaceOf(const openvdb::GridBase& grid) {
    const std::string space = textMetadata(grid, kSpaceKey);
    return space == "RAS" || space == "LPS" ? space : "";
}

// A volume that has its place, and no voxels.
Volume placedVolume(const openvdb::GridBase& grid, const GridCodesOptions& options) {
    Volume volume;
    volume.worldFromIndex = worldFromIndexOf(grid.transform(), options.where);
    volume.space = spaceOf(grid);
    requireMemory(options.where,
                  double(grid.constBaseTree().leafCount()) * leafBytes<CodeTree::Leaf>());
    return volume;
}

}  // namespace

glm::dmat4 worldFromIndexOf(const openvdb::math::Transform& transform, const std::string& where) {
    const auto fail = [&](const std::string& got, const std::string& expected) {
        throw Error(ErrorCode::kInput, gotExpected(where, got, expected));
    };
    if (!transform.isLinear()) {
        fail("a " + transform.mapType() + " transform", "a linear one (no frustum)");
    }
    glm::dmat4 matrix(0);
    try {
        matrix = matrixOf(transform);
    } catch (const openvdb::ArithmeticError&) {
        // OpenVDB's own word for a volume of a voxel below 3e-15.
    }
    bool finite = true;
    for (int axis = 0; axis < 4; ++axis) {
        finite = finite && std::isfinite(glm::dot(matrix[axis], matrix[axis]));
    }
    if (!finite || glm::determinant(matrix) == 0) {
        fail("a transform that cannot be inverted", "a finite affine map");
    }
    // A damaged file may hold any matrix, and OpenVDB does not look at the last column.
    if (glm::dvec4(matrix[0].w, matrix[1].w, matrix[2].w, matrix[3].w) != glm::dvec4(0, 0, 0, 1)) {
        fail("a transform that is a projection", "a finite affine map");
    }
    return matrix;
}

void settleEmpty(Volume& volume, const GridCodesOptions& options) {
    if (!std::isfinite(volume.background)) {
        const double replacement = options.reading.nanValue.value_or(0);
        options.listener.warn(options.where + ": background " + numberText(volume.background) +
                              " taken as " + numberText(replacement));
        volume.background = replacement;
    }
    if (volume.empty()) options.listener.warn(options.where + ": no active voxels");
}

Volume volumeOfGrid(const openvdb::GridBase::Ptr& grid, const GridCodesOptions& options,
                    openvdb::MetaMap::ConstPtr fileMetadata) {
    Volume volume = placedVolume(*grid, options);
    fillFromGrid(*grid, options, volume);
    const ReadOptions& reading = options.reading;
    if (reading.keepSource || (reading.keepInexact && !volume.codeBook.isExact())) {
        volume.source =
            std::make_shared<const SourceGrid>(SourceGrid{grid, std::move(fileMetadata)});
    }
    settleEmpty(volume, options);
    return volume;
}

std::optional<Volume> volumeOfLeaves(const VdbValues& values, const GridCodesOptions& options) {
    Volume volume = placedVolume(*values.grid, options);
    if (!fillFromLeaves(values, options, volume)) return std::nullopt;
    settleEmpty(volume, options);
    return volume;
}

}  // namespace deltasplat
