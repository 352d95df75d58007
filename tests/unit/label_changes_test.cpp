// SPDX-License-Identifier: Apache-2.0
#include "optics/label_function.h"

#include <gtest/gtest.h>

#include <string>

#include "deltasplat/optics/presets.h"
#include "optics/color_curve.h"
#include "support/error_of.h"
#include "support/make_volume.h"

namespace deltasplat {
namespace {

using test::errorOf;

const std::vector<LabelLook> kLooks = {{-3, {1, 0, 0}, 0.5},
                                       {1, {0, 1, 0}, 0.5},
                                       {2, {0, 0, 1}, 0.5},
                                       {4, {0, 1, 1}, 0},
                                       {900000000, {1, 1, 0}, 1}};

class LabelChangesTest : public testing::Test {
  protected:
    TransferFunction change(const LabelChanges& changes) {
        return changeLabels(labelFunction(kLooks), changes);
    }
    Listener listener() {
        return {{}, [this](const std::string& line) { warnings_ += line + "\n"; }};
    }
    std::string warnings_;
};

// Opacities of the labels, at either end of what is theirs as well, and of what is none.
void expectOpacities(const TransferFunction& function, const std::vector<double>& expected) {
    const ColorCurve curve(function);
    for (std::size_t i = 0; i < kLooks.size(); ++i) {
        for (const double off : {-0.45, 0.0, 0.45}) {
            EXPECT_EQ(function.opacityAt(kLooks[i].label + off), expected[i]) << kLooks[i].label;
            EXPECT_EQ(curve.at(kLooks[i].label + off),
                      ColorCurve(labelFunction(kLooks)).at(kLooks[i].label));
        }
    }
    for (const double other : {-4, 0, 3, 5, 899999999}) EXPECT_EQ(function.opacityAt(other), 0);
    EXPECT_TRUE(function.categorical);
}

TEST_F(LabelChangesTest, hideShowAndFade) {
    expectOpacities(change({}), {0.5, 0.5, 0.5, 0, 1});
    expectOpacities(change({{1, -3}, {}, {}}), {0, 0, 0.5, 0, 1});
    expectOpacities(change({{}, {2, 900000000}, {}}), {0, 0, 0.5, 0, 1});
    expectOpacities(change({{}, {}, {{1, 0.25}, {4, 0.75}}}), {0.5, 0.25, 0.5, 0.75, 1});
    expectOpacities(change({{2}, {1, 2}, {{1, 1}, {-3, 1}}}), {0, 1, 0, 0, 0});
    EXPECT_EQ(warnings_, "");
}

TEST_F(LabelChangesTest, ofThePreset) {
    const TransferFunction whole = presetFunction("labels");
    const TransferFunction function = changeLabels(whole, {{1, 65535}, {}, {{300, 1}}});
    EXPECT_EQ(function.opacityAt(1), 0);
    EXPECT_EQ(function.opacityAt(65535), 0);
    EXPECT_EQ(function.opacityAt(300), 1);
    EXPECT_EQ(function.opacityAt(299), whole.opacityAt(299));
    EXPECT_EQ(function.name, "labels");
}

TEST_F(LabelChangesTest, sayWhatIsNotThere) {
    const Volume volume =
        test::makeVolume({{0, 0, 0}, {3, 0, 0}}, [](int x, int, int) { return x < 2 ? 1 : 9; });
    warnOfAbsentLabels({{1, 2, 7}, {1}, {{8, 1}, {9, 1}, {4, 1}}}, labelFunction(kLooks), volume,
                       listener());
    EXPECT_EQ(warnings_,
              "`labels.hidden`: no label 2 in the volume\n"
              "`labels.hidden`: no label 7 in the table or the volume\n"
              "`labels.opacities`: no label 9 in the table\n"
              "`labels.opacities`: no label 4 in the volume\n"
              "`labels.opacities`: no label 8 in the table or the volume\n");
}

TEST_F(LabelChangesTest, sayWhatTheTableLacks) {
    const auto said = [&](int labels, const LabelChanges& changes) {
        const Volume volume =
            test::makeVolume({{0, 0, 0}, {19, 0, 0}}, [&](int x, int, int) { return x % labels; });
        warnings_.clear();
        warnOfUnlistedLabels(changes, labelFunction(kLooks), volume, listener());
        return warnings_;
    };
    EXPECT_EQ(said(3, {}), "");
    EXPECT_EQ(said(5, {}),
              "`transferFunction`: label 3 of the volume is not in the table, and not shown\n");
    const std::string six = "3, 5, 6, 7, 8, 9 of the volume are not in the table, and not shown\n";
    EXPECT_EQ(said(10, {}), "`transferFunction`: labels " + six);
    EXPECT_EQ(said(20, {}),
              "`transferFunction`: labels 3, 5, 6, 7, 8 and 11 more of the volume are not in the "
              "table, and not shown\n");
    // What is hidden is meant to be.
    EXPECT_EQ(said(20, {{}, {1, 2}, {}}), "");
    EXPECT_EQ(said(5, {{3}, {}, {}}), "");
    EXPECT_EQ(said(5, {{}, {1, 3}, {}}),
              "`transferFunction`: label 3 of the volume is not in the table, and not shown\n");
}

TEST_F(LabelChangesTest, ofValuesAreRefused) {
    const auto said = [&](const LabelChanges& changes) {
        return errorOf([&] { changeLabels(presetFunction("grey"), changes); });
    };
    EXPECT_EQ(said({}), "no error");
    EXPECT_EQ(said({{}, {1}, {}}),
              "usage: `labels.shown`: got a transfer function of values; expected a table of "
              "labels");
}

}  // namespace
}  // namespace deltasplat
