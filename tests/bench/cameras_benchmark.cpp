// SPDX-License-Identifier: Apache-2.0
// Renders a volume as cameras that go round it see it, both ways: each picture for itself
// (`render`), and of a scene that is prepared once. Prints milliseconds a picture, medians, and
// page faults a picture.
//   cameras_benchmark CAMERAS SIZE TRANSFER_FUNCTION.json FILE...
#include <sys/resource.h>

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
#include "deltasplat/render.h"

namespace {

using namespace deltasplat;

long pageFaults() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_minflt;
}

void measure(const char* what, int cameras, const std::function<void(int)>& renderOne) {
    std::vector<double> seconds;
    const long faults = pageFaults();
    for (int i = 0; i < cameras; ++i) {
        const Clock::time_point start = Clock::now();
        renderOne(i);
        seconds.push_back(secondsSince(start));
    }
    std::nth_element(seconds.begin(), seconds.begin() + cameras / 2, seconds.end());
    std::printf("  %-10s %8.2f ms a picture, %7ld page faults\n", what,
                1e3 * seconds[std::size_t(cameras / 2)], (pageFaults() - faults) / cameras);
}

void measureFile(const char* file, const char* transferFunction, int cameras, int size) {
    const auto volume = std::make_shared<const Volume>(readVolume(file));
    RenderOptions options;
    options.optics.transferFunction = readTransferFunction(transferFunction);
    options.camera.sizePixels = glm::ivec2(size);
    const auto optionsOf = [&](int i) {
        options.camera.azimuthDegrees = 360.0 * i / cameras;
        options.camera.elevationDegrees = 20;
        return options;
    };
    std::printf("%s\n", file);
    for (int i = 0; i < cameras; ++i) render(*volume, optionsOf(i));  // warms up
    measure("render", cameras, [&](int i) { render(*volume, optionsOf(i)); });

    const PreparedScene scene({volume, options.optics}, options.splat);
    const auto cameraOf = [&](int i) { return makeCamera(optionsOf(i).camera, *volume); };
    Image image(options.camera.sizePixels);
    const Clock::time_point start = Clock::now();
    for (int i = 0; i < cameras; ++i) scene.render(cameraOf(i), image);
    std::printf("  the first round, which prepares: %.2f ms a picture\n",
                1e3 * secondsSince(start) / cameras);
    measure("prepared", cameras, [&](int i) { scene.render(cameraOf(i), image); });
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 5) {
        std::fprintf(stderr,
                     "usage: cameras_benchmark CAMERAS SIZE TRANSFER_FUNCTION.json FILE...\n");
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
