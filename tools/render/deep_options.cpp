// SPDX-License-Identifier: Apache-2.0
#include "render/deep_options.h"

#include <string>

#include "deltasplat/error.h"
#include "options/parse.h"
#include "render/render_modes.h"

namespace deltasplat {
namespace {

void refuse(const std::string& got, const std::string& expected) {
    throw Error(ErrorCode::kUsage, "--deep", got, expected);
}

void checkHoldout(const RenderCommand& command) {
    const Mode mode = command.picture.render.mode;
    const std::string got = mode != Mode::kComposite         ? "--mode " + modeName(mode)
                            : command.deep                   ? "--deep"
                            : !command.channels.aovs.empty() ? "--aov"
                                                             : "";
    if (got.empty()) return;
    throw Error(ErrorCode::kUsage, "--holdout-depth", got + " besides",
                mode != Mode::kComposite ? "--mode composite" : "one of the two");
}

}  // namespace

void addDeepOptions(CLI::App& app, RenderCommand& command) {
    OptionGroup group(app, "Output");
    group.addFlag("--deep", command.deep,
                  "Write a deep .exr: samples of every pixel, each with the depths\n"
                  "between which it lies (Z, ZBack: along the camera's line of sight;\n"
                  "latlong from the eye), to be merged with others' by depth");
    group.addValue("--deep-slices", "N", command.deepOptions.slicesPerSample,
                   wholeNumber(1, kMostSlicesPerSample),
                   withDefault("--deep: slices of the volume that a sample holds at most",
                               std::to_string(command.deepOptions.slicesPerSample)));
    group.addValue("--holdout-depth", "FILE", command.holdoutDepth, anyText(),
                   "Picture with a channel Z, of the same size and camera: depths of\n"
                   "solid things, as --aov depth and --deep count them, behind which the\n"
                   "volume is not seen (0 and 1e10: nothing there)");
}

void checkDeep(const RenderCommand& command) {
    if (!command.holdoutDepth.empty()) checkHoldout(command);
    if (!command.deep) return;
    if (!isExr(command)) refuse(command.output.string(), "an .exr file");
    const Mode mode = command.picture.render.mode;
    if (mode != Mode::kComposite) refuse("--mode " + modeName(mode), "--mode composite");
    if (command.picture.background)
        refuse("--background besides", "none: what lies behind is put there by depth");
}

void warnOfUnusedDeepOptions(const CLI::App& app, const RenderCommand& command,
                             ProgressDisplay& display) {
    if (isGiven(app, "--deep-slices") && !command.deep)
        display.warn("--deep-slices: has no effect without --deep");
}

}  // namespace deltasplat
