// SPDX-License-Identifier: Apache-2.0
#include "render/render_modes.h"

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "base/text.h"
#include "deltasplat/error.h"
#include "options/input_options.h"
#include "render/value_window.h"

namespace deltasplat {
namespace {

// Options that only one mode has.
void warnOfOtherModes(const CLI::App& app, const RenderCommand& command, ProgressDisplay& display) {
    const Mode mode = command.picture.render.mode;
    const auto warnUnless = [&](const std::string& option, bool used, const std::string& where) {
        if (isGiven(app, option) && !used)
            display.warn(option + ": has no effect without " + where);
    };
    warnUnless("--depth-shade", mode == Mode::kMip, "--mode mip");
    warnUnless("--mu-water", mode == Mode::kDrr, "--mode drr");
    warnUnless("--photons", mode == Mode::kDrr && storesValues(command),
               "--mode drr and an .exr or a picture of numbers: others show the same of any "
               "number");
}

ImageFormat formatOf(const RenderCommand& command) {
    // What is no picture is refused elsewhere.
    try {
        return imageFormatOf(command.output);
    } catch (const Error&) {
        return ImageFormat::kPng;
    }
}

// Whether the file holds one 32-bit number for each pixel.
bool holdsNumbers(const RenderCommand& command) {
    if (command.picture.render.mode == Mode::kComposite) return false;
    const ImageFormat format = formatOf(command);
    return isOfNumbers(format) || (format == ImageFormat::kTiff && command.image.floatExr);
}

}  // namespace

bool isExr(const RenderCommand& command) {
    return lowerCase(command.output.extension().string()) == ".exr";
}

bool colorsValues(const RenderCommand& command) {
    const Mode mode = command.picture.render.mode;
    return mode == Mode::kMip || mode == Mode::kMin || mode == Mode::kAverage;
}

bool storesValues(const RenderCommand& command) {
    return holdsNumbers(command) ||
           (command.picture.render.mode != Mode::kComposite && isExr(command));
}

void checkNumbers(const RenderCommand& command) {
    const ImageFormat format = formatOf(command);
    const bool hasPlaces = format == ImageFormat::kNrrd || format == ImageFormat::kMetaImage;
    if (!hasPlaces || command.picture.render.camera.projection != Projection::kLatlong) return;
    throw Error(ErrorCode::kUsage, "--output",
                command.output.string() + " with --projection latlong", "a flat picture, or .npy");
}

bool showsWindow(const RenderCommand& command) {
    const Mode mode = command.picture.render.mode;
    if (mode == Mode::kComposite || storesValues(command)) return false;
    return !colorsValues(command) || command.picture.transferFunction.empty();
}

std::optional<glm::dvec2> windowAsked(const RenderCommand& command) {
    const RenderOptions& options = command.picture.render;
    return command.window || addsUp(options.mode) ? command.window : options.optics.range;
}

void applyMode(const CLI::App& app, RenderCommand& command) {
    Mode& mode = command.picture.render.mode;
    if (command.drr && isGiven(app, "--mode") && mode != Mode::kDrr) {
        throw Error(ErrorCode::kUsage, "--drr", "--mode " + modeName(mode) + " besides",
                    "--mode drr");
    }
    if (command.drr) mode = Mode::kDrr;
    if (mode == Mode::kComposite && !command.output.empty() && isOfNumbers(formatOf(command))) {
        throw Error(ErrorCode::kUsage, "--output",
                    command.output.string() + " with --mode composite",
                    "a mode of numbers: xray, mip, min, average or drr");
    }
    if (holdsNumbers(command)) command.image.numbers = true;
    // Nothing is no number there; sums are 0.
    if (command.image.numbers && colorsValues(command))
        command.image.nothing = std::numeric_limits<float>::quiet_NaN();
    if (storesValues(command)) command.image.floatExr = true;
    command.picture.render.mipColors =
        !storesValues(command) && !command.picture.transferFunction.empty();
}

void warnOfUnusedModeOptions(const CLI::App& app, const RenderCommand& command,
                             ProgressDisplay& display) {
    const Mode mode = command.picture.render.mode;
    if (isGiven(app, "--window") && !showsWindow(command)) {
        display.warn(std::string("--window: has no effect ") +
                     (mode == Mode::kComposite ? "with --mode composite"
                      : storesValues(command)
                          ? "on an .exr or a picture of numbers, which hold the values themselves"
                          : "with --tf, whose colours values get"));
    }
    warnOfOtherModes(app, command, display);
    if (mode == Mode::kComposite) return;
    std::vector<std::string> unused = {
        "--method",  "--tolerance",  "--tolerance-value", "--resolution",       "--between",
        "--join",    "--extinction", "--unit-distance",   "--color-by",         "--shade",
        "--light",   "--ambient",    "--diffuse",         "--specular",         "--shininess",
        "--surface", "--isovalue",   "--surface-color",   "--gradient-opacity", "--density-scale",
        "--filter",  "--sigma",      "--keep-lone"};
    for (const std::vector<std::string>& ofFog : {scatterOptions(), mediumOptions()})
        unused.insert(unused.end(), ofFog.begin(), ofFog.end());
    if (!colorsValues(command) || storesValues(command))
        unused.insert(unused.end(),
                      {"--tf", "--range", "--hide-labels", "--show-labels", "--label-opacity"});
    for (const std::string& option : unused) {
        if (isGiven(app, option))
            display.warn(option + ": has no effect with --mode " + modeName(mode));
    }
    if (isGiven(app, "--background") && (storesValues(command) || mode == Mode::kDrr))
        display.warn("--background: has no effect on " +
                     std::string(storesValues(command) ? "an .exr or numbers" : "a picture") +
                     " with --mode " + modeName(mode));
}

}  // namespace deltasplat
