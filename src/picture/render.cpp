// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/render.h"

#include <memory>
#include <string>

#include "base/default_floats.h"
#include "base/enum_name.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "deltasplat/optics/presets.h"
#include "picture/rays/ray_render.h"
#include "picture/render_views.h"
#include "screen/clear_image.h"
#include "volume/box_voxels.h"

namespace deltasplat {
namespace {

// The picture itself, and what encoding it takes besides (measured: 41 bytes for a float .exr).
constexpr double kBytesPerPixel = 48;

void requireImageMemory(glm::ivec2 size) {
    requireMemory("`sizePixels` " + dimsText(size), kBytesPerPixel * size.x * size.y);
}

}  // namespace

std::string methodName(Method method) {
    return enumName(method, {"auto", "delta", "sparse", "traditional"});
}

std::string pictureFilterName(PictureFilter filter) {
    return enumName(filter, {"catmull-rom", "mitchell", "gauss", "box"});
}

std::string modeName(Mode mode) {
    return enumName(mode, {"composite", "xray", "mip", "min", "average", "drr"});
}

RenderResult render(const Volume& volume, const RenderOptions& options, const Listener& listener) {
    const DefaultFloats floats;
    RenderResult result;
    const auto makePicture = [&](const Volume& seen) {
        result.camera = makeCamera(options.camera, seen);
        requireImageMemory(result.camera.sizePixels);
        result.image = clearImage(result.camera.sizePixels);
    };
    RenderStats& stats = result.stats;
    stats.voxels = voxelsOf(volume.box);
    stats.mode = options.mode;
    stats.method = options.splat.method;
    if (options.mode == Mode::kComposite) {
        // A camera that cannot be is refused before there is work.
        if (options.optics.parts.empty()) makePicture(volume);
        // The volume outlives the scene.
        const std::shared_ptr<const Volume> borrowed(std::shared_ptr<const Volume>(), &volume);
        const Clock::time_point start = Clock::now();
        const PreparedScene::Impl scene({borrowed, options.optics}, options.splat, true);
        const double sceneSeconds = secondsSince(start);
        if (!options.optics.parts.empty()) makePicture(*scene.scene.volume);
        KeptMemory memory;
        stats = renderImage(scene, result.camera, memory, result.image, listener);
        stats.prepareSeconds += sceneSeconds;
    } else {
        makePicture(volume);
        renderRays(volume, options, listener, result);
    }
    listener.report(1);
    return result;
}

RenderResult render(const Volume& volume, const Listener& listener) {
    RenderOptions options;
    options.optics = defaultOptics(volume);
    options.splat.mostJoined = kMostJoined;
    return render(volume, options, listener);
}

}  // namespace deltasplat
