// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/render_deep.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <string>

#include "default_floats.h"
#include "deltasplat/error.h"
#include "dims_text.h"
#include "image/clear_image.h"
#include "image/deep_builder.h"
#include "kept_memory.h"
#include "memory.h"
#include "number_text.h"
#include "picture_view.h"
#include "prepared_axis.h"
#include "stopwatch.h"
#include "view/affine.h"

namespace deltasplat {
namespace {

// The flat picture, and what it was before.
constexpr double kBytesPerPixel = 32;

void checkSlices(int slices) {
    if (slices >= 1 && slices <= kMostSlicesPerSample) return;
    throw Error(ErrorCode::kUsage,
                gotExpected("`slicesPerSample`", std::to_string(slices),
                            "a whole number within 1.." + std::to_string(kMostSlicesPerSample)));
}

std::string shortText(double number) {
    char text[32];
    return {text,
            std::to_chars(text, text + sizeof text, number, std::chars_format::general, 6).ptr};
}

// From an eye, what lies behind it is not seen. Depths of a parallel picture begin at its camera,
// which may be anywhere.
void requireBefore(const Camera& camera, const Volume& volume) {
    if (camera.projection != Projection::kOrtho || volume.empty()) return;
    double nearest = std::numeric_limits<double>::infinity();
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec4 index(cornerOf(volume.box, corner), 1);
        const glm::dvec3 away = glm::dvec3(volume.worldFromIndex * index) - camera.eyeWorld();
        nearest = std::min(nearest, glm::dot(away, camera.direction));
    }
    // Of a voxel there is half before its middle.
    for (int axis = 0; axis < 3; ++axis) {
        const glm::dvec3 step(volume.worldFromIndex[axis]);
        nearest -= 0.5 * std::abs(glm::dot(step, camera.direction));
    }
    // Six digits of what is enough are enough.
    constexpr double kRounding = 1e-5;
    if (nearest >= -kRounding * std::abs(camera.targetDistanceWorld)) return;
    throw Error(ErrorCode::kUsage,
                gotExpected("`distanceWorld`", numberText(camera.targetDistanceWorld),
                            "at least " + shortText(camera.targetDistanceWorld - nearest) +
                                " for a deep picture, all of whose depths are beyond the camera"));
}

RenderStats renderSamples(const PreparedScene::Impl& scene, const Camera& camera,
                          const DeepOptions& options, DeepImage& deep, Image& flat,
                          const Listener& listener) {
    DeepBuilder builder(camera.sizePixels, options.slicesPerSample);
    const DeepRequest request{options.slicesPerSample, builder};
    KeptMemory memory;
    RenderStats stats = renderComposite(scene, camera, memory, flat, listener, &request);
    const Clock::time_point start = Clock::now();
    memory.endPicture();
    deep = builder.finish();
    const double seconds = secondsSince(start);
    stats.warpSeconds += seconds;
    stats.renderSeconds += seconds;
    return stats;
}

}  // namespace

RenderResult renderDeep(const Volume& volume, const RenderOptions& options,
                        const DeepOptions& deepOptions, DeepImage& deep, const Listener& listener) {
    const DefaultFloats floats;
    checkSlices(deepOptions.slicesPerSample);
    if (options.mode != Mode::kComposite) {
        throw Error(ErrorCode::kUsage,
                    gotExpected("`mode`", modeName(options.mode), "composite for a deep picture"));
    }
    RenderResult result;
    const auto makePicture = [&](const Volume& seen) {
        result.camera = makeCamera(options.camera, seen.box, seen.worldFromIndex, seen.space);
        requireBefore(result.camera, seen);
        const glm::ivec2 size = result.camera.sizePixels;
        requireMemory("`sizePixels` " + dimsText(size), kBytesPerPixel * size.x * size.y);
        result.image = Image(size);
    };
    // A camera that cannot be is refused before there is work.
    if (options.optics.parts.empty()) makePicture(volume);
    // The volume outlives the scene.
    const std::shared_ptr<const Volume> borrowed(std::shared_ptr<const Volume>(), &volume);
    const Clock::time_point start = Clock::now();
    const PreparedScene::Impl scene({borrowed, options.optics}, options, true);
    const double sceneSeconds = secondsSince(start);
    if (!options.optics.parts.empty()) makePicture(*scene.scene.volume);
    result.stats = renderSamples(scene, result.camera, deepOptions, deep, result.image, listener);
    result.stats.prepareSeconds += sceneSeconds;
    listener.report(1);
    return result;
}

RenderStats renderDeep(const PreparedScene& scene, const Camera& camera,
                       const DeepOptions& deepOptions, DeepImage& deep, Image& flat,
                       const Listener& listener) {
    const DefaultFloats floats;
    checkSlices(deepOptions.slicesPerSample);
    requireSize(camera, flat);
    requireBefore(camera, *scene.scene().volume);
    const glm::ivec2 size = camera.sizePixels;
    requireMemory("`sizePixels` " + dimsText(size), 0.5 * kBytesPerPixel * size.x * size.y);
    clearImage(flat);
    return renderSamples(scene.impl(), camera, deepOptions, deep, flat, listener);
}

}  // namespace deltasplat
