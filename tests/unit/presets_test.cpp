// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/optics/presets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>

#include "deltasplat/optics/default_ramp.h"
#include "deltasplat/optics/transfer_function_names.h"
#include "image/srgb.h"
#include "optics/check_optics.h"
#include "optics/color_curve.h"
#include "optics/label_function.h"
#include "optics/value_colors.h"
#include "support/error_of.h"
#include "support/make_volume.h"
#include "unit/temp_folder.h"

namespace deltasplat {
namespace {

using test::errorOf;

double lightnessOf(const glm::dvec3& linear) {
    return glm::dot(linear, glm::dvec3(0.2126, 0.7152, 0.0722));
}

TEST(Presets, canBeRenderedWith) {
    ASSERT_GE(presets().size(), 18u);
    for (const Preset& preset : presets()) {
        SCOPED_TRACE(preset.name);
        Optics optics;
        optics.transferFunction = presetFunction(preset.name);
        EXPECT_NO_THROW(checkOptics(optics));
        EXPECT_EQ(optics.transferFunction.name, preset.name);
        EXPECT_EQ(optics.transferFunction.normalized, preset.values == Preset::Values::kRange);
        EXPECT_FALSE(preset.summary.empty());
        EXPECT_EQ(findPreset(preset.name), &preset);
        // Something is seen, and something is not.
        const TransferFunction& function = optics.transferFunction;
        double most = 0, least = 1;
        for (int i = 0; i <= 4000; ++i) {
            const double x = function.normalized ? i / 4000.0 : i - 1000.0;
            most = std::max(most, function.opacityAt(x));
            least = std::min(least, function.opacityAt(x));
        }
        EXPECT_GE(most, 0.05);
        EXPECT_EQ(least, 0);
    }
}

TEST(Presets, showOfAScanWhatTheirNamesSay) {
    const auto opacity = [](const char* name, double hounsfield) {
        return presetFunction(name).opacityAt(hounsfield);
    };
    for (const char* name : {"ct-bone", "ct-soft-tissue", "ct-lung", "ct-angio"})
        EXPECT_EQ(opacity(name, -1000), 0) << name;
    EXPECT_EQ(opacity("ct-bone", 60), 0);
    EXPECT_GT(opacity("ct-bone", 1000), 0.5);
    EXPECT_GT(opacity("ct-soft-tissue", 50), 0.1);
    EXPECT_GT(opacity("ct-soft-tissue", 800), opacity("ct-soft-tissue", 50));
    EXPECT_GT(opacity("ct-lung", -800), 0);
    EXPECT_EQ(opacity("ct-lung", 50), 0);
    EXPECT_EQ(opacity("ct-angio", 60), 0);
    EXPECT_GT(opacity("ct-angio", 300), 0.3);
}

// As published: ends and a middle of each map.
TEST(Presets, haveTheColorsOfWellKnownMaps) {
    struct Known {
        const char* name;
        double x;
        int r, g, b;
    };
    for (const Known& known :
         {Known{"viridis", 0, 68, 1, 84}, Known{"viridis", 1, 253, 231, 37},
          Known{"viridis", 0.5, 33, 145, 140}, Known{"inferno", 0, 0, 0, 4},
          Known{"inferno", 1, 252, 255, 164}, Known{"magma", 1, 252, 253, 191},
          Known{"plasma", 0, 13, 8, 135}, Known{"cividis", 1, 254, 232, 56},
          Known{"turbo", 0, 48, 18, 59}, Known{"turbo", 1, 122, 4, 3},
          Known{"coolwarm", 0, 59, 76, 192}, Known{"coolwarm", 0.5, 221, 221, 221}}) {
        const glm::dvec3 color = presetFunction(known.name).colorAt(known.x);
        const int expected[] = {known.r, known.g, known.b};
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(255 * srgbFromLinear(color[c]), expected[c], 1) << known.name << ' ' << c;
    }
    for (const char* name : {"viridis", "inferno", "magma", "plasma", "cividis", "grey"}) {
        const TransferFunction function = presetFunction(name);
        for (int i = 1; i <= 50; ++i) {
            EXPECT_GT(lightnessOf(function.colorAt(i / 50.0)),
                      lightnessOf(function.colorAt((i - 1) / 50.0)))
                << name << ' ' << i;
        }
    }
}

glm::dvec2 fittedRange(const char* preset, const Volume& volume) {
    Optics optics;
    fitPreset(*findPreset(preset), volume, optics);
    return optics.range.value_or(glm::dvec2(-1));
}

// One voxel in a hundred is far below, and one far above the others.
TEST(Presets, ofARangeShowWhereMostValuesLie) {
    const Volume volume = test::makeVolume({{0, 0, 0}, {99, 99, 0}}, [](int x, int y, int) {
        return y == 0 ? (x == 0 ? 9000 : 5) : 1000 + y;
    });
    const glm::dvec2 range = bulkRange(volume);
    EXPECT_GT(range.x, 4);
    EXPECT_LT(range.y, 1100);
    EXPECT_EQ(fittedRange("viridis", volume), rampRange(volume));
    EXPECT_EQ(fittedRange("ct-bone", volume), glm::dvec2(-1));
    EXPECT_EQ(fittedRange("labels", volume), glm::dvec2(-1));
    Optics optics;
    optics.range = {2, 3};
    fitPreset(*findPreset("viridis"), volume, optics);
    EXPECT_EQ(optics.range, glm::dvec2(2, 3));
}

// As the default ramp: clear below the value that nearly all have, from there on at the top.
TEST(Presets, ofARangeAreAStepWhereNearlyAllIsOneValue) {
    for (const int most : {0, 7}) {
        Volume volume = test::makeVolume({{0, 0, 0}, {9, 9, 9}}, [&](int x, int y, int z) {
            if (x + y + z == 0) return 1000;
            return x + y + z == 1 && most > 0 ? most - 1 : most;
        });
        test::changed(volume)->background = 60000;
        for (const char* name : {"viridis", "fire", "mr"}) {
            SCOPED_TRACE(name + std::to_string(most));
            Optics optics;
            optics.transferFunction = presetFunction(name);
            fitPreset(*findPreset(name), volume, optics);
            EXPECT_NO_THROW(checkOptics(optics));
            const ClassTable table = classify(volume, optics, 1);
            const double opacity = optics.transferFunction.opacityAt(1);
            const glm::dvec3 color = optics.transferFunction.colorAt(1);
            const ValueColors colors(volume, optics);
            for (const int value : {most, 1000}) {
                const glm::dvec4 light = table.lightOfCode(Code(value));
                EXPECT_NEAR(light.a, opacity, 1e-4);
                for (int c = 0; c < 3; ++c) {
                    EXPECT_NEAR(light[c], opacity * color[c], 1e-4 * (1 + color[c]));
                    EXPECT_NEAR(colors.colorOf(float(value))[c], color[c], 1e-5);
                }
            }
            EXPECT_TRUE(most == 0 || table.lightOfCode(Code(most - 1)).a == 0);
        }
    }
}

// A tenth of air, the rest tissue, in a patient; what a scanner has not seen does not matter.
Volume scan(double air, double tissue, const std::string& space = "LPS") {
    Volume volume =
        test::makeVolume({{0, 0, 0}, {9, 9, 9}}, [](int x, int, int) { return x < 2 ? x : 2; });
    test::changed(volume)->codeBook = CodeBook::ofTable({-3024, air, tissue});
    test::changed(volume)->space = space;
    return volume;
}

TEST(Presets, knowScansInHounsfieldUnits) {
    EXPECT_TRUE(isHounsfield(scan(-1000, 40)));
    EXPECT_FALSE(isHounsfield(scan(-1000, 40, "")));
    EXPECT_FALSE(isHounsfield(scan(0, 40)));
    EXPECT_FALSE(isHounsfield(scan(-1000, 900)));
    EXPECT_FALSE(isHounsfield(Volume{}));
    EXPECT_NE(findPreset(kScanPreset), nullptr);
}

TEST(Presets, giveEveryLabelItsOwnColor) {
    const TransferFunction labels = presetFunction("labels");
    EXPECT_EQ(labels.opacityAt(0), 0);
    EXPECT_EQ(labels.opacityAt(-3), 0);
    EXPECT_TRUE(labels.colorsJump());
    const ColorCurve curve(labels);
    for (int label = 1; label <= 65535; ++label) {
        const glm::dvec3 color = curve.at(label);
        ASSERT_EQ(labels.opacityAt(label), 0.4) << label;
        ASSERT_EQ(curve.at(label + 0.4), color) << label;
        ASSERT_EQ(curve.at(label - 0.4), color) << label;
        if (label == 65535) break;
        ASSERT_GT(glm::distance(curve.at(label + 1), color), 0.2) << label;
    }
    EXPECT_EQ(labels.opacityAt(65536), 0);
}

TEST(Presets, areNamedWhereThereIsNone) {
    EXPECT_EQ(findPreset("bone"), nullptr);
    const std::string error = errorOf([] { presetFunction("bone"); });
    EXPECT_EQ(error.find("usage: preset: got bone; expected one of grey, ct-bone, "), 0u) << error;
}

class TransferFunctionFile : public ::testing::Test {
  protected:
    std::filesystem::path write(const std::string& name, const std::string& text) {
        const std::filesystem::path file = folder_.path() / name;
        std::ofstream(file, std::ios::binary) << text;
        return file;
    }
    TransferFunction read(const std::filesystem::path& file) {
        Listener listener;
        listener.warning = [this](const std::string& line) { warnings_.push_back(line); };
        return readLabelTable(file, listener);
    }
    static void expectColor(const TransferFunction& function, double x, const glm::dvec3& bytes) {
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(255 * srgbFromLinear(function.colorAt(x)[c]), bytes[c], 1e-9)
                << x << ' ' << c;
        }
    }
    // Without the folder.
    std::string errorFor(const std::filesystem::path& file) {
        std::string error = errorOf([&] { readLabelTable(file); });
        const std::size_t at = error.find(folder_.path().string() + "/");
        if (at != std::string::npos) error.erase(at, folder_.path().string().size() + 1);
        return error;
    }

    test::TempFolder folder_;
    std::vector<std::string> warnings_;
};

TEST_F(TransferFunctionFile, holdsSeveral) {
    const auto file =
        write("all.json", R"([{"Name": "a", "RGBPoints": [0,0.1,0,0], "Points": [0,1,0.5,0]},
        {"Name": "b: c", "RGBPoints": [0,0.2,0,0], "Points": [0,1,0.5,0]},
        {"RGBPoints": [0,0.3,0,0], "Points": [0,1,0.5,0]}])");
    EXPECT_EQ(transferFunctionNames(file), (std::vector<std::string>{"a", "b: c", ""}));
    EXPECT_EQ(readTransferFunction(file).name, "a");
    EXPECT_EQ(readTransferFunction(file, "b: c").colors[0].rgb.r, 0.2);
    EXPECT_NE(
        errorOf([&] {
            readTransferFunction(file, "d");
        }).find("all.json: got no transfer function \"d\"; expected one of those it has: a, b: c"),
        std::string::npos);
}

TEST_F(TransferFunctionFile, mayHoldMalformedOnesBesideTheOneChosen) {
    const auto file = write("all.json", R"([{"Name": 7}, "none", {"Name": "bad", "RGBPoints": 1},
        {"Name": "good", "RGBPoints": [0,0.2,0,0], "Points": [0,1,0.5,0]}])");
    EXPECT_EQ(transferFunctionNames(file), (std::vector<std::string>{"", "", "bad", "good"}));
    EXPECT_EQ(readTransferFunction(file, "good").colors[0].rgb.r, 0.2);
    const auto ends = [](const std::string& text, const std::string& end) {
        return text.size() >= end.size() && text.substr(text.size() - end.size()) == end;
    };
    EXPECT_TRUE(ends(errorOf([&] { readTransferFunction(file); }), "expected text in Name"));
    EXPECT_TRUE(ends(errorOf([&] { readTransferFunction(file, "none"); }),
                     "expected one of those it has: bad, good"));
    EXPECT_NE(errorOf([&] { readTransferFunction(file, "bad"); }).find("all.json:1: got 1"),
              std::string::npos);
}

TEST_F(TransferFunctionFile, mayBeATableOf3dSlicer) {
    const TransferFunction function = read(write("tissue.ctbl",
                                                 "# Color table file tissue\n# 3 values\n"
                                                 "0 background 0 0 0 0\n"
                                                 "2 bone 241 214 145 255\r\n"
                                                 "\n3 skin 177 122 101 102\n"
                                                 "7 no_alpha 0 255 0\n"));
    EXPECT_EQ(function.name, "tissue");
    EXPECT_EQ(function.opacityAt(0), 0);
    EXPECT_EQ(function.opacityAt(1), 0);
    EXPECT_EQ(function.opacityAt(2), 1);
    EXPECT_EQ(function.opacityAt(3), 0.4);
    EXPECT_EQ(function.opacityAt(5), 0);
    EXPECT_EQ(function.opacityAt(7), 1);
    EXPECT_EQ(function.opacityAt(8), 0);
    expectColor(function, 2, {241, 214, 145});
    expectColor(function, 3, {177, 122, 101});
    expectColor(function, 7, {0, 255, 0});
    EXPECT_TRUE(warnings_.empty());
}

TEST_F(TransferFunctionFile, ofLabelsIsCategorical) {
    for (const char* lines : {"1 a 255 0 0 0\n3 b 0 255 0 255\n5 c 0 0 255 255\n",
                              "5 c 0 0 255 255\n", "1 a 9 9 9\n2 b 9 9 9\n"}) {
        const TransferFunction function = readLabelTable(write("gaps.ctbl", lines));
        EXPECT_TRUE(function.categorical) << lines;
        EXPECT_TRUE(function.colorsJump()) << lines;
    }
}

// As in the table, where neighbours share a step and where not.
TEST_F(TransferFunctionFile, ofLabelsHasTheirOpacities) {
    const TransferFunction function =
        readLabelTable(write("steps.ctbl",
                             "1 a 0 0 0 51\n2 b 0 0 0 51\n3 c 0 0 0 51\n4 d 0 0 0 102\n"
                             "6 e 0 0 0 102\n"));
    const double expected[] = {0, 0.2, 0.2, 0.2, 0.4, 0, 0.4, 0};
    for (int label = 0; label < 8; ++label)
        for (const double x : {label - 0.49, label + 0.0, label + 0.49})
            EXPECT_EQ(function.opacityAt(x), expected[label]) << x;
}

TEST_F(TransferFunctionFile, mayBeLabelsOfItkSnap) {
    const TransferFunction function =
        read(write("labels.txt",
                   "################\n# ITK-SnAP Label Description File\n"
                   "    0     0    0    0        0  0  0    \"Clear Label\"\n"
                   "    1   255   10   20        0.5  1  1    \"Left lung, upper lobe\"\n"
                   "    2    30  255   40        1  0  1    \"hidden\"\n"));
    EXPECT_EQ(function.opacityAt(1), 0.5);
    EXPECT_EQ(function.opacityAt(2), 0);
    expectColor(function, 1, {255, 10, 20});
    expectColor(function, 2, {30, 255, 40});
    EXPECT_TRUE(warnings_.empty());
}

TEST_F(TransferFunctionFile, ofLabelsWarnsWhereAllAreClear) {
    read(write("free.ctbl", "0 Unknown 0 0 0 0\n4 Left-Lateral-Ventricle 120 18 134 0\n"));
    ASSERT_EQ(warnings_.size(), 1u);
    EXPECT_NE(warnings_[0].find("free.ctbl: all labels are clear, for each has an alpha of 0; where"
                                " that means opaque, as in tables of FreeSurfer, replace it by "
                                "255"),
              std::string::npos);
    warnings_.clear();
    read(write("snap.label", "1 255 0 0 1 0 1 \"hidden\"\n"));
    ASSERT_EQ(warnings_.size(), 1u);
    EXPECT_NE(warnings_[0].find("all labels are clear, for each is hidden"), std::string::npos);
}

TEST_F(TransferFunctionFile, ofLabelsMayBeginWithAByteOrderMark) {
    EXPECT_EQ(readLabelTable(write("bom.ctbl",
                                   "\xEF\xBB\xBF"
                                   "1 a 1 2 3 255\n"))
                  .opacityAt(1),
              1);
    EXPECT_EQ(readTransferFunction(write("bom.json",
                                         "\xEF\xBB\xBF{\"RGBPoints\": [0,0.1,0,0], \"Points\": "
                                         "[0,1,0.5,0]}"))
                  .colors[0]
                  .rgb.r,
              0.1);
}

// Alone, and not within a character.
TEST_F(TransferFunctionFile, ofLabelsQuotesWholeCharacters) {
    const std::string letters = "1 " + std::string(57, 'x');
    EXPECT_EQ(errorFor(write("a.ctbl", letters + "\u00e4\u00e4\n"))
                  .find("input: a.ctbl:1: got \"" + letters + "...\"; expected label, "),
              0u);
    EXPECT_EQ(errorFor(write("a.ctbl", letters + "x\u00e4\n"))
                  .find("input: a.ctbl:1: got \"" + letters + "x...\"; expected label, "),
              0u);
}

TEST_F(TransferFunctionFile, ofLabelsSaysWhichLineIsNone) {
    EXPECT_EQ(errorFor(write("a.ctbl", "# nothing\n")),
              "input: a.ctbl: got no labels; expected at least one");
    for (const char* line :
         {"1 bone 241 214", "x bone 1 2 3 255", "1 bone 1 2 300 255", "1 bone 1 2 3 -1",
          "1 bone 1 2 3 255 7", "1 left lung 1 2 3 255", "1 bone 1 2 3 x", "1 2 3 4 0.5 1 1 bone",
          "1 2 3 4 0.5 1 1 \"bone", "1 2 3 4 0.5 1 \"bone\"", "1 2 3 4 0.5 1 x \"bone\"",
          "1 2 3 4 0.5 1 1 \"bone\" 1", "1 2 3 4 1.5 1 1 \"bone\"", "1.5 bone 1 2 3 255",
          "1 bone 1 nan 3 255"}) {
        const std::string error = errorFor(write("b.ctbl", std::string("\n") + line + "\n"));
        EXPECT_EQ(
            error.find(std::string("input: b.ctbl:2: got \"") + line + "\"; expected label, "), 0u)
            << error;
    }
    std::filesystem::create_directory(folder_.path() / "folder.ctbl");
    EXPECT_EQ(errorFor(folder_.path() / "none.ctbl"),
              "input: none.ctbl: got no such file; expected a table of labels");
    EXPECT_EQ(errorFor(folder_.path() / "folder.ctbl"),
              "input: folder.ctbl: got no file that can be read; expected a table of labels");
}

}  // namespace
}  // namespace deltasplat
