// SPDX-License-Identifier: Apache-2.0
// Renders one volume by transfer functions that change from picture to picture: each prepared anew,
// and by PreparedScene::withOptics, which keeps what did not change. Prints medians of
// milliseconds: of preparing, and of the whole picture.
//   optics_benchmark PICTURES SIZE TRANSFER_FUNCTION.json FILE...
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <memory>
#include <vector>

#include "base/progress.h"
#include "deltasplat/ingest/read_volume.h"
#include "deltasplat/prepared_scene.h"

namespace {

using namespace deltasplat;

double median(std::vector<double>& values) {
    std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2),
                     values.end());
    return values[values.size() / 2];
}

// What changes in picture i.
using Change = std::function<void(int i, Optics& optics)>;

void measureFile(const char* file, const char* transferFunction, int pictures, int size) {
    const auto volume = std::make_shared<const Volume>(readVolume(file));
    RenderOptions options;
    options.optics.transferFunction = readTransferFunction(transferFunction);
    options.camera.direction = {-1, 0.8, -0.6};
    options.camera.up = {0, 0, 1};
    options.camera.sizePixels = glm::ivec2(size);
    const Camera camera = makeCamera(options.camera, *volume);
    const struct {
        const char* name;
        Change change;
    } cases[] = {
        {"opacity", [](int i, Optics& optics) { optics.extinctionScale = 1 + 0.01 * i; }},
        {"colour",
         [](int i, Optics& optics) {
             for (auto& point : optics.transferFunction.colors) point.rgb.r *= 1 - 0.005 * i;
         }},
        {"threshold",
         [](int i, Optics& optics) {
             for (auto& point : optics.transferFunction.opacities) point.x += 0.002 * (i + 1);
         }},
    };
    std::printf("%s\n", file);
    Image image(options.camera.sizePixels);
    for (const auto& one : cases) {
        const PreparedScene first({volume, options.optics}, options.splat);
        first.render(camera, image);
        std::vector<double> prepare[2];
        std::vector<double> whole[2];
        for (int i = 0; i < pictures; ++i) {
            Optics optics = options.optics;
            one.change(i, optics);
            for (const bool keeps : {false, true}) {
                const Clock::time_point start = Clock::now();
                const PreparedScene scene = keeps ? first.withOptics(optics)
                                                  : PreparedScene({volume, optics}, options.splat);
                const double made = secondsSince(start);
                const RenderStats stats = scene.render(camera, image);
                whole[keeps].push_back(1e3 * secondsSince(start));
                prepare[keeps].push_back(1e3 * (made + stats.prepareSeconds));
            }
        }
        std::printf("  %-9s prepared anew %7.2f ms of %7.2f, kept %7.2f of %7.2f\n", one.name,
                    median(prepare[0]), median(whole[0]), median(prepare[1]), median(whole[1]));
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 5) {
        std::fprintf(stderr,
                     "usage: optics_benchmark PICTURES SIZE TRANSFER_FUNCTION.json FILE...\n");
        return 2;
    }
    try {
        for (int i = 4; i < argc; ++i) {
            measureFile(argv[i], argv[3], std::max(1, std::atoi(argv[1])),
                        std::max(1, std::atoi(argv[2])));
        }
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return 0;
}
