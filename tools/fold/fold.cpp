// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/memory.h"
#include "base/progress.h"
#include "batch/file_pattern.h"
#include "deltasplat/error.h"
#include "deltasplat/slabs.h"
#include "formats/input_files.h"
#include "listener.h"
#include "output_files.h"
#include "process/interrupt.h"
#include "render/color_options.h"
#include "render/exr_options.h"
#include "render/picture_metadata.h"
#include "render/picture_parts.h"
#include "render/render_modes.h"
#include "render/tone_options.h"
#include "subcommands.h"
#include "version.h"

namespace deltasplat {
namespace {

// Of the progress, what putting layers together takes before pixels are shown.
constexpr double kFoldShare = 0.6;

struct FoldCommand {
    std::vector<std::string> parts;
    RenderCommand picture;  ///< as render would have been asked for it
};

void declareOptions(CLI::App& app, FoldCommand& command) {
    app.add_option("PARTS", command.parts,
                   "Parts of a picture, all of them, in any order: .slabs files that\n"
                   "render --slab-range has written; or a pattern in quotes, 's.*.slabs'")
        ->type_name("FILE")
        ->required()
        ->group("Arguments");
    OptionGroup output(app, "Output");
    output.addValue("-o,--output", "FILE", command.picture.output, anyText(),
                    "Picture to write: .exr (scene-linear, premultiplied) or .png, .tif\n"
                    "or .jpg (sRGB; a .jpg without alpha: over --background or black)");
    addStorageOptions(app, command.picture.image);
    addBackgroundOption(output, command.picture.picture.background);
    addToneOptions(app, command.picture.tone);
    addColorOptions(app, command.picture.color);
    addExrFileOptions(app, command.picture);
}

std::string noteOf(const Notes& notes, const std::string& name) {
    const auto found = std::find_if(notes.begin(), notes.end(),
                                    [&](const auto& note) { return note.first == name; });
    return found == notes.end() ? "" : found->second;
}

// Takes from a part what a picture has of its scene, and checks what is asked for of it.
void applyParts(const SlabFiles& parts, const std::string& file, RenderCommand& command) {
    const std::string version = noteOf(parts.notes().picture, "version");
    if (version != programVersion()) {
        throw Error(ErrorCode::kInput, file, "a part that version " + version + " wrote",
                    "one of version " + programVersion());
    }
    const Camera& camera = parts.camera();
    command.input = noteOf(parts.notes().part, "input");
    CameraOptions& options = command.picture.render.camera;
    options.overscanPixels = camera.overscanPixels;
    options.sizePixels = camera.sizePixels - 2 * camera.overscanPixels;
    if (camera.overscanPixels != glm::ivec2(0) && !isExr(command)) {
        throw Error(ErrorCode::kUsage, "--output", command.output.string(),
                    "an .exr file, for its parts have --overscan");
    }
    checkExr(command);
    checkImageFile(command.output, options.sizePixels, command.image);
}

void warnOfUnusedOptions(const CLI::App& app, const RenderCommand& command,
                         ProgressDisplay& display) {
    if (isGiven(app, "--bits") && isExr(command)) display.warn("--bits: has no effect on an .exr");
    if (isGiven(app, "--dither") && (isExr(command) || command.image.bits == 16))
        display.warn("--dither: has no effect but in pictures of 8 bits");
    warnOfUnusedTone(app, command, display);
    warnOfUnusedExrOptions(app, command, display);
    warnOfUnusedColorOptions(app, command, display);
}

ImageFileOptions fileOptions(const RenderCommand& command, const PartNotes& partNotes,
                             const Picture& folded, const Session& session) {
    RenderResult said;
    said.camera = folded.camera();
    said.stats = folded.stats();
    boundOver(command.picture.background, said.stats);
    const Notes& notes = partNotes.picture;
    ImageFileOptions file = imageOptions(
        command, {noteOf(notes, "codeBook"), noteOf(notes, "codeError")}, said, session);
    file.metadata.emplace_back("partCommandLine", noteOf(partNotes.part, "commandLine"));
    return file;
}

void writeWhole(const RenderCommand& command, const PartNotes& notes, Picture& folded,
                const Session& session, const Listener& listener) {
    const glm::ivec2 size = folded.camera().sizePixels;
    constexpr double kBytesPerPixel = 16;
    requireMemory("picture", kBytesPerPixel * size.x * size.y);
    Image image(size);
    folded.show({{0, 0}, size}, image);
    ImageFileOptions file = fileOptions(command, notes, folded, session);
    finishLight(command, image, file, listener);
    writeImage(command.output, image, file);
}

// The parts, with the files that patterns stand for in their place.
Files partsOf(const FoldCommand& asked) {
    Files parts;
    for (const std::string& name : asked.parts) {
        if (!isPattern(name)) {
            parts.push_back(plainInput(name));
            continue;
        }
        const FoundFiles found = findFiles(name, {});
        for (const FoundFile& one : found.files) parts.push_back(one.file);
        if (found.files.empty()) {
            throw Error(ErrorCode::kInput, name, "no file that fits", "at least one");
        }
    }
    return parts;
}

void runFold(const CLI::App& app, const FoldCommand& asked, const Session& session) {
    RenderCommand command = asked.picture;
    command.output = plainName(command.output);
    requireArgument(!command.output.empty(), "--output", "FILE (see 'deltasplat fold --help')");
    imageFormatOf(command.output);
    const Files parts = partsOf(asked);
    checkOutput("--output", command.output, parts, "the parts");
    checkColors(command);
    SlabFiles files(parts);
    const PartNotes& notes = files.notes();
    std::optional<Picture> picture;
    applyParts(files, parts.front().string(), command);
    {
        ProgressDisplay display(session.common);
        warnOfUnusedOptions(app, command, display);
        const Listener all = display.stage(0, 1);
        Picture& folded = picture.emplace(files.fold(partOf(all, 0, kFoldShare)));
        const Listener writing = partOf(all, kFoldShare, 1);
        if (isMadeInParts(command, command.picture.render.camera)) {
            writeInParts(
                command, folded.camera().sizePixels,
                [&](const PixelBox& part, Image& image) { folded.show(part, image); },
                folded.stats().tolerance.isExact(),
                [&] { return fileOptions(command, notes, folded, session); }, writing);
        } else {
            writeWhole(command, notes, folded, session, writing);
        }
        all.report(1);
        allIsWritten();
    }
    RenderStats stats = picture->stats();
    boundOver(command.picture.background, stats);
    if (!stats.tolerance.isExact() && !session.common.quiet) showErrorBound(stats);
}

}  // namespace

Subcommand addFold(CLI::App& program) {
    const auto command = std::make_shared<FoldCommand>();
    CLI::App& app = addSubcommand(
        program, "fold", "Makes a picture of parts that render --slab-range has written.",
        {"deltasplat fold smoke.1.slabs smoke.2.slabs -o smoke.exr",
         "deltasplat fold smoke.*.slabs -o smoke.png --background 0,0,0"});
    return {&app, [&app, command] { declareOptions(app, *command); },
            [&app, command](const Session& session) { runFold(app, *command, session); }};
}

}  // namespace deltasplat
