// SPDX-License-Identifier: Apache-2.0
#include "formats/dense/dense_values.h"

#include <openvdb/tree/ValueAccessor.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <type_traits>
#include <vector>

#include "base/bits.h"
#include "formats/raw/raw_load.h"
#include "volume/code_math.h"
#include "volume/code_tree.h"
#include "volume/tree_grid.h"
#include "volume/value_cast.h"

namespace deltasplat {
namespace {

constexpr int kBlock = 8;

// Where the voxels of a box lie in an array of its values.
template <typename Value>
struct BoxArray {
    const IndexBox& box;
    Value* values;

    Value* at(const glm::ivec3& voxel) const {
        const glm::ivec3 place = voxel - box.min;
        const glm::ivec3 dims = box.dims();
        return values +
               (std::size_t(place.z) * std::size_t(dims.y) + std::size_t(place.y)) *
                   std::size_t(dims.x) +
               place.x;
    }
};

// Calls fill(row, count, number in its leaf of the row's first voxel) for the rows of a block.
template <typename Value, typename Fill>
void forRows(const IndexBox& block, const BoxArray<Value>& array, const Fill& fill) {
    const glm::ivec3& min = block.min;
    for (int z = min.z; z <= block.max.z; ++z) {
        for (int y = min.y; y <= block.max.y; ++y) {
            const auto first = openvdb::Index((min.x & 7) << 6 | (y & 7) << 3 | (z & 7));
            fill(array.at({min.x, y, z}), block.dims().x, first);
        }
    }
}

template <typename Accessor, typename ValueOf, typename Value>
void readBlock(const Accessor& accessor, const ValueOf& valueOf, const IndexBox& block,
               const BoxArray<Value>& array) {
    const openvdb::Coord corner(block.min.x, block.min.y, block.min.z);
    if (const auto* leaf = accessor.probeConstLeaf(corner)) {
        forRows(block, array, [&](Value* row, int count, openvdb::Index place) {
            constexpr openvdb::Index kAlongX = 64;
            for (int x = 0; x < count; ++x, place += kAlongX) {
                row[x] = valueOf(leaf->getValue(place), leaf->isValueOn(place));
            }
        });
    } else {
        const Value value = valueOf(accessor.getValue(corner), accessor.isValueOn(corner));
        forRows(block, array,
                [&](Value* row, int count, openvdb::Index) { std::fill_n(row, count, value); });
    }
}

template <typename Value, typename Tree, typename ValueOf>
ReadBox<Value> treeReader(const Tree& tree, const ValueOf& valueOf) {
    return [&tree, valueOf](const IndexBox& box, Value* values) {
        // The tree is not changed meanwhile, so the accessor need not hear of it.
        const openvdb::tree::ValueAccessor<const Tree, /*IsSafe=*/false> accessor(tree);
        const BoxArray<Value> array{box, values};
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

ReadBox<double> codeReader(const Volume& volume) {
    return treeReader<double>(
        volume.codes->tree(),
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

ReadBox<double> boxReader(const Volume& volume) {
    if (!volume.source) return codeReader(volume);
    ReadBox<double> reader;
    const bool isUnsigned = holdsUnsigned(volume);
    volume.source->grid.apply<ScalarTrees>([&](const auto& tree) {
        using T = typename std::decay_t<decltype(tree)>::ValueType;
        reader =
            treeReader<double>(tree, [=, background = volume.background](T value, bool) -> double {
                if (!std::isfinite(double(value))) return background;
                if constexpr (std::is_same_v<T, std::int64_t>)
                    if (isUnsigned) return double(std::uint64_t(value));
                return double(value);
            });
    });
    return reader;
}

ReadBox<std::int64_t> integerReader(const Volume& volume) {
    const auto* const tree = volume.source ? volume.source->grid.as<openvdb::Int64Tree>() : nullptr;
    if (!tree) return {};
    return treeReader<std::int64_t>(*tree, [](std::int64_t value, bool) { return value; });
}

double storeValues(const double* values, std::size_t count, RawType type, std::byte* out) {
    return withRawType(type, [&](auto zero) { return store<decltype(zero)>(values, count, out); });
}

double storeValues(const std::int64_t* values, std::size_t count, RawType, std::byte* out) {
    for (std::size_t i = 0; i < count; ++i) storeLittle(values[i], out + i * sizeof(values[i]));
    return 0;
}

}  // namespace deltasplat
