// SPDX-License-Identifier: Apache-2.0
#include <OpenImageIO/deepdata.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <string>
#include <vector>

#include "image/encode_image.h"
#include "image/seen_box.h"
#include "image/stored_samples.h"
#include "modules/image_module.h"
#include "parallel.h"

namespace deltasplat {
namespace {

constexpr int kChannels = 6;
// Rows that are handed over at once: enough for all threads to pack some.
constexpr int kBand = 64;

OIIO::ImageSpec deepSpec(glm::ivec2 size, const ImageFileOptions& options) {
    const OIIO::TypeDesc color = options.floatExr ? OIIO::TypeFloat : OIIO::TypeHalf;
    OIIO::ImageSpec spec(size.x, size.y, kChannels, color);
    spec.deep = true;
    spec.channelnames = {"R", "G", "B", "A", "Z", "ZBack"};
    spec.channelformats = {color, color, color, color, OIIO::TypeFloat, OIIO::TypeFloat};
    spec.alpha_channel = 3;
    spec.z_channel = 4;
    addExrAttributes(options, spec);
    return spec;
}

// Pixels as OpenImageIO has them.
class Band {
  public:
    Band(const DeepImage& image, const PixelBox& part, const OIIO::ImageSpec& spec, bool asFloat)
        : width_(part.size().x), rows_(std::size_t(part.size().y)) {
        data_.init(std::int64_t{width_} * part.size().y, kChannels, spec.channelformats,
                   spec.channelnames);
        std::vector<unsigned> counts(rows_.size() * std::size_t(width_));
        parallelFor(rows_.size(), [&](std::size_t y) {
            unsigned* count = &counts[y * std::size_t(width_)];
            for (int x = 0; x < width_; ++x) {
                const std::size_t before = rows_[y].size();
                addStored(image.pixel(part.min.x + x, part.min.y + int(y)), asFloat, rows_[y]);
                *count++ = unsigned(rows_[y].size() - before);
            }
        });
        data_.set_all_samples(counts);
        // Makes room for all at once, before threads ask for some.
        data_.all_data();
        parallelFor(rows_.size(), [&](std::size_t y) { fillRow(y); });
    }

    const OIIO::DeepData& data() const { return data_; }

  private:
    void fillRow(std::size_t y) {
        const DeepSample* sample = rows_[y].data();
        for (int x = 0; x < width_; ++x) {
            const std::int64_t pixel = std::int64_t(y) * width_ + x;
            const int count = data_.samples(pixel);
            for (int s = 0; s < count; ++s, ++sample) {
                for (int c = 0; c < 4; ++c) data_.set_deep_value(pixel, c, s, sample->rgba[c]);
                data_.set_deep_value(pixel, 4, s, sample->z);
                data_.set_deep_value(pixel, 5, s, sample->zBack);
            }
        }
    }

    int width_;
    std::vector<std::vector<DeepSample>> rows_;
    OIIO::DeepData data_;
};

bool writeBands(OIIO::ImageOutput& output, const DeepImage& image, const PixelBox& box,
                const OIIO::ImageSpec& spec, bool asFloat) {
    for (int first = box.min.y; first < box.max.y; first += kBand) {
        const int last = std::min(first + kBand, box.max.y);
        const Band band(image, {{box.min.x, first}, {box.max.x, last}}, spec, asFloat);
        const int y = spec.y - box.min.y;
        if (!output.write_deep_scanlines(y + first, y + last, 0, band.data())) return false;
    }
    return true;
}

}  // namespace

std::string image_module::encodeDeepImage(const std::filesystem::path& file, const DeepImage& image,
                                          const ImageFileOptions& options) {
    const PixelBox box =
        storedBox(options, image.size, [&](const PixelBox& part) { return seenBox(image, part); });
    OIIO::ImageSpec spec = deepSpec(box.size(), options);
    setWindows(options.exr, image.size, box.min, spec);
    return encodeInMemory(file, "openexr", spec, [&](OIIO::ImageOutput& output) {
        return writeBands(output, image, box, spec, options.floatExr);
    });
}

}  // namespace deltasplat
