// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/optics/transfer_function.h"

#include "deltasplat/optics/default_ramp.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "image/srgb.h"
#include "optics/color_curve.h"
#include "optics/transfer_function.h"
#include "support/changed_volume.h"

namespace deltasplat {
namespace {

TransferFunction withOpacities(std::vector<TransferFunction::OpacityPoint> points) {
    TransferFunction function;
    function.colors = {{0, glm::dvec3(1)}};
    function.opacities = std::move(points);
    return function;
}

// A volume of integer codes; `counts` says how many voxels have each of the first codes.
Volume volumeOf(const std::string& type, const std::vector<std::uint64_t>& counts) {
    VolumeData volume;
    volume.type = type;
    volume.codeBook = CodeBook::integer();
    volume.histogram.assign(kCodeCount, 0);
    int least = -1;
    for (std::size_t code = 0; code < counts.size(); ++code) {
        volume.histogram[code] = counts[code];
        volume.activeCount += counts[code];
        if (counts[code] == 0) continue;
        if (least < 0) least = int(code);
        volume.valueMax = double(code);
    }
    volume.valueMin = std::max(least, 0);
    volume.box = {glm::ivec3(0), glm::ivec3(int(volume.activeCount) - 1, 0, 0)};
    return Volume(std::move(volume));
}

TEST(TransferFunction, opacityIsAnExactLerpBetweenPlainPoints) {
    const TransferFunction function = withOpacities({{10, 0.125, 0.5, 0}, {14, 0.625, 0.5, 0}});
    EXPECT_EQ(function.opacityAt(10), 0.125);
    EXPECT_EQ(function.opacityAt(11), 0.25);
    EXPECT_EQ(function.opacityAt(12), 0.375);
    EXPECT_EQ(function.opacityAt(13.5), 0.5625);
    EXPECT_EQ(function.opacityAt(14), 0.625);
    for (double s = 0; s <= 1; s += 1.0 / 64) {
        EXPECT_EQ(function.opacityAt(10 + 4 * s), std::lerp(0.125, 0.625, s)) << s;
    }
}

// The colours that vtkColorTransferFunction 9.1 gives; its own matrix has four digits.
TEST(TransferFunction, mixesColorsAsVtkDoes) {
    struct Case {
        ColorSpace space;
        glm::dvec3 from, to;
        glm::dvec3 expected[3];  // at 0.25, 0.5 and 0.8
    };
    const glm::dvec3 blue(0.23137254902, 0.298039215686, 0.752941176471);
    const glm::dvec3 red(0.705882352941, 0.0156862745098, 0.149019607843);
    const glm::dvec3 warm(0.9, 0.2, 0.1), cold(0.2, 0.3, 0.95);
    const glm::dvec3 grey(0.5, 0.5, 0.5), yellow(0.9, 0.8, 0.1);
    const Case cases[] = {
        {ColorSpace::kHsv,
         blue,
         red,
         {{0.3764, 0.1749, 0.7412}, {0.6316, 0.1202, 0.7294}, {0.7153, 0.0567, 0.4387}}},
        {ColorSpace::kHsv,
         warm,
         cold,
         {{0.8649, 0.9125, 0.1241}, {0.152, 0.925, 0.1488}, {0.1792, 0.85, 0.94}}},
        {ColorSpace::kHsvShortest,
         warm,
         cold,
         {{0.9125, 0.1241, 0.4706}, {0.9218, 0.1488, 0.925}, {0.4214, 0.1792, 0.94}}},
        {ColorSpace::kHsvShortest,
         grey,
         yellow,
         {{0.6, 0.4958, 0.4667}, {0.7, 0.525, 0.3889}, {0.82, 0.6451, 0.2369}}},
        {ColorSpace::kLab,
         warm,
         cold,
         {{0.8287, 0.2165, 0.33}, {0.7299, 0.2381, 0.5315}, {0.5298, 0.2722, 0.779}}},
        {ColorSpace::kLab,
         grey,
         yellow,
         {{0.6124, 0.5712, 0.435}, {0.7135, 0.6452, 0.3603}, {0.827, 0.7371, 0.242}}},
        {ColorSpace::kDiverging,
         blue,
         red,
         {{0.5533, 0.6886, 0.9952}, {0.8654, 0.8654, 0.8654}, {0.9329, 0.5198, 0.4061}}},
        {ColorSpace::kDiverging,
         warm,
         cold,
         {{1.0, 0.6624, 0.493}, {1.0, 1.0, 1.0}, {0.6449, 0.5904, 1.0}}},
        {ColorSpace::kDiverging,
         grey,
         yellow,
         {{0.6727, 0.6421, 0.5507}, {0.8152, 0.7515, 0.5232}, {0.9067, 0.813, 0.3609}}},
    };
    for (const Case& one : cases) {
        TransferFunction function = withOpacities({{0, 1, 0.5, 0}});
        function.colorSpace = one.space;
        function.colors = {{-3, one.from}, {-1, one.to}, {1, one.from}};
        for (int i = 0; i < 3; ++i) {
            const double s = std::array{0.25, 0.5, 0.8}[std::size_t(i)];
            // And the same way back.
            for (const double x : {-3 + 2 * s, 1 - 2 * s}) {
                const glm::dvec3 color = function.colorAt(x);
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(srgbFromLinear(color[c]), one.expected[i][c], 2e-3)
                        << int(one.space) << ' ' << x << ' ' << c;
            }
        }
        for (const double x : {-3.0, -1.0, 1.0}) {
            const glm::dvec3 expected = x == -1 ? one.to : one.from;
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(function.colorAt(x)[c], linearFromSrgb(expected[c]), 1e-12);
        }
    }
}

// Light knows no largest value.
TEST(TransferFunction, mixesBrightColorsWithoutCuttingThem) {
    TransferFunction function = withOpacities({{0, 1, 0.5, 0}});
    function.linearColors = true;
    function.colors = {{0, {2, 1, 0.5}}, {1, {2000, 1000, 500}}};
    for (const ColorSpace space : {ColorSpace::kRgb, ColorSpace::kHsv, ColorSpace::kLab}) {
        function.colorSpace = space;
        const glm::dvec3 color = function.colorAt(0.5);
        EXPECT_GT(color.r, 100);
        EXPECT_NEAR(color.g / color.r, 0.5, 1e-9);
        EXPECT_NEAR(color.b / color.r, 0.25, 1e-9);
    }
}

// Next to black there are hues, and brightest light has room to be mixed.
TEST(TransferFunction, mixesFiniteColorsOfAnyTwo) {
    constexpr double kMost = std::numeric_limits<double>::max();
    for (const bool linear : {false, true}) {
        std::vector<double> parts = {0, 1e-9, 1e-4, 0.04, 1};
        if (linear) parts = {0, 1e-9, 1, 1e300, kMost};
        std::vector<glm::dvec3> colors;
        for (const double r : parts)
            for (const double g : parts)
                for (const double b : parts) colors.emplace_back(r, g, b);
        for (const ColorSpace space : {ColorSpace::kRgb, ColorSpace::kHsv, ColorSpace::kHsvShortest,
                                       ColorSpace::kLab, ColorSpace::kDiverging}) {
            TransferFunction function = withOpacities({{0, 1, 0.5, 0}});
            function.linearColors = linear;
            function.colorSpace = space;
            for (const glm::dvec3& from : colors) {
                for (const glm::dvec3& to : colors) {
                    function.colors = {{0, from}, {255, to}};
                    for (const double x : {1e-3, 100.0, 250.0}) {
                        const glm::dvec3 color = function.colorAt(x);
                        for (int c = 0; c < 3; ++c) {
                            ASSERT_TRUE(color[c] >= 0 && color[c] <= (linear ? kMost : 1 + 1e-9))
                                << int(space) << ": " << from.r << ' ' << from.g << ' ' << from.b
                                << " to " << to.r << ' ' << to.g << ' ' << to.b << ": " << color[c];
                        }
                    }
                }
            }
        }
    }
}

// As beside black itself.
TEST(TransferFunction, makesNoRainbowBesideWhatIsNextToBlack) {
    TransferFunction function = withOpacities({{0, 1, 0.5, 0}});
    function.colorSpace = ColorSpace::kDiverging;
    function.colors = {{0, {0, 0, 0}}, {255, {1, 1, 1}}};
    const glm::dvec3 grey = function.colorAt(100);
    EXPECT_GT(grey.g, 0.01);
    function.colors[0].rgb.b = 1e-9;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(function.colorAt(100)[c], grey[c], 1e-6);
}

TEST(TransferFunction, isConstantBeyondTheEnds) {
    TransferFunction function = withOpacities({{1, 0.25, 0.5, 0}, {2, 0.75, 0.5, 0}});
    function.linearColors = true;
    function.colors = {{1, {0.1, 0.2, 0.3}}, {2, {0.4, 0.5, 0.6}}};
    EXPECT_EQ(function.opacityAt(-1e300), 0.25);
    EXPECT_EQ(function.opacityAt(1e300), 0.75);
    EXPECT_EQ(function.colorAt(0.5), glm::dvec3(0.1, 0.2, 0.3));
    EXPECT_EQ(function.colorAt(2.5), glm::dvec3(0.4, 0.5, 0.6));
}

// To the last bit, though spaces are left by rounding.
TEST(TransferFunction, isConstantBetweenPointsOfOneColor) {
    TransferFunction function = withOpacities({{1, 0.25, 0.5, 0}});
    function.colors = {{1, {0.1, 0.73, 0.31}}, {2, {0.1, 0.73, 0.31}}, {5, {0.1, 0.73, 0.31}}};
    for (const bool isLinear : {false, true}) {
        function.linearColors = isLinear;
        for (const ColorSpace space : {ColorSpace::kRgb, ColorSpace::kHsv, ColorSpace::kHsvShortest,
                                       ColorSpace::kLab, ColorSpace::kDiverging}) {
            function.colorSpace = space;
            for (const double x : {-1.0, 1.0, 1.3, 2.0, 4.9, 5.0, 7.0})
                EXPECT_EQ(function.colorAt(x), function.colorAt(0));
        }
    }
    EXPECT_EQ(function.colorAt(3), function.colors[0].rgb);
    EXPECT_TRUE(hasOneColor(function));
    function.colors[1].rgb.b = 0.32;
    EXPECT_FALSE(hasOneColor(function));
}

TEST(TransferFunction, reachesHalfWayAtTheMidpoint) {
    const TransferFunction function = withOpacities({{0, 0, 0.2, 0}, {1, 0.8, 0.5, 0}});
    EXPECT_NEAR(function.opacityAt(0.1), 0.2, 1e-15);
    EXPECT_NEAR(function.opacityAt(0.2), 0.4, 1e-15);
    EXPECT_NEAR(function.opacityAt(0.6), 0.6, 1e-15);
}

TEST(TransferFunction, sharpnessOneIsAStepAtTheMidpoint) {
    const TransferFunction function = withOpacities({{0, 0.1, 0.25, 1}, {1, 0.9, 0.5, 0}});
    EXPECT_EQ(function.opacityAt(0.2499), 0.1);
    EXPECT_EQ(function.opacityAt(0.25), 0.9);
}

TEST(TransferFunction, sharpnessBendsAsInVtk) {
    // Sharpness 0.1 doubles the power (s = 0.25 goes to 0.5 * 0.5^2 = 0.125); the Hermite cubic
    // with slopes of 0.9 at both ends then gives 0.04296875 + 0.9 * 0.08203125 there.
    const TransferFunction function = withOpacities({{0, 0, 0.5, 0.1}, {1, 1, 0.5, 0}});
    EXPECT_NEAR(function.opacityAt(0.25), 0.04296875 + 0.9 * 0.08203125, 1e-15);
    EXPECT_NEAR(function.opacityAt(0.75), 1 - function.opacityAt(0.25), 1e-15);
    EXPECT_NEAR(function.opacityAt(0.5), 0.5, 1e-15);
}

TEST(TransferFunction, sharpnessNeverOvershootsAndNeverFalls) {
    for (const double sharpness : {0.02, 0.3, 0.5, 0.98}) {
        const TransferFunction function =
            withOpacities({{0, 0.2, 0.4, sharpness}, {1, 0.7, 0.5, 0}});
        double last = 0.2;
        for (double x = 0; x <= 1; x += 1.0 / 256) {
            const double opacity = function.opacityAt(x);
            EXPECT_GE(opacity, last) << sharpness << " at " << x;
            last = opacity;
        }
        EXPECT_EQ(last, 0.7);
    }
}

TEST(TransferFunction, twoPointsAtOneXAreAStepTheLastCountsThere) {
    const TransferFunction function =
        withOpacities({{0, 0, 0.5, 0}, {1, 0, 0.5, 0}, {1, 0.6, 0.5, 0}, {2, 0.6, 0.5, 0}});
    EXPECT_EQ(function.opacityAt(std::nextafter(1.0, 0.0)), 0);
    EXPECT_EQ(function.opacityAt(1), 0.6);
}

TEST(TransferFunction, spansAsWideAsDoublesDoNotOverflow) {
    const TransferFunction function = withOpacities({{-1.7e308, 0, 0.5, 0}, {1.7e308, 1, 0.5, 0}});
    EXPECT_EQ(function.opacityAt(0), 0.5);
}

TEST(TransferFunction, srgbColorsAreInterpolatedAsSrgbAndReturnedLinear) {
    TransferFunction function = withOpacities({{0, 1, 0.5, 0}});
    function.colors = {{0, {0, 0.04045, 0}}, {1, {1, 0.04045, 0.1}}};
    EXPECT_NEAR(function.colorAt(0.5).r, std::pow(0.555 / 1.055, 2.4), 1e-12);
    EXPECT_NEAR(function.colorAt(0.5).g, 0.04045 / 12.92, 1e-12);
    EXPECT_EQ(function.colorAt(1).r, 1);
    function.linearColors = true;
    EXPECT_EQ(function.colorAt(0.5), glm::dvec3(0.5, 0.04045, 0.05));
}

TEST(TransferFunction, hidesStretchesOfValues) {
    const auto hides = [](std::vector<TransferFunction::OpacityPoint> points, bool normalized,
                          bool hasRange) {
        TransferFunction function;
        function.opacities = std::move(points);
        function.normalized = normalized;
        return hidesValues(function, hasRange);
    };
    // A ramp is clear at its first value alone, unless there are values before it.
    EXPECT_FALSE(hides({{0, 0}, {1, 1}}, true, false));
    EXPECT_TRUE(hides({{0, 0}, {1, 1}}, true, true));
    EXPECT_TRUE(hides({{0, 0}, {1, 1}}, false, false));
    EXPECT_TRUE(hides({{0, 0.2}, {1, 0}}, false, false));
    EXPECT_FALSE(hides({{0, 0.2}, {1, 0.1}}, false, true));
    // Constant before the first point, and behind the last.
    EXPECT_TRUE(hides({{0.2, 0}, {1, 1}}, true, false));
    EXPECT_TRUE(hides({{0, 0.2}, {0.9, 0}}, true, false));
    EXPECT_FALSE(hides({{0.2, 0.1}, {0.9, 0.3}}, true, false));
    // Between two points; two at one value are a step.
    EXPECT_TRUE(hides({{0, 0.1}, {0.3, 0}, {0.4, 0}, {1, 1}}, true, false));
    EXPECT_FALSE(hides({{0, 0.1}, {0.3, 0}, {0.3, 0}, {1, 1}}, true, false));
    EXPECT_FALSE(hides({}, true, false));
}

TEST(TransferFunction, showsValuesAsFarAsIsKnown) {
    TransferFunction function;
    function.opacities = {{0, 0}, {0.5, 0}, {1, 1}};
    EXPECT_TRUE(showsValue(function, {}, "uint8", 0.75));
    EXPECT_FALSE(showsValue(function, {}, "int16", 0.5));
    function.normalized = true;
    EXPECT_FALSE(showsValue(function, {}, "uint8", 127));
    EXPECT_TRUE(showsValue(function, {}, "uint8", 128));
    // Of other types, the range is that of values which nobody knows.
    EXPECT_FALSE(showsValue(function, {}, "uint16", 60000));
    const glm::dvec2 range(-100, 300);
    EXPECT_FALSE(showsValue(function, range, "int16", 99));
    EXPECT_TRUE(showsValue(function, range, "int16", 101));
    EXPECT_TRUE(showsValue(function, range, "int16", 5000));
}

TEST(DefaultRamp, spansThePercentilesOfWhatIsNotBackground) {
    // A thousand voxels without the zeros: 9 of value 3, 981 of 5, 10 of 8. The 10th has value 5,
    // the 990th too.
    std::vector<std::uint64_t> counts = {5000, 0, 0, 9, 0, 981, 0, 0, 10};
    TransferFunction ramp = defaultRamp(volumeOf("uint16", counts));
    EXPECT_EQ(ramp.opacities.front().x, 5);
    EXPECT_EQ(ramp.opacities.back().x, 5);

    counts = {5000, 0, 0, 10, 0, 979, 0, 0, 11};
    ramp = defaultRamp(volumeOf("uint16", counts));
    ASSERT_EQ(ramp.opacities.size(), 2u);
    EXPECT_EQ(ramp.opacities[0].x, 3);
    EXPECT_EQ(ramp.opacities[0].opacity, 0);
    EXPECT_EQ(ramp.opacities[1].x, 8);
    EXPECT_EQ(ramp.opacities[1].opacity, kRampOpacity);
    EXPECT_EQ(ramp.colorAt(3), glm::dvec3(0));
    EXPECT_EQ(ramp.colorAt(8), glm::dvec3(1));
    EXPECT_NEAR(ramp.colorAt(5.5).g, 0.5, 1e-15);
}

TEST(DefaultRamp, showsAVolumeOfOneValue) {
    const TransferFunction ramp = defaultRamp(volumeOf("bool", {0, 40}));
    EXPECT_EQ(ramp.opacityAt(1), kRampOpacity);
    EXPECT_EQ(ramp.colorAt(1), glm::dvec3(1));
    EXPECT_EQ(ramp.opacityAt(0), 0);
}

TEST(DefaultRamp, fogIsWhiteWhereItIsThinToo) {
    Volume volume = volumeOf("half", {5000, 0, 0, 10, 0, 979, 0, 0, 11});
    EXPECT_EQ(defaultRamp(volume).colorAt(3), glm::dvec3(0));
    test::changed(volume)->gridClass = "fog volume";
    const TransferFunction ramp = defaultRamp(volume);
    for (const double x : {-1.0, 3.0, 4.0, 8.0, 100.0}) EXPECT_EQ(ramp.colorAt(x), glm::dvec3(1));
    EXPECT_EQ(ramp.opacityAt(0), 0);
    EXPECT_EQ(ramp.opacityAt(8), kRampOpacity);
}

// Of a fog nearly all of which is at its thinnest, the first percentile is what it is made of.
TEST(DefaultRamp, showsTheThinnestFog) {
    Volume volume = volumeOf("half", {5000, 0, 910, 0, 0, 0, 0, 0, 90});
    EXPECT_EQ(hiddenShare(volume, defaultRamp(volume), {}), 0.91);
    test::changed(volume)->gridClass = "fog volume";
    const TransferFunction ramp = defaultRamp(volume);
    EXPECT_EQ(ramp.opacityAt(0), 0);
    EXPECT_DOUBLE_EQ(ramp.opacityAt(2), kRampOpacity / 4);
    EXPECT_EQ(hiddenShare(volume, ramp, {}), 0);
    EXPECT_EQ(rampRange(volume), glm::dvec2(0, 8));
    // Where the background is more than all else, nothing says what is empty.
    test::changed(volume)->background = 20;
    EXPECT_EQ(rampRange(volume).x, 0);
}

// A volume with values from `lowest` on, one to a code.
Volume signedVolume(int lowest, const std::vector<std::uint64_t>& counts) {
    VolumeData data = volumeOf("int16", counts).data();
    data.codeBook.offset = lowest;
    data.valueMin = lowest;
    data.valueMax = lowest + int(counts.size()) - 1;
    return Volume(std::move(data));
}

TEST(DefaultRamp, divergesFromZeroWhereMostValuesAre) {
    // -3 to 4: half of them 0, or many near it.
    for (const auto& counts : {std::vector<std::uint64_t>{5, 10, 20, 600, 30, 20, 10, 5},
                               std::vector<std::uint64_t>{5, 10, 20, 30, 25, 20, 10, 5}}) {
        const TransferFunction ramp = defaultRamp(signedVolume(-3, counts));
        ASSERT_EQ(ramp.opacities.size(), 3u);
        EXPECT_EQ(ramp.opacityAt(0), 0);
        EXPECT_EQ(ramp.opacityAt(4), kRampOpacity);
        EXPECT_EQ(ramp.opacityAt(-4), kRampOpacity);
        EXPECT_DOUBLE_EQ(ramp.opacityAt(-1), ramp.opacityAt(1));
        EXPECT_GT(ramp.colorAt(-3).b, ramp.colorAt(-3).r);
        EXPECT_GT(ramp.colorAt(3).r, ramp.colorAt(3).b);
    }
}

// Noise around 0 has a little more on one side or on the other.
TEST(DefaultRamp, divergesWhicheverSideOfZeroHasMore) {
    for (const int more : {-1, 1}) {
        std::vector<std::uint64_t> counts;
        for (int value = -40; value <= 40; ++value)
            counts.push_back(std::uint64_t(1000 * std::exp(-value * value / 200.0)) +
                             (value * more > 0 ? 20 : 0));
        EXPECT_EQ(defaultRamp(signedVolume(-40, counts)).name, "diverging ramp");
    }
}

TEST(DefaultRamp, goesOneWayWhereZeroIsAValueAsOthers) {
    // Most are air, at the lower end; most are 2; nothing but a little overshoot is below 0.
    for (const auto& counts : {std::vector<std::uint64_t>{900, 10, 20, 25, 30, 20, 10, 5},
                               std::vector<std::uint64_t>{5, 10, 20, 25, 30, 900, 10, 5}}) {
        EXPECT_EQ(defaultRamp(signedVolume(-3, counts)).name, "grey ramp");
    }
    std::vector<std::uint64_t> overshoot(100, 10);
    overshoot[3] = 900;
    EXPECT_EQ(defaultRamp(signedVolume(-3, overshoot)).name, "grey ramp");
    // Fog has no other side.
    Volume fog = signedVolume(-3, {5, 10, 20, 600, 30, 20, 10, 5});
    test::changed(fog)->gridClass = "fog volume";
    EXPECT_EQ(defaultRamp(fog).name, "white ramp");
}

TEST(DefaultRamp, knowsFogByItsClassOrItsName) {
    Volume volume = volumeOf("float", {1});
    test::changed(volume)->hasBackground = true;
    test::changed(volume)->gridClass = "unknown";
    test::changed(volume)->name = "density";
    EXPECT_TRUE(isFog(volume));
    test::changed(volume)->space = "LPS";  // a scan that has become a .vdb
    EXPECT_FALSE(isFog(volume));
    test::changed(volume)->space = "";
    test::changed(volume)->name = "heat";
    EXPECT_FALSE(isFog(volume));
    test::changed(volume)->gridClass = "fog volume";
    EXPECT_TRUE(isFog(volume));
    test::changed(volume)->gridClass = "level set";
    EXPECT_FALSE(isFog(volume));
    test::changed(volume)->gridClass = "unknown";
    test::changed(volume)->name = "density";
    test::changed(volume)->hasBackground = false;  // a file density.nii
    EXPECT_FALSE(isFog(volume));
}

TEST(DefaultRamp, takesTheRangeThatIsAskedFor) {
    const Volume volume = volumeOf("uint16", {5000, 0, 0, 10, 0, 979, 0, 0, 11});
    const TransferFunction ramp = defaultRamp(volume, glm::dvec2(-5, 20));
    EXPECT_EQ(ramp.opacities.front().x, -5);
    EXPECT_EQ(ramp.opacityAt(-5), 0);
    EXPECT_EQ(ramp.opacityAt(20), kRampOpacity);
    EXPECT_EQ(ramp.colorAt(7.5), glm::dvec3(0.5));
    const TransferFunction whole = wholeRamp(volume, glm::dvec2(-5, 20));
    EXPECT_EQ(whole.colors.front().x, -5);
    EXPECT_EQ(whole.colors.back().x, 20);
}

TEST(DefaultRamp, leavesNothingButBackgroundClear) {
    EXPECT_EQ(defaultRamp(volumeOf("uint8", {100})).opacityAt(0), 0);
    EXPECT_EQ(defaultRamp(Volume()).opacityAt(0), 0);
}

TEST(DefaultRange, isTheTypesRangeForBytesAndTheDatasOtherwise) {
    EXPECT_EQ(defaultRange(volumeOf("uint8", {0, 0, 3, 4})), glm::dvec2(0, 255));
    EXPECT_EQ(defaultRange(volumeOf("uint16", {0, 0, 3, 4})), glm::dvec2(2, 3));
}

TEST(DefaultRange, takesInTheBackgroundOfAGrid) {
    Volume grid = volumeOf("int32", {0, 0, 3, 4});
    EXPECT_EQ(defaultRange(grid), glm::dvec2(2, 3));
    test::changed(grid)->hasBackground = true;
    EXPECT_EQ(defaultRange(grid), glm::dvec2(0, 3));
    test::changed(grid)->background = 9;
    EXPECT_EQ(defaultRange(grid), glm::dvec2(2, 9));
}

TEST(DefaultRange, isNeverEmpty) {
    EXPECT_EQ(defaultRange(volumeOf("uint16", {0, 0, 7})), glm::dvec2(0, 2));
    EXPECT_EQ(defaultRange(volumeOf("uint16", {7})), glm::dvec2(0, 1));
    Volume negative = volumeOf("int16", {7});
    VolumeData lower = negative.data();
    lower.valueMin = lower.valueMax = -4;
    negative = Volume(std::move(lower));
    EXPECT_EQ(defaultRange(negative), glm::dvec2(-4, 0));
}

}  // namespace
}  // namespace deltasplat
