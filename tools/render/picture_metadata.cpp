// SPDX-License-Identifier: Apache-2.0
#include "render/picture_metadata.h"

#include <algorithm>
#include <cstdio>

#include "base/text.h"
#include "render/color_options.h"
#include "render/exr_options.h"
#include "render/render_modes.h"
#include "render/render_stats.h"
#include "render/tone_options.h"
#include "version.h"
#include "volume_place.h"

namespace deltasplat {
namespace {

// Makes opaque what has no alpha when it is stored.
void fillForJpeg(const RenderCommand& command, Image& image, const Listener& listener) {
    if (command.isMovieAlone || imageFormatOf(command.output) != ImageFormat::kJpeg) return;
    if (isOpaque(image)) return;
    listener.warn(command.output.string() +
                  ": a .jpg has no alpha, so what is clear is black; --background gives it another "
                  "colour");
    compositeOver(image, glm::vec4(0, 0, 0, 1));
}

// Of a C-arm the detector's pixels, of others those of the plane through the target; the third axis
// goes on along the line of sight.
std::optional<glm::dmat4> worldFromPixel(const CameraOptions& options, const Camera& camera) {
    if (camera.projection == Projection::kLatlong) return {};
    const glm::dvec3 eye = camera.eyeWorld();
    const double scale = options.sourceToDetectorWorld && options.sourceToIsocenterWorld
                             ? *options.sourceToDetectorWorld / *options.sourceToIsocenterWorld
                             : 1;
    const glm::dvec3 first = eye + scale * (camera.worldFromPixel({0.5, 0.5}) - eye);
    const double pixel = scale * camera.pixelWorld();
    return glm::dmat4(glm::dvec4(pixel * camera.right, 0),
                      glm::dvec4(-scale * camera.pixelHeightWorld() * camera.up, 0),
                      glm::dvec4(pixel * camera.direction, 0), glm::dvec4(first, 1));
}

}  // namespace

CodeText codesOf(const Volume& volume) {
    return {volume.codeBook().name(), codeErrorText(volume.codeError())};
}

Metadata commonMetadata(const Session& session) {
    return {{"version", programVersion()}, {"commandLine", session.commandLine}};
}

ImageFileOptions imageOptions(const RenderCommand& command, const Camera& camera,
                              const Session& session) {
    ImageFileOptions options = command.image;
    setExr(command, camera, options);
    options.cameraFromWorld = camera.cameraFromWorld();
    options.ndcFromWorld = camera.ndcFromWorld();
    options.exr.pixelAspect = camera.pixelAspect;
    options.worldFromPixel = worldFromPixel(command.picture.render.camera, camera);
    const Metadata common = commonMetadata(session);
    options.metadata.insert(options.metadata.end(), common.begin(), common.end());
    setColors(command, options);
    return options;
}

ImageFileOptions imageOptions(const RenderCommand& command, const CodeText& codes,
                              const RenderResult& result, const Session& session) {
    ImageFileOptions options = imageOptions(command, result.camera, session);
    options.metadata.insert(options.metadata.end(), {{"input", command.input.string()},
                                                     {"mode", modeName(result.stats.mode)},
                                                     {"camera", cameraOptionsText(result.camera)},
                                                     {"codeBook", codes.book},
                                                     {"codeError", codes.error}});
    const RenderOptions& render = command.picture.render;
    if (result.stats.mode != Mode::kComposite)
        options.metadata.emplace_back("kernel", "trilinear, mean of pixels larger than a voxel");
    if (result.stats.mode == Mode::kDrr) {
        options.metadata.emplace_back("muWater", numberText(render.drr.muWater));
        if (render.drr.photons)
            options.metadata.emplace_back("photons", numberText(*render.drr.photons));
    }
    if (result.stats.mode == Mode::kMip && render.depthShade > 0)
        options.metadata.emplace_back("depthShade", numberText(render.depthShade));
    if (command.channels.has(Aov::kFront))
        options.metadata.emplace_back("depthOpacity", numberText(command.aovOptions.depthOpacity));
    if (command.deep)
        options.metadata.emplace_back("deepSlices",
                                      std::to_string(command.deepOptions.slicesPerSample));
    if (result.stats.mode != Mode::kComposite) return options;
    options.metadata.insert(options.metadata.end(),
                            {{"method", methodName(result.stats.method)},
                             {"tolerance", toleranceText(result.stats.tolerance)},
                             {"errorBound", errorBoundText(result.stats)}});
    return options;
}

void boundOver(const std::optional<glm::vec4>& background, RenderStats& stats) {
    if (!background || stats.tolerance.isExact()) return;
    const glm::dvec4 color(*background);
    stats.errorBoundColor +=
        stats.errorBoundAlpha * color.a * std::max({color.r, color.g, color.b});
    stats.errorBoundAlpha *= 1 - color.a;
}

void showErrorBound(const RenderStats& stats) {
    const std::string line =
        "tolerance " + toleranceText(stats.tolerance) +
        ": error of a pixel at most, scene-linear and premultiplied: " + errorBoundText(stats) +
        "\n";
    std::fputs(line.c_str(), stderr);
}

void finishLight(const RenderCommand& command, Image& image, ImageFileOptions& file,
                 const Listener& listener) {
    if (command.picture.background) compositeOver(image, *command.picture.background);
    fillForJpeg(command, image, listener);
    applyTone(command, image, file, listener);
    convertColors(command, image, file);
    if (isExr(command) && !file.floatExr && !command.deep)
        warnOfHalves(command, countBeyondHalf(image), listener);
}

}  // namespace deltasplat
