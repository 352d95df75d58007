// SPDX-License-Identifier: Apache-2.0
#include "convert/dense_values.h"

#include <openvdb/tree/ValueAccessor.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <type_traits>
#include <vector>

#include "ingest/codes/code_tree.h"
#include "ingest/codes/code_values.h"
#include "ingest/grids/source_grid.h"
#include "ingest/raw/raw_load.h"
#include "ingest/values/value_cast.h"
#include "little_endian.h"

namespace deltasplat {
namespace {

constexpr int kBlock = 8;

// Where the voxels of a box lie in an array of its values.
struct BoxArray {
    const IndexBox& box;
    double* values;

    double* at(const glm::ivec3& voxel) const {
        const glm::ivec3 place = voxel - box.min;
        const glm::ivec3 dims = box.dims();
        return values +
               (std::size_t(place.z) * std::size_t(dims.y) + std::size_t(place.y)) *
                   std::size_t(dims.x) +
               place.x;
    }
};

// Calls fill(row, count, number in its leaf of the row's first voxel) for the rows of a block.
template <typename Fill>
void forRows(const IndexBox& block, const BoxArray& array, const Fill& fill) {
    const glm::ivec3& min = block.min;
    for (int z = min.z; z <= block.max.z; ++z) {
        for (int y = min.y; y <= block.max.y; ++y) {
            const auto first = openvdb::Index((min.x & 7) << 6 | (y & 7) << 3 | (z & 7));
            fill(array.at({min.x, y, z}), block.dims().x, first);
        }
    }
}

template <typename Accessor, typename ValueOf>
void readBlock(const Accessor& accessor, const ValueOf& valueOf, const IndexBox& block,
               const BoxArray& array) {
    const openvdb::Coord corner(block.min.x, block.min.y, block.min.z);
    if (const auto* leaf = accessor.probeConstLeaf(corner)) {
        forRows(block, array, [&](double* row, int count, openvdb::Index place) {
            constexpr openvdb::Index kAlongX = 64;
            for (int x = 0; x < count; ++x, place += kAlongX) {
                row[x] = valueOf(leaf->getValue(place), leaf->isValueOn(place));
            }
        });
    } else {
        const double value = valueOf(accessor.getValue(corner), accessor.isValueOn(corner));
        forRows(block, array,
                [&](double* row, int count, openvdb::Index) { std::fill_n(row, count, value); });
    }
}

template <typename Tree, typename ValueOf>
ReadBox treeReader(const Tree& tree, const ValueOf& valueOf) {
    return [&tree, valueOf](const IndexBox& box, double* values) {
        // The tree is not changed meanwhile, so the accessor need not hear of it.
        const openvdb::tree::ValueAccessor<const Tree, /*IsSafe=*/false> accessor(tree);
        const BoxArray array{box, values};
        const glm::ivec3 first = box.min & ~(kBlock - 1);
        for (int z = first.z; z <= box.max.z; z += kBlock) {
            for (int y = first.y; y <= box.max.y; y += kBlock) {
                for (int x = first.x; x <= box.max.x; x += kBlock) {
                    const glm::ivec3 corner(x, y, z);
                    readBlock(accessor, valueOf,
                              {glm::max(corner, box.min), glm::min(corner + (kBlock - 1), box.max)},
                              array);
                }
            }
        }
    };
}

ReadBox codeReader(const Volume& volume) {
    return treeReader(volume.codes->tree(),
                      [values = valuesOfCodes(volume.codeBook), background = volume.background](
                          Code code, bool active) { return active ? values[code] : background; });
}

template <typename T>
double store(const double* values, std::size_t count, std::byte* out) {
    double error = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const T value = valueAs<T>(values[i]);
        error = std::max(error, std::abs(double(value) - values[i]));
        storeLittle(value, out + i * sizeof(T));
    }
    return error;
}

}  // namespace

ReadBox boxReader(const Volume& volume) {
    if (!volume.source) return codeReader(volume);
    ReadBox reader;
    volume.source->grid.apply<ScalarTrees>([&](const auto& tree) {
        using T = typename std::decay_t<decltype(tree)>::ValueType;
        reader = treeReader(tree, [background = volume.background](T value, bool) {
            if constexpr (std::is_floating_point_v<T>) {
                if (!std::isfinite(value)) return background;
            } else {
                static_cast<void>(background);
            }
            return double(value);
        });
    });
    return reader;
}

double storeValues(const double* values, std::size_t count, RawType type, std::byte* out) {
    return withRawType(type, [&](auto zero) { return store<decltype(zero)>(values, count, out); });
}

}  // namespace deltasplat
