// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "base/text.h"
#include "deltasplat/error.h"
#include "deltasplat/optics/transfer_function.h"
#include "optics/color_curve.h"
#include "optics/color_space.h"

namespace deltasplat {
namespace {

namespace fs = std::filesystem;

class ReadTransferFunction : public ::testing::Test {
  protected:
    void SetUp() override {
        const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
        folder_ = fs::temp_directory_path() /
                  ("deltasplat_tf_" + std::to_string(getpid()) + test->name());
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    TransferFunction read(const std::string& text) {
        std::ofstream(folder_ / "tf.json", std::ios::binary) << text;
        Listener listener;
        listener.warning = [this](const std::string& line) { warnings_.push_back(line); };
        return readTransferFunction(folder_ / "tf.json", listener);
    }

    // The error's text without the folder.
    std::string errorOf(const std::string& text) {
        try {
            read(text);
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::kInput);
            const std::string prefix = folder_.string() + "/";
            const std::string what = error.what();
            EXPECT_EQ(what.substr(0, prefix.size()), prefix);
            return what.substr(prefix.size());
        }
        return "no error";
    }

    fs::path folder_;
    std::vector<std::string> warnings_;
};

const char* const kPreset = R"([
 {
  "Name": "hot",
  "NanColor": [0, 0, 1],
  "RGBPoints": [
   -1.5, 0.1, 0.2, 0.3,
   2e1, 1, 1, 1
  ],
  "Points": [-1.5, 0, 0.25, 0.5, 20, 0.75, 0.5, 0]
 },
 { "Name": "second", "RGBPoints": "never looked at" }
])";

TEST_F(ReadTransferFunction, takesTheFirstPresetOfAnArray) {
    const TransferFunction function = read(kPreset);
    EXPECT_EQ(function.name, "hot");
    ASSERT_EQ(function.colors.size(), 2u);
    EXPECT_EQ(function.colors[0].x, -1.5);
    EXPECT_EQ(function.colors[0].rgb, glm::dvec3(0.1, 0.2, 0.3));
    EXPECT_EQ(function.colors[1].x, 20);
    ASSERT_EQ(function.opacities.size(), 2u);
    EXPECT_EQ(function.opacities[0].midpoint, 0.25);
    EXPECT_EQ(function.opacities[0].sharpness, 0.5);
    EXPECT_EQ(function.opacities[1].opacity, 0.75);
    EXPECT_FALSE(function.normalized);
    EXPECT_FALSE(function.linearColors);
    EXPECT_TRUE(warnings_.empty());
}

TEST_F(ReadTransferFunction, takesAPlainObjectWithAllItsSwitches) {
    const TransferFunction function =
        read(R"({"RGBPoints": [0,0,0,0], "Points": [0,0,0.5,0], "Normalized": true,
                 "ColorSpaceOfPoints": "linear", "ColorSpace": "RGB"})");
    EXPECT_EQ(function.name, "tf");
    EXPECT_TRUE(function.normalized);
    EXPECT_TRUE(function.linearColors);
    EXPECT_TRUE(warnings_.empty());
}

TEST_F(ReadTransferFunction, warnsOfAnotherColorSpace) {
    read(R"({"RGBPoints": [0,0,0,0], "Points": [0,0,0.5,0], "ColorSpace": "XYZ"})");
    ASSERT_EQ(warnings_.size(), 1u);
    EXPECT_EQ(warnings_[0],
              (folder_ / "tf.json").string() + ": ColorSpace XYZ is interpolated as RGB");
}

TEST_F(ReadTransferFunction, knowsTheColorSpacesOfParaView) {
    const auto spaceOf = [&](const std::string& members) {
        return read("{\"RGBPoints\": [0,0,0,0], \"Points\": [0,0,0.5,0], " + members + "}")
            .colorSpace;
    };
    EXPECT_EQ(spaceOf(R"("ColorSpace": "RGB")"), ColorSpace::kRgb);
    EXPECT_EQ(spaceOf(R"("ColorSpace": "HSV")"), ColorSpace::kHsv);
    EXPECT_EQ(spaceOf(R"("ColorSpace": "HSV", "HSVWrap": 1)"), ColorSpace::kHsvShortest);
    EXPECT_EQ(spaceOf(R"("ColorSpace": "HSV", "HSVWrap": true)"), ColorSpace::kHsvShortest);
    EXPECT_EQ(spaceOf(R"("ColorSpace": "HSV", "HSVWrap": false)"), ColorSpace::kHsv);
    EXPECT_EQ(spaceOf(R"("ColorSpace": "Lab")"), ColorSpace::kLab);
    EXPECT_EQ(spaceOf(R"("ColorSpace": "CIELAB")"), ColorSpace::kLab);
    EXPECT_EQ(spaceOf(R"("ColorSpace": "Diverging", "NanColor": [1, 1, 0])"),
              ColorSpace::kDiverging);
    EXPECT_TRUE(warnings_.empty());
}

TEST_F(ReadTransferFunction, ciede2000GoesTheShortestWay) {
    const std::string rest =
        R"("RGBPoints": [10,0,0,1, 20,1,1,0, 20,1,0,0], "Points": [0,0,0.5,0])";
    const TransferFunction function = read("{\"ColorSpace\": \"Lab/CIEDE2000\", " + rest + "}");
    const TransferFunction lab = read("{\"ColorSpace\": \"Lab\", " + rest + "}");
    EXPECT_TRUE(warnings_.empty());
    EXPECT_EQ(function.colorSpace, ColorSpace::kLab);
    // Steps of the same width look the same, which they do not as Lab.
    const auto unevenness = [](const TransferFunction& f) {
        double least = 1e9;
        double most = 0;
        for (int i = 0; i < 10; ++i) {
            const double step = colorDifference(labFromLinear(f.colorAt(10 + i)),
                                                labFromLinear(f.colorAt(11 + i - 1e-9 * i)));
            least = std::min(least, step);
            most = std::max(most, step);
        }
        return most / least;
    };
    EXPECT_LT(unevenness(function), 1.3);
    EXPECT_GT(unevenness(lab), 1.5);
    // The points themselves stay, and so do jumps.
    for (const double x : {5.0, 10.0, 20.0, 30.0})
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(function.colorAt(x)[c], lab.colorAt(x)[c], 1e-12);

    read("{\"ColorSpaceOfPoints\": \"linear\", \"ColorSpace\": \"Lab/CIEDE2000\", " + rest + "}");
    ASSERT_EQ(warnings_.size(), 1u);
    EXPECT_TRUE(warnings_[0].ends_with("with linear colours is interpolated as Lab"));
}

// As vtkColorTransferFunction::GetTable: of the nodes around x, the first that is not below x.
TEST_F(ReadTransferFunction, stepHoldsTheColorOfTheRightEnd) {
    const TransferFunction function =
        read(R"({"RGBPoints": [0,0.1,0,0, 1,0.2,0,0, 2,0.3,0,0], "Points": [0,0,0.5,0],
                 "ColorSpace": "Step", "ColorSpaceOfPoints": "linear"})");
    EXPECT_EQ(function.colorAt(-1).r, 0.1);
    EXPECT_EQ(function.colorAt(0).r, 0.1);
    EXPECT_EQ(function.colorAt(1e-9).r, 0.2);
    EXPECT_EQ(function.colorAt(0.5).r, 0.2);
    EXPECT_EQ(function.colorAt(1).r, 0.2);
    EXPECT_EQ(function.colorAt(1.5).r, 0.3);
    EXPECT_EQ(function.colorAt(2).r, 0.3);
    EXPECT_EQ(function.colorAt(9).r, 0.3);
    EXPECT_TRUE(warnings_.empty());
}

// Labels keep their own colours whatever the range does to their places.
TEST_F(ReadTransferFunction, stepGivesLabelsOfANormalizedRangeTheirOwnColors) {
    for (int labels = 2; labels <= 40; ++labels) {
        std::string points;
        for (int i = 0; i < labels; ++i) {
            points += (i > 0 ? ", " : "") + numberText(double(i) / (labels - 1)) + ", " +
                      numberText(double(i) / labels) + ", 0, 0";
        }
        const TransferFunction function =
            read("{\"RGBPoints\": [" + points + R"(], "Points": [0,0,0.5,0], "Normalized": true,
                 "ColorSpace": "Step", "ColorSpaceOfPoints": "linear"})");
        const double low = 1;
        const double high = labels;
        for (int i = 0; i < labels; ++i) {
            const double x = (0.5 * (i + 1) - 0.5 * low) / (0.5 * high - 0.5 * low);
            EXPECT_EQ(function.colorAt(x).r, double(i) / labels) << i << " of " << labels;
        }
    }
}

TEST_F(ReadTransferFunction, ramps0To1WithoutPoints) {
    const TransferFunction function = read(R"({"RGBPoints": [2,0,0,0, 6,1,1,1]})");
    EXPECT_EQ(function.opacityAt(2), 0);
    EXPECT_EQ(function.opacityAt(3), 0.25);
    EXPECT_EQ(function.opacityAt(6), 1);
    ASSERT_EQ(warnings_.size(), 1u);
    EXPECT_EQ(warnings_[0], (folder_ / "tf.json").string() +
                                ": no Points (opacities); opacity rises from 0 at 2 to 1 at 6");
}

TEST_F(ReadTransferFunction, saysWhichLineHoldsNoNumber) {
    EXPECT_EQ(errorOf("{\n\"RGBPoints\": [\n0,\n0,\n0,\n0,\n\"abc\", 0, 0, 0]}"),
              "tf.json:7: got \"abc\"; expected a number in RGBPoints");
    EXPECT_EQ(errorOf("{\"RGBPoints\": [0, 0, 0, 0],\n\"Points\": [0,\n null,\n0,0]}"),
              "tf.json:3: got null; expected a number in Points");
}

TEST_F(ReadTransferFunction, countsTheLineOfANumberThatEndsIt) {
    EXPECT_EQ(errorOf("{\"RGBPoints\": [\n0,\n0,\n0,\n1.5\n\n]}"),
              "tf.json:5: got 1.5; expected a number within 0..1 in RGBPoints");
}

TEST_F(ReadTransferFunction, refusesWhatIsOutOfRange) {
    const std::string colors = "{\"RGBPoints\": [0,0,0,0],\n\"Points\": ";
    EXPECT_EQ(errorOf(colors + "[0, -0.1, 0.5, 0]}"),
              "tf.json:2: got -0.1; expected a number within 0..1 in Points");
    EXPECT_EQ(errorOf(colors + "[0, 0.1, 2, 0]}"),
              "tf.json:2: got 2; expected a number within 0..1 in Points");
    EXPECT_EQ(errorOf(colors + "[0, 0.1, 0.5, 1e999]}"),
              "tf.json:2: got 1e999; expected a finite number");
    EXPECT_EQ(errorOf(colors + "[5, 0.1, 0.5, 0, 4, 0.1, 0.5, 0]}"),
              "tf.json:2: got 4; expected x not below the 5 before it in Points");
}

TEST_F(ReadTransferFunction, linearColorsMayBeBrighterThanOne) {
    const std::string bright = "\"RGBPoints\": [0, 1000, 0.001, 0], \"Points\": [0, 1, 0.5, 0]}";
    const TransferFunction function = read("{\"ColorSpaceOfPoints\": \"linear\", " + bright);
    EXPECT_EQ(function.colorAt(0), glm::dvec3(1000, 0.001, 0));
    EXPECT_EQ(errorOf("{" + bright),
              "tf.json:1: got 1000; expected a number within 0..1 in RGBPoints");
    EXPECT_EQ(errorOf("{\"ColorSpaceOfPoints\": \"linear\", \"RGBPoints\": [0, -1, 0, 0]}"),
              "tf.json:1: got -1; expected a number >= 0 in RGBPoints");
}

TEST_F(ReadTransferFunction, refusesAWrongNumberOfNumbers) {
    const std::string expected =
        "; expected RGBPoints with groups of four numbers (x, red, green, blue)";
    EXPECT_EQ(errorOf("{\n\"RGBPoints\": [0,0,0,0, 1]}"), "tf.json:2: got 5 numbers" + expected);
    EXPECT_EQ(errorOf("{\n\"RGBPoints\": []}"), "tf.json:2: got 0 numbers" + expected);
    EXPECT_EQ(errorOf("{\n\"RGBPoints\": 3}"), "tf.json:2: got 3" + expected);
    EXPECT_EQ(errorOf("\n{\n}"), "tf.json:2: got no RGBPoints" + expected);
    EXPECT_EQ(errorOf("{\"RGBPoints\": [0,0,0,0], \"Points\": []}"),
              "tf.json:1: got 0 numbers; expected Points with groups of four numbers (x, opacity, "
              "midpoint, sharpness)");
}

TEST_F(ReadTransferFunction, refusesMembersOfAnotherKind) {
    const std::string points = ", \"RGBPoints\": [0,0,0,0], \"Points\": [0,0,0,0]}";
    EXPECT_EQ(errorOf("{\"Name\": 3" + points), "tf.json:1: got 3; expected text in Name");
    EXPECT_EQ(errorOf("{\"Normalized\": 1" + points),
              "tf.json:1: got 1; expected true or false in Normalized");
    EXPECT_EQ(errorOf("{\"ColorSpace\": [1]" + points),
              "tf.json:1: got an array; expected text in ColorSpace");
}

TEST_F(ReadTransferFunction, refusesWhatIsNoTransferFunction) {
    const std::string expected = "; expected a transfer function, an object with RGBPoints";
    EXPECT_EQ(errorOf("[]"), "tf.json:1: got an empty array" + expected);
    EXPECT_EQ(errorOf("\n[\n7]"), "tf.json:3: got 7" + expected);
    EXPECT_EQ(errorOf("[[]]"), "tf.json:1: got an array" + expected);
    EXPECT_EQ(errorOf("\"abc\""), "tf.json:1: got \"abc\"" + expected);
}

TEST_F(ReadTransferFunction, refusesBrokenJson) {
    EXPECT_EQ(errorOf(""), "tf.json:1: got the end of the file; expected valid JSON");
    EXPECT_EQ(errorOf("{\"Name\":\n\n[1, 2"),
              "tf.json:3: got the end of the file; expected valid JSON");
    EXPECT_EQ(errorOf("{\n\"Name\" 5}"), "tf.json:2: got 5; expected valid JSON");
    EXPECT_EQ(errorOf("{} {}"), "tf.json:1: got {} {; expected valid JSON");
    const std::string unfinished = errorOf("{\n\"" + std::string(5000, 'x'));
    EXPECT_EQ(unfinished.substr(0, 18), "tf.json:2: got \"xx");
    EXPECT_LT(unfinished.size(), 100u);
}

TEST_F(ReadTransferFunction, survivesNestingAndForeignBytes) {
    EXPECT_EQ(errorOf(std::string(1000000, '[')),
              "tf.json:1: got more than 32 levels; expected a transfer function");
    std::string bytes;
    for (int i = 0; i < 4096; ++i) bytes.push_back(char((i * 2654435761u) >> 13));
    EXPECT_NE(errorOf(bytes).find("expected valid JSON"), std::string::npos);
}

TEST_F(ReadTransferFunction, refusesMissingFilesAndFolders) {
    for (const bool isThere : {false, true}) {
        const fs::path path = isThere ? folder_ : folder_ / "missing.json";
        const std::string got = isThere ? "no file that can be read" : "no such file";
        try {
            readTransferFunction(path);
            ADD_FAILURE() << path;
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::kInput);
            EXPECT_EQ(error.what(), path.string() + ": got " + got +
                                        "; expected a transfer function (ParaView's JSON)");
        }
    }
}

}  // namespace
}  // namespace deltasplat
