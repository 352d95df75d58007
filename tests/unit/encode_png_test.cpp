// SPDX-License-Identifier: Apache-2.0
// Pictures of more than one block, read back by another's reader.
#include "image/encode_png.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <random>
#include <vector>

#include "deltasplat/threads.h"
#include "image/quantize.h"
#include "image/srgb.h"
#include "unit/temp_folder.h"

namespace deltasplat {
namespace {

template <typename Sample>
PngPicture pictureOf(const std::vector<Sample>& samples, glm::ivec2 size, int rowPixels) {
    return {size, 8 * int(sizeof(Sample)), samples.data(), 4 * sizeof(Sample) * rowPixels, {}};
}

template <typename Sample>
std::vector<Sample> readBack(const std::string& bytes, glm::ivec2 size) {
    const test::TempFolder folder;
    std::ofstream(folder / "in.png", std::ios::binary) << bytes;
    const auto input = OIIO::ImageInput::open((folder / "in.png").string());
    EXPECT_TRUE(input) << OIIO::geterror();
    if (!input) return {};
    EXPECT_EQ(glm::ivec2(input->spec().width, input->spec().height), size);
    std::vector<Sample> samples(std::size_t{4} * size.x * size.y);
    // Straight alpha, as it is stored.
    OIIO::ImageSpec asStored;
    asStored.attribute("oiio:UnassociatedAlpha", 1);
    const auto again = OIIO::ImageInput::open((folder / "in.png").string(), &asStored);
    EXPECT_TRUE(again->read_image(0, 0, 0, 4, OIIO::BaseTypeFromC<Sample>::value, samples.data()))
        << again->geterror();
    return samples;
}

// Noise, ramps, lines, and nothing: each filter is the best somewhere.
template <typename Sample>
std::vector<Sample> someSamples(glm::ivec2 size) {
    std::mt19937 random(3);
    std::vector<Sample> samples;
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            for (int c = 0; c < 4; ++c) {
                const int part = (y / 37 + c) % 5;
                samples.push_back(part == 0   ? Sample(random())
                                  : part == 1 ? Sample(x * 3 + y * 7)
                                  : part == 2 ? Sample(x * 1000 / (y + 1))
                                  : part == 3 ? Sample(x % 16 == y % 16 ? 255 : 0)
                                              : Sample(0));
            }
        }
    }
    return samples;
}

template <typename Sample>
void expectReadBack(glm::ivec2 size) {
    const std::vector<Sample> samples = someSamples<Sample>(size);
    const std::string bytes = encodePng(pictureOf(samples, size, size.x));
    EXPECT_EQ(readBack<Sample>(bytes, size), samples) << size.x << "x" << size.y;
    const ThreadLimit limit(1);
    EXPECT_TRUE(encodePng(pictureOf(samples, size, size.x)) == bytes) << "one thread";
}

TEST(EncodePng, isReadBackWhateverItsSize) {
    for (const glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(3, 200), glm::ivec2(701, 403)}) {
        expectReadBack<std::uint8_t>(size);
        expectReadBack<std::uint16_t>(size);
    }
    // A row longer than a block, and rows that end with one.
    expectReadBack<std::uint16_t>({50'001, 3});
    expectReadBack<std::uint8_t>({(1 << 16) / 4 - 1, 33});
    expectReadBack<std::uint8_t>({1023, 1024});
}

TEST(EncodePng, takesAPartOfAPicture) {
    const glm::ivec2 size(90, 50);
    const auto samples = someSamples<std::uint16_t>(size);
    PngPicture picture = pictureOf(samples, {20, 7}, size.x);
    picture.samples = &samples[std::size_t(4) * std::size_t(11 * size.x + 60)];
    const auto part = readBack<std::uint16_t>(encodePng(picture), {20, 7});
    for (int y = 0; y < 7; ++y) {
        for (int i = 0; i < 80; ++i)
            ASSERT_EQ(part[std::size_t(80 * y + i)],
                      samples[std::size_t(4 * ((11 + y) * size.x + 60) + i)]);
    }
}

TEST(EncodePng, keepsTexts) {
    const test::TempFolder folder;
    const std::vector<std::uint8_t> samples(4, 7);
    PngPicture picture = pictureOf(samples, {1, 1}, 1);
    picture.texts = {{"deltasplat:a", "plain\ntext"}, {"deltasplat:b", "na\xC3\xAFve"}, {"c", ""}};
    std::ofstream(folder / "in.png", std::ios::binary) << encodePng(picture);
    const auto input = OIIO::ImageInput::open((folder / "in.png").string());
    ASSERT_TRUE(input) << OIIO::geterror();
    EXPECT_EQ(input->spec().get_string_attribute("deltasplat:a"), "plain\ntext");
    EXPECT_EQ(input->spec().get_string_attribute("deltasplat:b"), "na\xC3\xAFve");
    EXPECT_EQ(input->spec().get_string_attribute("oiio:ColorSpace"), "sRGB");
}

// What a table knows of the curve changes no sample.
template <typename Sample>
void expectOfTheCurve() {
    constexpr int kCount = 1 << 20;
    Image image({kCount / 2, 2});
    for (int i = 0; i < kCount; ++i) {
        float* const rgba = &image.rgba[std::size_t{4} * std::size_t(i)];
        // All of it, and its dark end more closely.
        rgba[0] = float(i) / (kCount - 1);
        rgba[1] = float(std::exp2(-14.0 * i / (kCount - 1)));
        rgba[2] = 0.0031308f + (float(i) / kCount - 0.5f) * 2e-5f;
        rgba[3] = 1;
    }
    const UnclearedVector<Sample> samples = straightSrgb<Sample>(image);
    constexpr double kMost = std::numeric_limits<Sample>::max();
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const double level = srgbFromLinear(double(image.rgba[i]));
        ASSERT_EQ(samples[i], i % 4 == 3 ? Sample(kMost) : Sample(std::floor(level * kMost + 0.5)))
            << image.rgba[i];
    }
}

TEST(Quantize, roundsAsTheCurveItselfDoes) {
    expectOfTheCurve<std::uint8_t>();
    expectOfTheCurve<std::uint16_t>();
}

}  // namespace
}  // namespace deltasplat
