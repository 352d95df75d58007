// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/optics/class_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <string>

#include "deltasplat/error.h"
#include "support/changed_volume.h"

namespace deltasplat {
namespace {

Volume volumeWithCodes(const std::vector<int>& codes) {
    VolumeData volume;
    volume.type = "uint16";
    volume.codeBook = CodeBook::integer();
    volume.histogram.assign(kCodeCount, 0);
    for (const int code : codes) volume.histogram[code] = 1;
    volume.activeCount = codes.size();
    volume.box = {glm::ivec3(0), glm::ivec3(int(codes.size()) - 1, 0, 0)};
    volume.valueMin = codes.front();
    volume.valueMax = codes.back();
    return Volume(std::move(volume));
}

// Opacity x / 100 and colour (x / 100, 0, 1), scene-linear.
Optics ramp() {
    Optics optics;
    optics.transferFunction.linearColors = true;
    optics.transferFunction.colors = {{0, {0, 0, 1}}, {100, {1, 0, 1}}};
    optics.transferFunction.opacities = {{0, 0, 0.5, 0}, {100, 1, 0.5, 0}};
    return optics;
}

double channel(const ClassTable& table, int code, int c) {
    return table.lightOfCode(Code(code))[c];
}

// The high digits of the first plane.
ClassTable::Color colorOf(const ClassTable& table, int code) {
    return table.planes.front().high.colors[table.classOfSlot()[code + 1]];
}

TEST(Classify, followsTheFormulaWithinHalfAUnit) {
    const Volume volume = volumeWithCodes({0, 10, 30, 60});
    Optics optics = ramp();
    optics.unitDistance = 2;
    optics.extinctionScale = 3;
    const double step = 1.25;
    const ClassTable table = classify(volume, optics, step);
    ASSERT_EQ(table.classOfSlot().size(), std::size_t(kSlotCount));
    EXPECT_FALSE(table.oneColor);
    for (const int code : {0, 10, 30, 60}) {
        const double extinction = -std::log(1 - code / 100.0) / 2 * 3;
        const double alpha = 1 - std::exp(-extinction * step);
        EXPECT_NEAR(channel(table, code, 3), alpha, table.scale.a * 0.501) << code;
        EXPECT_NEAR(channel(table, code, 0), alpha * code / 100, table.scale.r * 0.501) << code;
        EXPECT_NEAR(channel(table, code, 2), alpha, table.scale.b * 0.501) << code;
        EXPECT_EQ(colorOf(table, code)[1], 0);
    }
    EXPECT_EQ(table.scale.g, 0);
    for (const int c : {0, 2, 3}) EXPECT_EQ(colorOf(table, 60)[c], ClassTable::kMax) << c;
}

TEST(Classify, leavesCodesThatDoNotOccurEmpty) {
    const ClassTable table = classify(volumeWithCodes({10, 30}), ramp(), 1);
    for (int slot = 0; slot < kSlotCount; ++slot) {
        const bool occurs = slot == 11 || slot == 31;
        EXPECT_EQ(table.classOfSlot()[slot] != kEmptySlot, occurs) << slot;
    }
}

TEST(Classify, takesTheSmallestVoxelSizeAsUnitDistance) {
    Volume volume = volumeWithCodes({50});
    test::changed(volume)->worldFromIndex[0] = {0.5, 0, 0, 0};
    test::changed(volume)->worldFromIndex[2] = {0, 0, 4, 0};
    const ClassTable table = classify(volume, ramp(), 0.5);
    EXPECT_NEAR(table.scale.a * ClassTable::kMax, 0.5, 1e-12);
}

TEST(Classify, keepsOpacityOneAndZeroAtAnyStep) {
    for (const double step : {1e-9, 1.0, 1e9}) {
        const ClassTable table = classify(volumeWithCodes({0, 100}), ramp(), step);
        EXPECT_EQ(channel(table, 100, 3), 1) << step;
        EXPECT_EQ(colorOf(table, 0)[3], 0) << step;
    }
}

TEST(Classify, isClearWithoutExtinction) {
    Optics optics = ramp();
    optics.extinctionScale = 0;
    const ClassTable table = classify(volumeWithCodes({50, 100}), optics, 1);
    EXPECT_EQ(table.scale, glm::dvec4(0));
    for (const Slot slot : table.classOfSlot()) EXPECT_EQ(slot, kEmptySlot);
}

TEST(Classify, keepsPrecisionInThinFog) {
    Optics optics = ramp();
    optics.extinctionScale = 1e-12;
    const ClassTable table = classify(volumeWithCodes({10, 50}), optics, 1);
    const double alpha = -std::log(0.5) * 1e-12;
    EXPECT_NEAR(channel(table, 50, 3), alpha, alpha * 1e-9);
    EXPECT_NEAR(channel(table, 10, 3), -std::log(0.9) * 1e-12, alpha * 1e-5);
}

TEST(Classify, scalesNormalizedFunctionsToTheRange) {
    const Volume volume = volumeWithCodes({200, 300, 400});
    Optics optics = ramp();
    optics.transferFunction.normalized = true;
    optics.transferFunction.opacities = {{0, 0, 0.5, 0}, {1, 0.8, 0.5, 0}};
    EXPECT_NEAR(channel(classify(volume, optics, 1), 300, 3), 0.4, 2e-5);
    optics.range = glm::dvec2(100, 500);
    EXPECT_NEAR(channel(classify(volume, optics, 1), 400, 3), 0.6, 1e-12);
}

TEST(Classify, refusesOpticsOutOfRangeByTheFlagsName) {
    const auto messageOf = [](const Optics& optics) -> std::string {
        try {
            classify(volumeWithCodes({1}), optics, 1);
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::kUsage);
            return error.what();
        }
        return "no error";
    };
    Optics optics = ramp();
    optics.unitDistance = 0;
    EXPECT_EQ(messageOf(optics), "`unitDistance`: got 0; expected a number > 0");
    optics.unitDistance = INFINITY;
    EXPECT_EQ(messageOf(optics), "`unitDistance`: got inf; expected a number > 0");
    optics = ramp();
    optics.extinctionScale = -1;
    EXPECT_EQ(messageOf(optics), "`extinctionScale`: got -1; expected a number >= 0");
    optics.extinctionScale = NAN;
    EXPECT_EQ(messageOf(optics), "`extinctionScale`: got nan; expected a number >= 0");
    optics = ramp();
    optics.range = glm::dvec2(5, 2.5);
    EXPECT_EQ(messageOf(optics), "`range`: got 5,2.5; expected LO,HI with LO < HI");
    optics.range = glm::dvec2(5, 5);
    EXPECT_EQ(messageOf(optics), "`range`: got 5,5; expected LO,HI with LO < HI");
}

// Few steps of opacity and colour, so that codes share colours.
Optics steps() {
    Optics optics = ramp();
    optics.transferFunction.colors = {{0, {0, 0, 0}}, {30000, {0, 0, 0}}, {30001, {1, 1, 0}}};
    optics.transferFunction.opacities = {
        {100, 0, 0.5, 0}, {101, 0.2, 0.5, 0}, {50000, 0.2, 0.5, 0}, {50001, 0.7, 0.5, 0}};
    return optics;
}

TEST(Classify, codesThatLookAlikeShareAClass) {
    const ClassTable table =
        classify(volumeWithCodes({5, 101, 7000, 30001, 40000, 60000, 65535}), steps(), 1);
    EXPECT_EQ(table.size(), 4u);
    EXPECT_TRUE(table.oneDigit());
    const std::vector<ClassTable::Color>& colors = table.planes.front().high.colors;
    EXPECT_EQ(colors[0], ClassTable::Color{});
    EXPECT_EQ(table.classOfSlot()[6], kEmptySlot);
    EXPECT_EQ(table.classOfSlot()[102], table.classOfSlot()[7001]);
    EXPECT_EQ(table.classOfSlot()[30002], table.classOfSlot()[40001]);
    EXPECT_EQ(table.classOfSlot()[60001], table.classOfSlot()[65536]);
    for (std::size_t i = 0; i < table.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) EXPECT_NE(colors[i], colors[j]);
    }
}

TEST(Classify, oneColorHasEqualChannels) {
    Optics optics = ramp();
    optics.transferFunction.colors = {{0, {0.7, 0, 0.3}}};
    const ClassTable table = classify(volumeWithCodes({0, 10, 30, 60}), optics, 1);
    EXPECT_TRUE(table.oneColor);
    for (const int code : {0, 10, 30, 60}) {
        const ClassTable::Color color = colorOf(table, code);
        EXPECT_EQ(color[0], color[3]);
        EXPECT_EQ(color[1], 0);
        EXPECT_NEAR(channel(table, code, 0), 0.7 * code / 100, table.scale.r * 0.501);
    }
    EXPECT_EQ(table.scale.g, 0);
}

// The same classes, whatever steps they are classified for; colours are those of the steps.
TEST(Classify, classesCanBeColoredForOtherSteps) {
    for (const bool several : {false, true}) {
        Optics optics = ramp();
        if (!several) optics.transferFunction.colors = {{0, {0.7, 0, 0.3}}};
        const Volume volume = volumeWithCodes({0, 1, 10, 30, 60, 61, 62, 99});
        const ClassTable one = classify(volume, optics, 1);
        const ClassTable longer = one.atSteps(1.5);
        const ClassTable expected = classify(volume, optics, 1.5);
        EXPECT_EQ(longer.oneColor, !several);
        for (int code = 0; code < 100; ++code) {
            if (volume.histogram()[std::size_t(code)] == 0) continue;
            EXPECT_EQ(longer.lightOfCode(Code(code)), expected.lightOfCode(Code(code))) << code;
        }
    }
}

// All 65536 codes look different: one class fewer than that is left for them.
TEST(Classify, lastTwoOfAllCodesShareAClass) {
    Volume volume = volumeWithCodes({0, 65535});
    test::changed(volume)->histogram.assign(kCodeCount, 1);
    Optics optics = ramp();
    optics.transferFunction.colors = {{0, {0, 1, 0}}, {32767, {1, 1, 0}}, {65535, {1, 0, 0}}};
    optics.transferFunction.opacities = {{0, 0.5, 0.5, 0}, {65535, 0.9, 0.5, 0}};
    const ClassTable table = classify(volume, optics, 1);
    EXPECT_LE(table.size(), std::size_t(ClassTable::kMaxClasses));
    for (const Slot slot : table.classOfSlot()) ASSERT_LT(slot, ClassTable::kMaxClasses);
    for (int code = 0; code < kCodeCount; ++code) {
        const double alpha = 0.5 + 0.4 * code / 65535;
        ASSERT_NEAR(channel(table, code, 3), alpha, table.scale.a * 1.01);
    }
}

// Codes 1, 2, ... of these opacities and scene-linear colours.
struct TestLook {
    double opacity;
    glm::dvec3 color;
};

ClassTable classifyLooks(const std::vector<TestLook>& looks) {
    std::vector<int> codes;
    Optics optics;
    optics.transferFunction.linearColors = true;
    for (const TestLook& look : looks) {
        const int code = int(codes.size()) + 1;
        codes.push_back(code);
        optics.transferFunction.colors.push_back({double(code), look.color});
        optics.transferFunction.opacities.push_back({double(code), look.opacity, 0.5, 0});
    }
    return classify(volumeWithCodes(codes), optics, 1);
}

// Alpha, colours and their quotients are right to 2^-8; numbers of classes are those of their
// digits.
void expectLooks(const std::vector<TestLook>& looks, const ClassTable& table) {
    for (std::size_t i = 0; i < looks.size(); ++i) {
        const glm::dvec4 light = table.lightOfCode(Code(i + 1));
        const double alpha = looks[i].opacity;
        EXPECT_NEAR(light.a, alpha, alpha / 256) << alpha;
        for (int c = 0; c < 3; ++c) {
            const double color = looks[i].color[c];
            EXPECT_NEAR(light[c], alpha * color, alpha * color / 256) << alpha << ' ' << color;
            EXPECT_NEAR(light[c] / light.a, color, color / 256 * 1.0001) << alpha << ' ' << color;
        }
        const Slot number = table.classOfSlot()[i + 2];
        ASSERT_NE(number, kEmptySlot);
        for (const ClassTable::Plane& plane : table.planes) {
            for (const ClassTable::Digit* digit : {&plane.high, &plane.low}) {
                if (digit->colors.empty()) continue;
                const bool isZero = digit->colors[number] == ClassTable::Color{};
                EXPECT_TRUE(isZero || (number >= digit->first && number < digit->last));
            }
        }
    }
}

TEST(Classify, takesOneDigitWhereThatSaysEnough) {
    // 256 units and more.
    EXPECT_TRUE(classifyLooks({{1.0 / 128, {1, 1, 1}}, {1, {1, 1, 1}}}).oneDigit());
    EXPECT_TRUE(classifyLooks({{1.0 / 128, {1, 0.5, 0}}, {0.5, {0.5, 1, 0}}}).oneDigit());
    // 1/100 of a unit beside a whole number of them.
    EXPECT_TRUE(classifyLooks({{3.01 / 32767, {1, 1, 1}}, {1, {1, 1, 1}}}).oneDigit());
    EXPECT_FALSE(classifyLooks({{3.1 / 32767, {1, 1, 1}}, {1, {1, 1, 1}}}).oneDigit());
    EXPECT_FALSE(classifyLooks({{0.3, {0.001, 1, 1}}, {1, {1, 1, 1}}}).oneDigit());
}

TEST(Classify, keepsWhatIsThinOrDarkBesideWhatIsOpaqueAndBright) {
    std::vector<TestLook> looks;
    for (int k = 0; k <= 60; ++k) looks.push_back({std::pow(10, -k / 10.0), {1, 1, 1}});
    const ClassTable white = classifyLooks(looks);
    EXPECT_TRUE(white.oneColor);
    EXPECT_EQ(white.planes.size(), 1u);
    expectLooks(looks, white);
    for (int k = 0; k <= 60; ++k) looks[k].color = {0.9, std::pow(10, k / 20.0), 0.001};
    expectLooks(looks, classifyLooks(looks));
    std::vector<TestLook> all;
    for (const double opacity : {1.0, 0.3, 1e-3, 1e-6}) {
        for (const double light : {1e-3, 0.7, 1e3}) {
            all.push_back({opacity, {light, 1 / light, 0.5}});
            all.push_back({opacity, {0, light, 1 / light}});
        }
    }
    const ClassTable two = classifyLooks(all);
    EXPECT_EQ(two.planes.size(), 2u);
    expectLooks(all, two);
}

// Below 2^-40 of the largest, errors may grow; below 2^-51, nothing is seen.
TEST(Classify, letsGoOfWhatIsNextToNothing) {
    const ClassTable table =
        classifyLooks({{1, {1, 1, 1}}, {1e-11, {1, 1, 1}}, {1e-17, {1, 1, 1}}});
    EXPECT_NEAR(table.lightOfCode(2).a, 1e-11, 1e-14);
    EXPECT_EQ(table.classOfSlot()[4], kEmptySlot);
}

TEST(Classify, refusesWhatIsNoTransferFunction) {
    const Volume volume = volumeWithCodes({0, 50, 100});
    const auto errorOf = [&](const Optics& optics) -> std::string {
        try {
            classify(volume, optics, 1);
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::kUsage);
            return error.what();
        }
        return "";
    };
    using Function = TransferFunction;
    const auto errorWith = [&](std::vector<Function::ColorPoint> colors,
                               std::vector<Function::OpacityPoint> opacities) {
        Optics optics = ramp();
        optics.transferFunction.colors = std::move(colors);
        optics.transferFunction.opacities = std::move(opacities);
        return errorOf(optics);
    };
    const std::vector<Function::ColorPoint> white = {{0, {1, 1, 1}}};
    const std::vector<Function::OpacityPoint> thin = {{0, 0.1, 0.5, 0}};
    const double nan = std::nan("");
    EXPECT_EQ(errorWith(white, thin), "");
    EXPECT_EQ(errorWith({{1, {1, 1, 1}}, {1, {1, 0, 1}}}, thin), "");
    EXPECT_EQ(errorOf(Optics{}), "transfer function's colours: got none; expected at least one");
    EXPECT_EQ(errorWith(white, {}),
              "transfer function's opacities: got none; expected at least one");
    EXPECT_EQ(errorWith({{1, {1, 1, 1}}, {0, {1, 1, 1}}}, thin),
              "transfer function's colours: got x = 0 behind 1; expected x not decreasing");
    EXPECT_EQ(errorWith({{nan, {1, 1, 1}}}, thin),
              "transfer function's colours: got x = nan; expected a finite number");
    EXPECT_EQ(errorWith({{0, {1, nan, 1}}}, thin),
              "transfer function's colours: got nan; expected a finite number >= 0");
    EXPECT_EQ(errorWith({{0, {1, -1, 1}}}, thin),
              "transfer function's colours: got -1; expected a finite number >= 0");
    EXPECT_EQ(errorWith(white, {{INFINITY, 0.1, 0.5, 0}}),
              "transfer function's opacities: got x = inf; expected a finite number");
    EXPECT_EQ(errorWith(white, {{0, 1.5, 0.5, 0}}),
              "transfer function's opacities: got 1.5; expected a number within 0..1");
    EXPECT_EQ(errorWith(white, {{0, nan, 0.5, 0}}),
              "transfer function's opacities: got nan; expected a number within 0..1");
    EXPECT_EQ(errorWith(white, {{0, 0.1, -1, 0}}),
              "transfer function's opacities: got -1; expected a number within 0..1");
}

}  // namespace
}  // namespace deltasplat
