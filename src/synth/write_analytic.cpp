// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/synth/write_analytic.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "base/bits.h"
#include "base/default_floats.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/text.h"
#include "deltasplat/atomic_file.h"
#include "deltasplat/error.h"
#include "formats/raw/raw_format.h"
#include "formats/vdb/write_vdb.h"
#include "synth/sample_grids.h"
#include "synth/volumes.h"

namespace deltasplat {
namespace {

constexpr int kMostSamples = 16;

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
    { const AtomicFile probe(file); }  // a bad name should fail before the work, not after
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

}  // namespace deltasplat
