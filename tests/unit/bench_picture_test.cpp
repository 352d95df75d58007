// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "../tools/bench/bench_page_file.h"
#include "../tools/bench/heat_map.h"
#include "../tools/page/picture_data.h"
#include "deltasplat/error.h"
#include "image/srgb.h"
#include "unit/temp_folder.h"

namespace deltasplat {
namespace {

// How bright people see an sRGB colour.
double luminanceOf(const Rgb& color) {
    return 0.2126 * linearFromSrgb(color.r / 255.0) + 0.7152 * linearFromSrgb(color.g / 255.0) +
           0.0722 * linearFromSrgb(color.b / 255.0);
}

TEST(HeatColor, GetsBrighterAllTheWay) {
    double before = -1;
    for (int i = 0; i <= 64; ++i) {
        const double luminance = luminanceOf(heatColor(i / 64.0));
        EXPECT_GT(luminance, before) << i;
        before = luminance;
    }
    EXPECT_LT(luminanceOf(heatColor(0)), 0.01);
    EXPECT_GT(luminanceOf(heatColor(1)), 0.85);
}

TEST(HeatColor, EndsWithItsScale) {
    const auto channels = [](const Rgb& c) { return std::vector<int>{c.r, c.g, c.b}; };
    EXPECT_EQ(channels(heatColor(-1)), channels(heatColor(0)));
    EXPECT_EQ(channels(heatColor(7)), channels(heatColor(1)));
    // A quarter of the way stands the second of the gradient's five colours.
    const Rgb quarter = heatColor(0.25);
    const std::string text = "rgb(" + std::to_string(quarter.r) + "," + std::to_string(quarter.g) +
                             "," + std::to_string(quarter.b) + ")";
    EXPECT_NE(heatGradient().find(")," + text + ",rgb("), std::string::npos) << heatGradient();
}

TEST(HeatMap, ShowsTheLargestChannel) {
    Image a(glm::ivec2(3, 1));
    Image b(glm::ivec2(3, 1));
    b.rgba = {0, 0, 0, 0, 0.1F, -0.5F, 0, 0, 0, 0, 0, 1};
    const Image map = heatMap(a, b, 1);
    const double shares[] = {0, 0.5, 1};
    for (int x = 0; x < 3; ++x) {
        const Rgb color = heatColor(shares[x]);
        EXPECT_NEAR(srgbFromLinear(map.pixel(x, 0)[0]), color.r / 255.0, 1e-6) << x;
        EXPECT_NEAR(srgbFromLinear(map.pixel(x, 0)[1]), color.g / 255.0, 1e-6) << x;
        EXPECT_NEAR(srgbFromLinear(map.pixel(x, 0)[2]), color.b / 255.0, 1e-6) << x;
        EXPECT_EQ(map.pixel(x, 0)[3], 1);
    }
    const Image same = heatMap(a, a, 0);
    EXPECT_NEAR(srgbFromLinear(same.pixel(0, 0)[2]), heatColor(0).b / 255.0, 1e-6);
}

TEST(Base64, IsThatOfRfc4648) {
    EXPECT_EQ(base64Text(""), "");
    EXPECT_EQ(base64Text("f"), "Zg==");
    EXPECT_EQ(base64Text("fo"), "Zm8=");
    EXPECT_EQ(base64Text("foo"), "Zm9v");
    EXPECT_EQ(base64Text("foobar"), "Zm9vYmFy");
    EXPECT_EQ(base64Text("\xfb\xff\xfe"), "+//+");
}

TEST(PngDataUri, HoldsAPng) {
    const std::string uri = pngDataUri(Image(glm::ivec2(2, 3)));
    // The signature, and the length of the header that a PNG begins with.
    EXPECT_TRUE(uri.starts_with("data:image/png;base64,iVBORw0KGgoAAAAN")) << uri;
}

TEST(PageFile, MakesItsFolderOnlyWhenItIsWritten) {
    const test::TempFolder folder;
    for (const char* name : {"made", "slash/"}) {
        checkPageFolder(folder / name, {8, 8});
        EXPECT_FALSE(std::filesystem::exists(folder / name));
        writePage(folder / name, "<!doctype html>");
        EXPECT_EQ(test::readBytes(folder / name / "index.html"), "<!doctype html>");
        checkPageFolder(folder / name, {8, 8});
        writePage(folder / name, "again");
        EXPECT_EQ(test::readBytes(folder / name / "index.html"), "again");
    }
    EXPECT_EQ(folder.count(), 2);
}

TEST(PageFile, RefusesWhatItCannotWrite) {
    const test::TempFolder folder;
    const auto codeFor = [&](const std::string& name, glm::ivec2 size) {
        try {
            checkPageFolder(folder / name, size);
        } catch (const Error& error) {
            return error.code();
        }
        return ErrorCode::kFailed;
    };
    EXPECT_EQ(codeFor("no/folder", {8, 8}), ErrorCode::kOutput);
    EXPECT_EQ(codeFor("out", {1'000'001, 1}), ErrorCode::kUsage);
    std::filesystem::create_directories(folder / "taken/index.html");
    EXPECT_EQ(codeFor("taken", {8, 8}), ErrorCode::kOutput);
    std::ofstream(folder / "file") << "here";
    EXPECT_EQ(codeFor("file", {8, 8}), ErrorCode::kOutput);
}

}  // namespace
}  // namespace deltasplat
