// SPDX-License-Identifier: Apache-2.0
#include <openvdb/tree/ValueAccessor.h>

#include <string>

#include "base/parallel.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "deltasplat/ingest/make_volume.h"
#include "volume/code_tree.h"
#include "volume/tree_grid.h"

namespace deltasplat {
namespace {

// @param valueOf  of what the tree holds for an active voxel
template <typename Tree, typename ValueOf>
void readTree(const Tree& tree, const Volume& volume, const IndexBox& box, const ValueOf& valueOf,
              std::span<double> values, std::span<std::uint8_t> active) {
    const glm::ivec3 dims = box.dims();
    const double background = volume.hasBackground ? volume.background : 0;
    const auto rows = std::size_t(dims.y) * std::size_t(dims.z);
    parallelForChunks(rows, [&](std::size_t begin, std::size_t end) {
        openvdb::tree::ValueAccessor<const Tree> accessor(tree);
        for (std::size_t row = begin; row < end; ++row) {
            const int y = box.min.y + int(row % std::size_t(dims.y));
            const int z = box.min.z + int(row / std::size_t(dims.y));
            std::size_t place = row * std::size_t(dims.x);
            for (int x = 0; x < dims.x; ++x, ++place) {
                typename Tree::ValueType value;
                const bool isActive =
                    accessor.probeValue(openvdb::Coord(box.min.x + x, y, z), value);
                values[place] = isActive ? valueOf(value) : background;
                if (!active.empty()) active[place] = isActive ? 1 : 0;
            }
        }
    });
}

}  // namespace

void readVoxels(const Volume& volume, const IndexBox& box, std::span<double> values,
                std::span<std::uint8_t> active) {
    constexpr int kMost = (1 << 30) - 1;
    for (int axis = 0; axis < 3; ++axis) {
        if (box.min[axis] >= -kMost && box.max[axis] <= kMost) continue;
        throw Error(
            ErrorCode::kUsage, "voxels to read",
            "a box from " + std::to_string(box.min[axis]) + " to " + std::to_string(box.max[axis]),
            "indices within 2^30 of 0");
    }
    const glm::dvec3 dims = box.dims();
    const double voxels = dims.x * dims.y * dims.z;
    const auto requireSize = [&](const char* what, std::size_t size) {
        if (double(size) == voxels) return;
        throw Error(ErrorCode::kUsage, std::string("voxels to read: ") + what,
                    std::to_string(size) + " values", numberText(voxels));
    };
    requireSize("values", values.size());
    if (!active.empty()) requireSize("active", active.size());
    if (voxels == 0) return;
    if (volume.source) {
        const bool isScalar = volume.source->grid.apply<ScalarTrees>([&](const auto& tree) {
            readTree(
                tree, volume, box, [](auto value) { return double(value); }, values, active);
        });
        if (!isScalar) {
            throw Error(ErrorCode::kUsage, "voxels to read", "type " + volume.source->grid.type(),
                        "a scalar grid");
        }
    } else if (volume.codes) {
        readTree(
            volume.codes->tree(), volume, box,
            [&](Code code) { return volume.codeBook.valueOf(code); }, values, active);
    } else {
        throw Error(ErrorCode::kUsage, "voxels to read", "a volume without voxels",
                    "one that was read or made");
    }
}

}  // namespace deltasplat
