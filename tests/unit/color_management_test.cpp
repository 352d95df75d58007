// SPDX-License-Identifier: Apache-2.0
// Colours by OpenColorIO, of a configuration of our own.
#include "deltasplat/image/color_management.h"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <string>

#include "support/error_of.h"
#include "unit/temp_folder.h"

namespace deltasplat {
namespace {

using test::errorOf;

std::filesystem::path dataFile(const char* name) {
    return std::filesystem::path(DELTASPLAT_SOURCE_DIR) / "tests/cli/data" / name;
}

ColorOptions options() {
    ColorOptions options;
    options.config = dataFile("config.ocio");
    return options;
}

Image pixels() {
    Image image({4, 1});
    image.rgba = {1, 0, 0, 1, 0.09f, 0.18f, 0.045f, 0.5f, 0, 0, 0, 0, 4, 0.5f, 0.25f, 1};
    return image;
}

void expectPixel(const Image& image, int x, const std::array<double, 4>& expected, double within) {
    for (int c = 0; c < 4; ++c)
        EXPECT_NEAR(image.pixel(x, 0)[c], expected[std::size_t(c)], within) << x << " " << c;
}

TEST(ColorManagement, convertsLight) {
    ColorOptions acescg = options();
    acescg.colorSpace = "ACEScg";
    Image image = pixels();
    ColorTransform(acescg).convert(image);
    expectPixel(image, 0, {0.613097, 0.070194, 0.020616, 1}, 1e-6);
    expectPixel(image, 1,
                {0.613097 * 0.09 + 0.339523 * 0.18 + 0.047379 * 0.045,
                 0.070194 * 0.09 + 0.916354 * 0.18 + 0.013452 * 0.045,
                 0.020616 * 0.09 + 0.109570 * 0.18 + 0.869815 * 0.045, 0.5},
                1e-6);
    expectPixel(image, 2, {0, 0, 0, 0}, 0);
}

// A display of sRGB shows what is shown without one; others what they make of it.
TEST(ColorManagement, showsLight) {
    ColorOptions shown = options();
    shown.display = "sRGB";
    Image image = pixels();
    ColorTransform(shown).show(image);
    expectPixel(image, 0, {1, 0, 0, 1}, 1e-5);
    expectPixel(image, 1, {0.09, 0.18, 0.045, 0.5}, 1e-5);
    expectPixel(image, 2, {0, 0, 0, 0}, 0);
    expectPixel(image, 3, {1, 0.5, 0.25, 1}, 1e-5);
    shown.display.clear();
    shown.displayView = "Half";
    image = pixels();
    ColorTransform(shown).show(image);
    // Half of what white is stored as is linear 0.214.
    expectPixel(image, 0, {0.2140411, 0, 0, 1}, 1e-5);
}

TEST(ColorManagement, looksAreOfWhatIsShown) {
    ColorOptions look;
    look.look = dataFile("swap.cube");
    Image image = pixels();
    ColorTransform(look).show(image);
    expectPixel(image, 0, {0, 0, 1, 1}, 1e-5);
    expectPixel(image, 1, {0.045, 0.18, 0.09, 0.5}, 1e-5);
    expectPixel(image, 3, {0.25, 0.5, 1, 1}, 1e-5);
}

TEST(ColorManagement, knowsColoursOfAces) {
    EXPECT_EQ(chromaticitiesOf("ACEScg").value()[0], 0.713f);
    EXPECT_EQ(chromaticitiesOf("ACES - ACES2065-1").value()[0], 0.7347f);
    EXPECT_EQ(chromaticitiesOf("Linear Rec.709 (sRGB)"), kRec709);
    EXPECT_FALSE(chromaticitiesOf("filmlight"));
}

TEST(ColorManagement, refusesWhatIsNotThere) {
    const auto message = [](const auto& change) {
        ColorOptions color = options();
        change(color);
        return errorOf([&] { ColorTransform{color}; });
    };
    EXPECT_EQ(message([](ColorOptions& color) { color.colorSpace = "lin_srgb"; }), "no error");
    EXPECT_EQ(message([](ColorOptions& color) { color.colorSpace = "none"; }),
              "usage: `colorSpace`: got none; expected one of ACEScg, lin_srgb, sRGB, half, raw");
    EXPECT_EQ(message([](ColorOptions& color) { color.workingSpace = "none"; }),
              "usage: `workingSpace`: got none; expected one of ACEScg, lin_srgb, sRGB, half, raw");
    EXPECT_EQ(message([](ColorOptions& color) { color.display = "none"; }),
              "usage: `display`: got none; expected one of sRGB");
    EXPECT_EQ(message([](ColorOptions& color) { color.displayView = "none"; }),
              "usage: `displayView`: got none; expected one of Standard, Half");
    EXPECT_EQ(message([](ColorOptions& color) { color.look = "none.cube"; }),
              "input: none.cube: got no such file; expected a readable file");
    EXPECT_EQ(message([](ColorOptions& color) { color.config = "none.ocio"; }),
              "input: none.ocio: got no such file; expected a readable file");
    EXPECT_NE(message([](ColorOptions& color) {
                  color.config = dataFile("swap.cube");
              }).find("swap.cube: got "),
              std::string::npos);
    EXPECT_NE(message([](ColorOptions& color) {
                  color.look = dataFile("config.ocio");
              }).find("`look`: got "),
              std::string::npos);
}

// OpenImageIO takes what is said of a file for a format of its own message, and would end the
// process.
TEST(ColorManagement, refusesTablesWithBracesInThem) {
    const test::TempFolder folder;
    const std::string table = "LUT_1D_SIZE 2\n0 0 0\n1 1 1\n{:x \033[31m}\n";
    const std::string config = R"(ocio_profile_version: 2
search_path: .
roles: {default: raw, scene_linear: lin}
displays:
  sRGB:
    - !<View> {name: Bad, colorspace: bad}
    - !<View> {name: Gone, colorspace: gone}
active_displays: [sRGB]
active_views: [Bad, Gone]
colorspaces:
  - !<ColorSpace>
    name: lin
  - !<ColorSpace>
    name: raw
    isdata: true
  - !<ColorSpace>
    name: bad
    from_scene_reference: !<FileTransform> {src: a.cube}
  - !<ColorSpace>
    name: gone
    from_scene_reference: !<FileTransform> {src: "{}{:x}\e[31m.cube"}
)";
    std::ofstream(folder / "a.cube") << table;
    std::ofstream(folder / "{0}.cube") << table;
    std::ofstream(folder / "c.ocio") << config;
    const auto message = [&](const auto& change) {
        ColorOptions color;
        color.config = folder / "c.ocio";
        change(color);
        return errorOf([&] { ColorTransform{color}; });
    };
    const auto expectRefused = [](const std::string& text, const std::string& begin,
                                  const std::string& part) {
        EXPECT_TRUE(text.starts_with(begin)) << text;
        EXPECT_NE(text.find(part), std::string::npos) << text;
        EXPECT_EQ(text.find_first_of("\n\033"), std::string::npos) << text;
    };
    expectRefused(message([](ColorOptions& color) { color.display = "sRGB"; }),
                  "input: `display`: got sRGB: ", "a.cube). At line (4): '{:x ?[31m}'");
    expectRefused(message([](ColorOptions& color) { color.displayView = "Gone"; }),
                  "input: `display`: got sRGB: ", "'{}{:x}?[31m.cube' could not be located");
    expectRefused(message([](ColorOptions& color) { color.colorSpace = "bad"; }),
                  "input: `colorSpace`: got bad: ", "'{:x ?[31m}'");
    expectRefused(message([&](ColorOptions& color) { color.look = folder / "a.cube"; }),
                  "input: `look`: got " + (folder / "a.cube").string() + ": ", "'{:x ?[31m}'");
    expectRefused(message([&](ColorOptions& color) { color.look = folder / "{0}.cube"; }),
                  "input: `look`: got " + (folder / "{0}.cube").string() + ": ",
                  "/{0}.cube). At line (4): '{:x ?[31m}'");
    EXPECT_EQ(message([](ColorOptions& color) { color.colorSpace = "lin"; }), "no error");
}

}  // namespace
}  // namespace deltasplat
