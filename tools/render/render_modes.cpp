// SPDX-License-Identifier: Apache-2.0
#include "render/render_modes.h"

#include <algorithm>
#include <string>
#include <vector>

#include "lower_case.h"
#include "options/input_options.h"

namespace deltasplat {
namespace {

bool isExr(const std::filesystem::path& file) {
    return lowerCase(file.extension().string()) == ".exr";
}

}  // namespace

bool storesValues(const RenderCommand& command) {
    return command.picture.render.mode != Mode::kComposite && isExr(command.output);
}

bool showsWindow(const RenderCommand& command) {
    const Mode mode = command.picture.render.mode;
    if (mode == Mode::kComposite || isExr(command.output)) return false;
    return mode == Mode::kXray || command.picture.transferFunction.empty();
}

void applyMode(RenderCommand& command) {
    if (storesValues(command)) command.image.floatExr = true;
    command.picture.render.mipColors =
        !isExr(command.output) && !command.picture.transferFunction.empty();
}

void warnOfUnusedModeOptions(const CLI::App& app, const RenderCommand& command,
                             ProgressDisplay& display) {
    const Mode mode = command.picture.render.mode;
    if (isGiven(app, "--window") && !showsWindow(command))
        display.warn("--window: has no effect without --mode xray or mip, in an .exr or with --tf");
    if (mode == Mode::kComposite) return;
    std::vector<std::string> unused = {
        "--method",     "--tolerance",     "--tolerance-value", "--resolution", "--between",
        "--extinction", "--unit-distance", "--color-by",        "--shade",      "--light",
        "--ambient",    "--diffuse",       "--specular",        "--shininess",  "--surface",
        "--isovalue",   "--surface-color", "--gradient-opacity"};
    if (mode == Mode::kMip) unused.push_back("--sigma");
    if (mode == Mode::kXray || isExr(command.output))
        unused.insert(unused.end(),
                      {"--tf", "--range", "--hide-labels", "--show-labels", "--label-opacity"});
    for (const std::string& option : unused) {
        if (isGiven(app, option))
            display.warn(option + ": has no effect with --mode " + modeName(mode));
    }
    if (isGiven(app, "--background") && storesValues(command))
        display.warn("--background: has no effect on an .exr with --mode " + modeName(mode));
}

}  // namespace deltasplat
