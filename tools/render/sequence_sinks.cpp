// SPDX-License-Identifier: Apache-2.0
#include "render/sequence_sinks.h"

#include <algorithm>
#include <cstdint>

#include "base/memory.h"
#include "base/refuse.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "formats/input_files.h"
#include "render/color_options.h"
#include "render/render_modes.h"
#include "render/tone_options.h"
#include "sequence/contact_sheet.h"
#include "sequence/frame_name.h"
#include "sequence/movie.h"

namespace deltasplat {
namespace {

void checkSheet(const CLI::App& app, RenderCommand& command, std::size_t pictures) {
    const glm::ivec2 cells = *command.contactSheet;
    const std::size_t count = pictures > 0 ? pictures : command.frames.frames.size();
    const auto room = std::size_t(cells.x) * std::size_t(cells.y);
    if (count > room) {
        refuseUsage("--contact-sheet",
                    dimsText(cells) + " for " + std::to_string(count) +
                        (pictures > 0 ? " pictures" : " frames"),
                    "room for all of them");
    }
    if (FrameName::find(command.output))
        refuseUsage("--output", command.output.string() + " with --contact-sheet", "one file");
    command.output = plainName(command.output);
    for (const char* option :
         {"--aov", "--deep", "--stats", "--region", "--overscan", "--autocrop", "--progressive"}) {
        if (isGiven(app, option))
            refuseUsage("--contact-sheet", option + std::string(" besides"), "one of them");
    }
    const glm::i64vec2 size =
        glm::i64vec2(cells) * glm::i64vec2(command.picture.render.camera.sizePixels);
    constexpr std::int64_t kMostSide = 1'000'000;
    if (std::max(size.x, size.y) > kMostSide) {
        refuseUsage("--contact-sheet", dimsText(size) + " pixels",
                    "at most " + std::to_string(kMostSide) + " each way");
    }
    checkImageFile(command.output, glm::ivec2(size), command.image);
    requireMemory("--contact-sheet", 16.0 * double(size.x) * double(size.y));
}

void checkMovieOf(const CLI::App& app, RenderCommand& command) {
    checkMovie(command.movie, command.picture.render.camera.sizePixels);
    command.isMovieAlone = command.output.empty();
    if (command.isMovieAlone) command.output = command.movie;
    if (isExr(command))
        refuseUsage("--movie", "an .exr besides, which shows light as it is",
                    "-o with a .png, or none");
    if (storesValues(command))
        refuseUsage("--movie", "numbers besides, which no movie shows", "-o with a .png, or none");
    if (!command.isMovieAlone) return;
    for (const char* option : {"--float", "--bits", "--progressive", "--region"})
        if (isGiven(app, option)) refuseUsage(option, "a movie alone", "-o with pictures");
}

}  // namespace

void addSinkOptions(CLI::App& app, RenderCommand& command) {
    OptionGroup group(app, "Sequence");
    group.addValue("--contact-sheet", "CxR", command.contactSheet, pixelSize("CxR"),
                   "Put all frames, or pictures of a batch, into one picture, the output,\n"
                   "in so many columns and rows, each of --size");
    group.addFlag("--slate", command.slate,
                  "Draw the number of its frame into each, upper left; of a\n"
                  "batch the name of the file");
    group.addValue("--movie", "FILE", command.movie, anyText(),
                   "Movie to make of all frames, in place of pictures or, with -o,\n"
                   "besides: .mp4, .m4v or .mkv (H.264, 8 bits) or .mov (ProRes 422 HQ,\n"
                   "10 bits), sRGB over --background or black; needs ffmpeg");
    group.addValue("--fps", "N", command.framesPerSecond, number(0.1, 1000),
                   withDefault("Frames a second of it", "24"));
}

void applySinks(const CLI::App& app, RenderCommand& command, std::size_t pictures) {
    const bool isSingle = !command.frames.asked() && pictures == 0;
    for (const char* option : {"--contact-sheet", "--movie", "--slate"})
        if (isSingle && isGiven(app, option))
            refuseUsage(option, "one picture", "several (--frames, --turntable, or a batch)");
    const bool isLookAlone = command.frames.asked() && !command.firstPass.empty();
    if (command.output.empty() && command.movie.empty() && !isLookAlone)
        refuseUsage("--output", "nothing", "FILE (see 'deltasplat render --help')");
    if (isGiven(app, "--fps") && command.movie.empty())
        refuseUsage("--fps", "it without --movie", "a movie to make");
    if (command.contactSheet && !command.movie.empty())
        refuseUsage("--contact-sheet", "--movie besides", "one of them");
    if (command.slate && (isExr(command) || storesValues(command))) {
        refuseUsage("--slate", command.output.string() + ", whose pixels are light or values alone",
                    "a .png (render to both)");
    }
    if (command.frames.missing == MissingFrames::kBlack) {
        for (const char* option : {"--aov", "--deep", "--overscan", "--stats"}) {
            if (isGiven(app, option))
                refuseUsage("--missing", std::string("black with ") + option,
                            "error, skip or hold");
        }
    }
    if (command.contactSheet) checkSheet(app, command, pictures);
    if (!command.movie.empty()) checkMovieOf(app, command);
    if (!command.contactSheet && command.movie.empty()) return;
    for (const char* option : {"--skip-existing", "--update"})
        if (isGiven(app, option))
            refuseUsage(option, "a sheet or movie of all frames", "pictures of their own");
}

SequenceSinks::SequenceSinks(const RenderCommand& command,
                             const std::vector<std::pair<std::string, std::string>>& metadata)
    : areWritten_(!command.contactSheet && !command.isMovieAlone) {
    const glm::ivec2 size = command.picture.render.camera.sizePixels;
    if (command.contactSheet) {
        ImageFileOptions options = command.image;
        options.metadata = metadata;
        sinks_.push_back(std::make_unique<ContactSheet>(command.output, *command.contactSheet, size,
                                                        options, blackPicture(command)));
    }
    if (!command.movie.empty()) {
        sinks_.push_back(std::make_unique<Movie>(
            command.movie, size, MovieOptions{command.framesPerSecond, command.image.dither}));
    }
}

void SequenceSinks::put(std::size_t i, const Image& image) {
    isAnyPut_ = true;
    for (const auto& sink : sinks_) sink->put(i, image);
}

void SequenceSinks::skip(std::size_t i) {
    for (const auto& sink : sinks_) sink->skip(i);
}

void SequenceSinks::finish() {
    if (!isAnyPut_) return;
    for (const auto& sink : sinks_) sink->finish();
}

Image blackPicture(const RenderCommand& command) {
    Image image(command.picture.render.camera.sizePixels);
    if (storesValues(command)) return image;
    if (command.picture.background) compositeOver(image, *command.picture.background);
    ImageFileOptions unused;
    applyTone(command, image, unused, {});
    convertColors(command, image, unused);
    return image;
}

}  // namespace deltasplat
