// SPDX-License-Identifier: Apache-2.0
// Makes larger volumes to measure on: a volume of whole values of 0..255 with FACTOR times as many
// voxels each way, interpolated linearly between voxel centres and rounded, as
// FOLDER/NAMEFACTOR_XxYxZ_uint8.raw. Prints the file's name.
//   enlarge_volume FACTOR INPUT FOLDER
#include <openvdb/tree/ValueAccessor.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "base/text.h"
#include "deltasplat/ingest/read_volume.h"
#include "volume/code_tree.h"

namespace {

using namespace deltasplat;

// [z][y][x]; what is not active is the background.
std::vector<std::uint8_t> valuesOf(const Volume& volume) {
    const glm::ivec3 dims = volume.box().dims();
    std::vector<std::uint8_t> values;
    values.reserve(std::size_t(volume.box().voxels()));
    const openvdb::tree::ValueAccessor<const CodeTree::Tree> codes(volume.codes()->tree());
    for (int z = 0; z < dims.z; ++z) {
        for (int y = 0; y < dims.y; ++y) {
            for (int x = 0; x < dims.x; ++x) {
                const glm::ivec3 at = volume.box().min + glm::ivec3(x, y, z);
                Code code = 0;
                const bool isActive = codes.probeValue({at.x, at.y, at.z}, code);
                const double value =
                    isActive ? volume.codeBook().valueOf(code) : volume.background();
                values.push_back(std::uint8_t(std::clamp(std::lround(value), 0L, 255L)));
            }
        }
    }
    return values;
}

// Between which two of `count` samples a sample of those that are more lies, and how far.
struct Between {
    int low, high;
    double share;
    Between(int i, int factor, int count) {
        const double place = std::clamp((i + 0.5) / factor - 0.5, 0.0, count - 1.0);
        low = int(place);
        high = std::min(low + 1, count - 1);
        share = place - low;
    }
};

void enlarge(int factor, const char* input, const std::filesystem::path& folder) {
    const Volume volume = readVolume(input);
    const std::vector<std::uint8_t> values = valuesOf(volume);
    const glm::ivec3 dims = volume.box().dims();
    const glm::ivec3 large = factor * dims;
    std::string name = std::filesystem::path(input).filename().string();
    name = name.substr(0, name.find_first_of("_."));
    const std::filesystem::path file =
        folder / (name + std::to_string(factor) + "_" + dimsText(large) + "_uint8.raw");
    std::ofstream out(file, std::ios::binary);
    std::vector<char> slice(std::size_t(large.x) * std::size_t(large.y));
    for (int z = 0; z < large.z; ++z) {
        const Between bz(z, factor, dims.z);
        parallelFor(std::size_t(large.y), [&](std::size_t row) {
            const Between by(int(row), factor, dims.y);
            for (int x = 0; x < large.x; ++x) {
                const Between bx(x, factor, dims.x);
                const auto along = [&](int y, int atZ) {
                    const std::uint8_t* line =
                        &values[(std::size_t(atZ) * std::size_t(dims.y) + std::size_t(y)) *
                                std::size_t(dims.x)];
                    return std::lerp(double(line[bx.low]), double(line[bx.high]), bx.share);
                };
                const auto across = [&](int atZ) {
                    return std::lerp(along(by.low, atZ), along(by.high, atZ), by.share);
                };
                const double value = std::lerp(across(bz.low), across(bz.high), bz.share);
                slice[row * std::size_t(large.x) + std::size_t(x)] =
                    char(std::uint8_t(std::lround(value)));
            }
        });
        out.write(slice.data(), std::streamsize(slice.size()));
    }
    out.close();
    if (!out) throw std::runtime_error("cannot write " + file.string());
    std::puts(file.c_str());
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 4 || std::atoi(argv[1]) < 1) {
        std::fprintf(stderr, "usage: enlarge_volume FACTOR INPUT FOLDER\n");
        return 2;
    }
    try {
        enlarge(std::atoi(argv[1]), argv[2], argv[3]);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return 0;
}
