// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/render.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "annotate/annotate.h"
#include "camera/camera_options.h"
#include "deltasplat/hold_out.h"
#include "deltasplat/image/write_deep_image.h"
#include "deltasplat/render_deep.h"
#include "dims_text.h"
#include "listener.h"
#include "listener_part.h"
#include "modules/load_early.h"
#include "number_text.h"
#include "options/input_options.h"
#include "output_files.h"
#include "process/interrupt.h"
#include "process/run_log.h"
#include "render/aov_options.h"
#include "render/color_options.h"
#include "render/deep_options.h"
#include "render/exr_options.h"
#include "render/ground_options.h"
#include "render/picture_legend.h"
#include "render/picture_metadata.h"
#include "render/picture_parts.h"
#include "render/preview.h"
#include "render/preview_file.h"
#include "render/read_medium.h"
#include "render/render_batch.h"
#include "render/render_input.h"
#include "render/render_modes.h"
#include "render/render_options.h"
#include "render/render_sequence.h"
#include "render/render_stats.h"
#include "render/scene_input.h"
#include "render/slab_options.h"
#include "render/tone_options.h"
#include "render/validate.h"
#include "render/value_window.h"
#include "stopwatch.h"
#include "subcommands.h"
#include "volume_place.h"

namespace deltasplat {
namespace {

// Shares of the progress that reading and rendering take, measured on the engine data set.
constexpr double kReadShare = 0.3;
// Of what is left then, what rendering takes before the picture is written.
constexpr double kRenderShare = 0.93;

// Light in fog has lights as well.
void warnOfUnusedLight(const CLI::App& app, const PictureOptions& picture,
                       ProgressDisplay& display) {
    const bool isUnlit = !picture.shading.shades.value_or(true);
    if ((!isUnlit && !picture.medium.asked()) || picture.scatter.asked()) return;
    for (const char* option : {"--light", "--ambient", "--diffuse", "--specular", "--shininess"}) {
        if (isGiven(app, option))
            display.warn(std::string(option) + ": has no effect " +
                         (isUnlit ? "with --no-shade"
                                  : "on a medium of several grids without --lighting scatter"));
    }
}

// @param inputs  all that are read
void warnOfUnusedOptions(const CLI::App& app, const RenderCommand& command, Files inputs,
                         ProgressDisplay& display) {
    const Files mask = filesOfMask(command.picture.parts);
    inputs.insert(inputs.end(), mask.begin(), mask.end());
    warnOfUnusedInputOptions(app, inputs, display.stage(0, 0));
    if (isGiven(app, "--bits") && isExr(command)) display.warn("--bits: has no effect on an .exr");
    if (isGiven(app, "--dither") && (isExr(command) || command.image.bits == 16))
        display.warn("--dither: has no effect but in pictures of 8 bits");
    warnOfUnusedTone(app, command, display);
    warnOfUnusedDeepOptions(app, command, display);
    warnOfUnusedAovOptions(app, command, display);
    warnOfUnusedExrOptions(app, command, display);
    warnOfUnusedColorOptions(app, command, display);
    warnOfUnusedModeOptions(app, command, display);
    if (command.picture.render.mode != Mode::kComposite) return;
    warnOfUnusedScatterOptions(app, command.picture.scatter, command.picture.shading,
                               command.picture.medium.emissionLights.has_value(), display);
    warnOfUnusedLight(app, command.picture, display);
    warnOfUnusedMediumOptions(app, command.picture.medium, display);
    if (!command.picture.surface.asked) return;
    std::vector<std::string> unused = {"--extinction", "--unit-distance", "--density-scale"};
    const bool isColored = !command.picture.transferFunction.empty();
    if (!isColored || command.picture.surface.color) unused.push_back("--range");
    for (const std::string& option : unused)
        if (isGiven(app, option)) display.warn(option + ": has no effect on a surface");
}

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
    annotate(layOut(command.annotations, result.camera, volume.space, legend, inkFor(result.image),
                    listener),
             result.image);
}

// Cut finely, for what solid things cut is shared by the length that is left of it.
RenderResult renderHeldOut(const std::filesystem::path& depths, const Volume& volume,
                           const RenderOptions& options, const Listener& listener) {
    constexpr DeepOptions kFine{2};
    const DepthImage solid = readDepthImage(depths, listener);
    const glm::ivec2 size = options.camera.sizePixels;
    if (solid.size != size) {
        throw Error(ErrorCode::kInput,
                    gotExpected(depths.string(), dimsText(solid.size) + " pixels",
                                dimsText(size) + ", those of --size"));
    }
    DeepImage deep;
    RenderResult result = renderDeep(volume, options, kFine, deep, listener);
    result.image = holdOut(deep, solid);
    return result;
}

// Writes what the picture is asked for as: all of it, or what is seen of it.
void writePicture(const RenderCommand& command, const DeepImage& deep, const Image& flat,
                  const ImageFileOptions& options) {
    if (command.deep) return writeDeepImage(command.output, deep, options);
    writeImage(command.output, flat, options);
}

// Reads the scene, unless it is there already.
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

RenderResult renderPrepared(const PreparedScene& scene, const RenderOptions& options,
                            const Listener& listener) {
    const Volume& seen = *scene.scene().volume;
    RenderResult result;
    result.camera = makeCamera(options.camera, seen.box, seen.worldFromIndex, seen.space);
    result.image = Image(result.camera.sizePixels);
    result.stats = renderComposite(scene, result.camera, result.image, listener);
    return result;
}

// A picture and what there is to say of it.
struct MadePicture {
    RenderResult result;
    RenderTimes times;
    DeepStats deep;
    std::string codeBook;
    PictureFacts facts;
};

// Renders and writes a picture some rows at a time.
RenderResult makeInParts(const RenderCommand& command, const ReadScene& read,
                         const SequencePart& part, const Session& session,
                         const Listener& listener) {
    const Clock::time_point start = Clock::now();
    std::optional<PreparedScene> own;
    if (!part.prepared) own.emplace(Scene{read.volume, read.options.optics}, read.options);
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
    } else if (part.behind) {
        result = part.behind->render(volume, options, rendering);
    } else {
        result = render(volume, options, rendering);
    }
    boundOver(picture.background, result.stats);
    ImageFileOptions image = imageOptions(command, codesOf(volume), result, session);
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
    if (part.isWritten) writePicture(command, deep, result.image, image);
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

// Reads, renders and writes one picture.
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
    made.codeBook = "code book " + volume.codeBook.name() + ", largest error " +
                    codeErrorText(volume.codeError) + "\n";
    made.facts = {volume.name, volume.box.dims(), glm::dvec2(volume.valueMin, volume.valueMax),
                  volume.empty()};

    const Listener showing = partOf(listener, kReadShare, 1);
    std::optional<Preview> preview;
    if (command.progressive) {
        const Clock::time_point start = Clock::now();
        preview.emplace(command, scene, part.prepared, session, showing);
        made.times.preview = secondsSince(start);
    }
    showScene(command, scene, part, session, showing, made);
    made.times.total = secondsSince(session.begin);
    writeStats(command.stats, statsJson(made.result, volume, made.times, made.deep));
    listener.report(1);
    return made;
}

// Writes what stands for a frame that there is none of.
void makeBlack(const RenderCommand& command, const Session& session, const SequencePart& part) {
    Image image = blackPicture(command);
    const Volume& seen = part.look->sequence.seen();
    const Camera camera =
        makeCamera(command.picture.render.camera, seen.box, seen.worldFromIndex, seen.space);
    if (!command.annotations.lines.empty()) {
        AnnotationChoice lines;
        lines.lines = command.annotations.lines;
        annotate(layOut(lines, camera, "", std::nullopt, inkFor(image)), image);
    }
    if (part.take) part.take(image);
    if (!part.isWritten) return;
    writeImage(command.output, image, imageOptions(command, camera, session));
}

// Of several pictures, the largest bound is said.
class WorstBound {
  public:
    void add(const RenderStats& stats) {
        const std::lock_guard lock(mutex_);
        if (!stats.tolerance.isExact() && !(stats.errorBoundColor <= worst_.errorBoundColor))
            worst_ = stats;
    }
    void show(const Session& session) const {
        if (!worst_.tolerance.isExact() && !session.common.quiet) showErrorBound(worst_);
    }

  private:
    std::mutex mutex_;
    RenderStats worst_;
};

// How much frames differ from the ones before.
class ChangedShares {
  public:
    // Of a frame that was rendered behind another, or first.
    void add(int frame, const RenderStats& stats) {
        {
            const std::lock_guard lock(mutex_);
            ++frames_;
        }
        if (!stats.changed) return;
        logLine(LogLevel::kInfo, "frame " + std::to_string(frame) + ": " + percent(*stats.changed) +
                                     " of what it shows differs from the frame before");
        const std::lock_guard lock(mutex_);
        shares_.push_back(*stats.changed);
    }
    void show(const Session& session) {
        if (frames_ < 2 || !session.common.verbose) return;
        std::string text = "not known, for no two frames can be compared";
        std::sort(shares_.begin(), shares_.end());
        if (!shares_.empty()) {
            text = percent(shares_[shares_.size() / 2]) + " of what a frame shows (median of " +
                   std::to_string(shares_.size()) + "), " + percent(shares_.front()) + " to " +
                   percent(shares_.back());
        }
        std::fputs(("differs from the frame before: " + text + "\n").c_str(), stderr);
    }

  private:
    static std::string percent(double share) {
        char text[32];
        std::snprintf(text, sizeof text, "%.3g %%", 100 * share);
        return text;
    }

    std::mutex mutex_;
    std::size_t frames_ = 0;
    std::vector<double> shares_;
};

void runSequence(const CLI::App& app, const RenderCommand& command, const Session& session) {
    WorstBound worst;
    ChangedShares changed;
    if (!command.output.empty()) validateOptions(command);
    {
        ProgressDisplay display(session.common);
        warnOfUnusedOptions(app, command, {command.input}, display);
        SequenceSinks sinks(command, commonMetadata(session));
        renderSequence(
            command, sinks, display.stage(0, 1),
            [&](const RenderCommand& frame, const SequencePart& part, const Listener& listener) {
                validate(frame);
                if (frame.input.empty()) return makeBlack(frame, session, part);
                const RenderStats stats =
                    makePicture(app, frame, session, part, listener).result.stats;
                worst.add(stats);
                if (part.behind) changed.add(*part.frame, stats);
            });
    }
    changed.show(session);
    worst.show(session);
}

// Writes what others fold into a picture.
void runSlabs(const CLI::App& app, const RenderCommand& command, const Session& session) {
    ProgressDisplay display(session.common);
    warnOfUnusedOptions(app, command, {command.input}, display);
    const Listener all = display.stage(0, 1);
    const Listener reading = partOf(all, 0, kReadShare);
    const ReadScene scene = sceneOf(command, {}, reading);
    warnOfUnusedView(app, scene.options.camera, *scene.volume, reading);
    warnOfClipping(command.picture, SequencePart().frame, *scene.volume, reading);
    writeSlabs(app, command, scene, session, partOf(all, kReadShare, 1));
}

// Puts together what options say, before anything but cameras is read; of a scene the volume is
// known.
// @param pictures  of a batch, else 0
void prepare(const CLI::App& app, RenderCommand& command, std::size_t pictures,
             const Listener& listener) {
    applyMode(app, command);
    applyProjection(app, command.picture.render.camera);
    applyCamera(app, command.frames, command.picture, listener);
    applyOverscan(command);
    applySinks(app, command, pictures);
    applySlabs(app, command);
    applyLayers(app, command.picture);
    applySurface(app, command.picture.render.mode, isFog(command.picture), command.picture.surface,
                 command.picture.read);
}

void runBatch(const CLI::App& app, const RenderCommand& command, const Session& session) {
    WorstBound worst;
    std::vector<BatchFailure> failures;
    const std::jthread loading = loadEarly(command.output);
    const auto run = [&] {
        ProgressDisplay display(session.common);
        const Listener listener = display.stage(0, 1);
        const std::vector<BatchItem> items = findBatch(command, listener);
        std::optional<SequenceSinks> sinks;
        BatchWork work;
        work.open = [&](RenderCommand& one, const Listener& part) {
            applyScene(app, one.frames.frames, one, part);
        };
        work.prepare = [&](RenderCommand& one, const Listener& part) {
            prepare(app, one, items.size(), part);
            validate(one);
        };
        work.begin = [&](const RenderCommand& first) {
            Files inputs;
            for (const BatchItem& item : items) inputs.push_back(item.input);
            warnOfUnusedOptions(app, first, inputs, display);
            if (first.contactSheet) sinks.emplace(first, commonMetadata(session));
        };
        work.make = [&](const RenderCommand& one, std::size_t i, const Listener& part) {
            Session own = session;
            own.begin = Clock::now();
            SequencePart sequence;
            sequence.isWritten = !one.contactSheet;
            if (sinks) sequence.take = [&](const Image& image) { sinks->put(i, image); };
            const MadePicture made = makePicture(app, one, own, sequence, part);
            worst.add(made.result.stats);
            return made.facts;
        };
        work.end = [&] {
            if (sinks) sinks->finish();
        };
        renderBatch(command, items, session.commandLine, work, listener, failures);
    };
    try {
        run();
    } catch (const Error&) {
        showFailures(failures);
        throw;
    }
    worst.show(session);
}

void runRender(const CLI::App& app, RenderCommand command, const Session& session) {
    if (isBatch(app, command)) return runBatch(app, command, session);
    applySequence(app, command);
    {
        ProgressDisplay display(session.common);
        applyScene(app, command.frames.frames, command, display.stage(0, 0));
        prepare(app, command, 0, display.stage(0, 0));
    }
    const std::jthread loading = loadEarly(command.output);
    if (command.frames.asked()) return runSequence(app, command, session);
    validate(command);
    if (command.slabs) return runSlabs(app, command, session);
    MadePicture made;
    {
        ProgressDisplay display(session.common);
        warnOfUnusedOptions(app, command, {command.input}, display);
        made = makePicture(app, command, session, {}, display.stage(0, 1));
    }
    const RenderStats& stats = made.result.stats;
    if (!stats.tolerance.isExact() && !session.common.quiet) showErrorBound(stats);
    if (session.common.verbose)
        std::fputs((made.codeBook + statsSummary(made.result, made.times, made.deep)).c_str(),
                   stderr);
}

}  // namespace

Subcommand addRender(CLI::App& program) {
    const auto command = std::make_shared<RenderCommand>();
    CLI::App& app = addSubcommand(
        program, "render", "Renders one picture of a volume.",
        {"deltasplat render smoke.vdb -o smoke.png --view iso --size 1024x1024 "
         "--background 0,0,0",
         "deltasplat render engine_256x256x128_uint8.raw.gz -o engine.exr --tf examples/ct.json "
         "--direction=-1,0.8,-0.6 --up 0,0,1",
         "deltasplat render 'shots/**/*.vdb' -o 'thumbs/{dir}/{name}.png' --index "
         "thumbs/index.html"});
    addRenderOptions(app, *command);
    return {&app, [&app, command](const Session& session) { runRender(app, *command, session); }};
}

}  // namespace deltasplat
