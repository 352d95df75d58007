// SPDX-License-Identifier: Apache-2.0
// Functions that a module does, and nothing besides.
#include "deltasplat/hold_out.h"

#include <algorithm>

#include "base/parallel.h"
#include "base/text.h"
#include "deltasplat/image/color_management.h"
#include "image/quantize.h"
#include "image/srgb.h"
#include "modules/helper_process.h"
#include "modules/image_module.h"

namespace deltasplat {

bool isWholeImage(const std::filesystem::path& file) {
    return imageModule().isWholeImage(file);
}

Image readThumbnail(const std::filesystem::path& file, int mostSide) {
    return imageModule().readThumbnail(file, mostSide);
}

std::string encodeThumbnail(const Image& image) {
    return imageModule().encodeThumbnail(image);
}

DepthImage readDepthImage(const std::filesystem::path& file, const Listener& listener) {
    return imageModule().readDepthImage(file, listener);
}

// Names and paths that have a zero in them are none that OpenColorIO knows.
std::string textOf(const ColorOptions& options) {
    std::string all;
    for (const std::string& text :
         {options.config.string(), options.workingSpace, options.colorSpace, options.display,
          options.displayView, options.look.string()})
        all += text + '\0';
    return all;
}

struct ColorTransform::Impl {
    std::unique_ptr<ColorProcessor> processor;
};

ColorTransform::ColorTransform(const ColorOptions& options) : impl_(std::make_unique<Impl>()) {
    constexpr double kBytesOfOpenImageIo = 112 << 20;  // resident, once it is loaded
    HelperProcess helper("colors", kBytesOfOpenImageIo);
    // Both load the same libraries, which takes longer than all else, and do so at once.
    if (!options.colorSpace.empty() || options.isShown()) helper.beginRequest(textOf(options), 0);
    impl_->processor = imageModule().makeColorProcessor(options, helper);
}
ColorTransform::~ColorTransform() = default;
ColorTransform::ColorTransform(ColorTransform&&) noexcept = default;

void ColorTransform::convert(Image& image) const {
    impl_->processor->convert(image);
}

void ColorTransform::show(Image& image) const {
    const DefaultFloats floats;
    impl_->processor->show(image);
}

// Based on: SMPTE ST 2065-1:2021 (ACES2065-1), Academy S-2014-004 (ACEScg).
std::optional<Chromaticities> chromaticitiesOf(const std::string& colorSpace) {
    const std::string name = lowerCase(colorSpace);
    if (name == "acescg" || name == "aces - acescg" || name == "lin_ap1")
        return Chromaticities{0.713f, 0.293f, 0.165f, 0.83f, 0.128f, 0.044f, 0.32168f, 0.33767f};
    if (name == "aces2065-1" || name == "aces - aces2065-1" || name == "lin_ap0")
        return Chromaticities{0.7347f, 0.2653f, 0, 1, 0.0001f, -0.077f, 0.32168f, 0.33767f};
    const bool isRec709 =
        std::find(kLinearRec709.begin(), kLinearRec709.end(), name) != kLinearRec709.end();
    return isRec709 ? std::optional<Chromaticities>(kRec709) : std::nullopt;
}

}  // namespace deltasplat
