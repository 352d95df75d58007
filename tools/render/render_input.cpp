// SPDX-License-Identifier: Apache-2.0
#include "render/render_input.h"

#include <string>

#include "deltasplat/optics/default_ramp.h"
#include "number_text.h"
#include "options/transfer_function_option.h"

namespace deltasplat {
namespace {

// Who sees little of it should know why.
void warnOfOtherData(const Preset& preset, const Volume& volume, const Listener& listener) {
    if (volume.empty()) return;
    const std::string values =
        "values from " + numberText(volume.valueMin) + " to " + numberText(volume.valueMax);
    // Around whatever is scanned is air, and in it fat.
    if (preset.values == Preset::Values::kHounsfield && volume.valueMin >= 0) {
        listener.warn("--tf: " + preset.name +
                      " is for Hounsfield units (air -1000, water 0), which " + values +
                      " are hardly");
    }
    const bool real = volume.type == "float" || volume.type == "double" ||
                      volume.type == "float32" || volume.type == "float64";
    if (preset.values == Preset::Values::kLabels && real) {
        listener.warn("--tf: " + preset.name + " is for whole numbers, and " + values +
                      " of type " + volume.type + " may lie between");
    }
}

}  // namespace

RenderOptions readOptics(const PictureOptions& picture, const Listener& listener) {
    RenderOptions options = picture.render;
    const bool ramp = picture.transferFunction.empty();
    if (!ramp) {
        options.optics.transferFunction =
            readTransferFunctionOption(picture.transferFunction, listener);
    }
    if (options.optics.range && !ramp && !options.optics.transferFunction.normalized)
        listener.warn("--range: has no effect on a transfer function that is not normalized");
    return options;
}

Volume readToRender(const std::filesystem::path& input, const PictureOptions& picture,
                    RenderOptions& options, const Listener& listener) {
    const bool mip = picture.render.mode == Mode::kMip;
    ReadOptions read = picture.read;
    read.keepInexact = picture.render.mode != Mode::kComposite;
    Volume volume = readVolume(input, read, listener);
    if (!picture.transferFunction.empty()) {
        const Preset* preset = parseTransferFunction(picture.transferFunction).preset;
        if (!preset) return volume;
        fitPreset(*preset, volume, options.optics);
        warnOfOtherData(*preset, volume, listener);
        return volume;
    }
    const std::optional<glm::dvec2>& range = picture.render.optics.range;
    options.optics.transferFunction =
        range ? (mip ? wholeRamp(volume, *range) : defaultRamp(volume, *range))
              : (mip ? wholeRamp(volume) : defaultRamp(volume));
    return volume;
}

}  // namespace deltasplat
