// SPDX-License-Identifier: Apache-2.0
// Renders volumes by all four methods, interleaved in one process, and prints medians of each
// stage.
//   render_benchmark REPEATS THREADS DIRECTION|aligned TF.json|- VOLUME...
// for example: render_benchmark 9 1 -1,0.8,-0.6 tf_ct.json engine_256x256x128_uint8.raw.gz
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "deltasplat/ingest/read_volume.h"
#include "deltasplat/render.h"
#include "deltasplat/simd.h"
#include "deltasplat/threads.h"

namespace {

using namespace deltasplat;

constexpr Method kMethods[] = {Method::kTraditional, Method::kSparse, Method::kDelta,
                               Method::kAuto};

// All repeats of one method.
struct Runs {
    std::vector<RenderStats> stats;
    std::vector<float> pixels;

    double median(double RenderStats::*member) const {
        std::vector<double> values;
        for (const RenderStats& one : stats) values.push_back(one.*member);
        std::sort(values.begin(), values.end());
        return 1e3 * values[values.size() / 2];
    }
};

void printTable(const std::vector<Runs>& runs) {
    const RenderStats& any = runs[0].stats[0];
    std::printf(
        "  %llu voxels, visible %.2f %%, deltas %.2f %%, %d slabs, r = %d, %dx%d footprint\n",
        static_cast<unsigned long long>(any.voxels), 100.0 * any.visible / any.voxels,
        100.0 * any.deltas / any.voxels, any.slabs, any.resolution, any.footprint, any.footprint);
    std::printf("  %-12s %10s %9s %9s %9s %9s %9s %6s\n", "method", "stamps", "prepare", "splat",
                "composite", "warp", "render", "ratio");
    const double traditional = runs[0].median(&RenderStats::renderSeconds);
    for (const Runs& run : runs) {
        const double seconds = run.median(&RenderStats::renderSeconds);
        std::printf("  %-12s %10llu %9.2f %9.2f %9.2f %9.2f %9.2f %6.2f%s\n",
                    methodName(run.stats[0].method).c_str(),
                    static_cast<unsigned long long>(run.stats[0].stamps),
                    run.median(&RenderStats::prepareSeconds),
                    run.median(&RenderStats::splatSeconds),
                    run.median(&RenderStats::compositeSeconds),
                    run.median(&RenderStats::warpSeconds), seconds, traditional / seconds,
                    run.pixels == runs[0].pixels ? "" : "  DIFFERENT PIXELS");
    }
}

void benchmarkVolume(const std::string& file, const RenderOptions& base, int repeats) {
    const Volume volume = readVolume(file);
    std::vector<Runs> runs(std::size(kMethods));
    for (int i = 0; i <= repeats; ++i) {
        for (std::size_t m = 0; m < std::size(kMethods); ++m) {
            RenderOptions options = base;
            options.method = kMethods[m];
            RenderResult result = render(volume, options);
            // The first round warms caches up.
            if (i > 0) runs[m].stats.push_back(result.stats);
            runs[m].pixels = std::move(result.image.rgba);
        }
    }
    std::printf("%s\n", std::filesystem::path(file).filename().c_str());
    printTable(runs);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 6) {
        std::fprintf(stderr,
                     "usage: render_benchmark REPEATS THREADS X,Y,Z|aligned TF.json|- VOLUME...\n");
        return 2;
    }
    try {
        const ThreadLimit limit(std::atoi(argv[2]));
        RenderOptions options;
        glm::dvec3 direction;
        if (std::sscanf(argv[3], "%lf,%lf,%lf", &direction.x, &direction.y, &direction.z) == 3) {
            options.camera.direction = direction;
            options.camera.up = glm::dvec3(0, 0, 1);
        }
        const bool ramp = std::string(argv[4]) == "-";
        if (!ramp) options.optics.transferFunction = readTransferFunction(argv[4]);
        std::printf("milliseconds, medians of %s, %s thread(s), %s\n", argv[1], argv[2],
                    simdLevel().c_str());
        for (int i = 5; i < argc; ++i) {
            if (ramp) options.optics.transferFunction = defaultRamp(readVolume(argv[i]));
            benchmarkVolume(argv[i], options, std::max(1, std::atoi(argv[1])));
        }
    } catch (const std::exception& error) {
        std::fprintf(stderr, "render_benchmark: %s\n", error.what());
        return 1;
    }
    return 0;
}
