// SPDX-License-Identifier: Apache-2.0
#include "render/tone_options.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/text.h"
#include "deltasplat/image/tone.h"
#include "render/color_options.h"
#include "render/render_modes.h"

namespace deltasplat {
namespace {

// Of the pixels that are not clear: single highlights are no reason to say something.
constexpr double kNoticedShare = 0.01;

Parser<Tone> tone() {
    return [](const std::string& option, const std::string& text) {
        const std::string filmic = toneName(Tone::kFilmic);
        const std::string word = choice({toneName(Tone::kStandard), filmic})(option, text);
        return word == filmic ? Tone::kFilmic : Tone::kStandard;
    };
}

// To a tenth.
std::string percentText(double share) {
    return numberText(std::round(1000 * share) / 10) + " %";
}

// @param isBeyondHalf  whether there was light that an .exr of halves does not hold
void warnOfClipping(const RenderCommand& command, const Image& image, bool isBeyondHalf,
                    const Listener& listener) {
    const double share = clippedShare(image);
    if (!(share > kNoticedShare)) return;
    listener.warn(command.output.string() + ": " + percentText(share) + " of the pixels " +
                  (isOpaque(image) ? "are brighter than white"
                                   : "that are not clear are brighter than their alpha") +
                  ", and clipped: --exposure darkens all, --tone filmic rolls highlights off, an "
                  ".exr " +
                  (isBeyondHalf ? "with --float keeps them" : "keeps them"));
}

}  // namespace

bool isOpaque(const Image& image) {
    for (std::size_t i = 3; i < image.rgba.size(); i += 4)
        if (image.rgba[i] < 1) return false;
    return true;
}

void addToneOptions(CLI::App& app, ToneChoice& choice) {
    OptionGroup group(app, "Output");
    group.addValue("--exposure", "STOPS", choice.exposureStops,
                   number(-kMaxExposureStops, kMaxExposureStops),
                   withDefault("Makes what a .png, .tif or .jpg shows of light, --background\n"
                               "included, 2^STOPS times as bright",
                               numberText(choice.exposureStops)));
    group.addValue("--tone", "NAME", choice.tone, tone(),
                   withDefault("What it shows of light that is brighter than white: standard\n"
                               "(clipped) or filmic (all highlights roll off to white, and\n"
                               "shadows are deeper)",
                               toneName(choice.tone)));
}

void warnOfUnusedTone(const CLI::App& app, const RenderCommand& command, ProgressDisplay& display) {
    const Mode mode = command.picture.render.mode;
    if (mode == Mode::kComposite && !isExr(command)) return;
    const std::string where = mode == Mode::kComposite ? "on an .exr, which holds light as it is"
                                                       : "with --mode " + modeName(mode);
    for (const char* option : {"--exposure", "--tone"})
        if (isGiven(app, option)) display.warn(std::string(option) + ": has no effect " + where);
}

void warnOfHalves(const RenderCommand& command, std::size_t pixels, const Listener& listener) {
    if (pixels == 0) return;
    listener.warn(command.output.string() + ": " + std::to_string(pixels) +
                  (pixels == 1 ? " pixel is" : " pixels are") +
                  " brighter than 65504, the most that halves hold, and clipped to it: --float "
                  "keeps them");
}

void applyTone(const RenderCommand& command, Image& image, ImageFileOptions& file,
               const Listener& listener) {
    if (command.picture.render.mode != Mode::kComposite || isExr(command)) return;
    const ToneChoice& choice = command.tone;
    file.metadata.insert(file.metadata.end(), {{"exposure", numberText(choice.exposureStops)},
                                               {"tone", toneName(choice.tone)}});
    const bool isBeyondHalf = countBeyondHalf(image) > 0;
    if (choice.exposureStops != 0) expose(image, choice.exposureStops);
    if (command.color.isShown()) return colorsOf(command).show(image);
    if (choice.tone == Tone::kFilmic) return toneFilmic(image);
    warnOfClipping(command, image, isBeyondHalf, listener);
}

}  // namespace deltasplat
