// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/image/tone.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "deltasplat/threads.h"
#include "support/error_of.h"

namespace deltasplat {
namespace {

using test::errorOf;
using Pixel = std::array<float, 4>;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kMost = std::numeric_limits<float>::max();

Image pictureOf(const std::vector<Pixel>& pixels) {
    Image image({int(pixels.size()), 1});
    for (std::size_t i = 0; i < pixels.size(); ++i)
        std::copy(pixels[i].begin(), pixels[i].end(), &image.rgba[4 * i]);
    return image;
}

Pixel pixelOf(const Image& image) {
    return {image.rgba[0], image.rgba[1], image.rgba[2], image.rgba[3]};
}

Pixel toned(const Pixel& pixel) {
    Image image = pictureOf({pixel});
    toneFilmic(image);
    return pixelOf(image);
}

Pixel exposed(const Pixel& pixel, double stops) {
    Image image = pictureOf({pixel});
    expose(image, stops);
    return pixelOf(image);
}

// Reckoned in fractions from the published matrices and curve, of 1.462 times the light. The
// published blue row adds up to 0.99999.
TEST(ToneFilmic, IsHillsFit) {
    const struct {
        float light[3];
        double shown[3];
    } known[] = {
        {{0.002f, 0.002f, 0.002f}, {0, 0, 0}},
        {{0.0023f, 0.0023f, 0.0023f}, {1.43e-05, 1.43e-05, 1.43e-05}},
        {{0.01f, 0.01f, 0.01f}, {0.0019726, 0.0019726, 0.0019726}},
        {{0.18f, 0.18f, 0.18f}, {0.180012, 0.180012, 0.1800102}},
        {{1, 1, 1}, {0.730831, 0.730831, 0.7308237}},
        {{4, 4, 4}, {0.9431549, 0.9431549, 0.9431455}},
        {{17.5f, 17.5f, 17.5f}, {0.9999458, 0.9999458, 0.9999358}},
        {{1, 0.3f, 0.02f}, {0.8019307, 0.3579791, 0.0350638}},
        {{3, 0.9f, 0.06f}, {0.9932869, 0.7315115, 0.2414193}},
        {{10, 3, 0}, {1, 0.9297458, 0.5959279}},
        {{30, 9, 0}, {1, 0.987939, 0.8647674}},
        {{0.18f, 0, 0}, {0.1365055, 0, 0.0001467}},
        {{0, 3, 0}, {0.6837377, 0.9280018, 0.3960616}},
        {{0, 0, 3}, {0.1355291, 0.0066238, 0.9657296}},
        {{0.5f, 0.25f, 0.125f}, {0.5159415, 0.2779403, 0.1318806}},
        {{1000, 10, 0}, {1, 1, 1}},
    };
    for (const auto& [light, shown] : known) {
        const Pixel result = toned({light[0], light[1], light[2], 1});
        for (int channel = 0; channel < 3; ++channel)
            EXPECT_NEAR(result[channel], shown[channel], channel == 2 ? 1.1e-5 : 3e-7)
                << light[0] << "," << light[1] << "," << light[2] << " channel " << channel;
        EXPECT_EQ(result[3], 1);
    }
}

TEST(ToneFilmic, GreysStayGreysAndInOrder) {
    float before = 0;
    for (double stops = -20; stops <= 20; stops += 1.0 / 64) {
        const float light = float(std::exp2(stops));
        const Pixel shown = toned({light, light, light, 1});
        EXPECT_EQ(shown[1], shown[0]) << light;
        EXPECT_EQ(shown[2], shown[0]) << light;
        EXPECT_GE(shown[0], before) << light;
        // Strictly so between black and white, which are where the header says.
        if (light > 0.00223f && light < 17.5f) {
            EXPECT_GT(shown[0], before) << light;
        }
        if (light < 0.00222f) {
            EXPECT_EQ(shown[0], 0) << light;
        }
        if (light >= 17.6f) {
            EXPECT_EQ(shown[0], 1) << light;
        }
        before = shown[0];
    }
    EXPECT_EQ(before, 1);
}

TEST(ToneFilmic, MiddleGreyStaysInTheMiddle) {
    EXPECT_NEAR(toned({0.18f, 0.18f, 0.18f, 1})[0], 0.18, 1e-4);
}

// Of flames as hot as 1200 to 2600 K, the coolest without any blue.
TEST(ToneFilmic, FireGoesFromOrangeOverPaleYellowToWhite) {
    for (const Pixel fire : {Pixel{1, 0.12f, 0, 1}, Pixel{1, 0.3f, 0, 1}, Pixel{1, 0.45f, 0.1f}}) {
        Pixel before{};
        for (double stops = -8; stops <= 20; stops += 0.25) {
            const float scale = float(std::exp2(stops));
            const Pixel shown = toned({fire[0] * scale, fire[1] * scale, fire[2] * scale, 1});
            for (int channel = 0; channel < 3; ++channel)
                EXPECT_GE(shown[channel], before[channel] - 1e-6f) << fire[1] << " at " << stops;
            EXPECT_GE(shown[0], shown[1]) << fire[1] << " at " << stops;
            EXPECT_GE(shown[1] + 2e-3f, shown[2]) << fire[1] << " at " << stops;
            // What is nearly as green as red is no pure yellow.
            if (shown[1] > 0.95f) {
                EXPECT_GT(shown[2], 0.6f) << fire[1] << " at " << stops;
            }
            before = shown;
        }
        EXPECT_EQ(before, (Pixel{1, 1, 1, 1}));
    }
}

TEST(ToneFilmic, ClearStaysClear) {
    EXPECT_EQ(toned({0, 0, 0, 0}), (Pixel{0, 0, 0, 0}));
    EXPECT_EQ(toned({0, 0, 0, 0.5f}), (Pixel{0, 0, 0, 0.5f}));
    EXPECT_EQ(toned({0.001f, 0.001f, 0.001f, 0}), (Pixel{0, 0, 0, 0}));
}

// Over black the picture is the toned one: no colour is above alpha, which a file would cut off.
TEST(ToneFilmic, AlphaGrowsToWhatIsSeen) {
    const Pixel opaque = toned({10, 3, 0, 1});
    EXPECT_EQ(opaque[3], 1);
    const Pixel thin = toned({1, 0.3f, 0.02f, 0.1f});
    EXPECT_EQ(thin[3], thin[0]);
    EXPECT_EQ(thin[0], toned({1, 0.3f, 0.02f, 1})[0]);
    EXPECT_EQ(toned({1, 0.3f, 0.02f, 0})[3], thin[0]);
    EXPECT_EQ(toned({0.3f, 0.3f, 0.3f, 0.9f})[3], 0.9f);
}

TEST(ToneFilmic, TakesAnyNumber) {
    EXPECT_EQ(toned({kNan, -1, -kInfinity, 1}), (Pixel{0, 0, 0, 1}));
    EXPECT_EQ(toned({kInfinity, kMost, 1e9f, 1}), (Pixel{1, 1, 1, 1}));
    const Pixel red = toned({kInfinity, kNan, 0, 1});
    EXPECT_EQ(red[0], 1);
    EXPECT_GT(red[1], 0.99f);
}

TEST(ToneFilmic, ThreadsMakeNoDifference) {
    Image image({37, 53});
    for (std::size_t i = 0; i < image.rgba.size(); ++i) image.rgba[i] = float(i % 97) / 13;
    std::vector<float> expected;
    for (const int threads : {1, 2, 8}) {
        const ThreadLimit limit(threads);
        Image copy = image;
        expose(copy, 0.3);
        toneFilmic(copy);
        if (expected.empty()) expected = copy.rgba;
        EXPECT_EQ(copy.rgba, expected) << threads;
    }
}

TEST(Expose, MultipliesColourByAPowerOfTwo) {
    EXPECT_EQ(exposed({0.1f, 3, -2, 0.7f}, 3), (Pixel{0.8f, 24, -16, 0.7f}));
    EXPECT_EQ(exposed({0.1f, 3, -2, 0.7f}, -1), (Pixel{0.05f, 1.5f, -1, 0.7f}));
    EXPECT_EQ(exposed({0.1f, 3, -2, 0.7f}, 0), (Pixel{0.1f, 3, -2, 0.7f}));
    EXPECT_EQ(exposed({1, 0.25f, 0, 1}, 0.5), (Pixel{1.41421356f, 0.35355339f, 0, 1}));
    EXPECT_EQ(exposed({1, 0, 0, 1}, -0.25)[0], 0.84089642f);
}

TEST(Expose, StaysFinite) {
    EXPECT_EQ(exposed({1e30f, -1e30f, 1, 1}, 100), (Pixel{kMost, -kMost, 0x1p100f, 1}));
    EXPECT_EQ(exposed({1, 0, 0, 1}, -100)[0], 0x1p-100f);
}

TEST(Expose, RefusesWhatIsNoExposure) {
    Image image({1, 1});
    const auto refused = [&](double stops) { return errorOf([&] { expose(image, stops); }); };
    const std::string expected = "; expected a finite number from -100 to 100";
    EXPECT_EQ(refused(kNan), "usage: `exposureStops`: got nan" + expected);
    EXPECT_EQ(refused(kInfinity), "usage: `exposureStops`: got inf" + expected);
    EXPECT_EQ(refused(-100.5), "usage: `exposureStops`: got -100.5" + expected);
    EXPECT_EQ(refused(100), "no error");
}

TEST(ClippedShare, IsThatOfPixelsThatShowSomething) {
    EXPECT_EQ(clippedShare(pictureOf({{0, 0, 0, 0}})), 0);
    EXPECT_EQ(clippedShare(pictureOf({{1, 1, 1, 1}, {0, 0, 0, 1}, {0.5f, 0, 0, 0.5f}})), 0);
    EXPECT_EQ(clippedShare(pictureOf({{0, 1.1f, 0, 1}, {1, 0, 0, 1}, {0, 0, 0, 0}})), 0.5);
    EXPECT_EQ(clippedShare(pictureOf({{0, 0, 0.6f, 0.5f}, {0, 0, 0, 1}, {9, 9, 9, 1}})), 2.0 / 3);
    // Light of its own where nothing is covered.
    EXPECT_EQ(clippedShare(pictureOf({{0.5f, 0, 0, 0}, {0, 0, 0, 0}})), 1);
}

TEST(ClippedShare, LeavesOutWhatCannotBeSeen) {
    EXPECT_EQ(clippedShare(pictureOf({{1.0039f, 1, 1, 1}})), 0);
    EXPECT_EQ(clippedShare(pictureOf({{1.004f, 1, 1, 1}})), 1);
    EXPECT_EQ(clippedShare(pictureOf({{kNan, kNan, kNan, 1}})), 0);
}

TEST(ClippedShare, IsNothingOfWhatIsToned) {
    Image image({64, 64});
    for (std::size_t i = 0; i < image.rgba.size(); ++i)
        image.rgba[i] = i % 4 == 3 ? 0.5f : float(i % 89) / 7;
    EXPECT_GT(clippedShare(image), 0.5);
    toneFilmic(image);
    EXPECT_EQ(clippedShare(image), 0);
}

TEST(ToneName, IsWhatIsSaid) {
    EXPECT_EQ(toneName(Tone::kStandard), "standard");
    EXPECT_EQ(toneName(Tone::kFilmic), "filmic");
}

}  // namespace
}  // namespace deltasplat
