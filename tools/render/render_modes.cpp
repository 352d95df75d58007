// SPDX-License-Identifier: Apache-2.0
#include "render/render_modes.h"

#include <algorithm>
#include <string>
#include <vector>

#include "deltasplat/error.h"
#include "lower_case.h"
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
    warnUnless("--photons", mode == Mode::kDrr && isExr(command),
               "--mode drr and an .exr: other pictures show the same of any number");
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
    return command.picture.render.mode != Mode::kComposite && isExr(command);
}

bool showsWindow(const RenderCommand& command) {
    const Mode mode = command.picture.render.mode;
    if (mode == Mode::kComposite || isExr(command)) return false;
    return !colorsValues(command) || command.picture.transferFunction.empty();
}

std::optional<glm::dvec2> windowAsked(const RenderCommand& command) {
    const RenderOptions& options = command.picture.render;
    return command.window || addsUp(options.mode) ? command.window : options.optics.range;
}

void applyMode(const CLI::App& app, RenderCommand& command) {
    Mode& mode = command.picture.render.mode;
    if (command.drr && isGiven(app, "--mode") && mode != Mode::kDrr) {
        throw Error(ErrorCode::kUsage,
                    gotExpected("--drr", "--mode " + modeName(mode) + " besides", "--mode drr"));
    }
    if (command.drr) mode = Mode::kDrr;
    if (storesValues(command)) command.image.floatExr = true;
    command.picture.render.mipColors = !isExr(command) && !command.picture.transferFunction.empty();
}

void warnOfUnusedModeOptions(const CLI::App& app, const RenderCommand& command,
                             ProgressDisplay& display) {
    const Mode mode = command.picture.render.mode;
    if (isGiven(app, "--window") && !showsWindow(command)) {
        display.warn(std::string("--window: has no effect ") +
                     (mode == Mode::kComposite ? "with --mode composite"
                      : isExr(command)         ? "on an .exr, which holds the values themselves"
                                               : "with --tf, whose colours values get"));
    }
    warnOfOtherModes(app, command, display);
    if (mode == Mode::kComposite) return;
    std::vector<std::string> unused = {
        "--method",  "--tolerance",  "--tolerance-value", "--resolution",       "--between",
        "--join",    "--extinction", "--unit-distance",   "--color-by",         "--shade",
        "--light",   "--ambient",    "--diffuse",         "--specular",         "--shininess",
        "--surface", "--isovalue",   "--surface-color",   "--gradient-opacity", "--density-scale",
        "--filter"};
    for (const std::vector<std::string>& ofFog : {scatterOptions(), mediumOptions()})
        unused.insert(unused.end(), ofFog.begin(), ofFog.end());
    if (colorsValues(command)) unused.push_back("--sigma");
    if (!colorsValues(command) || isExr(command))
        unused.insert(unused.end(),
                      {"--tf", "--range", "--hide-labels", "--show-labels", "--label-opacity"});
    for (const std::string& option : unused) {
        if (isGiven(app, option))
            display.warn(option + ": has no effect with --mode " + modeName(mode));
    }
    const bool fromEye = command.picture.render.camera.projection != Projection::kOrtho;
    if (isGiven(app, "--sigma") && !colorsValues(command) && fromEye)
        display.warn("--sigma: has no effect with --mode " + modeName(mode) +
                     " but in --projection ortho");
    if (isGiven(app, "--background") && (storesValues(command) || mode == Mode::kDrr))
        display.warn("--background: has no effect on " +
                     std::string(storesValues(command) ? "an .exr" : "a picture") +
                     " with --mode " + modeName(mode));
}

}  // namespace deltasplat
