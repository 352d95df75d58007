// SPDX-License-Identifier: Apache-2.0
#include "image/exr_pixels.h"

#include <OpenEXR/ImfChannelList.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#include "base/parallel.h"
#include "image/quantize.h"

namespace deltasplat {
namespace {

constexpr std::size_t kChannels = 4;
constexpr const char* kNames[kChannels]{"R", "G", "B", "A"};

// Whether all channels of a pixel are 0, without a sign.
bool isClear(const float* pixel) {
    std::uint64_t bits[2];
    std::memcpy(bits, pixel, sizeof bits);
    return (bits[0] | bits[1]) == 0;
}

template <typename Value>
std::vector<Value> finite(const Image& image, const PixelBox& box, float largest) {
    const std::size_t rowValues = kChannels * std::size_t(box.size().x);
    std::vector<Value> values(rowValues * std::size_t(box.size().y));
    parallelFor(std::size_t(box.size().y), [&](std::size_t y) {
        const float* const from = image.pixel(box.min.x, box.min.y + int(y));
        Value* const to = &values[rowValues * y];
        for (std::size_t i = 0; i < rowValues; i += kChannels) {
            // Most pictures are clear for the most part, as values are already.
            if (isClear(from + i)) continue;
            for (std::size_t c = i; c < i + kChannels; ++c)
                to[c] = Value(finiteValue(from[c], largest));
        }
    });
    return values;
}

}  // namespace

void addRgba(bool asFloat, Imf::Header& header) {
    for (const char* name : kNames)
        header.channels().insert(name, Imf::Channel(asFloat ? Imf::FLOAT : Imf::HALF));
}

ExrRgba::ExrRgba(const Image& image, const PixelBox& box, bool asFloat) : size_(box.size()) {
    if (asFloat) {
        floats_ = finite<float>(image, box, std::numeric_limits<float>::max());
    } else {
        halves_ = finite<half>(image, box, kLargestHalf);
    }
}

Imf::FrameBuffer ExrRgba::at(const Imath::V2i& first) const {
    Imf::FrameBuffer pixels;
    for (std::size_t c = 0; c < kChannels; ++c) {
        const auto insert = [&](Imf::PixelType type, const auto& values) {
            const std::size_t stride = kChannels * sizeof values[0];
            pixels.insert(kNames[c], Imf::Slice::Make(type, &values[c], first, size_.x, size_.y,
                                                      stride, stride * std::size_t(size_.x)));
        };
        halves_.empty() ? insert(Imf::FLOAT, floats_) : insert(Imf::HALF, halves_);
    }
    return pixels;
}

std::vector<float> exrPlane(const std::vector<float>& values, const PixelBox& box, int width) {
    const auto columns = std::size_t(box.size().x);
    std::vector<float> plane(columns * std::size_t(box.size().y));
    parallelFor(std::size_t(box.size().y), [&](std::size_t y) {
        const float* const from =
            &values[(std::size_t(box.min.y) + y) * std::size_t(width) + std::size_t(box.min.x)];
        for (std::size_t x = 0; x < columns; ++x) plane[columns * y + x] = finiteValue(from[x]);
    });
    return plane;
}

}  // namespace deltasplat
