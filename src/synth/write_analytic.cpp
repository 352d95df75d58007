// SPDX-License-Identifier: Apache-2.0
#include <openvdb/tools/Prune.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/ext/matrix_transform.hpp>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "base/bits.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/portable_math.h"
#include "base/text.h"
#include "deltasplat/atomic_file.h"
#include "deltasplat/error.h"
#include "deltasplat/synth/analytic_volume.h"
#include "deltasplat/synth/write_analytic.h"
#include "formats/raw/raw_format.h"
#include "formats/vdb/grid_metadata.h"
#include "formats/vdb/write_vdb.h"
#include "synth/volumes.h"
#include "volume/leaf_slices.h"
#include "volume/tree_grid.h"
#include "volume/tree_types.h"
#include "volume/vdb_transform.h"

namespace deltasplat {

namespace {

/// Samples a volume into the grids that writeAnalytic writes to a `.vdb`.
/// @throw Error(kFailed) if memory is short; exceptions of `listener.progress`
std::vector<TreeGrid> sampleGrids(const AnalyticVolume& volume, const AnalyticFileOptions& options,
                                  const Listener& listener);

namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;
using ColorLeaf = openvdb::Vec3STree::LeafNodeType;

// Samples 8^3 voxels; null if none exceeds the threshold. Voxels beyond dims stay inactive.
std::unique_ptr<Leaf> sampleLeaf(const AnalyticGrid& sampled, const openvdb::Coord& origin,
                                 const AnalyticFileOptions& options) {
    const glm::ivec3& dims = options.dims;
    auto leaf = std::make_unique<Leaf>(origin, 0.0f);
    for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) {
        const openvdb::Coord at = leaf->offsetToGlobalCoord(i);
        if (at.x() >= dims.x || at.y() >= dims.y || at.z() >= dims.z) continue;
        const auto value = float(sampleVoxel(sampled.valueAt, {at.x(), at.y(), at.z()}, options));
        if (value != 0 && double(value) > sampled.threshold) leaf->setValueOn(i, value);
    }
    return leaf->isEmpty() ? nullptr : std::move(leaf);
}

// A constant leaf is stored as a tile.
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

// Turns uniform nodes into tiles, like OpenVDB's prune, whose code is in its library.
void pruneUniform(openvdb::FloatTree& tree) {
    openvdb::tree::NodeManager<openvdb::FloatTree, openvdb::FloatTree::DEPTH - 2> nodes(tree);
    nodes.foreachBottomUp(openvdb::tools::TolerancePruneOp<openvdb::FloatTree>(tree, 0.0f));
}

openvdb::FloatTree::Ptr sampleScalars(const AnalyticGrid& sampled,
                                      const AnalyticFileOptions& options,
                                      const Listener& listener) {
    constexpr int kEdge = int(Leaf::DIM);
    const glm::ivec3 leaves = (options.dims - 1) / kEdge + 1;
    auto tree = std::make_shared<openvdb::FloatTree>(0.0f);
    // One layer of leaves at a time keeps tasks large and the list short.
    const std::size_t layerLeaves = std::size_t(leaves.y) * std::size_t(leaves.z);
    // A layer's size is unknown beforehand, so memory for a full layer is requested.
    constexpr double kLeafBytes = leafBytes<Leaf>() + sizeof(void*);
    requireMemory("`dims`", kLeafBytes * double(layerLeaves));
    std::vector<std::unique_ptr<Leaf>> layer(layerLeaves);
    for (int x = 0; x < leaves.x; ++x) {
        requireMemory("`dims`", kLeafBytes * double(layerLeaves));
        parallelFor(layer.size(), [&](std::size_t i) {
            const int y = int(i / std::size_t(leaves.z)), z = int(i % std::size_t(leaves.z));
            layer[i] = sampleLeaf(sampled, {x * kEdge, y * kEdge, z * kEdge}, options);
        });
        for (std::unique_ptr<Leaf>& leaf : layer) addLeaf(*tree, std::move(leaf));
        listener.report(double(x + 1) / leaves.x);
    }
    pruneUniform(*tree);
    return tree;
}

void colorLeaf(const AnalyticVolume& volume, const AnalyticFileOptions& options, ColorLeaf& leaf) {
    for (auto voxel = leaf.beginValueOn(); voxel; ++voxel) {
        const openvdb::Coord at = voxel.getCoord();
        const glm::vec3 color(sampleVoxel(volume.colorAt, {at.x(), at.y(), at.z()}, options));
        voxel.setValue({color.r, color.g, color.b});
    }
}

// Colours vary within uniform smoke, so its tiles become leaves.
openvdb::Vec3STree::Ptr sampleColors(const AnalyticVolume& volume, const openvdb::FloatTree& shape,
                                     const AnalyticFileOptions& options, const Listener& listener) {
    constexpr std::size_t kBatch = 4096;  // leaves
    const double mostLeaves =
        double(shape.leafCount()) + double(shape.activeVoxelCount()) / ColorLeaf::SIZE;
    requireMemory("`dims`", leafBytes<ColorLeaf>() * mostLeaves);
    auto tree =
        std::make_shared<openvdb::Vec3STree>(shape, openvdb::Vec3s(0.0f), openvdb::TopologyCopy());
    tree->voxelizeActiveTiles(/*threaded=*/false);
    std::vector<ColorLeaf*> leaves;
    tree->getNodes(leaves);
    for (std::size_t first = 0; first < leaves.size(); first += kBatch) {
        const std::size_t count = std::min(kBatch, leaves.size() - first);
        parallelFor(count, [&](std::size_t i) { colorLeaf(volume, options, *leaves[first + i]); });
        listener.report(double(first + count) / double(leaves.size()));
    }
    return tree;
}

}  // namespace

std::vector<TreeGrid> sampleGrids(const AnalyticVolume& volume, const AnalyticFileOptions& options,
                                  const Listener& listener) {
    const double parts = 1 + double(volume.others.size()) + (volume.colorAt ? 1 : 0);
    const auto map = makeMap(glm::scale(glm::dmat4(1), options.spacing));
    std::vector<TreeGrid> grids;
    const auto add = [&](std::shared_ptr<openvdb::TreeBase> tree, const std::string& name) {
        TreeGrid& grid = grids.emplace_back(TreeGrid{std::move(tree), {}, map});
        grid.metadata.insert(openvdb::GridBase::META_GRID_NAME, name);
        grid.metadata.insert(openvdb::GridBase::META_GRID_CREATOR, std::string("deltasplat"));
    };
    const auto addFog = [&](std::shared_ptr<openvdb::TreeBase> tree, const std::string& name) {
        add(std::move(tree), name);
        grids.back().metadata.insert(openvdb::GridBase::META_GRID_CLASS, std::string(kFogClass));
    };
    const auto part = [&] {
        Listener own = listener;
        own.progress = [&, done = double(grids.size())](double share) {
            listener.report((done + share) / parts);
        };
        return own;
    };
    // Any non-zero value is density; some volumes have negative ones.
    constexpr double kNone = std::numeric_limits<double>::lowest();
    const auto density = sampleScalars({"density", volume.valueAt, kNone}, options, part());
    addFog(density, "density");
    for (const AnalyticGrid& other : volume.others)
        addFog(sampleScalars(other, options, part()), other.name);
    if (volume.colorAt) add(sampleColors(volume, *density, options, part()), "Cd");
    return grids;
}

constexpr int kMostSamples = 16;

// Stores a value 0..1 as a little-endian sample.
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
    throw Error(ErrorCode::kUsage, "`type`", "\"" + name + "\"",
                "uint8, uint16 or float32 for .raw");
}

void warnOfOthers(const AnalyticVolume& volume, const std::filesystem::path& file,
                  const Listener& listener) {
    std::string names;
    const auto add = [&](const std::string& name) { names += (names.empty() ? "" : ", ") + name; };
    for (const AnalyticGrid& other : volume.others) add(other.name);
    if (volume.colorAt) add("Cd");
    if (names.empty()) return;
    listener.warn(file.string() + ": holds density alone; left out " + names +
                  ", which a .vdb holds");
}

void writeRaw(const AnalyticVolume& volume, const std::filesystem::path& file,
              const AnalyticFileOptions& options, const Listener& listener) {
    const SampleType type = sampleType(options.type);
    const glm::ivec3 dims = options.dims;
    const std::size_t rowBytes = std::size_t(dims.x) * type.bytes;
    requireMemory("`dims`", double(rowBytes) * dims.y);

    saysLayout(file, {dims, type.raw, false, 0});
    warnOfOthers(volume, file, listener);

    AtomicFile out(file);
    std::vector<std::byte> slice(rowBytes * std::size_t(dims.y));
    for (int z = 0; z < dims.z; ++z) {
        parallelFor(std::size_t(dims.y), [&](std::size_t y) {
            std::byte* row = &slice[y * rowBytes];
            for (int x = 0; x < dims.x; ++x, row += type.bytes) {
                type.store(sampleVoxel(volume.valueAt, {x, int(y), z}, options), row);
            }
        });
        out.write(slice.data(), slice.size());
        listener.report(double(z + 1) / dims.z);
    }
    out.commit();
}

void writeGrids(const AnalyticVolume& volume, const std::filesystem::path& file,
                const AnalyticFileOptions& options, const Listener& listener) {
    if (!options.type.empty() && options.type != "float32") {
        throw Error(ErrorCode::kUsage, "`type`", "\"" + options.type + "\"", "float32 for .vdb");
    }
    { const AtomicFile probe(file); }  // reports a bad name before the work
    std::vector<WrittenGrid> grids;
    for (const auto& grid : sampleGrids(volume, options, listener))
        grids.push_back(writtenGrid(grid));
    writeVdb(file, grids);
}

void checkOptions(const AnalyticFileOptions& options) {
    const glm::ivec3& dims = options.dims;
    if (dims.x < 1 || dims.y < 1 || dims.z < 1) {
        throw Error(
            ErrorCode::kUsage, "`dims`",
            std::to_string(dims.x) + "x" + std::to_string(dims.y) + "x" + std::to_string(dims.z),
            "three numbers of at least 1");
    }
    if (options.samples < 1 || options.samples > kMostSamples) {
        throw Error(ErrorCode::kUsage, "`samples`", std::to_string(options.samples),
                    "a whole number within 1.." + std::to_string(kMostSamples));
    }
    for (int axis = 0; axis < 3; ++axis) {
        const double spacing = options.spacing[axis];
        if (spacing > 0 && std::isfinite(spacing)) continue;
        throw Error(ErrorCode::kUsage, "`spacing`", numberText(options.spacing),
                    "three numbers above 0");
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
        writeGrids(volume, file, options, listener);
    } else {
        throw Error(ErrorCode::kUsage, file.string(),
                    "extension \"" + file.extension().string() + "\"", ".raw or .vdb");
    }
}

// Based on: S. Marschner, R. Lobb, "An Evaluation of Reconstruction Filters for Volume Rendering",
// 1994, section 5 (marschner-lobb); D. Griffiths, "Introduction to Quantum Mechanics", 1995,
// section 4.2 (hydrogen: radial function R_32 and spherical harmonic Y_20).
ValueAt makeMarschnerLobb() {
    return [](const glm::dvec3& p) {
        constexpr double kPi = std::numbers::pi;
        constexpr double kFrequency = 6;  // f_M
        constexpr double kAlpha = 0.25;
        const double radius = std::sqrt(p.x * p.x + p.y * p.y);
        const double ripple = portable::cos(2 * kPi * kFrequency * portable::cos(kPi * radius / 2));
        return (1 - portable::sin(kPi * p.z / 2) + kAlpha * (1 + ripple)) / (2 * (1 + kAlpha));
    };
}

ValueAt makeHydrogen() {
    return [](const glm::dvec3& p) {
        // |psi|^2 ~ (r^2 exp(-r/3) (3 cos^2 theta - 1))^2, r in Bohr radii, theta from the y axis.
        constexpr double kHalfEdge = 20;
        const glm::dvec3 q = p * kHalfEdge;
        const double radius = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z);
        const double psi = (2 * q.y * q.y - q.x * q.x - q.z * q.z) * portable::exp(-radius / 3);
        // On the y axis psi is 2 y^2 exp(-y/3), with its maximum at y = 6.
        const double largest = 72 * portable::exp(-2.0);
        return (psi / largest) * (psi / largest);
    };
}

ValueAt makeSlab() {
    return [](const glm::dvec3& p) {
        const bool inside = std::abs(p.x) <= 0.8 && std::abs(p.y) <= 0.8 && std::abs(p.z) <= 0.5;
        return inside ? 1.0 : 0.0;
    };
}

const std::vector<std::string>& analyticNames() {
    static const std::vector<std::string> kNames = {
        "marschner-lobb", "hydrogen", "shepp-logan", "engine", "cloud",
        "slab",           "vessels",  "body",        "fire",   "explosion"};
    return kNames;
}

AnalyticVolume makeAnalytic(const std::string& name, std::uint64_t seed, double noise) {
    const DefaultFloats floats;
    if (!(noise >= 0) || !std::isfinite(noise)) {
        throw Error(ErrorCode::kUsage, "`noise`", std::to_string(noise), "a number of at least 0");
    }
    if (name == "marschner-lobb") return {name, makeMarschnerLobb()};
    if (name == "hydrogen") return {name, makeHydrogen()};
    if (name == "shepp-logan") return {name, makeSheppLogan()};
    if (name == "engine") return {name, makeEngine(seed, noise)};
    if (name == "cloud") return {name, makeCloud(seed)};
    if (name == "slab") return {name, makeSlab()};
    if (name == "vessels") return {name, makeVessels(seed, noise)};
    if (name == "body") return {name, makeBody()};
    if (name == "fire") return makeFire(seed);
    if (name == "explosion") return makeExplosion(seed);

    std::string names;
    for (const std::string& known : analyticNames()) names += (names.empty() ? "" : ", ") + known;
    throw Error(ErrorCode::kUsage, "`name`", "\"" + name + "\"", "one of " + names);
}

}  // namespace deltasplat
