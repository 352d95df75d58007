// SPDX-License-Identifier: Apache-2.0
#include "render/make_picture.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>

#include "annotate/annotate.h"
#include "base/progress.h"
#include "base/text.h"
#include "camera/camera_options.h"
#include "deltasplat/hold_out.h"
#include "deltasplat/image/write_deep_image.h"
#include "deltasplat/render.h"
#include "deltasplat/render_deep.h"
#include "image/quantize.h"
#include "output_files.h"
#include "process/leave_to_system.h"
#include "render/aov_options.h"
#include "render/deep_options.h"
#include "render/ground_options.h"
#include "render/picture_legend.h"
#include "render/picture_metadata.h"
#include "render/picture_parts.h"
#include "render/preview.h"
#include "render/preview_file.h"
#include "render/read_medium.h"
#include "render/render_modes.h"
#include "render/tone_options.h"
#include "render/validate.h"
#include "render/value_window.h"
#include "volume_place.h"

namespace deltasplat {
namespace {

// Of what is left when the scene has been read, what rendering takes before the picture is written.
constexpr double kRenderShare = 0.93;

// Shows values as greys, and says in `image` what black and white stand for.
glm::dvec2 applyWindow(const RenderCommand& command, const Volume& volume, RenderResult& result,
                       ImageFileOptions& image) {
    const RenderOptions& options = command.picture.render;
    readyForGreys(options, volume, result.camera, result.image);
    const std::optional<glm::dvec2> asked = windowAsked(command);
    const glm::dvec2 window =
        asked ? *asked : defaultWindow(options.mode, middleValues(options.mode, result.image));
    showGreys(window, result.image);
    image.metadata.emplace_back("window", numberText(window));
    if (options.mode == Mode::kXray) image.metadata.emplace_back("xrayScale", numberText(window.y));
    return window;
}

// Makes the picture what is stored of it, and says in `image` what that took.
// @param optics  that it was made with
void finishPicture(const RenderCommand& command, const Volume& volume, const Optics& optics,
                   RenderResult& result, ImageFileOptions& image, const Listener& listener) {
    if (storesValues(command)) return;
    std::optional<glm::dvec2> window;
    if (showsWindow(command)) window = applyWindow(command, volume, result, image);
    finishLight(command, result.image, image, listener);
    std::optional<Legend> legend;
    if (optics.surface && command.annotations.legend) {
        listener.warn("--legend: left out, for what is shown is a surface, of one colour");
    } else if (command.annotations.legend) {
        legend = pictureLegend(command, volume, optics, window);
    }
    if (!command.annotations.any()) return;
    if (command.annotations.scaleBar && volume.lengthUnit().empty() && !volume.space().empty())
        listener.warn(
            "--scale-bar: the file names no unit of length; millimetres are meant, as is usual of "
            "a "
            "patient's space");
    const bool isMillimetres = volume.lengthUnit().empty() && !volume.space().empty();
    annotate(
        layOut(command.annotations, result.camera, volume.space(),
               isMillimetres ? "mm" : volume.lengthUnit(), legend, inkFor(result.image), listener),
        result.image);
}

// Cut finely, for what solid things cut is shared by the length that is left of it.
RenderResult renderHeldOut(const std::filesystem::path& depths, const Volume& volume,
                           const RenderOptions& options, const Listener& listener) {
    constexpr DeepOptions kFine{2};
    const DepthImage solid = readDepthImage(depths, listener);
    const glm::ivec2 size = options.camera.sizePixels;
    if (solid.size != size) {
        throw Error(ErrorCode::kInput, depths.string(), dimsText(solid.size) + " pixels",
                    dimsText(size) + ", those of --size");
    }
    DeepImage deep;
    RenderResult result = renderDeep(volume, options, kFine, deep, listener);
    result.image = holdOut(deep, solid);
    return result;
}

// How many pixels have a sample that halves do not hold.
std::size_t countBeyondHalf(const DeepImage& deep) {
    std::size_t pixels = 0;
    for (int y = 0; y < deep.size.y; ++y) {
        for (int x = 0; x < deep.size.x; ++x) {
            const std::span<const DeepSample> samples = deep.pixel(x, y);
            pixels += std::any_of(samples.begin(), samples.end(), [](const DeepSample& sample) {
                const glm::vec4& v = sample.rgba;
                return std::max({std::abs(v.r), std::abs(v.g), std::abs(v.b)}) > kLargestHalf;
            });
        }
    }
    return pixels;
}

// Writes what the picture is asked for as: all of it, or what is seen of it.
void writePicture(const RenderCommand& command, const DeepImage& deep, const Image& flat,
                  const ImageFileOptions& options, const Listener& listener) {
    if (!command.deep) return writeImage(command.output, flat, options);
    if (!options.floatExr) warnOfHalves(command, countBeyondHalf(deep), listener);
    writeDeepImage(command.output, deep, options);
}

RenderResult renderPrepared(const PreparedScene& scene, const RenderOptions& options,
                            const Listener& listener) {
    const Volume& seen = *scene.scene().volume;
    RenderResult result;
    result.camera = makeCamera(options.camera, seen);
    result.image = Image(result.camera.sizePixels);
    result.stats = scene.render(result.camera, result.image, listener);
    return result;
}

// Renders and writes a picture some rows at a time.
RenderResult makeInParts(const RenderCommand& command, const ReadScene& read,
                         const SequencePart& part, const Session& session,
                         const Listener& listener) {
    const Clock::time_point start = Clock::now();
    std::optional<PreparedScene> own;
    if (!part.prepared) own.emplace(Scene{read.volume, read.options.optics}, read.options.splat);
    const double sceneSeconds = own ? secondsSince(start) : 0;
    RenderResult result = renderInParts(
        command, own ? *own : *part.prepared, read.options.camera,
        [&](const RenderResult& known) {
            RenderResult said;
            said.camera = known.camera;
            said.stats = known.stats;
            boundOver(command.picture.background, said.stats);
            return imageOptions(command, codesOf(*read.volume), said, session);
        },
        listener);
    result.stats.prepareSeconds += sceneSeconds;
    boundOver(command.picture.background, result.stats);
    return result;
}

// Renders a scene and writes the picture.
void showScene(const RenderCommand& command, const ReadScene& scene, const SequencePart& part,
               const Session& session, const Listener& listener, MadePicture& made) {
    const PictureOptions& picture = command.picture;
    const RenderOptions& options = scene.options;
    const Volume& volume = *scene.volume;
    RenderResult& result = made.result;
    if (!part.take && isMadeInParts(command, options.camera)) {
        result = makeInParts(command, scene, part, session, listener);
        return;
    }
    const Listener rendering = partOf(listener, 0, kRenderShare);
    DeepImage deep;
    if (command.deep) {
        result = renderDeep(volume, options, command.deepOptions, deep, rendering);
        made.deep = deepStatsOf(deep, command.deepOptions.slicesPerSample);
    } else if (!command.holdoutDepth.empty()) {
        result = renderHeldOut(command.holdoutDepth, volume, options, rendering);
    } else if (part.prepared) {
        result = renderPrepared(*part.prepared, options, rendering);
    } else {
        result = render(volume, options, rendering);
    }
    boundOver(picture.background, result.stats);
    ImageFileOptions image = imageOptions(command, codesOf(volume), result, session);
    image.space = volume.space();
    image.lengthUnit = volume.lengthUnit();
    const Listener writing = partOf(listener, kRenderShare, 1);
    warnOfDepths(command.channels, options.optics, writing);
    AovOptions aovOptions = command.aovOptions;
    aovOptions.picture = &result.image;
    image.channels = withEmptyMattes(
        picture.medium, options.optics,
        renderAovs(volume, options, result.camera, command.channels.aovs, aovOptions));
    addGroundShadow(command, volume, options, result, image, {{}, writing.warning});
    finishPicture(command, volume, options.optics, result, image, writing);
    writing.report(0);
    const auto beginWrite = std::chrono::steady_clock::now();
    if (part.take) part.take(result.image);
    if (part.isWritten) writePicture(command, deep, result.image, image, writing);
    made.times.write = secondsSince(beginWrite);
}

// A small picture that is there until the one it goes before is, or has failed.
class Preview {
  public:
    Preview(const RenderCommand& command, const ReadScene& scene, const PreparedScene* prepared,
            const Session& session, const Listener& listener)
        : file_(previewFile(command.output)) {
        ReadScene small = scene;
        small.options.camera = previewCamera(small.options.camera);
        SequencePart part;
        part.prepared = prepared;
        MadePicture made;
        // What there is to warn of is said of the picture.
        Listener silent = partOf(listener, 0, 0);
        silent.warning = {};
        showScene(previewOf(command), small, part, session, silent, made);
        file_.noteWritten();
    }

  private:
    PreviewFile file_;
};

}  // namespace

ReadScene sceneOf(const RenderCommand& command, const SequencePart& part,
                  const Listener& listener) {
    if (part.prepared) {
        const Scene& scene = part.prepared->scene();
        ReadScene read{command.picture.render, scene.volume};
        read.options.optics = scene.optics;
        return read;
    }
    ReadScene read = readScene(command.input, command.picture, listener, part.look);
    if (command.picture.surface.color && !read.options.optics.surface)
        listener.warn("--surface-color: has no effect without a surface");
    return read;
}

MadePicture makePicture(const CLI::App& app, const RenderCommand& command, const Session& session,
                        const SequencePart& part, const Listener& listener) {
    const PictureOptions& picture = command.picture;
    MadePicture made;
    const auto beginRead = std::chrono::steady_clock::now();
    // Everything from here on is reading; what can be refused without it has been.
    const Listener reading = partOf(listener, 0, kReadShare);
    const ReadScene scene = sceneOf(command, part, reading);
    const RenderOptions& options = scene.options;
    const Volume& volume = *scene.volume;
    if (!part.look) warnOfUnusedView(app, options.camera, volume, reading);
    warnOfDetector(options.camera, volume, reading);
    warnOfClipping(picture, part.frame, volume, reading);
    made.times.read = secondsSince(beginRead);
    made.codeBook = "code book " + volume.codeBook().name() + ", largest error " +
                    codeErrorText(volume.codeError()) + "\n";
    made.facts = {volume.name(), volume.box().dims(),
                  glm::dvec2(volume.valueMin(), volume.valueMax()), volume.empty()};

    const Listener showing = partOf(listener, kReadShare, 1);
    std::optional<Preview> preview;
    if (command.progressive) {
        const Clock::time_point start = Clock::now();
        preview.emplace(command, scene, part.prepared, session, showing);
        made.times.preview = secondsSince(start);
    }
    showScene(command, scene, part, session, showing, made);
    if (part.endsProgram) leaveToSystem(std::make_shared<const ReadScene>(scene));
    made.times.total = secondsSince(session.begin);
    writeStats(command.stats, statsJson(made.result, volume, made.times, made.deep));
    listener.report(1);
    return made;
}

void makeBlack(const RenderCommand& command, const Session& session, const SequencePart& part) {
    Image image = blackPicture(command);
    const Volume& seen = part.look->sequence.seen();
    const Camera camera = makeCamera(command.picture.render.camera, seen);
    if (!command.annotations.lines.empty()) {
        AnnotationChoice lines;
        lines.lines = command.annotations.lines;
        annotate(layOut(lines, camera, "", "", std::nullopt, inkFor(image)), image);
    }
    if (part.take) part.take(image);
    if (!part.isWritten) return;
    writeImage(command.output, image, imageOptions(command, camera, session));
}

}  // namespace deltasplat
