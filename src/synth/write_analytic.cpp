// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/synth/write_analytic.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/Prune.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "default_floats.h"
#include "deltasplat/atomic_file.h"
#include "deltasplat/error.h"
#include "ingest/raw/raw_format.h"
#include "little_endian.h"
#include "lower_case.h"
#include "memory.h"
#include "number_text.h"
#include "parallel.h"
#include "write_vdb.h"

namespace deltasplat {
namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;

constexpr int kMostSamples = 16;

// Returns the mean of a voxel's samples.
double valueAt(const AnalyticVolume& volume, const glm::ivec3& index,
               const AnalyticFileOptions& options) {
    const int each = options.samples;
    double sum = 0;
    for (int n = 0; n < each * each * each; ++n) {
        const glm::dvec3 part(n % each, n / each % each, n / (each * each));
        const glm::dvec3 at = 2.0 * glm::dvec3(index) + (2.0 * part + 1.0) / double(each);
        sum += volume.valueAt(at / glm::dvec3(options.dims) - 1.0);
    }
    return sum / (each * each * each);
}

// Stores a value 0..1 as one little-endian sample.
void storeFloat(double value, std::byte* at) {
    storeLittle(float(value), at);
}
template <typename Whole>
void storeWhole(double value, std::byte* at) {
    storeLittle(Whole(std::lround(value * std::numeric_limits<Whole>::max())), at);
}

struct SampleType {
    RawType raw;
    std::size_t bytes;
    void (*store)(double value, std::byte* at);
};

SampleType sampleType(const std::string& name) {
    if (name.empty() || name == "uint8") return {RawType::kUint8, 1, storeWhole<std::uint8_t>};
    if (name == "uint16") return {RawType::kUint16, 2, storeWhole<std::uint16_t>};
    if (name == "float32") return {RawType::kFloat32, 4, storeFloat};
    throw Error(ErrorCode::kUsage,
                gotExpected("`type`", "\"" + name + "\"", "uint8, uint16 or float32 for .raw"));
}

void writeRaw(const AnalyticVolume& volume, const std::filesystem::path& file,
              const AnalyticFileOptions& options, const Listener& listener) {
    const SampleType type = sampleType(options.type);
    const glm::ivec3 dims = options.dims;
    const std::size_t rowBytes = std::size_t(dims.x) * type.bytes;
    requireMemory("`dims`", double(rowBytes) * dims.y);

    saysLayout(file, {dims, type.raw, false, 0});

    AtomicFile out(file);
    std::vector<std::byte> slice(rowBytes * std::size_t(dims.y));
    for (int z = 0; z < dims.z; ++z) {
        parallelFor(std::size_t(dims.y), [&](std::size_t y) {
            std::byte* row = &slice[y * rowBytes];
            for (int x = 0; x < dims.x; ++x, row += type.bytes) {
                type.store(valueAt(volume, {x, int(y), z}, options), row);
            }
        });
        out.write(slice.data(), slice.size());
        listener.report(double(z + 1) / dims.z);
    }
    out.commit();
}

// Samples 8^3 voxels; null if all are zero. Voxels beyond the volume's dims stay inactive.
std::unique_ptr<Leaf> sampleLeaf(const AnalyticVolume& volume, const openvdb::Coord& origin,
                                 const AnalyticFileOptions& options) {
    const glm::ivec3& dims = options.dims;
    auto leaf = std::make_unique<Leaf>(origin, 0.0f);
    for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) {
        const openvdb::Coord at = leaf->offsetToGlobalCoord(i);
        if (at.x() >= dims.x || at.y() >= dims.y || at.z() >= dims.z) continue;
        const float value = float(valueAt(volume, {at.x(), at.y(), at.z()}, options));
        if (value != 0) leaf->setValueOn(i, value);
    }
    return leaf->isEmpty() ? nullptr : std::move(leaf);
}

// A leaf that is one value throughout takes no more memory than a tile.
void addLeaf(openvdb::FloatTree& tree, std::unique_ptr<Leaf> leaf) {
    float value = 0;
    bool active = false;
    if (!leaf) return;
    if (leaf->isConstant(value, active)) {
        tree.addTile(1, leaf->origin(), value, active);
    } else {
        tree.addLeaf(leaf.release());
    }
}

openvdb::FloatGrid::Ptr sampleGrid(const AnalyticVolume& volume, const AnalyticFileOptions& options,
                                   const Listener& listener) {
    constexpr int kEdge = int(Leaf::DIM);
    const glm::ivec3 leaves = (options.dims - 1) / kEdge + 1;
    auto grid = openvdb::FloatGrid::create(0.0f);
    // One layer of leaves at a time keeps the work in large pieces and the list of them short.
    const std::size_t layerLeaves = std::size_t(leaves.y) * std::size_t(leaves.z);
    // What a layer takes is known only when it is there, so room is asked for one full layer more.
    constexpr double kLeafBytes = sizeof(Leaf) + Leaf::SIZE * sizeof(float) + sizeof(void*);
    requireMemory("`dims`", kLeafBytes * double(layerLeaves));
    std::vector<std::unique_ptr<Leaf>> layer(layerLeaves);
    for (int x = 0; x < leaves.x; ++x) {
        requireMemory("`dims`", kLeafBytes * double(layerLeaves));
        parallelFor(layer.size(), [&](std::size_t i) {
            const int y = int(i / std::size_t(leaves.z)), z = int(i % std::size_t(leaves.z));
            layer[i] = sampleLeaf(volume, {x * kEdge, y * kEdge, z * kEdge}, options);
        });
        for (std::unique_ptr<Leaf>& leaf : layer) addLeaf(grid->tree(), std::move(leaf));
        listener.report(double(x + 1) / leaves.x);
    }
    openvdb::tools::prune(grid->tree());
    return grid;
}

void writeGrid(const AnalyticVolume& volume, const std::filesystem::path& file,
               const AnalyticFileOptions& options, const Listener& listener) {
    if (!options.type.empty() && options.type != "float32") {
        throw Error(ErrorCode::kUsage,
                    gotExpected("`type`", "\"" + options.type + "\"", "float32 for .vdb"));
    }
    { const AtomicFile probe(file); }  // a bad name should fail before the work, not after
    const openvdb::FloatGrid::Ptr grid = sampleGrid(volume, options, listener);
    grid->setName("density");
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    grid->setCreator("deltasplat");
    const openvdb::Vec3d spacing(options.spacing.x, options.spacing.y, options.spacing.z);
    grid->setTransform(openvdb::math::Transform::Ptr(new openvdb::math::Transform(
        openvdb::math::MapBase::Ptr(new openvdb::math::ScaleMap(spacing)))));
    writeVdb(file, {grid});
}

void checkOptions(const AnalyticFileOptions& options) {
    const glm::ivec3& dims = options.dims;
    if (dims.x < 1 || dims.y < 1 || dims.z < 1) {
        throw Error(ErrorCode::kUsage,
                    gotExpected("`dims`",
                                std::to_string(dims.x) + "x" + std::to_string(dims.y) + "x" +
                                    std::to_string(dims.z),
                                "three numbers of at least 1"));
    }
    if (options.samples < 1 || options.samples > kMostSamples) {
        throw Error(ErrorCode::kUsage,
                    gotExpected("`samples`", std::to_string(options.samples),
                                "a whole number within 1.." + std::to_string(kMostSamples)));
    }
    for (int axis = 0; axis < 3; ++axis) {
        const double spacing = options.spacing[axis];
        if (spacing > 0 && std::isfinite(spacing)) continue;
        throw Error(ErrorCode::kUsage,
                    gotExpected("`spacing`", numberText(options.spacing), "three numbers above 0"));
    }
}

}  // namespace

void writeAnalytic(const AnalyticVolume& volume, const std::filesystem::path& file,
                   const AnalyticFileOptions& options, const Listener& listener) {
    const DefaultFloats floats;
    checkOptions(options);
    const std::string extension = lowerCase(file.extension().string());
    if (extension == ".raw") {
        writeRaw(volume, file, options, listener);
    } else if (extension == ".vdb") {
        writeGrid(volume, file, options, listener);
    } else {
        throw Error(ErrorCode::kUsage,
                    gotExpected(file.string(), "extension \"" + file.extension().string() + "\"",
                                ".raw or .vdb"));
    }
}

}  // namespace deltasplat
