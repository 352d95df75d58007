// SPDX-License-Identifier: Apache-2.0

#include <OpenImageIO/deepdata.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <exception>
#include <vector>

#include "base/parallel.h"
#include "base/silent_stderr.h"
#include "deltasplat/error.h"
#include "formats/images/image_claims.h"
#include "image/quantize.h"
#include "image/srgb.h"
#include "modules/image_module.h"
#include "oiio/encode_image.h"
#include "oiio/image_file.h"

namespace deltasplat {

namespace {

constexpr const char* kCompression = "jpeg:85";
// Steps of a table of sRGB that includes all 8-bit levels.
constexpr int kSteps = 255 * 16;

float linearOf(float level) {
    static const std::vector<float> table = [] {
        std::vector<float> values;
        for (int i = 0; i <= kSteps; ++i)
            values.push_back(float(linearFromSrgb(double(i) / kSteps)));
        return values;
    }();
    return table[std::size_t(std::lround(std::clamp(level, 0.0F, 1.0F) * kSteps))];
}

// Returns the premultiplied linear light of a pixel with one, three or four channels.
std::array<float, 4> lightOf(const float* pixel, int channels, bool isLight) {
    std::array<float, 4> rgba{};
    for (int c = 0; c < 3; ++c) rgba[std::size_t(c)] = pixel[channels >= 3 ? c : 0];
    rgba[3] = channels >= 4 ? pixel[3] : 1;
    if (!isLight)
        for (std::size_t c = 0; c < 3; ++c) rgba[c] = linearOf(rgba[c]) * rgba[3];
    for (float& value : rgba) value = finiteValue(value);
    return rgba;
}

class Shrinker {
  public:
    Shrinker(const OIIO::ImageSpec& spec, int mostSide)
        : size_(std::max(spec.full_width, 1), std::max(spec.full_height, 1)),
          first_(glm::i64vec2(spec.x, spec.y) - glm::i64vec2(spec.full_x, spec.full_y)),
          step_((std::max(size_.x, size_.y) - 1) / mostSide + 1),
          image_((size_ - 1) / step_ + 1) {}

    // @param y  counted from the file's first row
    void add(int y, const float* row, int width, int channels, bool isLight) {
        const std::int64_t line = first_.y + y;
        if (line < 0 || line >= size_.y) return;
        for (int x = 0; x < width; ++x) {
            const std::int64_t column = first_.x + x;
            if (column < 0 || column >= size_.x) continue;
            const auto rgba = lightOf(row + std::ptrdiff_t{channels} * x, channels, isLight);
            float* sum = image_.pixel(int(column / step_), int(line / step_));
            for (std::size_t c = 0; c < 4; ++c) sum[c] += rgba[c];
        }
    }

    Image take() {
        for (int y = 0; y < image_.size.y; ++y) {
            for (int x = 0; x < image_.size.x; ++x) {
                const glm::ivec2 rest = size_ - step_ * glm::ivec2(x, y);
                const float count = float(std::min(step_, rest.x)) * float(std::min(step_, rest.y));
                for (int c = 0; c < 4; ++c) image_.pixel(x, y)[c] /= count;
            }
        }
        return std::move(image_);
    }

  private:
    glm::ivec2 size_;
    glm::i64vec2 first_;
    int step_;
    Image image_;
};

Image shrunk(OIIO::ImageInput& input, int mostSide) {
    const OIIO::ImageSpec spec = input.spec();
    if (spec.deep || spec.tile_width > 0 || spec.nchannels < 1 || spec.depth > 1) return {};
    Shrinker shrinker(spec, mostSide);
    const int channels = std::min(spec.nchannels, 4);
    const bool isLight = std::string(input.format_name()) == "openexr";
    constexpr int kRows = 64;
    const std::size_t rowSize = std::size_t(spec.width) * std::size_t(channels);
    std::vector<float> rows(rowSize * kRows);
    for (int y = 0; y < spec.height; y += kRows) {
        const int end = std::min(y + kRows, spec.height);
        if (!input.read_scanlines(0, 0, spec.y + y, spec.y + end, 0, 0, channels, OIIO::TypeFloat,
                                  rows.data()))
            return {};
        for (int line = y; line < end; ++line) {
            shrinker.add(line, &rows[rowSize * std::size_t(line - y)], spec.width, channels,
                         isLight);
        }
    }
    return shrinker.take();
}

}  // namespace

Image image_module::readThumbnail(const std::filesystem::path& file, int mostSide) {
    const DefaultFloats floats;
    OIIO::ImageSpec asStored;
    asStored.attribute("oiio:UnassociatedAlpha", 1);
    try {
        limitExrThreads(requireClaims(file));
    } catch (const Error&) {
        return {};
    }
    const auto input = OIIO::ImageInput::open(file.string(), &asStored);
    Image image = input ? shrunk(*input, mostSide) : Image();
    // OpenImageIO prints unread errors when the thread ends.
    if (input) (void)input->geterror();
    (void)OIIO::geterror();
    return image;
}

std::string image_module::encodeThumbnail(const Image& image) {
    const DefaultFloats floats;
    OIIO::ImageSpec spec(image.size.x, image.size.y, 3, OIIO::TypeUInt8);
    spec.attribute("compression", kCompression);
    spec.attribute("oiio:ColorSpace", "sRGB");
    const UnclearedVector<std::uint8_t> samples = opaqueSrgb(image, false);
    return encodeInMemory("thumbnail.jpg", "jpeg", spec, [&](OIIO::ImageOutput& output) {
        return output.write_image(OIIO::TypeUInt8, samples.data());
    });
}

namespace {

bool isReadable(const std::filesystem::path& file, OIIO::ImageInput& input) {
    const OIIO::ImageSpec spec = input.spec();
    if (spec.deep) {
        OIIO::DeepData pixels;
        return input.read_native_deep_image(0, 0, pixels);
    }
    requireSane(file, spec);
    std::vector<char> pixels(spec.image_bytes(true));
    return input.read_image(0, 0, 0, spec.nchannels, OIIO::TypeUnknown, pixels.data());
}

}  // namespace

bool image_module::isWholeImage(const std::filesystem::path& file) {
    bool isWhole = false;
    const SilentStderr silent;
    try {
        limitExrThreads(requireClaims(file));
        const auto input = OIIO::ImageInput::open(file.string());
        isWhole = input && isReadable(file, *input) && !input->has_error();
        if (input) (void)input->geterror();
    } catch (const std::exception&) {
        isWhole = false;
    }
    // OpenImageIO prints unread errors when the thread ends.
    (void)OIIO::geterror();
    return isWhole;
}

}  // namespace deltasplat
