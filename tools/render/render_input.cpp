// SPDX-License-Identifier: Apache-2.0
#include "render/render_input.h"

#include "deltasplat/optics/default_ramp.h"

namespace deltasplat {

RenderOptions readOptics(const PictureOptions& picture, const Listener& listener) {
    RenderOptions options = picture.render;
    const bool ramp = picture.transferFunction.empty();
    if (!ramp)
        options.optics.transferFunction = readTransferFunction(picture.transferFunction, listener);
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
    if (!picture.transferFunction.empty()) return volume;
    const std::optional<glm::dvec2>& range = picture.render.optics.range;
    options.optics.transferFunction =
        range ? (mip ? wholeRamp(volume, *range) : defaultRamp(volume, *range))
              : (mip ? wholeRamp(volume) : defaultRamp(volume));
    return volume;
}

}  // namespace deltasplat
