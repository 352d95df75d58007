// SPDX-License-Identifier: Apache-2.0
#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDeepFrameBuffer.h>
#include <OpenEXR/ImfDeepScanLineOutputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "base/parallel.h"
#include "deltasplat/image/deep_image.h"
#include "image/encode_exr.h"
#include "image/exr_header.h"
#include "image/quantize.h"

namespace deltasplat {
namespace {

/// Appends a pixel's samples in stored form: NaN becomes 0, other values finite, and empty samples
/// are dropped. Halves are rounded so that the composited pixel stays right: each compensates for
/// earlier rounding. Alpha below 1 stays below 1 if samples follow.
/// @param samples  front to back
/// @param asFloat  colour and alpha as floats instead of halves
void addStored(std::span<const DeepSample> samples, bool asFloat, std::vector<DeepSample>& stored);

namespace {

constexpr float kBelowOne = 1 - 0x1p-11f;  // the largest half below 1

glm::vec4 finite(const glm::vec4& color, float largest) {
    glm::vec4 result;
    for (int c = 0; c < 4; ++c) result[c] = finiteValue(color[c], largest);
    return result;
}

// Rounds to 11 significant bits, or to multiples of 2^-24.
float roundedToHalf(double value) {
    if (value == 0) return 0;
    const double step = std::ldexp(1.0, std::max(std::ilogb(value), -14) - 10);
    return float(std::clamp(std::nearbyint(value / step) * step, -double(kLargestHalf),
                            double(kLargestHalf)));
}

// Clamps to the intended sign; 0 stays 0.
double ofSameSign(double value, float meant) {
    return meant > 0 ? std::max(value, 0.0) : meant < 0 ? std::min(value, 0.0) : 0.0;
}

class HalfRounder {
  public:
    glm::vec4 rounded(const glm::vec4& color, bool isLast) {
        whole_ += (1 - whole_.a) * glm::dvec4(color);
        const double left = 1 - shown_.a;
        glm::dvec4 wanted(color);
        if (left > 0) wanted = (whole_ - shown_) / left;
        glm::vec4 result;
        for (int c = 0; c < 4; ++c) result[c] = roundedToHalf(ofSameSign(wanted[c], color[c]));
        if (color.a < 1 && !isLast) result.a = std::min(result.a, kBelowOne);
        shown_ += left * glm::dvec4(result);
        return result;
    }

  private:
    glm::dvec4 whole_{0.0};
    glm::dvec4 shown_{0.0};
};

}  // namespace

void addStored(std::span<const DeepSample> samples, bool asFloat, std::vector<DeepSample>& stored) {
    const float largest = asFloat ? std::numeric_limits<float>::max() : kLargestHalf;
    HalfRounder halves;
    for (const DeepSample& sample : samples) {
        glm::vec4 color = finite(sample.rgba, largest);
        if (!asFloat) color = halves.rounded(color, &sample == &samples.back());
        if (color != glm::vec4(0)) stored.push_back({color, sample.z, sample.zBack});
    }
}

}  // namespace

namespace {

constexpr std::array<const char*, 6> kChannels{"R", "G", "B", "A", "Z", "ZBack"};
constexpr std::size_t kColors = 4;
// Rows per write, enough for all threads to compress.
constexpr int kBand = 64;

template <typename Color>
struct StoredSample {
    std::array<Color, kColors> rgba;
    std::array<float, 2> z;
};

Imf::PixelType typeOf(half) {
    return Imf::HALF;
}
Imf::PixelType typeOf(float) {
    return Imf::FLOAT;
}

// Rows for OpenEXR: per pixel the number of samples, per channel the first one's address.
template <typename Color>
class Band {
  public:
    Band(const DeepImage& image, const PixelBox& part)
        : width_(std::size_t(part.size().x)), rows_(std::size_t(part.size().y)) {
        counts_.resize(width_ * rows_.size());
        for (auto& first : firsts_) first.resize(counts_.size());
        parallelFor(rows_.size(), [&](std::size_t y) { fillRow(image, part, y); });
    }

    // @param first  the first pixel's place in the file's data window
    Imf::DeepFrameBuffer at(const Imath::V2i& first) {
        // OpenEXR's base address is that of pixel 0, 0.
        const auto base = [&](auto& values) {
            const std::ptrdiff_t before = first.y * std::ptrdiff_t(width_) + first.x;
            return reinterpret_cast<char*>(values.data()) -
                   before * std::ptrdiff_t(sizeof values[0]);
        };
        const auto strides = [&](const auto& values) {
            return std::array{sizeof values[0], sizeof values[0] * width_};
        };
        Imf::DeepFrameBuffer pixels;
        const auto [countX, countY] = strides(counts_);
        pixels.insertSampleCountSlice({Imf::UINT, base(counts_), countX, countY});
        for (std::size_t c = 0; c < kChannels.size(); ++c) {
            const auto [x, y] = strides(firsts_[c]);
            const Imf::PixelType type = c < kColors ? typeOf(Color()) : Imf::FLOAT;
            pixels.insert(kChannels[c], Imf::DeepSlice(type, base(firsts_[c]), x, y,
                                                       sizeof(StoredSample<Color>)));
        }
        return pixels;
    }

  private:
    void fillRow(const DeepImage& image, const PixelBox& part, std::size_t y) {
        std::vector<DeepSample> samples;
        for (std::size_t x = 0; x < width_; ++x) {
            const std::size_t before = samples.size();
            addStored(image.pixel(part.min.x + int(x), part.min.y + int(y)),
                      std::is_same_v<Color, float>, samples);
            counts_[y * width_ + x] = unsigned(samples.size() - before);
        }
        std::vector<StoredSample<Color>>& row = rows_[y];
        for (const DeepSample& sample : samples) {
            const glm::vec4& c = sample.rgba;
            row.push_back(
                {{Color(c.r), Color(c.g), Color(c.b), Color(c.a)}, {sample.z, sample.zBack}});
        }
        StoredSample<Color>* next = row.data();
        for (std::size_t i = y * width_; i < (y + 1) * width_; next += counts_[i++]) {
            if (counts_[i] == 0) continue;
            for (std::size_t c = 0; c < kColors; ++c) firsts_[c][i] = &next->rgba[c];
            for (std::size_t c = 0; c < 2; ++c) firsts_[kColors + c][i] = &next->z[c];
        }
    }

    std::size_t width_;
    std::vector<std::vector<StoredSample<Color>>> rows_;
    std::vector<unsigned> counts_;                             // [height][width]
    std::array<std::vector<void*>, kChannels.size()> firsts_;  // the same
};

template <typename Color>
void writeBands(const DeepImage& image, const PixelBox& box, Imf::Header header, Imf::OStream& to) {
    header.setType(Imf::DEEPSCANLINE);
    for (std::size_t c = 0; c < kChannels.size(); ++c)
        header.channels().insert(kChannels[c],
                                 Imf::Channel(c < kColors ? typeOf(Color()) : Imf::FLOAT));
    Imf::DeepScanLineOutputFile file(to, header);
    Imath::V2i place = header.dataWindow().min;
    for (int first = box.min.y; first < box.max.y; first += kBand) {
        const int last = std::min(first + kBand, box.max.y);
        Band<Color> band(image, {{box.min.x, first}, {box.max.x, last}});
        file.setFrameBuffer(band.at(place));
        file.writePixels(last - first);
        place.y += last - first;
    }
}

}  // namespace

std::string encodeDeepExr(const std::filesystem::path& file, const DeepImage& image,
                          const ImageFileOptions& options) {
    const PixelBox box =
        storedBox(options, image.size, [&](const PixelBox& part) { return seenBox(image, part); });
    ExrMemoryStream memory(file);
    writeExr(file, [&] {
        // The best compression that deep pictures allow.
        const Imf::Header header = exrHeader(options, image.size, box, "zips");
        options.floatExr ? writeBands<float>(image, box, header, memory)
                         : writeBands<half>(image, box, header, memory);
    });
    return memory.takeBytes();
}

}  // namespace deltasplat
