// SPDX-License-Identifier: Apache-2.0
// Turns uint8 raw files into delta grids, stage by stage, beside what OpenVDB's own dense copy
// takes for the same file, interleaved in one process; prints medians.
//   delta_benchmark REPEATS THREADS engine_256x256x128_uint8.raw...
#include <openvdb/tools/Dense.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "base/progress.h"
#include "deltasplat/delta/delta_file.h"
#include "deltasplat/error.h"
#include "deltasplat/ingest/read_volume.h"
#include "deltasplat/threads.h"
#include "formats/raw/raw_format.h"
#include "volume/tree_types.h"

namespace {

using namespace deltasplat;

struct Stage {
    const char* name;
    std::function<void()> run;
    std::vector<double> seconds;

    double median() {
        std::sort(seconds.begin(), seconds.end());
        return seconds[seconds.size() / 2];
    }
};

openvdb::FloatGrid::Ptr copyDense(const std::string& file, const RawLayout& layout) {
    const openvdb::CoordBBox box(
        {0, 0, 0}, {int(layout.dims.x) - 1, int(layout.dims.y) - 1, int(layout.dims.z) - 1});
    openvdb::tools::Dense<std::uint8_t, openvdb::tools::LayoutXYZ> dense(box);
    std::ifstream(file, std::ios::binary)
        .read(reinterpret_cast<char*>(dense.data()), std::streamsize(layout.dataBytes()));
    auto grid = openvdb::FloatGrid::create();
    parallelFor(1, [&](std::size_t) { openvdb::tools::copyFromDense(dense, *grid, 0.0f); });
    return grid;
}

void benchmarkFile(const std::string& file, int repeats) {
    const RawLayout layout = resolveRawLayout(file, {});
    if (layout.type != RawType::kUint8)
        throw Error(ErrorCode::kUsage, file, rawTypeName(layout.type), "uint8");
    const std::filesystem::path output = std::filesystem::temp_directory_path() / "benchmark.vdb";
    openvdb::FloatGrid::Ptr dense;
    Volume volume;
    std::unique_ptr<DeltaFile> deltas;
    std::vector<Stage> stages = {
        {"OpenVDB: read, copyFromDense", [&] { dense = copyDense(file, layout); }, {}},
        {"OpenVDB: write", [&] { openvdb::io::File(output).write({dense}); }, {}},
        {"read", [&] { volume = readVolume(file); }, {}},
        {"take differences",
         [&] {
             deltas = std::make_unique<DeltaFile>();
             deltas->add(volume, {});
         },
         {}},
        {"write", [&] { deltas->write(output); }, {}}};
    for (int i = 0; i <= repeats; ++i) {
        for (Stage& stage : stages) {
            const Clock::time_point start = Clock::now();
            stage.run();
            // The first round warms caches up.
            if (i > 0) stage.seconds.push_back(secondsSince(start));
        }
    }
    std::printf("%s: %.1f M voxels, %.1f MB written\n",
                std::filesystem::path(file).filename().c_str(), double(layout.voxels()) / 1e6,
                double(std::filesystem::file_size(output)) / 1e6);
    std::filesystem::remove(output);
    const auto print = [&](const char* name, double seconds) {
        std::printf("  %-30s %9.1f ms %9.1f M voxels/s %6.2f of the dense copy\n", name,
                    1e3 * seconds, double(layout.voxels()) / seconds / 1e6,
                    stages[0].median() / seconds);
    };
    for (Stage& stage : stages) print(stage.name, stage.median());
    const double taken = stages[2].median() + stages[3].median();
    print("OpenVDB: all", stages[0].median() + stages[1].median());
    print("read, take", taken);
    print("read, take, write", taken + stages[4].median());
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 4) {
        std::fprintf(stderr, "usage: delta_benchmark REPEATS THREADS FILE.raw...\n");
        return 2;
    }
    try {
        openvdb::initialize();
        const ThreadLimit limit(std::atoi(argv[2]));
        for (int i = 3; i < argc; ++i) benchmarkFile(argv[i], std::max(1, std::atoi(argv[1])));
    } catch (const std::exception& error) {
        std::fprintf(stderr, "delta_benchmark: %s\n", error.what());
        return 1;
    }
    return 0;
}
