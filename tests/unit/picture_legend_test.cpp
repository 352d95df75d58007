// SPDX-License-Identifier: Apache-2.0
#include "render/picture_legend.h"

#include <gtest/gtest.h>

#include <fstream>

#include "deltasplat/optics/presets.h"
#include "options/transfer_function_option.h"
#include "support/make_volume.h"
#include "unit/temp_folder.h"

namespace deltasplat {
namespace {

constexpr IndexBox kBox{{0, 0, 0}, {3, 0, 0}};

// Four voxels: 0, 1, 2 and 600.
Volume someVolume() {
    return test::makeVolume(kBox, [](int x, int, int) { return x == 3 ? 600 : x; });
}

ValueScale scaleOf(const TransferFunction& function, std::optional<glm::dvec2> range = {},
                   Mode mode = Mode::kComposite) {
    RenderCommand command;
    command.picture.render.mode = mode;
    Optics optics;
    optics.transferFunction = function;
    optics.range = range;
    return std::get<ValueScale>(pictureLegend(command, someVolume(), optics, {}).key);
}

TransferFunction blackToWhite(double begin, double end) {
    TransferFunction function;
    function.colors = {{begin, glm::dvec3(0)}, {end, glm::dvec3(1)}};
    function.opacities = {{begin - 10, 0, 0.5, 0}, {end, 1, 0.5, 0}};
    return function;
}

TEST(PictureLegend, SpansThePointsOfTheFunction) {
    const ValueScale scale = scaleOf(blackToWhite(100, 200));
    EXPECT_EQ(scale.range, glm::dvec2(90, 200));
    EXPECT_EQ(scale.colorOf(100).g, 0);
    EXPECT_EQ(scale.colorOf(160).g, 153);  // of 255 six tenths
    EXPECT_NEAR(scale.opacityOf(145), 0.5, 1e-12);
    // Of largest values opacities mean nothing.
    const ValueScale mip = scaleOf(blackToWhite(100, 200), {}, Mode::kMip);
    EXPECT_EQ(mip.range, glm::dvec2(100, 200));
    EXPECT_FALSE(mip.opacityOf);
}

TEST(PictureLegend, SpansTheRangeOfANormalizedFunction) {
    TransferFunction function = blackToWhite(0, 1);
    function.opacities.front().x = 0;
    function.normalized = true;
    EXPECT_EQ(scaleOf(function).range, glm::dvec2(0, 600));
    const ValueScale given = scaleOf(function, glm::dvec2(-50, 150));
    EXPECT_EQ(given.range, glm::dvec2(-50, 150));
    EXPECT_EQ(given.colorOf(100).r, 191);  // three quarters
    EXPECT_NEAR(given.opacityOf(0), 0.25, 1e-12);
}

TEST(PictureLegend, HasSomethingToShowOfOneValue) {
    TransferFunction function = blackToWhite(600, 600);
    function.opacities = {{600, 0.5, 0.5, 0}};
    EXPECT_EQ(scaleOf(function).range, glm::dvec2(0, 600));
}

TEST(PictureLegend, ShowsThePartOfAScanPresetThatMatters) {
    EXPECT_EQ(scaleOf(presetFunction("ct-soft-tissue")).range, glm::dvec2(-400, 1500));
}

TEST(PictureLegend, ShowsAWindowAsGreys) {
    RenderCommand command;
    command.picture.render.mode = Mode::kMip;
    const Legend legend = pictureLegend(command, someVolume(), {}, glm::dvec2(10, 20));
    EXPECT_EQ(legend.title, "test");
    const auto& scale = std::get<ValueScale>(legend.key);
    EXPECT_EQ(scale.range, glm::dvec2(10, 20));
    EXPECT_FALSE(scale.opacityOf);
    EXPECT_EQ(scale.colorOf(16).b, 153);
}

TEST(PictureLegend, ListsTheLabelsThatAreSeen) {
    const test::TempFolder folder;
    const auto table = folder / "some.ctbl";
    std::ofstream(table) << "0 nothing 0 0 0 0\n1 \"left lung\" 255 0 0 255\n3 other 9 9 9 255\n"
                            "600 bone 0 0 255 128\n";
    RenderCommand command;
    command.picture.transferFunction = table;
    Optics optics;
    optics.transferFunction = readTransferFunctionOption(table, {});
    const auto labels =
        std::get<std::vector<LabelColor>>(pictureLegend(command, someVolume(), optics, {}).key);
    ASSERT_EQ(labels.size(), 2u);
    EXPECT_EQ(labels[0].name, "left lung");
    EXPECT_EQ(labels[0].color.r, 255);
    EXPECT_EQ(labels[1].name, "bone");
    EXPECT_EQ(labels[1].color.b, 255);

    // A preset knows numbers only.
    RenderCommand preset;
    preset.picture.transferFunction = "labels";
    optics.transferFunction = presetFunction("labels");
    const auto numbers =
        std::get<std::vector<LabelColor>>(pictureLegend(preset, someVolume(), optics, {}).key);
    ASSERT_EQ(numbers.size(), 3u);
    EXPECT_EQ(numbers[0].name, "1");
    EXPECT_EQ(numbers[2].name, "600");
}

}  // namespace
}  // namespace deltasplat
