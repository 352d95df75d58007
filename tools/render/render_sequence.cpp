// SPDX-License-Identifier: Apache-2.0
#include "render/render_sequence.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/memory.h"
#include "base/progress.h"
#include "camera/camera_options.h"
#include "deltasplat/error.h"
#include "deltasplat/threads.h"
#include "formats/input_files.h"
#include "options/file_and_name.h"
#include "options/transfer_function_option.h"
#include "output_files.h"
#include "process/interrupt.h"
#include "render/first_pass.h"
#include "render/render_input.h"
#include "render/render_modes.h"
#include "render/scene_input.h"
#include "render/sequence_window.h"
#include "sequence/frame_name.h"
#include "sequence/frames_to_make.h"
#include "sequence/run_frames.h"

namespace deltasplat {
namespace {

// Of the memory there is, what volumes of the survey may take that are kept, and what pictures that
// are made at the same time may.
constexpr double kKeptShare = 0.3;
constexpr double kWorkShare = 0.5;
// What rendering takes of a volume's memory, itself included, and of a pixel.
constexpr double kTimesVolume = 4;
constexpr double kBytesPerPixel = 200;

// How far a turntable has turned, in degrees: whatever frames a command line has, a frame is the
// same.
double turnOf(int frame, std::optional<int> turntable) {
    return turntable ? 360 * (double(frame - 1) / *turntable) : 0;
}

// Whether the transfer function's name has a place for a frame's number, and names no file, nor one
// in a file.
bool hasFunctions(const RenderCommand& command) {
    const std::filesystem::path& given = command.picture.transferFunction;
    return FrameName::find(given) && !findFileAndName("--tf", given);
}

// The transfer function of a frame of those that have their own. In `FILE:NAME` the place is the
// file's, if there is one: a name may have a # as well.
std::filesystem::path functionOf(const RenderCommand& command, int frame) {
    const std::string text = command.picture.transferFunction.string();
    for (std::size_t colon = text.rfind(':'); colon != std::string::npos && colon > 0;
         colon = text.rfind(':', colon - 1)) {
        const std::optional<FrameName> file = FrameName::find(text.substr(0, colon));
        if (file && hasInput(file->at(frame))) return file->at(frame).string() + text.substr(colon);
    }
    return FrameName::find(std::filesystem::path(text))->at(frame);
}

// Whether a frame has a transfer function that can be read, as far as that is its own.
bool hasFunction(const RenderCommand& command, int frame) {
    if (!hasFunctions(command)) return true;
    try {
        readTransferFunctionOption(functionOf(command, frame), {});
        return true;
    } catch (const Error&) {
        return false;
    }
}

// Puts what a frame reads into `command`.
void showAll(const FrameFiles& files, RenderCommand& command) {
    if (hasFunctions(command)) command.picture.transferFunction = functionOf(command, files.frame);
    showFrame(files.frame, files.input, command);
}

// The command that makes one frame.
// @param stats  empty: none are written
RenderCommand commandOf(const RenderCommand& command, const FrameFiles& files,
                        const std::optional<FrameName>& stats) {
    RenderCommand frame = command;
    const std::optional<FrameName> camera = cameraFiles(command.picture);
    if (camera) frame.picture.camera.file = camera->at(files.frame);
    // One without a file is black.
    frame.input.clear();
    if (!files.input.empty()) showAll(files, frame);
    frame.output = files.output;
    if (stats) frame.stats = stats->at(files.frame);
    if (cameraMoves(command.picture))
        frame.picture.render.camera = cameraAt(command.picture, files.frame);
    else
        frame.picture.render.camera.azimuthDegrees += turnOf(files.frame, command.turntable);
    if (command.slate) {
        frame.annotations.lines.insert(frame.annotations.lines.begin(),
                                       "frame " + std::to_string(files.frame));
    }
    return frame;
}

class Survey {
  public:
    // @param isAlone  whether no frame is shown afterwards
    Survey(const RenderCommand& command, const std::vector<FrameFiles>& frames, bool isAlone)
        : command_(command), frames_(frames), isAlone_(isAlone) {}

    // Reads all frames and notes what is in them. What is wrong with one is said when it is shown,
    // or here if it is not.
    void run(SequenceLook& look, const Listener& listener) {
        const std::vector<FrameFiles> files = filesToRead();
        if (files.empty()) refuseWithoutInputs(command_.input);
        tellsFailures_ = isAlone_ && files.size() > 1;
        std::optional<Error> failed;
        try {
            runFrames(
                files, command_.frames.keepGoing, threadCount(),
                [&](std::size_t i, const Listener& part) { add(i, files[i], look, part); },
                listener);
        } catch (const Error& error) {
            if (!command_.frames.keepGoing || error.code() == ErrorCode::kInterrupted) throw;
            failed = error;
        }
        if (!anyIsRead_) throw failed ? *failed : *failure_;
        look.finish();
        failed_ = failed;
    }

    // Returns the frames that were read, in order.
    std::vector<int> framesRead() const {
        std::vector<int> frames;
        for (const FrameFiles& one : frames_)
            if (!one.input.empty() && !unread_.contains(one.input)) frames.push_back(one.frame);
        return frames;
    }

    // What ends the command when what there is has been written.
    void throwFailure() const {
        if (failed_) throw *failed_;
    }

  private:
    // Of frames without a file none are tried that are told of when they are shown, for there may
    // be millions; but if there is none at all, the first says why.
    std::vector<FrameFiles> filesToRead() {
        std::vector<FrameFiles> files;
        std::set<std::filesystem::path> known;
        const FrameFiles* absent = nullptr;
        for (const FrameFiles& one : frames_) {
            // A scene may show one file in several places.
            if (one.input.empty() || (known.contains(one.input) && !command_.scene.moves()))
                continue;
            if (!hasFunction(command_, one.frame)) {
                if (!known.contains(one.input)) unread_.insert(one.input);
                if (!absent) absent = &one;
                continue;
            }
            known.insert(one.input);
            unread_.erase(one.input);
            if (isAlone_ || hasInput(one.input)) {
                files.push_back(one);
                continue;
            }
            unread_.insert(one.input);
            if (!absent) absent = &one;
        }
        if (files.empty() && absent) files.push_back(*absent);
        return files;
    }

    void add(std::size_t i, const FrameFiles& files, SequenceLook& look, const Listener& part) {
        // What there is to warn of is said when a frame is shown, if it is.
        Listener silent;
        silent.progress = part.progress;
        if (isAlone_) silent.warning = part.warning;
        const FrameLook frame{look, i};
        try {
            RenderCommand command = command_;
            showAll(files, command);
            readScene(command.input, command.picture, silent, &frame);
            anyIsRead_ = true;
        } catch (const Error& error) {
            const std::lock_guard lock(mutex_);
            unread_.insert(files.input);
            if (error.code() == ErrorCode::kInterrupted || tellsFailures_) throw;
            if (!failure_ || i < failedFrame_) {
                failure_ = error;
                failedFrame_ = i;
            }
        }
    }

    const RenderCommand& command_;
    const std::vector<FrameFiles>& frames_;
    const bool isAlone_;
    bool tellsFailures_ = false;
    std::optional<Error> failed_;  // frames, which have been told of
    std::mutex mutex_;
    std::set<std::filesystem::path> unread_;
    std::atomic<bool> anyIsRead_{false};
    std::optional<Error> failure_;
    std::size_t failedFrame_ = 0;
};

// Whether all frames show the same, which then is made ready once.
bool seesOneThing(const RenderCommand& command) {
    // Other grids of a medium would be read for each transfer function.
    const bool isOneMedium = !hasFunctions(command) || !isFog(command.picture);
    return !FrameName::findInput(command.input) && !command.scene.moves() && isOneMedium &&
           command.picture.render.mode == Mode::kComposite && !command.deep &&
           command.holdoutDepth.empty() && command.channels.aovs.empty();
}

// @param command  of the first frame
PreparedScene prepareOnce(const RenderCommand& command, SequenceLook& look,
                          const Listener& listener) {
    Listener warnings;
    warnings.warning = listener.warning;
    const FrameLook frame{look, 0};
    const ReadScene scene = readScene(command.input, command.picture, warnings, &frame);
    return PreparedScene({scene.volume, scene.options.optics}, scene.options.splat);
}

// Returns the scene as another frame's transfer function shows it.
// @param scene    of the first frame
PreparedScene seenBy(const RenderCommand& command, const PreparedScene& scene,
                     const FrameLook& frame, const Listener& listener) {
    return scene.withOptics(
        opticsFor(*scene.scene().volume, command.input, command.picture, listener, frame).optics);
}

// Makes a camera, as far as it is not said where it is, hold all of a turn.
void fixCamera(const Volume& seen, std::optional<int> turntable, CameraOptions& choice) {
    CameraOptions turned = choice;
    double width = 0;
    double distance = 0;
    for (int frame = 0; frame < turntable.value_or(1); ++frame) {
        turned.azimuthDegrees = choice.azimuthDegrees + turnOf(frame + 1, turntable);
        const Camera camera = makeCamera(turned, seen).withoutOverscan();
        width = std::max(width, camera.frameWidthWorld);
        distance = std::max(distance, camera.targetDistanceWorld);
        if (!choice.targetWorld && !choice.worldFromCamera) choice.targetWorld = camera.targetWorld;
    }
    const bool isPlaced = choice.eyeWorld || choice.sourceToDetectorWorld || choice.worldFromCamera;
    if (choice.projection == Projection::kOrtho && !choice.frameWidthWorld)
        choice.frameWidthWorld = width;
    // From there on depths are counted as well.
    const bool hasDistance =
        choice.projection == Projection::kPerspective
            ? !isPlaced
            : choice.projection == Projection::kOrtho && !choice.worldFromCamera;
    if (hasDistance && !choice.distanceWorld) choice.distanceWorld = distance;
}

// Puts what all frames have into what they are rendered by.
RenderCommand fixedTo(const SequenceLook& look, RenderCommand command) {
    RenderOptions& options = command.picture.render;
    if (!options.optics.unitDistance && look.smallestVoxelWorld() > 0)
        options.optics.unitDistance = look.smallestVoxelWorld();
    fixCamera(look.seen(), command.turntable, options.camera);
    const bool cameraTurns =
        command.turntable || cameraMoves(command.picture) || cameraFiles(command.picture);
    const bool showOne = !FrameName::findInput(command.input) && !command.scene.moves();
    if (cameraTurns || showOne) command.picture.join = joinOfMany(command.picture);
    return command;
}

void finishAfterFailure(SequenceSinks& sinks) {
    try {
        sinks.finish();
    } catch (const Error& error) {
        showError(error.what());
    }
}

// Whether nothing but --first-pass is to be made.
bool isLookAlone(const RenderCommand& command) {
    return command.output.empty();
}

// What frames still take from themselves alone.
void warnOfOwnRanges(const RenderCommand& command, const Listener& listener) {
    if (!FrameName::findInput(command.input) && !command.scene.moves()) return;
    const RenderOptions& render = command.picture.render;
    const std::string may = ", so that what stands still may change from frame to frame";
    if (render.mode == Mode::kComposite && render.optics.colorBy != ColorBy::kValue)
        listener.warn("--color-by " + colorByName(render.optics.colorBy) +
                      ": colours span each frame's own voxels" + may);
    if (render.mode == Mode::kMip && render.depthShade > 0)
        listener.warn("--depth-shade: spans each frame's own voxels" + may);
}

// The files of all frames; if pictures go elsewhere, all have the same output.
std::vector<FrameFiles> filesFor(const RenderCommand& command, bool areWritten,
                                 const Listener& listener) {
    const bool mayStand = command.turntable.has_value() || cameraMoves(command.picture) ||
                          command.scene.moves() || hasFunctions(command);
    if (areWritten)
        return filesOfFrames(command.frames, command.input, mayStand, "--output", command.output,
                             listener);
    std::vector<FrameFiles> files;
    if (mayStand && !FrameName::findInput(command.input)) {
        for (const int frame : command.frames.frames)
            files.push_back({frame, command.input, command.output});
        return files;
    }
    files = inputsOfFrames(command.frames, "INPUT", command.input, listener);
    for (FrameFiles& one : files) one.output = command.output;
    return files;
}

// How many pictures there is memory for.
double picturesThatFit(const RenderCommand& command, const SequenceLook& look) {
    const glm::dvec2 pixels(command.picture.render.camera.sizePixels);
    const double bytes = kTimesVolume * look.largestBytes() + kBytesPerPixel * pixels.x * pixels.y;
    return kWorkShare * double(availableMemory()) / bytes;
}

// How many pictures may be made at once.
int workersFor(const RenderCommand& command, const SequenceLook& look) {
    return std::max(1, int(std::min(double(threadCount()), picturesThatFit(command, look))));
}

// Whether greys are chosen by what is in the pictures.
bool choosesWindow(const RenderCommand& command) {
    return showsWindow(command) && !windowAsked(command);
}

// Share of the progress that looking at all frames takes before any is made.
double surveyShare(const RenderCommand& command, bool isKnown, std::size_t frames) {
    if (isKnown && !choosesWindow(command)) return 0;
    const bool readsOne = !FrameName::findInput(command.input) && !command.scene.moves();
    return readsOne && !choosesWindow(command) ? 1 / (1 + double(frames)) : 0.4;
}

// Puts into a look, and into `command`, the greys that all frames are shown in.
// @param isKnown  whether what there is to know of all frames is known already
void fixWindow(const std::vector<FrameFiles>& frames, bool isKnown, SequenceLook& look,
               RenderCommand& command, const Listener& listener) {
    if (!choosesWindow(command)) return;
    if (!look.window()) {
        if (isKnown) {
            throw Error(ErrorCode::kInput, command.firstPass.string(),
                        "no values of black and white",
                        "what --first-pass has written with the same --mode");
        }
        look.setWindow(sequenceWindow(
            frames, [&](std::size_t i) { return commandOf(command, frames[i], {}); }, look,
            workersFor(command, look), listener));
    }
    command.window = look.window();
}

// Frames 1 to `count`, which another option than --frames asks for.
void useFrames(const char* option, std::size_t count, FrameChoice& frames) {
    frames.askedBy = option;
    frames.frames.resize(count);
    std::iota(frames.frames.begin(), frames.frames.end(), 1);
}

}  // namespace

void addSequenceOptions(CLI::App& app, RenderCommand& command) {
    addFrameOptions(app, command.frames, true);
    OptionGroup group(app, "Sequence");
    group.addValue("--first-pass", "FILE", command.firstPass, anyText(),
                   "JSON file of what all frames are shown by alike: the values and the\n"
                   "place of all of them. Made from --frames if it is not there, without\n"
                   "-o that alone; tasks of a farm that have some of the frames each\n"
                   "share one");
    addSinkOptions(app, command);
    group.addValue("--poses", "FILE.csv", command.picture.camera.posesFile, anyText(),
                   "C-arm: a line of numbers for each frame, under the names primary\n"
                   "(degrees, LAO > 0), secondary (CRA > 0), sid, sdd (as --sid, --sdd)\n"
                   "and pixel (of the detector, mm); frames 1 to as many as there are\n"
                   "if --frames names no others; INPUT may be one volume");
    group.addValue("--turntable", "N", command.turntable, wholeNumber(1, 1'000'000),
                   "Turns the camera once around in N frames, 1 to N if --frames names\n"
                   "no others; INPUT may be one volume");
}

void applySequence(const CLI::App& app, RenderCommand& command) {
    command.readingOptions = readingOptions(app);
    const CameraChoice& choice = command.picture.camera;
    const bool hasPoses = !choice.posesFile.empty();
    if (command.turntable &&
        (choice.asked() || hasPoses || command.picture.render.camera.worldFromCamera)) {
        throw Error(ErrorCode::kUsage, "--turntable",
                    std::string("it and ") + (choice.asked() ? "--camera"
                                              : hasPoses     ? "--poses"
                                                             : "--camera-matrix"),
                    "a camera that options turn");
    }
    if (command.turntable && !command.frames.asked())
        useFrames("--turntable", std::size_t(*command.turntable), command.frames);
    if (hasPoses && !command.frames.asked())
        useFrames("--poses", readPoses(choice.posesFile).size(), command.frames);
    settleNames(app, command.frames, command.input, command.output);
    if (!command.frames.asked()) {
        command.stats = plainName(command.stats);
        if (command.firstPass.empty() || command.slabs) return;
        refuseWithoutFrames("--first-pass");
    }
    if (!command.stats.empty()) frameNameOf(command.frames, "--stats", command.stats);
    refuseLog("--first-pass", command.firstPass);
}

void renderSequence(const RenderCommand& command, SequenceSinks& sinks, const Listener& listener,
                    const MakePicture& makePicture) {
    interruptBetweenFiles();
    const std::vector<FrameFiles> all = withScene(
        command.scene, filesFor(command, sinks.areWritten() && !isLookAlone(command), listener));
    const std::optional<FrameName> stats = FrameName::find(command.stats);
    requireOwnOutputs("--output", all, command.firstPass, "the first pass");
    if (stats) {
        std::vector<FrameFiles> ofStats = all;
        for (FrameFiles& one : ofStats) one.output = stats->at(one.frame);
        requireOwnOutputs("--stats", ofStats, command.firstPass, "the first pass");
    }
    SequenceLook look(kKeptShare * double(availableMemory()));
    const std::optional<std::filesystem::path> held = readFirstPass(command, look, listener);
    const bool isKnown = held.has_value();
    const std::vector<FrameFiles> present = withInputs(all, command.frames.missing, listener, held);
    if (present.empty() && sinks.any()) refuseWithoutInputs(all.front().input);
    const bool isAlone = isLookAlone(command);
    const std::vector<FrameFiles> frames = framesToMake(present, command.frames, stats);
    // Nobody needs to know then what is in them.
    if (frames.empty() && !isAlone && !sinks.any() && (isKnown || command.firstPass.empty()))
        return listener.report(1);
    warnOfOwnRanges(command, listener);
    const double surveyed = surveyShare(command, isKnown, present.size());
    const double readShare = choosesWindow(command) ? surveyed / 2 : surveyed;
    Survey survey(command, present, isAlone);
    if (!isKnown && isAlone && !command.frames.keepGoing &&
        command.frames.missing == MissingFrames::kError)
        requireInputs(present);
    // Asked now, rather than after all frames have been read.
    if (!isKnown && !command.firstPass.empty()) requireWritableFirstPass(command);
    if (!isKnown) survey.run(look, partOf(listener, 0, readShare));
    RenderCommand fixed = fixedTo(look, command);
    fixWindow(present, isKnown, look, fixed, partOf(listener, readShare, surveyed));
    if (!isKnown && !command.firstPass.empty()) writeFirstPass(command, survey.framesRead(), look);
    if (isAlone) {
        listener.report(1);
        return survey.throwFailure();
    }
    const Listener making = partOf(listener, surveyed, 1);
    OutputFolders folders;
    std::optional<PreparedScene> prepared;
    const auto first = std::find_if(frames.begin(), frames.end(), [&](const FrameFiles& one) {
        return hasFunction(command, one.frame);
    });
    if (first != frames.end() && seesOneThing(command))
        prepared = prepareOnce(commandOf(fixed, *first, {}), look, making);
    const bool ownFunctions = hasFunctions(command);
    try {
        runFrames(
            frames, command.frames.keepGoing, workersFor(command, look),
            [&](std::size_t i, const Listener& part) {
                const FrameLook frame{look, i};
                SequencePart sequence{&frame,
                                      prepared ? &*prepared : nullptr,
                                      {},
                                      sinks.areWritten(),
                                      frames[i].frame};
                if (sinks.any()) sequence.take = [&](const Image& image) { sinks.put(i, image); };
                try {
                    const RenderCommand one = commandOf(fixed, frames[i], stats);
                    std::optional<PreparedScene> seen;
                    if (prepared && ownFunctions && frames[i].frame != first->frame)
                        sequence.prepared = &seen.emplace(seenBy(one, *prepared, frame, part));
                    if (sinks.areWritten()) folders.makeFor(one.output);
                    folders.makeFor(one.stats);
                    makePicture(one, sequence, part);
                } catch (...) {
                    sinks.skip(i);
                    throw;
                }
            },
            making);
    } catch (const Error& error) {
        // What there is goes into the file of all.
        if (command.frames.keepGoing && error.code() != ErrorCode::kInterrupted)
            finishAfterFailure(sinks);
        throw;
    }
    sinks.finish();
    listener.report(1);
}

}  // namespace deltasplat
