// SPDX-License-Identifier: Apache-2.0
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "base/parallel.h"
#include "deltasplat/error.h"
#include "deltasplat/image/image.h"
#include "deltasplat/threads.h"
#include "image/srgb.h"
#include "modules/helper_process.h"
#include "modules/image_module.h"
#include "oiio/color_transforms.h"

namespace deltasplat {
namespace {

class Processor : public ColorProcessor {
  public:
    explicit Processor(ColorTransforms transforms) : transforms_(std::move(transforms)) {}

    void convert(Image& image) const override {
        if (transforms_.stored) apply(transforms_.stored, image);
    }

    void show(Image& image) const override {
        if (transforms_.shown) {
            apply(transforms_.shown, image);
        } else {
            eachColor(image, [](double v) { return srgbFromLinear(std::clamp(v, 0.0, 1.0)); });
        }
        if (transforms_.look) apply(transforms_.look, image);
        eachColor(image, [](double v) { return linearFromSrgb(std::clamp(v, 0.0, 1.0)); });
    }

  private:
    void apply(const OIIO::ColorProcessorHandle& processor, Image& image) const {
        OIIO::ImageSpec spec(image.size.x, image.size.y, 4, OIIO::TypeFloat);
        spec.alpha_channel = 3;
        OIIO::ImageBuf buffer(spec, image.rgba.data());
        if (OIIO::ImageBufAlgo::colorconvert(buffer, buffer, processor.get(), true, {},
                                             threadCount()))
            return;
        throw Error(ErrorCode::kFailed, "OpenColorIO: " + lineOf(buffer.geterror()));
    }

    // Changes colours, divided by alpha, each by itself.
    template <typename Change>
    static void eachColor(Image& image, const Change& change) {
        parallelFor(std::size_t(image.size.y), [&](std::size_t y) {
            for (int x = 0; x < image.size.x; ++x) {
                float* rgba = image.pixel(x, int(y));
                for (int c = 0; c < 3; ++c) {
                    if (rgba[3] > 0) rgba[c] = float(change(double(rgba[c]) / rgba[3]) * rgba[3]);
                }
            }
        });
    }

    ColorTransforms transforms_;
};

// Of the option that the helper was at when it ended no transform can be made.
// @param note  the option, and on further lines what OpenColorIO complains of
void requireAnother(const std::string& note, const char* option, const std::string& name) {
    const std::size_t end = std::min(note.find('\n'), note.size());
    if (end == 0 || note.substr(0, end) == option) refuseTransform(option, name, note.substr(end));
}

}  // namespace

std::unique_ptr<ColorProcessor> image_module::makeColorProcessor(const ColorOptions& options,
                                                                 HelperProcess& helper) {
    std::optional<bool> isDone;  // by the helper, which is waited for before the first transform
    std::string note;
    const auto before = [&](const char* option, const std::string& name) {
        if (!isDone) isDone = helper.finishRequest(nullptr, &note);
        if (!*isDone) requireAnother(note, option, name);
    };
    return std::make_unique<Processor>(makeColorTransforms(options, before));
}

}  // namespace deltasplat
