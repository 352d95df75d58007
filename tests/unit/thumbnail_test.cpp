// SPDX-License-Identifier: Apache-2.0
#include "image/quantize.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <utility>

#include "deltasplat/image/write_deep_image.h"
#include "deltasplat/image/write_image.h"
#include "unit/temp_folder.h"

namespace deltasplat {
namespace {

// A picture whose left half is a colour, and whose right half is clear.
Image halfFull(glm::ivec2 size, const glm::vec4& color) {
    Image image(size);
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x / 2; ++x)
            for (int c = 0; c < 4; ++c) image.pixel(x, y)[c] = color[c];
    return image;
}

void expectPixel(const Image& image, int x, int y, const glm::vec4& color) {
    for (int c = 0; c < 4; ++c)
        EXPECT_NEAR(image.pixel(x, y)[c], color[c], 0.004) << x << "," << y << ":" << c;
}

TEST(Thumbnail, IsTheSameLightOfAllFormats) {
    const test::TempFolder folder;
    const glm::vec4 color(0.1F, 0.3F, 0.02F, 0.5F);
    for (const char* name : {"a.exr", "a.png", "a.tif"}) {
        writeImage(folder / name, halfFull({8, 4}, color), {});
        const Image same = readThumbnail(folder / name, 100);
        ASSERT_EQ(same.size, glm::ivec2(8, 4)) << name;
        expectPixel(same, 0, 0, color);
        expectPixel(same, 7, 3, glm::vec4(0));
    }
    writeImage(folder / "a.jpg", halfFull({16, 16}, glm::vec4(0.3F, 0.3F, 0.3F, 1)), {});
    const Image jpeg = readThumbnail(folder / "a.jpg", 100);
    expectPixel(jpeg, 3, 8, glm::vec4(0.3F, 0.3F, 0.3F, 1));
}

TEST(Thumbnail, TakesTheMeanOfWholePixels) {
    const test::TempFolder folder;
    const glm::vec4 color(0.4F, 0.2F, 0.1F, 1);
    writeImage(folder / "a.exr", halfFull({100, 50}, color), {});
    // Each way three of them, one at the end.
    const Image small = readThumbnail(folder / "a.exr", 34);
    ASSERT_EQ(small.size, glm::ivec2(34, 17));
    expectPixel(small, 0, 0, color);
    expectPixel(small, 15, 16, color);
    expectPixel(small, 16, 8, color * (2 / 3.0F));
    expectPixel(small, 33, 16, glm::vec4(0));
    EXPECT_EQ(readThumbnail(folder / "a.exr", 33).size, glm::ivec2(25, 13));
}

TEST(Thumbnail, ShowsTheWindowOfTheFrame) {
    const test::TempFolder folder;
    const glm::vec4 color(0.4F, 0.2F, 0.1F, 1);
    ImageFileOptions options;
    options.exr.autocrop = true;
    Image image(glm::ivec2(10, 6));
    for (int c = 0; c < 4; ++c) image.pixel(7, 2)[c] = color[c];
    writeImage(folder / "a.exr", image, options);
    const Image whole = readThumbnail(folder / "a.exr", 10);
    ASSERT_EQ(whole.size, glm::ivec2(10, 6));
    expectPixel(whole, 7, 2, color);
    expectPixel(whole, 0, 0, glm::vec4(0));
}

// Frames may be as large as numbers are.
TEST(Thumbnail, KnowsFramesOfAnySize) {
    const test::TempFolder folder;
    writeImage(folder / "a.exr", halfFull({1000, 4}, glm::vec4(1)), {});
    std::string bytes = test::readBytes(folder / "a.exr");
    const std::string name("displayWindow\0box2i\0\20\0\0\0", 24);
    const std::size_t box = bytes.find(name);
    ASSERT_NE(box, std::string::npos);
    const std::int32_t last = 2'147'483'600 / 2;
    for (const auto& [corner, value] : {std::pair(0, -last), std::pair(2, last - 1)})
        std::memcpy(&bytes[box + name.size() + sizeof last * std::size_t(corner)], &value, 4);
    std::ofstream(folder / "wide.exr", std::ios::binary) << bytes;
    const Image image = readThumbnail(folder / "wide.exr", 320);
    EXPECT_EQ(image.size, glm::ivec2(320, 1));
}

TEST(Thumbnail, IsNoneOfWhatCannotBeRead) {
    const test::TempFolder folder;
    std::ofstream(folder / "a.png") << "no picture";
    EXPECT_TRUE(readThumbnail(folder / "a.png", 10).rgba.empty());
    EXPECT_TRUE(readThumbnail(folder / "none.exr", 10).rgba.empty());
    DeepImage deep;
    deep.size = {2, 2};
    deep.rows.resize(2);
    for (DeepRow& row : deep.rows) row.begins = {0, 0, 0};
    writeDeepImage(folder / "deep.exr", deep, {});
    EXPECT_TRUE(readThumbnail(folder / "deep.exr", 10).rgba.empty());
}

TEST(Thumbnail, IsEncodedAsAJpeg) {
    const std::string bytes = encodeThumbnail(halfFull({16, 16}, glm::vec4(1)));
    EXPECT_TRUE(bytes.starts_with("\xff\xd8\xff"));
}

}  // namespace
}  // namespace deltasplat
