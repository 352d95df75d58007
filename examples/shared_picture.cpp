// SPDX-License-Identifier: Apache-2.0
// One picture by several processes, on whatever machines, with the bits that one of them gives it:
//   shared_picture part cloud.vdb 1 2 a.slabs
//   shared_picture part cloud.vdb 2 2 b.slabs
//   shared_picture fold cloud.exr a.slabs b.slabs
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "deltasplat/error.h"
#include "deltasplat/image/write_image.h"
#include "deltasplat/ingest/read_volume.h"
#include "deltasplat/optics/presets.h"
#include "deltasplat/slabs.h"

using namespace deltasplat;

namespace {

void writePart(const char* input, int part, int parts, const char* output) {
    const auto volume = std::make_shared<const Volume>(readVolume(input));
    const PreparedScene scene({volume, defaultOptics(*volume)}, {});
    const CameraOptions camera{.azimuthDegrees = 40, .elevationDegrees = 20};
    const SlabPicture picture(scene, makeCamera(camera, *volume));
    writeSlabs(picture, {.first = part, .last = part, .count = parts}, {}, output);
}

void fold(const char* output, const std::vector<std::filesystem::path>& parts) {
    Picture picture = SlabFiles(parts).fold();
    const glm::ivec2 size = picture.camera().sizePixels;
    Image image(size);
    picture.show({{0, 0}, size}, image);
    writeImage(output, image, {});
}

}  // namespace

int main(int argc, char** argv) {
    const std::string what = argc > 1 ? argv[1] : "";
    try {
        if (what == "part" && argc == 6) {
            writePart(argv[2], std::atoi(argv[3]), std::atoi(argv[4]), argv[5]);
        } else if (what == "fold" && argc > 3) {
            fold(argv[2], {argv + 3, argv + argc});
        } else {
            return std::fprintf(stderr, "Usage: see the first lines of this file\n"), 2;
        }
    } catch (const Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
