// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/render.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "base/progress.h"
#include "camera/camera_options.h"
#include "listener.h"
#include "modules/load_early.h"
#include "options/input_options.h"
#include "output_files.h"
#include "process/run_log.h"
#include "render/aov_options.h"
#include "render/color_options.h"
#include "render/deep_options.h"
#include "render/exr_options.h"
#include "render/make_picture.h"
#include "render/picture_metadata.h"
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
#include "subcommands.h"

namespace deltasplat {
namespace {

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

void warnOfUnusedJoin(const CLI::App& app, const RenderCommand& command, ProgressDisplay& display) {
    if (!isGiven(app, "--join")) return;
    for (const char* option : {"--between", "--resolution", "--sigma", "--deep"}) {
        if (isGiven(app, option))
            return display.warn(std::string("--join: has no effect with ") + option);
    }
    if (!command.picture.render.splat.tolerance.isExact())
        display.warn("--join: has no effect with a tolerance");
}

// Whether holding values within a tolerance takes longer than it saves: where voxels look as their
// values do, however wide footprints are. Who asks for a method has it.
bool toleranceDoesNotPay(const PictureOptions& picture) {
    const RenderOptions& render = picture.render;
    const bool isLit = picture.shading.asked() || picture.scatter.asked() ||
                       picture.medium.asked() || picture.surface.asked;
    return render.mode == Mode::kComposite && render.splat.method == Method::kAuto && !isLit;
}

void warnOfTolerance(const CLI::App& app, const RenderCommand& command, ProgressDisplay& display) {
    if (!toleranceDoesNotPay(command.picture)) return;
    for (const char* option : {"--tolerance", "--tolerance-value"}) {
        if (isGiven(app, option) && app.get_option(option)->as<double>() > 0)
            display.warn(std::string(option) +
                         ": left out by --method auto, for holding values takes longer than it "
                         "saves; --method delta holds them");
    }
}

// @param inputs  all that are read
void warnOfUnusedOptions(const CLI::App& app, const RenderCommand& command, Files inputs,
                         ProgressDisplay& display) {
    const Files mask = filesOfMask(command.picture.parts);
    inputs.insert(inputs.end(), mask.begin(), mask.end());
    warnOfUnusedInputOptions(app, inputs, display.stage(0, 0));
    if (isGiven(app, "--bits") && (isExr(command) || command.image.numbers))
        display.warn("--bits: has no effect on an .exr or a picture of numbers");
    if (isGiven(app, "--dither") && (isExr(command) || command.image.bits == 16))
        display.warn("--dither: has no effect but in pictures of 8 bits");
    warnOfUnusedTone(app, command, display);
    warnOfUnusedDeepOptions(app, command, display);
    warnOfUnusedAovOptions(app, command, display);
    warnOfUnusedExrOptions(app, command, display);
    warnOfUnusedColorOptions(app, command, display);
    warnOfUnusedModeOptions(app, command, display);
    if (command.picture.render.mode != Mode::kComposite) return;
    warnOfTolerance(app, command, display);
    warnOfUnusedJoin(app, command, display);
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

void runSequence(const CLI::App& app, const RenderCommand& command, const Session& session) {
    WorstBound worst;
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
            });
    }
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
    if (toleranceDoesNotPay(command.picture)) command.picture.render.splat.tolerance = {};
}

void runBatch(const CLI::App& app, const RenderCommand& command, const Session& session) {
    WorstBound worst;
    const std::jthread loading = loadEarly(command.output);
    {
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
        renderBatch(command, items, session.commandLine, work, listener);
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
        SequencePart single;
        single.endsProgram = true;
        made = makePicture(app, command, session, single, display.stage(0, 1));
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
    return {&app, [&app, command] { addRenderOptions(app, *command); },
            [&app, command](const Session& session) { runRender(app, *command, session); }};
}

}  // namespace deltasplat
