// SPDX-License-Identifier: Apache-2.0
// Headers that claim more than there can be.
#include "formats/images/image_claims.h"

#include <gtest/gtest.h>

#include "deltasplat/cameras/read_camera.h"
#include "deltasplat/hold_out.h"
#include "deltasplat/memory_limit.h"
#include "deltasplat/optics/environment.h"
#include "unit/format_helpers.h"
#include "unit/tiff_helpers.h"

namespace deltasplat {
namespace {

using namespace deltasplat::testing;

std::string attribute(const std::string& name, const std::string& type, const std::string& value) {
    return name + '\0' + type + '\0' + bytesOf<std::uint32_t>({std::uint32_t(value.size())}) +
           value;
}

std::string box(int width, int height) {
    return bytesOf<std::int32_t>({0, 0, width - 1, height - 1});
}

// An .exr of one channel of floats, without pixels.
std::string exrBytes(int width, int height, char compression, int tile = 0) {
    const std::string channel = std::string("Y\0", 2) + bytesOf<std::uint32_t>({2, 0, 1, 1});
    std::string bytes = bytesOf<std::uint32_t>({20000630, tile > 0 ? 0x202u : 2u}) +
                        attribute("channels", "chlist", channel + '\0') +
                        attribute("compression", "compression", std::string(1, compression)) +
                        attribute("dataWindow", "box2i", box(width, height)) +
                        attribute("displayWindow", "box2i", box(16, 16)) +
                        attribute("lineOrder", "lineOrder", std::string(1, '\0')) +
                        attribute("pixelAspectRatio", "float", bytesOf<float>({1})) +
                        attribute("screenWindowCenter", "v2f", bytesOf<float>({0, 0})) +
                        attribute("screenWindowWidth", "float", bytesOf<float>({1}));
    if (tile > 0) {
        bytes +=
            attribute("tiles", "tiledesc",
                      bytesOf<std::uint32_t>({std::uint32_t(tile), std::uint32_t(tile)}) + '\0');
    }
    return bytes + std::string(4097, '\0');
}

// Where memory is limited to what such a file needs.
class Claims : public ::testing::Test {
  protected:
    Claims() { setMemoryLimit(std::uint64_t{1} << 30); }
    ~Claims() override { setMemoryLimit(0); }

    TempFolder folder_;
};

void expectClaim(const std::string& file) {
    try {
        requireClaims(file);
        ADD_FAILURE() << file << " was believed";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::kInput) << error.what();
    }
}

// OpenEXR takes lines of all blocks when it opens a file: 20 GB here.
TEST_F(Claims, LinesOfAnExr) {
    for (const char compression : {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}) {
        writeBytes("wide.exr", exrBytes(40'000'000, 1, compression));
        expectClaim("wide.exr");
        expectInputError("wide.exr");
        EXPECT_THROW(readCamera("wide.exr", "", {}), Error);
        EXPECT_THROW(readDepthImage("wide.exr", {}), Error);
        EXPECT_THROW(readEnvironment("wide.exr", {}), Error);
    }
    writeBytes("zip.exr", exrBytes(4'000'000, 1, 3));
    expectRefused("zip.exr: got " + std::to_string(exrBytes(4'000'000, 1, 3).size()) +
                      " bytes; expected enough for 4000000x1 pixels",
                  "zip.exr");
    writeBytes("small.exr", exrBytes(16, 16, 3));
    EXPECT_TRUE(requireClaims("small.exr"));
}

TEST_F(Claims, TilesOfAnExr) {
    writeBytes("tile.exr", exrBytes(16, 16, 3, 60000));
    expectClaim("tile.exr");
    writeBytes("good.exr", exrBytes(16, 16, 3, 64));
    EXPECT_TRUE(requireClaims("good.exr"));
}

TEST_F(Claims, TilesOfATiff) {
    const auto bytesFor = [](std::uint32_t side, std::uint32_t packing) {
        TiffPageBytes page;
        page.width = page.height = 16;
        page.pixels = std::string(1200, '\0');
        page.more = {{259, {packing}}, {322, {side}}, {323, {side}}, {324, {8}}, {325, {1200}}};
        return tiffBytes({page});
    };
    writeBytes("a.tif", bytesFor(60000, 8));
    expectRefused(
        "a.tif: got page 1 with a tile of 1200 bytes; expected enough for 60000x60000 pixels",
        "a.tif");
    expectClaim("a.tif");
    // Enough to be packed so, and too much for memory.
    setMemoryLimit(1);
    writeBytes("b.tif", bytesFor(1024, 8));
    expectInputError("b.tif");
}

// What comes in several passes is held whole from the start.
TEST_F(Claims, FramesOfAJpeg) {
    const auto bytesOf = [](const std::string& before, unsigned char frame, int side) {
        const std::string size{char(side >> 8), char(side & 255)};
        return std::string("\xff\xd8", 2) + before +
               std::string({char(0xff), char(frame), 0, 11, 8}) + size + size +
               std::string({1, 1, 0x11, 0}) + std::string(200, '\0');
    };
    for (const std::string before : {"", "\xff", "xyz", "\xff\xe0\x01\x04"}) {
        const std::string filled = before.size() == 4 ? before + std::string(258, 'a') : before;
        writeBytes("a.jpg", bytesOf(filled, 0xc2, 65000));
        expectClaim("a.jpg");
        expectInputError("a.jpg");
    }
    writeBytes("b.jpg", bytesOf("", 0xc2, 64));
    EXPECT_TRUE(requireClaims("b.jpg"));
}

TEST_F(Claims, RunsOfABmp) {
    const auto bytesFor = [](int side) {
        return "BM" + bytesOf<std::uint32_t>({2000, 0, 54, 40}) +
               bytesOf<std::int32_t>({side, side}) + bytesOf<std::uint16_t>({1, 8}) +
               bytesOf<std::uint32_t>({1, 0, 0, 0, 0, 0}) + std::string(2000, '\0');
    };
    writeBytes("a.bmp", bytesFor(60000));
    expectClaim("a.bmp");
    expectInputError("a.bmp");
    writeBytes("b.bmp", bytesFor(64));
    EXPECT_TRUE(requireClaims("b.bmp"));
}

// Files that end anywhere, or are something else, are for their decoders to refuse.
TEST_F(Claims, FilesThatAreCutAnywhere) {
    const std::string exr = exrBytes(16, 16, 3);
    for (std::size_t size = 0; size < 400; ++size) {
        writeBytes("a.exr", exr.substr(0, size));
        EXPECT_NO_THROW(requireClaims("a.exr")) << size;
        writeBytes("a.jpg", std::string("\xff\xd8\xff\xe0\x00\x10", 6) + exr.substr(0, size));
        EXPECT_NO_THROW(requireClaims("a.jpg")) << size;
    }
}

}  // namespace
}  // namespace deltasplat
