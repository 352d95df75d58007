// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/image/write_deep_image.h"

#include <OpenImageIO/deepdata.h>
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "deltasplat/threads.h"
#include "support/error_of.h"
#include "unit/temp_folder.h"

namespace deltasplat {
namespace {

using test::errorOf;
using test::readBytes;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

void addPixel(DeepRow& row, const std::vector<DeepSample>& samples) {
    row.samples.insert(row.samples.end(), samples.begin(), samples.end());
    row.begins.push_back(row.samples.size());
}

DeepImage onePixel(const std::vector<DeepSample>& samples) {
    DeepImage image{{1, 1}, {DeepRow()}};
    addPixel(image.rows[0], samples);
    return image;
}

// Up to four samples a pixel, many of none.
DeepImage randomImage(glm::ivec2 size) {
    std::mt19937 random(5);
    const auto unit = [&] { return float(random() >> 8) / 16777216.0f; };
    DeepImage image{size, std::vector<DeepRow>(std::size_t(size.y))};
    for (DeepRow& row : image.rows) {
        for (int x = 0; x < size.x; ++x) {
            std::vector<DeepSample> samples;
            float z = unit();
            for (unsigned count = random() % 8; count > 0 && count < 5; --count) {
                const float back = z + unit();
                samples.push_back({{unit(), unit(), unit(), unit()}, z, back});
                z = back;
            }
            addPixel(row, samples);
        }
    }
    return image;
}

struct Stored {
    OIIO::ImageSpec spec;
    OIIO::DeepData data;
};

Stored readBack(const std::filesystem::path& file) {
    const auto input = OIIO::ImageInput::open(file.string());
    if (!input) throw std::runtime_error(OIIO::geterror());
    Stored stored{input->spec(), {}};
    if (!input->read_native_deep_image(0, 0, stored.data))
        throw std::runtime_error(input->geterror());
    return stored;
}

Stored writeAndRead(const DeepImage& image, const ImageFileOptions& options) {
    const test::TempFolder folder;
    writeDeepImage(folder / "out.exr", image, options);
    return readBack(folder / "out.exr");
}

ImageFileOptions asFloats() {
    ImageFileOptions options;
    options.floatExr = true;
    return options;
}

TEST(WriteDeepImage, floatsAreBitExact) {
    const DeepImage image = randomImage({70, 150});
    const Stored stored = writeAndRead(image, asFloats());
    EXPECT_EQ(stored.spec.width, 70);
    EXPECT_EQ(stored.spec.height, 150);
    ASSERT_EQ(stored.data.pixels(), 70 * 150);
    for (int pixel = 0; pixel < 70 * 150; ++pixel) {
        const auto samples = image.pixel(pixel % 70, pixel / 70);
        ASSERT_EQ(stored.data.samples(pixel), int(samples.size())) << pixel;
        for (int s = 0; s < int(samples.size()); ++s) {
            const DeepSample& sample = samples[std::size_t(s)];
            for (int c = 0; c < 4; ++c)
                ASSERT_EQ(stored.data.deep_value(pixel, c, s), sample.rgba[c]);
            ASSERT_EQ(stored.data.deep_value(pixel, 4, s), sample.z);
            ASSERT_EQ(stored.data.deep_value(pixel, 5, s), sample.zBack);
        }
    }
}

TEST(WriteDeepImage, hasChannelsAsOpenExrNamesThem) {
    const Stored stored = writeAndRead(randomImage({5, 4}), {});
    EXPECT_TRUE(stored.spec.deep);
    EXPECT_EQ(stored.spec.channelnames,
              (std::vector<std::string>{"R", "G", "B", "A", "Z", "ZBack"}));
    for (int c = 0; c < 6; ++c) {
        EXPECT_EQ(stored.spec.channelformat(c), c < 4 ? OIIO::TypeHalf : OIIO::TypeFloat);
        EXPECT_EQ(writeAndRead(randomImage({5, 4}), asFloats()).spec.channelformat(c),
                  OIIO::TypeFloat);
    }
    // What OpenImageIO merges and flattens by.
    EXPECT_EQ(stored.data.Z_channel(), 4);
    EXPECT_EQ(stored.data.Zback_channel(), 5);
    EXPECT_EQ(stored.data.A_channel(), 3);
    EXPECT_EQ(stored.spec.get_string_attribute("compression"), "zips");
}

TEST(WriteDeepImage, halvesAreWithinHalfAStepAndDepthsExact) {
    const Stored stored =
        writeAndRead(onePixel({{{0.3f, 0.7f, 12.3f, 0.9f}, 1234.567f, 1234.568f}}), {});
    ASSERT_EQ(stored.data.samples(0), 1);
    const float values[] = {0.3f, 0.7f, 12.3f, 0.9f};
    for (int c = 0; c < 4; ++c)
        EXPECT_NEAR(stored.data.deep_value(0, c, 0), values[c], values[c] * 0x1p-11);
    EXPECT_EQ(stored.data.deep_value(0, 4, 0), 1234.567f);
    EXPECT_EQ(stored.data.deep_value(0, 5, 0), 1234.568f);
}

// What samples give over each other, with depths alone left out.
glm::dvec4 flattened(const std::vector<DeepSample>& samples) {
    glm::dvec4 sum(0);
    for (const DeepSample& sample : samples) sum += (1 - sum.a) * glm::dvec4(sample.rgba);
    return sum;
}

TEST(WriteDeepImage, roundedSamplesOverEachOtherStayThePixel) {
    std::mt19937 random(9);
    const auto unit = [&] { return float(random() >> 8) / 16777216.0f; };
    // From a few dense ones to many thin ones, and what is bright behind what lets little through.
    for (int count = 1; count < 300; count += 1 + count / 8) {
        for (int i = 0; i < 20; ++i) {
            std::vector<DeepSample> samples;
            double left = 1;
            while (int(samples.size()) < count && left > 1e-3) {
                const float alpha = std::min(1.0f, 3 * unit() / float(count));
                const float bright = left < 0.01 ? 30.0f : 1.0f;
                samples.push_back({{alpha * unit() * bright, alpha, 0, alpha}, 1, 2});
                left *= 1 - alpha;
            }
            const Stored stored = writeAndRead(onePixel(samples), {});
            std::vector<DeepSample> halves;
            for (int s = 0; s < stored.data.samples(0); ++s) {
                DeepSample& half = halves.emplace_back();
                for (int c = 0; c < 4; ++c) half.rgba[c] = stored.data.deep_value(0, c, s);
                EXPECT_EQ(half.rgba.b, 0);
                EXPECT_LE(half.rgba.a, 1);
            }
            const glm::dvec4 wanted = flattened(samples);
            const glm::dvec4 got = flattened(halves);
            for (int c = 0; c < 4; ++c)
                ASSERT_NEAR(got[c], wanted[c], 0x1p-12 * std::max(1.0, wanted[c])) << count;
        }
    }
}

// A half has no room for 0.9999; behind it something is seen all the same.
TEST(WriteDeepImage, whatIsNotOpaqueHidesNothing) {
    const std::vector<DeepSample> samples = {{{0, 0, 0, 0.9999f}, 1, 2}, {{1, 1, 1, 1}, 2, 3}};
    const Stored stored = writeAndRead(onePixel(samples), {});
    ASSERT_EQ(stored.data.samples(0), 2);
    EXPECT_EQ(stored.data.deep_value(0, 3, 0), 1 - 0x1p-11f);
    EXPECT_NEAR(stored.data.deep_value(0, 0, 1) * 0x1p-11f, 1e-4f, 1e-7f);
    // Alone it is what it is rounded to.
    EXPECT_EQ(writeAndRead(onePixel({samples[0]}), {}).data.deep_value(0, 3, 0), 1);
}

TEST(WriteDeepImage, leavesOutSamplesOfWhichNothingIsStored) {
    const std::vector<DeepSample> samples = {
        {{0, 0, 0, 0}, 1, 2},           // nothing at all
        {{0, 0x1p-25f, 0, 0}, 2, 3},    // nothing as halves
        {{0, 0, 0x1.1p-25f, 0}, 3, 4},  // light without alpha
        {{0, 0, 0, 0.5f}, 4, 5},        // alpha without light
        {{kNan, 0, 0, 0}, 5, 6},
    };
    const Stored halves = writeAndRead(onePixel(samples), {});
    ASSERT_EQ(halves.data.samples(0), 2);
    EXPECT_EQ(halves.data.deep_value(0, 4, 0), 3);
    EXPECT_GT(halves.data.deep_value(0, 2, 0), 0);
    EXPECT_EQ(halves.data.deep_value(0, 4, 1), 4);
    const Stored floats = writeAndRead(onePixel(samples), asFloats());
    ASSERT_EQ(floats.data.samples(0), 3);
    EXPECT_EQ(floats.data.deep_value(0, 1, 0), 0x1p-25f);
}

TEST(WriteDeepImage, storesFiniteNumbers) {
    const DeepImage image = onePixel({{{1e6f, -kInfinity, kNan, 0.5f}, 1, 2}});
    const Stored halves = writeAndRead(image, {});
    EXPECT_EQ(halves.data.deep_value(0, 0, 0), 65504);
    EXPECT_EQ(halves.data.deep_value(0, 1, 0), -65504);
    EXPECT_EQ(halves.data.deep_value(0, 2, 0), 0);
    const Stored floats = writeAndRead(image, asFloats());
    EXPECT_EQ(floats.data.deep_value(0, 0, 0), 1e6f);
    EXPECT_EQ(floats.data.deep_value(0, 1, 0), std::numeric_limits<float>::lowest());
}

TEST(WriteDeepImage, hasTheAttributesOfAFlatOne) {
    ImageFileOptions options;
    options.cameraFromWorld = glm::dmat4(2.0);
    options.ndcFromWorld = glm::dmat4(3.0);
    options.metadata = {{"method", "delta"}};
    const OIIO::ImageSpec spec = writeAndRead(randomImage({5, 4}), options).spec;
    EXPECT_EQ(spec.get_string_attribute("deltasplat:method"), "delta");
    EXPECT_EQ(spec.get_string_attribute("DateTime"), "");
    float stored[16] = {};
    ASSERT_TRUE(spec.getattribute("worldToCamera", OIIO::TypeMatrix, stored));
    EXPECT_EQ(stored[0], 2);
    ASSERT_TRUE(spec.getattribute("worldToNDC", OIIO::TypeMatrix, stored));
    EXPECT_EQ(stored[5], 3);
}

TEST(WriteDeepImage, hasTheSameBytesOnAnyNumberOfThreads) {
    const DeepImage image = randomImage({90, 200});
    const std::string bytes = encodeDeepImage("out.exr", image, {});
    EXPECT_GT(bytes.size(), 10000u);
    for (const int threads : {1, 2, 5}) {
        const ThreadLimit limit(threads);
        EXPECT_TRUE(encodeDeepImage("out.exr", image, {}) == bytes) << threads;
    }
}

// OpenImageIO itself would write to the name that it is told.
TEST(WriteDeepImage, encodingTouchesNoFile) {
    const test::TempFolder folder;
    EXPECT_FALSE(encodeDeepImage(folder / "out.exr", randomImage({5, 4}), {}).empty());
    EXPECT_EQ(folder.count(), 0);
    EXPECT_FALSE(encodeDeepImage("no/such/folder/out.exr", randomImage({5, 4}), {}).empty());
}

TEST(WriteDeepImage, refusesWhatCannotBeDeep) {
    const test::TempFolder folder;
    const std::string png = (folder / "out.png").string();
    const std::string message = "usage: " + png + ": got a deep picture; expected an .exr file";
    EXPECT_EQ(errorOf([&] { writeDeepImage(png, randomImage({2, 2}), {}); }), message);
    EXPECT_EQ(errorOf([&] { checkDeepImageFile(png, {2, 2}, {}); }), message);
    EXPECT_EQ(errorOf([&] { checkDeepImageFile(folder / "out.exr", {2, 2}, {}); }), "no error");
    EXPECT_NE(errorOf([&] {
                  checkDeepImageFile(folder / "no/out.exr", {2, 2}, {});
              }).find("output"),
              std::string::npos);
    EXPECT_EQ(errorOf([&] { encodeDeepImage("out.exr", {}, {}); }),
              "usage: out.exr: got 0x0 pixels; expected at least 1x1");
    EXPECT_EQ(folder.count(), 0);
}

}  // namespace
}  // namespace deltasplat
