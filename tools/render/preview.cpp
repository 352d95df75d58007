// SPDX-License-Identifier: Apache-2.0
#include "render/preview.h"

#include <algorithm>
#include <glm/common.hpp>

#include "deltasplat/atomic_file.h"
#include "deltasplat/error.h"
#include "render/preview_file.h"

namespace deltasplat {
namespace {

constexpr int kSmaller = 8;

[[noreturn]] void refuse(const std::string& got, const std::string& expected) {
    throw Error(ErrorCode::kUsage, "--progressive", got, expected);
}

}  // namespace

void addPreviewOption(CLI::App& app, RenderCommand& command) {
    OptionGroup group(app, "Output");
    group.addFlag("--progressive", command.progressive,
                  "Write a small picture first, of an eighth of the pixels each way, to\n"
                  "FILE.preview.EXT, which goes when the picture is there");
}

void checkPreview(const RenderCommand& command) {
    if (!command.progressive) return;
    if (!command.holdoutDepth.empty()) refuse("--holdout-depth besides", "one of them");
    if (AtomicFile(command.output).isDevice())
        refuse(command.output.string() + ", which is no file", "one to write beside");
}

CameraOptions previewCamera(CameraOptions camera) {
    const glm::ivec2 size = camera.sizePixels;
    glm::ivec2 small = glm::max((size + kSmaller / 2) / kSmaller, glm::ivec2(1));
    if (camera.projection == Projection::kLatlong) small.x = 2 * small.y;
    // The frame stays, though no whole number of pixels may have its shape.
    const double shape = double(small.y) / small.x * size.x / size.y;
    if (camera.detectorWorld) {
        camera.detectorWorld->y = camera.detectorWorld->x * small.y / small.x;
    } else if (camera.projection != Projection::kLatlong) {
        camera.pixelAspect =
            std::clamp(camera.pixelAspect * shape, kLeastPixelAspect, kMostPixelAspect);
    }
    camera.sizePixels = small;
    camera.overscanPixels = glm::ivec2(0);
    return camera;
}

RenderCommand previewOf(RenderCommand command) {
    command.image.metadata = {{kPreviewMark, command.output.filename().string()}};
    command.output = previewFile(command.output);
    command.stats.clear();
    command.picture.render.camera = previewCamera(command.picture.render.camera);
    command.region.reset();
    command.overscan = {};
    command.image.exr.autocrop = false;
    command.image.exr.multipart = false;
    command.channels = {};
    command.deep = false;
    command.annotations = {};
    command.progressive = false;
    return command;
}

}  // namespace deltasplat
