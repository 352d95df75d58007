// SPDX-License-Identifier: Apache-2.0
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <string>

#include "base/memory.h"
#include "base/parallel.h"
#include "deltasplat/error.h"
#include "deltasplat/optics/environment.h"
#include "files/file_name.h"
#include "image/srgb.h"
#include "modules/image_module.h"
#include "oiio/image_file.h"

namespace deltasplat {
namespace {

using OIIO::ImageSpec;
using OIIO::TypeDesc;

void requireKnownName(const std::filesystem::path& file) {
    constexpr std::array<const char*, 7> kKnown{".exr", ".hdr", ".tif", ".tiff",
                                                ".png", ".jpg", ".jpeg"};
    const std::string extension = lowerExtension(file);
    if (std::find(kKnown.begin(), kKnown.end(), extension) != kKnown.end()) return;
    refuseFile(file, extension.empty() ? "a name without extension" : "a file named " + extension,
               "an environment named .exr, .hdr, .tif, .tiff, .png, .jpg or .jpeg");
}

bool isGrey(const ImageSpec& spec) {
    return spec.nchannels == 1 || (spec.nchannels == 2 && spec.alpha_channel == 1);
}

void requireLatlong(const std::filesystem::path& file, const ImageSpec& spec) {
    const std::string size = std::to_string(spec.width) + "x" + std::to_string(spec.height);
    if (spec.width != 2 * std::int64_t{spec.height}) {
        refuseFile(file, size + " pixels", "a lat-long picture, twice as wide as high");
    }
    if (spec.x != spec.full_x || spec.y != spec.full_y || spec.width != spec.full_width ||
        spec.height != spec.full_height) {
        refuseFile(file,
                   size + " pixels of a picture of " + std::to_string(spec.full_width) + "x" +
                       std::to_string(spec.full_height),
                   "a whole picture");
    }
    if (!isGrey(spec) && !hasColors(spec)) {
        refuseFile(file, sizeText(spec), "the channels R, G and B, or one");
    }
}

bool isWhole(const TypeDesc& type) {
    return type != TypeDesc::HALF && type != TypeDesc::FLOAT && type != TypeDesc::DOUBLE;
}

void warnOfLosses(const std::filesystem::path& file, const ImageSpec& spec,
                  const Listener& listener) {
    if (isWhole(spec.format)) {
        listener.warn(file.string() + ": whole numbers are read as sRGB, which ends at 1: " +
                      "what is brighter, as the sun is, has lost its light");
    }
    // OpenEXR's order: x and y of red, green, blue and white.
    constexpr std::array<float, 8> kRec709{0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f};
    std::array<float, 8> primaries = kRec709;
    spec.getattribute("chromaticities", TypeDesc(TypeDesc::FLOAT, 8), primaries.data());
    for (std::size_t i = 0; i < primaries.size(); ++i) {
        if (std::abs(primaries[i] - kRec709[i]) < 0.005f) continue;
        listener.warn(file.string() + ": colours of other primaries are read as Rec. 709's");
        return;
    }
}

// Grey becomes three equal channels.
std::vector<float> readColors(const std::filesystem::path& file, ImageFile& image) {
    const ImageSpec& spec = image.spec();
    const std::size_t pixels = std::size_t(spec.width) * std::size_t(spec.height);
    const int channels = isGrey(spec) ? 1 : 3;
    const double bytes = 12 + channels * (4 + double(spec.format.size()));
    requireClaimedMemory(file.string(), double(pixels) * bytes);
    std::vector<float> values(pixels * std::size_t(channels));
    image.read(channels, TypeDesc::FLOAT, values.data());
    if (channels == 3) return values;
    std::vector<float> rgb(pixels * 3);
    for (std::size_t i = 0; i < pixels; ++i) std::fill_n(&rgb[3 * i], 3, values[i]);
    return rgb;
}

// Decodes integers from sRGB, sets negative values to 0, and refuses invalid pictures.
void mendValues(const std::filesystem::path& file, bool whole, std::vector<float>& values,
                const Listener& listener) {
    std::atomic<std::size_t> odd = 0, negative = 0;
    std::atomic<bool> anyLight = false;
    parallelForChunks(values.size(), [&](std::size_t begin, std::size_t end) {
        std::size_t oddHere = 0, negativeHere = 0;
        bool lightHere = false;
        for (std::size_t i = begin; i < end; ++i) {
            float& value = values[i];
            oddHere += !std::isfinite(value);
            negativeHere += value < 0;
            if (!(value > 0)) value = 0;
            if (whole) value = float(linearFromSrgb(double(value)));
            lightHere = lightHere || value > 0;
        }
        odd += oddHere;
        negative += negativeHere;
        if (lightHere) anyLight = true;
    });
    const std::string all = " of " + std::to_string(values.size()) + " values";
    if (odd > 0) {
        refuseFile(file, std::to_string(odd) + all + " that are not finite", "how bright they are");
    }
    if (!anyLight) refuseFile(file, "a picture without light", "a value above 0");
    if (negative == 0) return;
    listener.warn(file.string() + ": " + std::to_string(negative) + all +
                  " are below 0, and count as 0");
}

}  // namespace

Environment image_module::readEnvironment(const std::filesystem::path& file,
                                          const Listener& listener) {
    const DefaultFloats floats;
    requireKnownName(file);
    ImageFile image(file, ImagePages(file), 0);
    const ImageSpec& spec = image.spec();
    requireSane(file, spec);
    requireLatlong(file, spec);
    warnOfLosses(file, spec, listener);
    Environment environment;
    environment.sizePixels = {spec.width, spec.height};
    environment.rgb = readColors(file, image);
    mendValues(file, isWhole(spec.format), environment.rgb, listener);
    return environment;
}

}  // namespace deltasplat
