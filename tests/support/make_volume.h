// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <random>
#include <vector>

#include "deltasplat/ingest/volume.h"
#include "support/changed_volume.h"
#include "volume/code_tree.h"

namespace deltasplat::test {

inline constexpr int kInactive = -1;

/// Builds a volume in memory whose voxel (x, y, z) has the code codeAt(x, y, z), or is inactive
/// where that is kInactive. The box is the given one, as if all of it had been in a file.
inline Volume makeVolume(const IndexBox& box, const std::function<int(int x, int y, int z)>& codeAt,
                         glm::dvec3 voxelSize = glm::dvec3(1)) {
    auto tree = std::make_shared<CodeTree>();
    VolumeData volume;
    volume.name = "test";
    volume.type = "uint16";
    volume.gridClass = "fog volume";
    volume.codeBook = CodeBook::integer();
    volume.box = box;
    volume.histogram.assign(kCodeCount, 0);
    for (int z = box.min.z; z <= box.max.z; ++z) {
        for (int y = box.min.y; y <= box.max.y; ++y) {
            for (int x = box.min.x; x <= box.max.x; ++x) {
                const int code = codeAt(x, y, z);
                if (code == kInactive) continue;
                tree->tree().setValueOn(openvdb::Coord(x, y, z), Code(code));
                if (volume.activeCount++ == 0) volume.valueMin = volume.valueMax = code;
                volume.valueMin = std::min<double>(volume.valueMin, code);
                volume.valueMax = std::max<double>(volume.valueMax, code);
                ++volume.histogram[code];
            }
        }
    }
    for (int c = 0; c < 3; ++c) volume.worldFromIndex[c][c] = voxelSize[c];
    volume.codes = std::move(tree);
    return Volume(std::move(volume));
}

/// A seeded random volume: runs of equal codes along every axis, so that some voxels change and
/// some do not; about `emptyShare` of it is inactive.
inline Volume randomVolume(const IndexBox& box, std::uint32_t seed, double emptyShare = 0.3,
                           glm::dvec3 voxelSize = glm::dvec3(1)) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0, 1);
    const glm::ivec3 dims = box.dims();
    std::vector<int> codes(box.voxels());
    for (std::size_t i = 0; i < codes.size(); ++i) {
        const double choice = uniform(random);
        const std::size_t before[] = {1, std::size_t(dims.x), std::size_t(dims.x) * dims.y};
        if (choice < 0.6 && i >= before[i % 3]) {
            codes[i] = codes[i - before[i % 3]];
        } else {
            codes[i] = uniform(random) < emptyShare ? kInactive : int(uniform(random) * 255.99);
        }
    }
    return makeVolume(
        box,
        [&](int x, int y, int z) {
            const glm::ivec3 p = glm::ivec3(x, y, z) - box.min;
            return codes[(std::size_t(p.z) * dims.y + p.y) * dims.x + p.x];
        },
        voxelSize);
}

}  // namespace deltasplat::test
