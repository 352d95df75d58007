// SPDX-License-Identifier: Apache-2.0
// Twelve pictures around a volume, which is prepared once: many_cameras cloud.vdb turn
#include <chrono>
#include <cstdio>
#include <memory>
#include <string>

#include "deltasplat/error.h"
#include "deltasplat/image/write_image.h"
#include "deltasplat/ingest/read_volume.h"
#include "deltasplat/optics/presets.h"
#include "deltasplat/prepared_scene.h"

using namespace deltasplat;

int main(int argc, char** argv) {
    if (argc != 3) return std::fprintf(stderr, "Usage: many_cameras INPUT NAME\n"), 2;
    try {
        const auto volume = std::make_shared<const Volume>(readVolume(argv[1]));
        // Each slice axis is made ready when a camera first needs it, and kept.
        const PreparedScene scene({volume, defaultOptics(*volume)}, {});
        Image image({512, 512});
        for (int i = 0; i < 12; ++i) {
            const CameraOptions options{.azimuthDegrees = 30.0 * i, .elevationDegrees = 20};
            const auto start = std::chrono::steady_clock::now();
            const RenderStats stats = scene.render(makeCamera(options, *volume), image);
            const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
            std::printf("%3d degrees: %.1f ms, along %c\n", 30 * i, 1e3 * seconds.count(),
                        "xyz"[stats.sliceAxis]);
            compositeOver(image, {0.02F, 0.04F, 0.1F, 1});
            writeImage(std::string(argv[2]) + "." + std::to_string(i) + ".png", image, {});
        }
    } catch (const Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
