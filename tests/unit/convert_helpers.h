// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <glm/vec3.hpp>
#include <string>
#include <utility>
#include <vector>

#include "deltasplat/convert/write_volume.h"
#include "deltasplat/ingest/read_volume.h"
#include "unit/ingest_helpers.h"
#include "volume/tree_types.h"

namespace deltasplat::testing {

/// Writes raw values and reads them as convert does.
template <typename T>
Volume rawVolume(const std::vector<T>& values, const glm::ivec3& dims, const std::string& type,
                 const glm::dvec3& spacing = glm::dvec3(1),
                 const glm::dvec3& origin = glm::dvec3(0)) {
    writeBytes("source.raw", bytesOf(values));
    ReadOptions options;
    options.keepSource = true;
    options.raw.dims = dims;
    options.raw.type = type;
    options.raw.spacing = spacing;
    options.raw.origin = origin;
    return readVolume("source.raw", options);
}

inline Volume readKept(const std::filesystem::path& file, const std::string& grid = "") {
    ReadOptions options;
    options.keepSource = true;
    options.levelSetToFog = false;
    if (!grid.empty()) options.gridName = grid;
    return readVolume(file, options);
}

inline WriteReport write(const std::filesystem::path& file, Volume volume,
                         const WriteOptions& options = {}) {
    std::vector<Volume> volumes;
    volumes.push_back(std::move(volume));
    return writeVolumes(file, std::move(volumes), options);
}

/// Reads the grids of a .vdb by OpenVDB alone.
inline openvdb::GridPtrVec readGrids(const std::filesystem::path& file) {
    openvdb::initialize();
    openvdb::io::File in(file.string());
    in.open(/*delayLoad=*/false);
    return *in.getGrids();
}

template <typename Grid>
typename Grid::Ptr readGrid(const std::filesystem::path& file) {
    const openvdb::GridPtrVec grids = readGrids(file);
    EXPECT_EQ(grids.size(), 1u);
    return openvdb::gridPtrCast<Grid>(grids.at(0));
}

/// Values 0, 1, 2, ... that do not repeat within a leaf, with runs that make whole blocks uniform.
template <typename T>
std::vector<T> pattern(const glm::ivec3& dims, T low, T high) {
    std::vector<T> values;
    for (int z = 0; z < dims.z; ++z) {
        for (int y = 0; y < dims.y; ++y) {
            for (int x = 0; x < dims.x; ++x) {
                const bool uniform = x < 8 && y < 8;
                const double share = double((x * 7 + y * 13 + z * 29) % 101) / 100;
                values.push_back(uniform ? low
                                         : T(double(low) + share * (double(high) - double(low))));
            }
        }
    }
    values.back() = high;
    return values;
}

}  // namespace deltasplat::testing
