// SPDX-License-Identifier: Apache-2.0
// A deep picture, and how thick the fog is in its middle: deep_picture cloud.vdb cloud.exr
#include <cstdio>

#include "deltasplat/error.h"
#include "deltasplat/image/write_deep_image.h"
#include "deltasplat/ingest/read_volume.h"
#include "deltasplat/optics/presets.h"
#include "deltasplat/render_deep.h"

using namespace deltasplat;

int main(int argc, char** argv) {
    if (argc != 3) return std::fprintf(stderr, "Usage: deep_picture INPUT OUTPUT.exr\n"), 2;
    try {
        const Volume volume = readVolume(argv[1]);
        RenderOptions options;
        options.camera = {.projection = Projection::kPerspective, .azimuthDegrees = 30};
        options.optics = defaultOptics(volume);
        DeepImage deep;
        const DeepOptions samples{.slicesPerSample = 4};
        const RenderResult result = renderDeep(volume, options, samples, deep);

        const glm::ivec2 middle = result.camera.sizePixels / 2;
        for (const DeepSample& sample : deep.pixel(middle.x, middle.y)) {
            std::printf("from %8.3f to %8.3f: alpha %.4f\n", sample.z, sample.zBack, sample.rgba.a);
        }
        std::printf("all together: alpha %.4f\n", result.image.pixel(middle.x, middle.y)[3]);

        ImageFileOptions file;
        file.cameraFromWorld = result.camera.cameraFromWorld();
        file.ndcFromWorld = result.camera.ndcFromWorld();
        writeDeepImage(argv[2], deep, file);
    } catch (const Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
