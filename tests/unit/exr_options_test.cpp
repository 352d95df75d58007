// SPDX-License-Identifier: Apache-2.0
// How pictures lie in an .exr, and how their numbers are packed.
#include "deltasplat/image/exr_options.h"

#include <OpenImageIO/deepdata.h>
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "deltasplat/image/exr_rows.h"
#include "deltasplat/image/write_deep_image.h"
#include "support/error_of.h"
#include "unit/temp_folder.h"

namespace deltasplat {
namespace {

using test::errorOf;
using test::readBytes;

float valueAt(int x, int y, int channel) {
    return float(1 + x + 100 * y + 10000 * channel) / 65536;
}

// Clear but for a box.
Image boxImage(glm::ivec2 size, const PixelBox& box) {
    Image image(size);
    for (int y = box.min.y; y < box.max.y; ++y) {
        for (int x = box.min.x; x < box.max.x; ++x)
            for (int c = 0; c < 4; ++c) image.pixel(x, y)[c] = valueAt(x, y, c);
    }
    return image;
}

struct Stored {
    OIIO::ImageSpec spec;
    std::vector<float> values;

    PixelBox box() const { return {{spec.x, spec.y}, {spec.x + spec.width, spec.y + spec.height}}; }
    glm::ivec2 display() const { return {spec.full_width, spec.full_height}; }
    float at(int x, int y, int channel) const {
        return values[std::size_t((y - spec.y) * spec.width + x - spec.x) *
                          std::size_t(spec.nchannels) +
                      std::size_t(channel)];
    }
};

Stored stored(const Image& image, const ImageFileOptions& options) {
    const test::TempFolder folder;
    writeImage(folder / "out.exr", image, options);
    const auto input = OIIO::ImageInput::open((folder / "out.exr").string());
    if (!input) throw std::runtime_error(OIIO::geterror());
    Stored result{input->spec(), {}};
    const int channels = result.spec.nchannels;
    result.values.resize(std::size_t(result.spec.image_pixels()) * std::size_t(channels));
    if (!input->read_image(0, 0, 0, channels, OIIO::TypeFloat, result.values.data()))
        throw std::runtime_error(input->geterror());
    return result;
}

ImageFileOptions floats() {
    ImageFileOptions options;
    options.floatExr = true;
    return options;
}

void expectValues(const Stored& file, glm::ivec2 shift = {0, 0}) {
    for (int y = file.box().min.y; y < file.box().max.y; ++y) {
        for (int x = file.box().min.x; x < file.box().max.x; ++x)
            for (int c = 0; c < 4; ++c)
                ASSERT_EQ(file.at(x, y, c), valueAt(x - shift.x, y - shift.y, c));
    }
}

TEST(ExrOptions, autocropStoresWhatIsSeen) {
    ImageFileOptions options = floats();
    const PixelBox box{{3, 5}, {20, 7}};
    const Image image = boxImage({40, 30}, box);
    EXPECT_EQ(stored(image, options).box(), (PixelBox{{0, 0}, {40, 30}}));
    options.exr.autocrop = true;
    const Stored file = stored(image, options);
    EXPECT_EQ(file.box(), box);
    EXPECT_EQ(file.display(), glm::ivec2(40, 30));
    expectValues(file);
}

TEST(ExrOptions, autocropOfOnePixelAndOfNone) {
    ImageFileOptions options = floats();
    options.exr.autocrop = true;
    for (const glm::ivec2 place : {glm::ivec2(0, 0), {39, 29}, {39, 0}, {7, 11}}) {
        const PixelBox box{place, place + 1};
        EXPECT_EQ(stored(boxImage({40, 30}, box), options).box(), box);
    }
    const Stored none = stored(Image({40, 30}), options);
    EXPECT_EQ(none.box(), (PixelBox{{0, 0}, {1, 1}}));
    EXPECT_EQ(none.display(), glm::ivec2(40, 30));
    EXPECT_EQ(none.values, std::vector<float>(4));
}

// Light without alpha is seen, and so is what channels tell.
TEST(ExrOptions, autocropLooksAtAllChannels) {
    ImageFileOptions options = floats();
    options.exr.autocrop = true;
    Image image({40, 30});
    image.pixel(10, 12)[2] = 0.5f;
    EXPECT_EQ(stored(image, options).box(), (PixelBox{{10, 12}, {11, 13}}));
    ImageChannel depth{"Z", std::vector<float>(40 * 30, 1e10f), 1e10f};
    options.channels = {depth, {"shadow.R", std::vector<float>(40 * 30)}};
    EXPECT_EQ(stored(image, options).box(), (PixelBox{{10, 12}, {11, 13}}));
    options.channels[0].values[20 * 40 + 8] = 3;
    options.channels[1].values[29 * 40 + 39] = 0.1f;
    const Stored file = stored(image, options);
    EXPECT_EQ(file.box(), (PixelBox{{8, 12}, {40, 30}}));
    EXPECT_EQ(file.at(10, 12, 2), 0.5f);
    EXPECT_EQ(file.at(8, 20, 4), 3);
    EXPECT_EQ(file.at(39, 29, 5), 0.1f);
}

TEST(ExrOptions, pictureLiesInTheDisplayWindow) {
    ImageFileOptions options = floats();
    options.exr.dataMin = {-4, 6};
    options.exr.displaySize = glm::ivec2(32, 50);
    const PixelBox box{{2, 3}, {9, 30}};
    const Image image = boxImage({40, 30}, {{0, 0}, {40, 30}});
    const Stored all = stored(image, options);
    EXPECT_EQ(all.box(), (PixelBox{{-4, 6}, {36, 36}}));
    EXPECT_EQ(all.display(), glm::ivec2(32, 50));
    EXPECT_EQ(all.spec.full_x, 0);
    EXPECT_EQ(all.spec.full_y, 0);
    expectValues(all, {-4, 6});
    options.region = box;
    const Stored part = stored(image, options);
    EXPECT_EQ(part.box(), (PixelBox{{-2, 9}, {5, 36}}));
    expectValues(part, {-4, 6});
    options.exr.autocrop = true;
    const Stored seen = stored(boxImage({40, 30}, {{0, 0}, {4, 5}}), options);
    EXPECT_EQ(seen.box(), (PixelBox{{-2, 9}, {0, 11}}));
}

// The same pixels as of the whole, dither included.
TEST(ExrOptions, regionIsAPartOfOtherFilesAsWell) {
    const Image image = boxImage({40, 30}, {{0, 0}, {40, 30}});
    const auto read = [&](const char* name, const ImageFileOptions& options, glm::ivec2 size) {
        const test::TempFolder folder;
        writeImage(folder / name, image, options);
        const auto input = OIIO::ImageInput::open((folder / name).string());
        EXPECT_EQ(input->spec().width, size.x);
        EXPECT_EQ(input->spec().height, size.y);
        std::vector<std::uint8_t> bytes(std::size_t(size.x * size.y * input->spec().nchannels));
        EXPECT_TRUE(input->read_image(0, 0, 0, -1, OIIO::TypeUInt8, bytes.data()));
        return bytes;
    };
    ImageFileOptions part;
    part.region = PixelBox{{5, 7}, {31, 30}};
    for (const char* name : {"out.png", "out.tif"}) {
        const std::vector<std::uint8_t> whole = read(name, {}, {40, 30});
        const std::vector<std::uint8_t> cut = read(name, part, {26, 23});
        for (int y = 0; y < 23; ++y) {
            for (int x = 0; x < 4 * 26; ++x)
                ASSERT_EQ(cut[std::size_t(y * 4 * 26 + x)],
                          whole[std::size_t((y + 7) * 4 * 40 + 4 * 5 + x)]);
        }
    }
    read("out.jpg", part, {26, 23});
}

TEST(ExrOptions, deepPicturesHaveWindows) {
    DeepImage image{{20, 10}, std::vector<DeepRow>(10)};
    for (int y = 0; y < 10; ++y) {
        for (int x = 0; x < 20; ++x) {
            DeepRow& row = image.rows[std::size_t(y)];
            if (x >= 4 && x < 9 && y >= 2 && y < 8)
                row.samples.push_back({glm::vec4(0.5f), float(x), float(x) + 1});
            row.begins.push_back(row.samples.size());
        }
    }
    ImageFileOptions options = floats();
    options.exr.dataMin = {-3, 1};
    options.exr.displaySize = glm::ivec2(14, 12);
    options.exr.autocrop = true;
    const test::TempFolder folder;
    writeDeepImage(folder / "out.exr", image, options);
    const auto input = OIIO::ImageInput::open((folder / "out.exr").string());
    ASSERT_TRUE(input);
    const OIIO::ImageSpec& spec = input->spec();
    EXPECT_EQ((std::array{spec.x, spec.y, spec.width, spec.height}), (std::array{1, 3, 5, 6}));
    EXPECT_EQ((std::array{spec.full_width, spec.full_height}), (std::array{14, 12}));
    OIIO::DeepData data;
    ASSERT_TRUE(input->read_native_deep_image(0, 0, data));
    for (int pixel = 0; pixel < 30; ++pixel) {
        ASSERT_EQ(data.samples(pixel), 1);
        EXPECT_EQ(data.deep_value(pixel, 4, 0), float(4 + pixel % 5));
    }
}

TEST(ExrOptions, compressionsKeepWhatTheyCan) {
    const Image image = boxImage({70, 60}, {{10, 10}, {60, 50}});
    for (const std::string& name : exrCompressions()) {
        ImageFileOptions options = floats();
        options.exr.compression = name;
        const Stored file = stored(image, options);
        EXPECT_EQ(file.spec.get_string_attribute("compression").substr(0, name.size()), name);
        const bool loses = name == "pxr24" || name[0] == 'd';
        for (std::size_t i = 0; i < file.values.size(); ++i) {
            if (loses) {
                ASSERT_NEAR(file.values[i], image.rgba[i], 1e-2) << name;
            } else {
                ASSERT_EQ(file.values[i], image.rgba[i]) << name;
            }
        }
    }
    const auto bytes = [&](const std::string& name, double level) {
        ImageFileOptions options;
        options.exr.compression = name;
        options.exr.level = level;
        return encodeImage("out.exr", image, options).size();
    };
    EXPECT_LT(bytes("dwaa", 1000), bytes("dwaa", 1));
    EXPECT_LT(bytes("zip", 9), bytes("zip", 1));
}

// As small and as noisy as they may be.
TEST(ExrOptions, partsOfOneChannelArePackedAsAskedFor) {
    std::mt19937 random(7);
    for (const glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(15, 9), glm::ivec2(70, 40)}) {
        ImageFileOptions options = floats();
        options.exr.compression = "dwaa";
        options.exr.multipart = true;
        options.channels = {{"Z", {}}};
        for (int i = 0; i < size.x * size.y; ++i)
            options.channels[0].values.push_back(std::ldexp(float(random()), int(random() % 64)));
        const test::TempFolder folder;
        writeImage(folder / "out.exr", Image(size), options);
        const auto input = OIIO::ImageInput::open((folder / "out.exr").string());
        ASSERT_TRUE(input && input->seek_subimage(1, 0));
        EXPECT_EQ(input->spec().get_string_attribute("compression"), "dwaa");
        std::vector<float> values(options.channels[0].values.size());
        ASSERT_TRUE(input->read_image(1, 0, 0, 1, OIIO::TypeFloat, values.data()));
        EXPECT_EQ(values, options.channels[0].values);
    }
}

TEST(ExrOptions, saysWhatColoursAndPixelsAre) {
    const Image image = boxImage({4, 4}, {{0, 0}, {4, 4}});
    ImageFileOptions options;
    Stored file = stored(image, options);
    std::array<float, 8> colours{};
    const OIIO::TypeDesc type(OIIO::TypeDesc::FLOAT, 8);
    ASSERT_TRUE(file.spec.getattribute("chromaticities", type, colours.data()));
    EXPECT_EQ(colours, kRec709);
    EXPECT_EQ(file.spec.get_float_attribute("PixelAspectRatio"), 1);
    options.exr.chromaticities.reset();
    options.exr.pixelAspect = 2;
    file = stored(image, options);
    EXPECT_FALSE(file.spec.getattribute("chromaticities", type, colours.data()));
    EXPECT_EQ(file.spec.get_float_attribute("PixelAspectRatio"), 2);
}

TEST(ExrOptions, refusesWhatCannotBe) {
    const auto message = [](const auto& change) {
        ImageFileOptions options;
        change(options);
        return errorOf([&] { encodeImage("out.exr", Image({4, 3}), options); });
    };
    EXPECT_EQ(
        message([](auto& o) { o.exr.compression = "lzw"; }),
        "usage: `compression`: got lzw; expected none, rle, zip, zips, piz, pxr24, b44, b44a, "
        "dwaa or dwab");
    EXPECT_EQ(
        message([](auto& o) { o.exr.compression = "piz", o.exr.level = 3; }),
        "usage: `compression`: got piz:3; expected a level with zip, zips, dwaa or dwab alone");
    for (const double level : {0.0, 10.0, 2.5}) {
        EXPECT_NE(message([&](auto& o) {
                      o.exr.compression = "zip", o.exr.level = level;
                  }).find("expected a level that is a whole number within 1..9"),
                  std::string::npos);
    }
    EXPECT_EQ(message([](auto& o) { o.exr.compression = "dwaa", o.exr.level = -1; }),
              "usage: `compression`: got dwaa:-1; expected a level within 0..1000000");
    EXPECT_EQ(message([](auto& o) { o.exr.pixelAspect = 0; }),
              "usage: pixel aspect: got 0; expected a number within 1e-06..1e+06");
    EXPECT_EQ(message([](auto& o) { o.exr.displaySize = glm::ivec2(0, 3); }),
              "usage: display window: got 0x3; expected WxH, each at least 1");
    EXPECT_EQ(message([](auto& o) {
                  o.region = PixelBox{{1, 0}, {5, 2}};
              }),
              "usage: `region`: got 4x2 pixels from 1,0 on; expected all of them among the "
              "picture's 4x3");
    EXPECT_EQ(message([](auto& o) { o.exr.displaySize = glm::ivec2(2'000'000'000, 3); }),
              "output: out.exr: cannot be encoded: Cannot open image file \"out.exr\". Invalid "
              "display window in image header.");
    ImageFileOptions options;
    options.exr.compression = "zip";
    EXPECT_EQ(errorOf([&] { encodeDeepImage("out.exr", DeepImage(), options); }),
              "usage: `compression`: got zip of a deep picture; expected zips");
}

Image rowsOf(const Image& image, const PixelBox& box) {
    Image rows(box.size());
    for (int y = 0; y < rows.size.y; ++y) {
        const float* first = image.pixel(box.min.x, box.min.y + y);
        std::copy(first, first + 4 * rows.size.x, rows.pixel(0, y));
    }
    return rows;
}

// Byte for byte, however many rows are written at a time.
TEST(ExrRows, areTheFileOfTheWhole) {
    const test::TempFolder folder;
    const Image image = boxImage({37, 300}, {{3, 10}, {30, 280}});
    for (const char* compression : {"zip", "none", "piz", "dwab"}) {
        for (const int count : {1, 16, 100, 300}) {
            ImageFileOptions options;
            options.exr.compression = compression;
            options.exr.dataMin = {5, -7};
            options.metadata = {{"method", "delta"}};
            options.region = PixelBox{{1, 4}, {33, 290}};
            ExrRows rows(folder / "rows.exr", image.size, *options.region, options);
            for (int y = 4; y < 290; y += count)
                rows.write(rowsOf(image, {{1, y}, {33, std::min(y + count, 290)}}));
            EXPECT_FALSE(std::filesystem::exists(folder / "rows.exr"));
            rows.finish();
            EXPECT_TRUE(readBytes(folder / "rows.exr") == encodeImage("out.exr", image, options))
                << compression << " " << count;
            std::filesystem::remove(folder / "rows.exr");
        }
    }
}

TEST(ExrRows, refusesWhatDoesNotFit) {
    const test::TempFolder folder;
    const PixelBox all{{0, 0}, {8, 6}};
    ImageFileOptions options;
    EXPECT_EQ(errorOf([&] {
                  ExrRows(folder / "out.png", {8, 6}, all, options);
              }),
              "usage: " + (folder / "out.png").string() +
                  ": got a picture in parts; expected an .exr file");
    ExrRows rows(folder / "out.exr", {8, 6}, all, options);
    EXPECT_EQ(errorOf([&] {
                  rows.write(Image({7, 1}));
              }),
              "usage: rows of a picture: got 7x1; expected some of 8x6");
    rows.write(Image({8, 4}));
    EXPECT_EQ(errorOf([&] {
                  rows.write(Image({8, 3}));
              }),
              "usage: rows of a picture: got 8x3; expected some of 8x2");
    EXPECT_EQ(errorOf([&] { rows.finish(); }), "usage: rows of a picture: got 4; expected 6");
    options.channels = {{"Z", std::vector<float>(48)}};
    EXPECT_NE(errorOf([&] {
                  ExrRows(folder / "z.exr", {8, 6}, all, options);
              }).find("got other channels besides; expected a picture alone"),
              std::string::npos);
}

}  // namespace
}  // namespace deltasplat
