// SPDX-License-Identifier: Apache-2.0
#include "render/picture_parts.h"

#include <algorithm>

#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "deltasplat/atomic_file.h"
#include "deltasplat/image/exr_rows.h"
#include "deltasplat/image/tone.h"
#include "deltasplat/image/write_image.h"
#include "deltasplat/picture.h"
#include "image/exr_header.h"
#include "render/color_options.h"
#include "render/render_modes.h"
#include "render/tone_options.h"

namespace deltasplat {
namespace {

// What a part takes, and from which size on a picture is made in parts.
constexpr double kPartBytes = double(64 << 20);
constexpr double kBytesPerPixel = 16;
// Of the progress, what rendering takes before pixels are shown.
constexpr double kRenderShare = 0.5;

// Calls use(rows, first) with rows of a box from the top on.
template <typename Use>
void forParts(const ShowPart& show, const RenderCommand& command, const PixelBox& box,
              const Use& use) {
    const bool isConverted = !command.color.colorSpace.empty();
    const int most = std::max(1, int(kPartBytes / (kBytesPerPixel * box.size().x)));
    for (int first = box.min.y; first < box.max.y; first += most) {
        const int last = std::min(first + most, box.max.y);
        Image rows({box.size().x, last - first});
        show({{box.min.x, first}, {box.max.x, last}}, rows);
        if (command.picture.background) compositeOver(rows, *command.picture.background);
        if (isConverted) colorsOf(command).convert(rows);
        use(rows, first);
    }
}

// A part has at least a row, which takes memory for all that is made of it as well.
void requireRow(glm::ivec2 size) {
    constexpr double kTimesPixel = 3;
    requireMemory("--size " + dimsText(size), kTimesPixel * kBytesPerPixel * size.x);
}

// What is seen of a part of the picture, at least a pixel.
PixelBox findSeen(const ShowPart& show, const RenderCommand& command, const PixelBox& part) {
    PixelBox all;
    forParts(show, command, part, [&](const Image& rows, int first) {
        PixelBox box = seenBox(rows, {{0, 0}, rows.size}, {});
        if (box.empty()) return;
        const glm::ivec2 place(part.min.x, first);
        box = {box.min + place, box.max + place};
        all = all.empty() ? box
                          : PixelBox{{std::min(all.min.x, box.min.x), all.min.y},
                                     {std::max(all.max.x, box.max.x), box.max.y}};
    });
    return all.empty() ? PixelBox{part.min, part.min + 1} : all;
}

}  // namespace

bool isMadeInParts(const RenderCommand& command, const CameraOptions& camera) {
    const glm::dvec2 size(camera.sizePixels + 2 * camera.overscanPixels);
    const bool isLightAlone = isExr(command) && command.picture.render.mode == Mode::kComposite &&
                              !command.deep && command.holdoutDepth.empty() &&
                              !command.channels.asked() && !command.ground;
    // What is written behind its end cannot be gone back to.
    return isLightAlone && !AtomicFile(command.output).isDevice() &&
           (command.region || kBytesPerPixel * size.x * size.y > kPartBytes);
}

void writeInParts(const RenderCommand& command, glm::ivec2 size, const ShowPart& show, bool isExact,
                  const std::function<ImageFileOptions()>& fileOptions, const Listener& listener) {
    ImageFileOptions file = fileOptions();
    PixelBox box = file.region.value_or(PixelBox{{0, 0}, size});
    // How far pixels may be off stands before them in the file.
    if (file.exr.autocrop || !isExact) {
        const PixelBox found = findSeen(show, command, box);
        if (file.exr.autocrop) box = found;
    }
    file = fileOptions();
    ExrRows rows(command.output, size, box, file);
    std::size_t beyondHalf = 0;
    forParts(show, command, box, [&](const Image& image, int first) {
        if (!file.floatExr) beyondHalf += countBeyondHalf(image);
        rows.write(image);
        listener.report(double(first + image.size.y - box.min.y) / box.size().y);
    });
    rows.finish();
    warnOfHalves(command, beyondHalf, listener);
}

RenderResult renderInParts(const RenderCommand& command, const PreparedScene& scene,
                           const CameraOptions& camera,
                           const std::function<ImageFileOptions(const RenderResult&)>& fileOptions,
                           const Listener& listener) {
    const Volume& seen = *scene.scene().volume;
    RenderResult result;
    result.camera = makeCamera(camera, seen);
    requireRow(result.camera.sizePixels);
    Picture picture(scene, result.camera, partOf(listener, 0, kRenderShare));
    writeInParts(
        command, result.camera.sizePixels,
        [&](const PixelBox& part, Image& image) { picture.show(part, image); },
        picture.stats().tolerance.isExact(),
        [&] {
            result.stats = picture.stats();
            return fileOptions(result);
        },
        partOf(listener, kRenderShare, 1));
    result.stats = picture.stats();
    return result;
}

}  // namespace deltasplat
