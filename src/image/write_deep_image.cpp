// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/image/write_deep_image.h"

#include <OpenImageIO/deepdata.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "default_floats.h"
#include "deltasplat/atomic_file.h"
#include "deltasplat/error.h"
#include "image/encode_image.h"
#include "memory.h"
#include "parallel.h"

namespace deltasplat {
namespace {

constexpr int kChannels = 6;
// Rows that are handed over at once: enough for all threads to pack some.
constexpr int kBand = 64;
// The encoded samples, and their copy that is written: each takes no more than the samples do.
constexpr double kEncodedCopies = 2;

void requireExr(const std::filesystem::path& file) {
    if (imageFormatOf(file) == ImageFormat::kExr) return;
    throw Error(ErrorCode::kUsage, gotExpected(file.string(), "a deep picture", "an .exr file"));
}

OIIO::ImageSpec deepSpec(glm::ivec2 size, const ImageFileOptions& options) {
    const OIIO::TypeDesc color = options.floatExr ? OIIO::TypeFloat : OIIO::TypeHalf;
    OIIO::ImageSpec spec(size.x, size.y, kChannels, color);
    spec.deep = true;
    spec.channelnames = {"R", "G", "B", "A", "Z", "ZBack"};
    spec.channelformats = {color, color, color, color, OIIO::TypeFloat, OIIO::TypeFloat};
    spec.alpha_channel = 3;
    spec.z_channel = 4;
    // What deep pictures may have, besides run lengths.
    spec.attribute("compression", "zips");
    addExrAttributes(options, spec);
    return spec;
}

// How values are stored.
class Stored {
  public:
    explicit Stored(bool asFloat)
        : largest_(asFloat ? std::numeric_limits<float>::max() : 65504.0f),
          nothing_(asFloat ? 0.0f : 0x1p-25f) {}

    float of(float value) const {
        return std::isnan(value) ? 0.0f : std::clamp(value, -largest_, largest_);
    }
    // Whether no channel of the sample becomes anything but 0.
    bool isNothing(const DeepSample& sample) const {
        const auto isNone = [&](float value) { return !(std::abs(value) > nothing_); };
        return isNone(sample.rgba.r) && isNone(sample.rgba.g) && isNone(sample.rgba.b) &&
               isNone(sample.rgba.a);
    }

  private:
    float largest_;
    float nothing_;  // what is rounded to 0
};

// Rows [first, last) as OpenImageIO has them.
class Band {
  public:
    Band(const DeepImage& image, int first, int last, const OIIO::ImageSpec& spec,
         const Stored& stored)
        : image_(image), first_(first), width_(image.size.x), stored_(stored) {
        const auto rows = std::size_t(last - first);
        data_.init(std::int64_t{width_} * (last - first), kChannels, spec.channelformats,
                   spec.channelnames);
        std::vector<unsigned> counts(rows * std::size_t(width_));
        parallelFor(counts.size() / std::size_t(width_), [&](std::size_t row) {
            for (int x = 0; x < width_; ++x)
                counts[row * std::size_t(width_) + std::size_t(x)] = countOf({x, int(row)});
        });
        data_.set_all_samples(counts);
        // Makes room for all at once, before threads ask for some.
        data_.all_data();
        parallelFor(rows, [&](std::size_t row) {
            for (int x = 0; x < width_; ++x) fill({x, int(row)});
        });
    }

    const OIIO::DeepData& data() const { return data_; }

  private:
    unsigned countOf(glm::ivec2 pixel) const {
        const auto samples = image_.pixel(pixel.x, first_ + pixel.y);
        return unsigned(
            std::count_if(samples.begin(), samples.end(),
                          [&](const DeepSample& sample) { return !stored_.isNothing(sample); }));
    }

    void fill(glm::ivec2 pixel) {
        const std::int64_t number = std::int64_t{width_} * pixel.y + pixel.x;
        int next = 0;
        for (const DeepSample& sample : image_.pixel(pixel.x, first_ + pixel.y)) {
            if (stored_.isNothing(sample)) continue;
            for (int c = 0; c < 4; ++c)
                data_.set_deep_value(number, c, next, stored_.of(sample.rgba[c]));
            data_.set_deep_value(number, 4, next, sample.z);
            data_.set_deep_value(number, 5, next, sample.zBack);
            ++next;
        }
    }

    const DeepImage& image_;
    int first_;
    int width_;
    const Stored& stored_;
    OIIO::DeepData data_;
};

bool writeBands(OIIO::ImageOutput& output, const DeepImage& image, const OIIO::ImageSpec& spec,
                const Stored& stored) {
    for (int first = 0; first < image.size.y; first += kBand) {
        const int last = std::min(first + kBand, image.size.y);
        const Band band(image, first, last, spec, stored);
        if (!output.write_deep_scanlines(first, last, 0, band.data())) return false;
    }
    return true;
}

}  // namespace

void checkDeepImageFile(const std::filesystem::path& file, glm::ivec2 sizePixels,
                        const ImageFileOptions& options) {
    requireExr(file);
    checkImageFile(file, sizePixels, options);
}

std::string encodeDeepImage(const std::filesystem::path& file, const DeepImage& image,
                            const ImageFileOptions& options) {
    const DefaultFloats floats;
    requireExr(file);
    if (image.size.x < 1 || image.size.y < 1) {
        throw Error(ErrorCode::kUsage, gotExpected(file.string(),
                                                   std::to_string(image.size.x) + "x" +
                                                       std::to_string(image.size.y) + " pixels",
                                                   "at least 1x1"));
    }
    const double sampleBytes = options.floatExr ? 24 : 16;
    requireMemory(file.string() + ", " + std::to_string(image.samples()) + " samples",
                  kEncodedCopies * sampleBytes * double(image.samples()));
    const OIIO::ImageSpec spec = deepSpec(image.size, options);
    const Stored stored(options.floatExr);
    return encodeInMemory(file, "openexr", spec, [&](OIIO::ImageOutput& output) {
        return writeBands(output, image, spec, stored);
    });
}

void writeDeepImage(const std::filesystem::path& file, const DeepImage& image,
                    const ImageFileOptions& options) {
    writeFileAtomically(file, encodeDeepImage(file, image, options));
}

}  // namespace deltasplat
