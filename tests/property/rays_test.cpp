// SPDX-License-Identifier: Apache-2.0
// X-ray and MIP against closed forms; and the same pixels on every machine.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "deltasplat/simd.h"
#include "deltasplat/threads.h"
#include "optics/value_colors.h"
#include "property/ray_scene.h"
#include "support/changed_volume.h"
#include "support/simd_levels.h"

namespace deltasplat::test {
namespace {

constexpr Mode kModes[] = {Mode::kXray, Mode::kMip};

TEST(Rays, HalfFloatsAreValues) {
    Volume volume = makeVolume({{0, 0, 0}, {15, 15, 15}}, [](int, int, int) { return 0xBE00; });
    test::changed(volume)->codeBook = CodeBook::half();
    const double value = volume.codeBook().valueOf(0xBE00);
    ASSERT_NE(value, 0xBE00);
    ASSERT_NE(value, 0);
    const TestView view = viewOf(volume, {0, 0, -1});
    const Image xray = render(volume, optionsOf(Mode::kXray, view)).image;
    EXPECT_FLOAT_EQ(xray.pixel(35, 30)[0], float(16 * value));
    const Image mip = render(volume, optionsOf(Mode::kMip, view)).image;
    EXPECT_FLOAT_EQ(mip.pixel(35, 30)[0], float(value));
}

// What 32-bit floats do not hold is said.
TEST(Rays, ValuesBeyondFloatsAreWarnedOf) {
    const auto warningsOf = [](Mode mode, double value) {
        Volume volume = makeVolume({{0, 0, 0}, {15, 15, 15}}, [](int, int, int) { return 0; });
        test::changed(volume)->codeBook = CodeBook::ofTable({value});
        {
            test::Changed parts(volume);
            parts->valueMin = parts->valueMax = value;
        }
        std::string lines;
        Listener listener;
        listener.warning = [&](const std::string& line) { lines += line + "\n"; };
        render(volume, optionsOf(mode, viewOf(volume, {0, 0, -1})), listener);
        return lines;
    };
    EXPECT_EQ(warningsOf(Mode::kMip, 1e37), "");
    EXPECT_EQ(warningsOf(Mode::kXray, 1e36), "");
    EXPECT_EQ(warningsOf(Mode::kXray, 1e-30), "");
    const std::string taken =
        "values of up to 1e+300: those beyond +-8.5e+37 are taken for that, as x-rays and "
        "largest values are 32-bit floats\n";
    const std::string sums =
        " may add up to more than a 32-bit float holds: pixels are wrong where they do\n";
    EXPECT_EQ(warningsOf(Mode::kMip, -1e300), taken);
    EXPECT_EQ(warningsOf(Mode::kXray, -1e300), taken + "values of up to 1e+300" + sums);
    EXPECT_EQ(warningsOf(Mode::kXray, 3e37), "values of up to 3e+37" + sums);
    EXPECT_EQ(warningsOf(Mode::kMip, 1e-36),
              "values of up to 1e-36 lose digits, or become 0, as 32-bit floats\n");
}

// A slab perpendicular to z is as long as the line of sight is in it.
TEST(Rays, HomogeneousSlabIsValueTimesLength) {
    for (const glm::dvec3& spacing :
         {glm::dvec3(1), glm::dvec3(0.5, 2, 0.25), glm::dvec3(1, 1, 3)}) {
        const int thickness = 24;
        const int width = int(3 * thickness * spacing.z / spacing.x) + 20;
        const Volume volume = makeVolume(
            {{0, 0, 0}, {width, 20, thickness - 1}}, [](int, int, int) { return 7; }, spacing);
        for (const double degrees : {0.0, 20.0, 44.0, 50.0}) {
            SCOPED_TRACE(degrees);
            const double angle = degrees * std::acos(-1.0) / 180;
            TestView view = viewOf(volume, {-std::sin(angle), 0, -std::cos(angle)});
            view.size = {8, 8};
            view.pixelWorld = 0.2 * spacing.x;
            const double expected = 7 * thickness * spacing.z / std::cos(angle);
            const Image xray = render(volume, optionsOf(Mode::kXray, view)).image;
            const double limit = 2e-6 * expected;
            for (const float value : xray.rgba) ASSERT_NEAR(value, expected, limit);
            for (const float value : render(volume, optionsOf(Mode::kMip, view)).image.rgba)
                ASSERT_TRUE(value == 7 || value == 1) << value;
        }
    }
}

TEST(Rays, BallIsAsDeepAsItsChords) {
    const int radius = 20;
    const Volume ball = makeVolume({{-21, -21, -21}, {21, 21, 21}}, [&](int x, int y, int z) {
        return x * x + y * y + z * z <= radius * radius ? 3 : kInactive;
    });
    for (const glm::dvec3& direction : kDirections) {
        TestView view = viewOf(ball, direction);
        view.size = {41, 41};
        view.pixelWorld = 1;
        const Image xray = render(ball, optionsOf(Mode::kXray, view)).image;
        const Image mip = render(ball, optionsOf(Mode::kMip, view)).image;
        double error = 0;
        int pixels = 0;
        for (int y = 0; y < 41; ++y) {
            for (int x = 0; x < 41; ++x) {
                const double r = std::hypot(x - 20.0, y - 20.0);
                if (r > radius - 2) continue;
                EXPECT_EQ(mip.pixel(x, y)[0], 3);
                EXPECT_EQ(mip.pixel(x, y)[3], 1);
                const double chord = 2 * std::sqrt(radius * radius - r * r);
                error += xray.pixel(x, y)[0] - 3 * chord;
                EXPECT_NEAR(xray.pixel(x, y)[0], 3 * chord, 3 * 3);
                ++pixels;
            }
        }
        // On average a lattice is neither deeper nor flatter than the ball.
        EXPECT_NEAR(error / pixels, 0, 0.13 * 3);
    }
}

TEST(Rays, LargestValueOfOneVoxelIsItsOwn) {
    for (const int offset : {0, -500}) {
        Volume volume = makeVolume({{0, 0, 0}, {9, 9, 9}}, [](int x, int y, int z) {
            return x == 4 && y == 5 && z == 3 ? 200 : kInactive;
        });
        test::changed(volume)->codeBook = CodeBook::integer(offset);
        TestView view = viewOf(volume, {0, 0, -1});
        view.up = {0, 1, 0};
        view.target = {4, 5, 3};
        view.size = {9, 9};
        view.pixelWorld = 1;
        const Image image = render(volume, optionsOf(Mode::kMip, view)).image;
        for (int y = 0; y < 9; ++y) {
            for (int x = 0; x < 9; ++x) {
                const bool middle = x == 4 && y == 4;
                EXPECT_EQ(image.pixel(x, y)[0], middle ? 200 + offset : 0) << x << ' ' << y;
                EXPECT_EQ(image.pixel(x, y)[3], middle ? 1 : 0) << x << ' ' << y;
            }
        }
    }
}

TEST(Rays, ThreadsAndSimdLevelsGiveTheSamePixels) {
    // Higher than a band on every axis, with tiles inside.
    Volume volume = randomVolume({{-19, 5, -60}, {60, 110, 32}}, 17, 0.5, {1, 1.5, 0.8});
    auto tree = std::make_shared<CodeTree>(*volume.codes());
    tree->tree().addTile(1, openvdb::Coord(8, 24, -16), 77, true);
    test::changed(volume)->codes = tree;
    ++test::changed(volume)->histogram[77];
    for (const Mode mode : kModes) {
        for (const glm::dvec3& direction : kDirections) {
            const RenderOptions options = optionsOf(mode, viewOf(volume, direction));
            const Image expected = render(volume, options).image;
            for (const int threads : {1, 2, 3, 8}) {
                const ThreadLimit limit(threads);
                EXPECT_EQ(render(volume, options).image.rgba, expected.rgba) << threads;
            }
            for (const std::string& level : test::testedSimdLevels()) {
                setSimdLevel(level);
                EXPECT_EQ(render(volume, options).image.rgba, expected.rgba) << level;
            }
            setSimdLevel("auto");
        }
    }
}

// Blocks lie otherwise in the volume, and positions in the picture are rounded otherwise.
TEST(Rays, PlaceInIndexSpaceDoesNotMatter) {
    const auto block = [](const glm::ivec3& offset) {
        return makeVolume({offset, offset + 19}, [&](int x, int y, int z) {
            const glm::ivec3 p = glm::ivec3(x, y, z) - offset;
            return (p.x * 31 + p.y * 17 + p.z * 7) % 5 == 0 ? kInactive
                                                            : (p.x * 13 + p.y * 7 + p.z * 29) % 256;
        });
    };
    for (const Mode mode : kModes) {
        for (const glm::dvec3& direction : kDirections) {
            const auto imageAt = [&](const glm::ivec3& offset) {
                const Volume volume = block(offset);
                return render(volume, optionsOf(mode, viewOf(volume, direction))).image;
            };
            const Image here = imageAt(glm::ivec3(0));
            const float largest = *std::max_element(here.rgba.begin(), here.rgba.end());
            EXPECT_GT(largest, 100);
            for (const glm::ivec3& offset : {glm::ivec3(3, -5, 9), glm::ivec3(1 << 20)}) {
                const Image there = imageAt(offset);
                int apart = 0;
                for (std::size_t i = 0; i < here.rgba.size(); ++i)
                    apart += std::abs(there.rgba[i] - here.rgba[i]) > 2e-3f * largest;
                // A pixel half met may be so or not.
                EXPECT_LE(apart, mode == Mode::kMip ? 16 : 0) << offset.x;
            }
        }
    }
}

TEST(Rays, NothingActiveIsTransparent) {
    for (const Mode mode : kModes) {
        const Volume nothing =
            makeVolume({{0, 0, 0}, {7, 7, 7}}, [](int, int, int) { return kInactive; });
        for (const float value :
             render(nothing, optionsOf(mode, viewOf(nothing, {0, 0, -1}))).image.rgba)
            ASSERT_EQ(value, 0);
    }
}

TEST(Rays, ColoursOfLargestValuesAreTheTransferFunctions) {
    const Volume volume = makeVolume({{0, 0, 0}, {19, 19, 7}}, [](int x, int, int z) {
        return x < 2 ? kInactive : (z == 3 ? 10 * x : 5);
    });
    TestView view = viewOf(volume, {0, 0, -1});
    view.up = {0, 1, 0};
    view.size = {20, 20};
    view.pixelWorld = 1;
    RenderOptions options = optionsOf(Mode::kMip, view);
    options.mipColors = true;
    options.optics.transferFunction.colors = {{40, {1, 0, 0.5}}, {150, {0, 0.75, 1}}};
    options.optics.transferFunction.opacities = {{0, 0, 0.5, 0}};
    const Image image = render(volume, options).image;
    for (int x = 0; x < 20; ++x) {
        const float* rgba = image.pixel(x, 10);
        const glm::dvec3 expected =
            x < 2 ? glm::dvec3(0)
                  : options.optics.transferFunction.colorAt(std::max(10.0 * x, 5.0));
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(rgba[c], expected[c], 1e-4) << x;
        EXPECT_EQ(rgba[3], x < 2 ? 0 : 1);
    }
}

// 0.7 is no float: the picture's is a little smaller than the volume's own.
TEST(Rays, ConstantThatIsNoFloatHasItsColour) {
    Volume volume = test::makeVolume({{0, 0, 0}, {7, 7, 7}}, [](int, int, int) { return 0; });
    test::changed(volume)->codeBook = CodeBook::ofTable({0.7});
    {
        test::Changed parts(volume);
        parts->valueMin = parts->valueMax = 0.7;
    }
    Optics optics;
    optics.transferFunction.linearColors = true;
    optics.transferFunction.colors = {{0.7, {0, 0, 0}}, {0.7, {0.25, 0.5, 1}}};
    optics.transferFunction.opacities = {{0, 1, 0.5, 0}};
    const glm::vec3 color = ValueColors(volume, optics).colorOf(float(0.7));
    EXPECT_EQ(color, glm::vec3(0.25f, 0.5f, 1));
}

// Beside a jump of the function no colour is a mixture.
TEST(Rays, LargestValuesHaveNoColourBetweenTwoSteps) {
    const Volume volume =
        test::makeVolume({{0, 0, 0}, {7, 0, 0}}, [](int x, int, int) { return x; });
    Optics optics;
    optics.transferFunction.linearColors = true;
    for (int i = 0; i < 8; ++i) {
        const glm::dvec3 color(i / 7.0);
        if (i > 0) optics.transferFunction.colors.push_back({i - 1 + 1e-6, color});
        optics.transferFunction.colors.push_back({double(i), color});
    }
    optics.transferFunction.opacities = {{0, 1, 0.5, 0}};
    const ValueColors colors(volume, optics);
    for (float value = 0; value <= 7; value += 0.000999f) {
        const double level = std::ceil(double(value) - 1e-6) / 7;
        EXPECT_NEAR(colors.colorOf(value).g, level, 1e-6) << value;
    }
}

TEST(Rays, CountsSayWhatWasDone) {
    const Volume volume = makeVolume({{0, 0, 0}, {9, 9, 9}}, [](int x, int y, int) {
        return x == 0 ? kInactive : (y < 5 ? 0 : 9);
    });
    const RenderStats xray =
        render(volume, optionsOf(Mode::kXray, viewOf(volume, {0, 1, 0}))).stats;
    EXPECT_EQ(xray.mode, Mode::kXray);
    EXPECT_EQ(xray.voxels, 1000);
    EXPECT_EQ(xray.visible, 450);
    EXPECT_EQ(xray.stamps, 0);
    EXPECT_EQ(xray.sliceAxis, 1);
    EXPECT_EQ(render(volume, optionsOf(Mode::kMip, viewOf(volume, {0, 1, 0}))).stats.visible, 900);
}

}  // namespace
}  // namespace deltasplat::test
