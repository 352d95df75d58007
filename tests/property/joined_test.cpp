// SPDX-License-Identifier: Apache-2.0
// Slices that are drawn as one, where the screen is too coarse for it to be seen.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/vector_relational.hpp>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include "deltasplat/error.h"
#include "deltasplat/render.h"
#include "deltasplat/render_deep.h"
#include "support/make_volume.h"
#include "support/same_picture.h"
#include "support/small_joined.h"
#include "support/some_scene.h"

namespace deltasplat {
namespace {

using test::Colors;
using test::someOptics;

class Joined : public testing::Test {
    test::SmallJoined joined_;
};

const double kPi = std::acos(-1.0);

constexpr IndexBox kBox{{-19, 5, -41}, {28, 50, 2}};

// Of voxels of side 1.
RenderOptions optionsFor(Colors colors, double pixelsPerVoxel, const glm::dvec3& direction) {
    RenderOptions options;
    options.optics = someOptics(colors);
    options.camera.direction = direction;
    options.camera.up = glm::dvec3(0.1, 1, 0.2);
    options.camera.sizePixels = glm::max(glm::ivec2(80 * pixelsPerVoxel), 1);
    options.camera.frameWidthWorld = options.camera.sizePixels.x / pixelsPerVoxel;
    return options;
}

// The same from an eye that sees the middle of the box so.
RenderOptions fromEye(RenderOptions options, double fovDegrees) {
    const double tangent = std::tan(0.5 * fovDegrees * kPi / 180);
    options.camera.projection = Projection::kPerspective;
    options.camera.fovDegrees = fovDegrees;
    options.camera.distanceWorld = 0.5 * *options.camera.frameWidthWorld / tangent;
    options.camera.frameWidthWorld.reset();
    return options;
}

RenderOptions fromEye(Colors colors, double pixelsPerVoxel, const glm::dvec3& direction,
                      double fovDegrees) {
    return fromEye(optionsFor(colors, pixelsPerVoxel, direction), fovDegrees);
}

RenderResult unjoined(const Volume& volume, RenderOptions options) {
    options.splat.between = 0;
    RenderResult result = render(volume, options);
    EXPECT_EQ(result.stats.joined, 1);
    return result;
}

double largestDifference(const Image& a, const Image& b) {
    double largest = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i)
        largest = std::max(largest, std::abs(double(a.rgba[i]) - double(b.rgba[i])));
    return largest;
}

double sumOf(const Image& image) {
    double sum = 0;
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) sum += double(image.rgba[i]);
    return sum;
}

const glm::dvec3 kOblique(1, 0.7, -0.9);

TEST_F(Joined, chosenWhereVoxelsCoverHalfAPixel) {
    const Volume volume = test::randomVolume(kBox, 5, 0.5);
    const auto joinedOf = [&](Colors colors, double pixels) {
        return render(volume, optionsFor(colors, pixels, kOblique)).stats.joined;
    };
    for (const Colors colors : {Colors::kOne, Colors::kSeveral}) {
        EXPECT_EQ(joinedOf(colors, 0.51), 1);
        EXPECT_EQ(joinedOf(colors, 0.5), 2);
        EXPECT_EQ(joinedOf(colors, 0.01), 2);
    }
    EXPECT_EQ(joinedOf(Colors::kOwn, 0.1), 1);
    EXPECT_EQ(joinedOf(Colors::kLit, 0.1), 1);
}

// The exact picture is another one.
TEST_F(Joined, sayNoBound) {
    const Volume volume = test::randomVolume(kBox, 5, 0.5);
    RenderOptions options = optionsFor(Colors::kSeveral, 0.4, kOblique);
    const RenderStats joined = render(volume, options).stats;
    EXPECT_EQ(joined.joined, 2);
    EXPECT_TRUE(std::isinf(joined.errorBoundColor));
    EXPECT_TRUE(std::isinf(joined.errorBoundAlpha));
    options.splat.between = 0;
    const RenderStats exact = render(volume, options).stats;
    EXPECT_EQ(exact.joined, 1);
    EXPECT_EQ(exact.errorBoundColor, 0);
    EXPECT_EQ(exact.errorBoundAlpha, 0);
    options.splat.between = {};
    options.splat.tolerance.relative = 0.05;
    const RenderStats held = render(volume, options).stats;
    EXPECT_EQ(held.joined, 1);
    EXPECT_FALSE(std::isinf(held.errorBoundColor));
    EXPECT_GT(held.errorBoundAlpha, 0);
}

// More than two where they are moved by no more than a quarter of a pixel, for who asks for it.
TEST_F(Joined, joinsUpToEightWhereThatMovesLittle) {
    const Volume volume = test::randomVolume(kBox, 5, 0.5);
    const auto joinedOf = [&](double pixels, const glm::dvec3& direction, int most) {
        RenderOptions options = optionsFor(Colors::kSeveral, pixels, direction);
        options.splat.mostJoined = most;
        return render(volume, options).stats.joined;
    };
    EXPECT_EQ(joinedOf(0.5, {0, 0, 1}, 8), 8);
    EXPECT_EQ(joinedOf(0.5, {0, 0, 1}, 4), 4);
    EXPECT_EQ(joinedOf(0.51, {0, 0, 1}, 8), 1);
    // Fifths and tenths of voxels: eight slices are up to 0.4 and 0.4 from their places, four 0.3
    // and 0.3.
    const glm::dvec3 oblique(1, 0.8, 0.6);
    EXPECT_EQ(joinedOf(0.25 / std::hypot(0.4, 0.4) - 1e-3, oblique, 8), 8);
    EXPECT_EQ(joinedOf(0.25 / std::hypot(0.4, 0.4) + 1e-3, oblique, 8), 4);
    EXPECT_EQ(joinedOf(0.5, oblique, 8), 4);
    // Not where lines of sight leave a column only now and then.
    struct Joint {
        double slope;
        int ofEight;
        int ofFour;
    };
    for (const Joint& joint :
         {Joint{0.03, 4, 4}, {0.12, 2, 2}, {0.13, 8, 2}, {0.24, 8, 2}, {0.26, 8, 4}}) {
        EXPECT_EQ(joinedOf(0.2, {1, joint.slope, 0.8}, 8), joint.ofEight) << joint.slope;
        EXPECT_EQ(joinedOf(0.2, {1, joint.slope, 0.8}, 4), joint.ofFour) << joint.slope;
    }
    for (const int none : {0, 3, 5, 64, -2}) EXPECT_THROW(joinedOf(0.2, oblique, none), Error);
    RenderOptions eye = fromEye(Colors::kSeveral, 0.1, kOblique, 20);
    eye.splat.mostJoined = 8;
    EXPECT_EQ(render(volume, eye).stats.joined, 2);
}

// As many as cover four pixels where they lie side by side.
TEST_F(Joined, joinsTheMoreTheSmallerVoxelsAre) {
    const Volume volume =
        test::makeVolume({{0, 4, -8}, {63, 63, 60}}, [](int, int, int z) { return 100 + z; });
    RenderOptions options;
    struct Joint {
        double pixels;
        int slices;
        int within;
    };
    for (const Colors colors : {Colors::kOne, Colors::kSeveral}) {
        for (const Joint& joint : {Joint{0.51, 1, 1},
                                   {0.5, 8, 1},
                                   {0.251, 8, 1},
                                   {0.25, 16, 1},
                                   {0.188, 16, 1},
                                   {0.1875, 16, 2},
                                   {0.063, 16, 2},
                                   {0.0625, 32, 4},
                                   {0.01, 32, 4}}) {
            options = optionsFor(colors, joint.pixels, {0, 0, 1});
            options.splat.mostJoined = kMostJoined;
            const RenderStats stats = render(volume, options).stats;
            EXPECT_EQ(stats.joined, joint.slices) << joint.pixels;
            EXPECT_EQ(stats.resolution, 1.0 / joint.within) << joint.pixels;
            // Of fewer slices no voxels beside each other become one.
            options.splat.mostJoined = 8;
            EXPECT_EQ(render(volume, options).stats.resolution, 1);
        }
    }
}

// Threads of one voxel along the line of sight, every eighth voxel, would be four times as thick:
// so only slices are joined. Plates across it are as dense, whatever becomes one.
TEST_F(Joined, keepsThreadsAlongTheLineOfSightAsThin) {
    const auto isThread = [](int x, int y) { return (x & 7) == 3 && (y & 7) == 2; };
    const Volume threads = test::makeVolume({{0, 0, 0}, {63, 63, 127}}, [&](int x, int y, int) {
        return isThread(x, y) ? 200 : test::kInactive;
    });
    const Volume plates = test::makeVolume({{0, 0, 0}, {63, 63, 127}}, [&](int, int, int z) {
        return z % 16 == 3 ? 100 : test::kInactive;
    });
    for (const Colors colors : {Colors::kOne, Colors::kSeveral}) {
        for (const double pixels : {0.1875, 0.0625}) {
            RenderOptions options = optionsFor(colors, pixels, {0, 0, 1});
            options.splat.mostJoined = kMostJoined;
            for (const bool areThreads : {false, true}) {
                const Volume& volume = areThreads ? threads : plates;
                const RenderResult joined = render(volume, options);
                EXPECT_GE(joined.stats.joined, 16);
                EXPECT_EQ(joined.stats.resolution == 1, areThreads);
                EXPECT_NEAR(sumOf(joined.image) / sumOf(unjoined(volume, options).image), 1, 4e-3);
            }
        }
    }
}

// What is a voxel thin and goes on along lines of sight is drawn slice by slice: joined, it would
// be as much as a fifth too thin or too thick. What is thicker is joined.
TEST_F(Joined, keepsWhatGoesOnAlongLinesOfSightAsDense) {
    // Along the slices, every 16th voxel.
    const auto rods = [](int thick) {
        return test::makeVolume({{0, 0, 0}, {95, 95, 127}}, [=](int x, int y, int) {
            return (x & 15) < thick && (y & 15) < thick ? 200 : test::kInactive;
        });
    };
    // Every tenth voxel, tilted.
    const auto plates = [](double slope) {
        return test::makeVolume({{0, 0, 0}, {95, 95, 127}}, [=](int, int y, int z) {
            const int place = y - int(std::ceil(slope * z));
            return (place % 10 + 10) % 10 == 0 ? 200 : test::kInactive;
        });
    };
    const auto expectAsDense = [](const Volume& volume, const RenderOptions& options) {
        const RenderResult joined = render(volume, options);
        const double ratio = sumOf(joined.image) / sumOf(unjoined(volume, options).image);
        EXPECT_NEAR(ratio, 1, 0.03) << joined.stats.joined;
        return joined.stats.joined;
    };
    const Volume thinRods = rods(1);
    const Volume thickRods = rods(6);
    for (const double slope : {0.3, 0.497, 0.505, 0.7}) {
        for (const double pixels : {0.45, 0.1}) {
            RenderOptions options = optionsFor(Colors::kOne, pixels, {slope, 0.36, 1});
            options.splat.mostJoined = kMostJoined;
            expectAsDense(thinRods, options);
            EXPECT_GT(expectAsDense(thickRods, options), 1) << slope;
            options.splat.mostJoined = 2;
            EXPECT_EQ(expectAsDense(thinRods, options), 1) << slope;
        }
    }
    for (const double pixels : {0.45, 0.1}) {
        for (const double slope : {0.25, 0.32, 0.46}) {
            RenderOptions options = optionsFor(Colors::kOne, pixels, {0.214, slope, 1});
            options.splat.mostJoined = kMostJoined;
            expectAsDense(plates(slope), options);
        }
    }
    RenderOptions edgeOn = optionsFor(Colors::kOne, 0.45, {0.214, 0.32, 1});
    for (const int most : {2, 8, kMostJoined}) {
        edgeOn.splat.mostJoined = most;
        EXPECT_EQ(expectAsDense(plates(0.32), edgeOn), 1) << most;
    }
    // Seen straight, slices are where they are.
    EXPECT_EQ(expectAsDense(thinRods, optionsFor(Colors::kOne, 0.45, {0, 0, 1})), 2);
}

// From an eye lines of sight have slopes of their own, along whatever axis they go.
TEST_F(Joined, keepsWhatRecedesFromAnEyeAsDense) {
    for (int axis = 0; axis < 3; ++axis) {
        const auto rods = [&](int thick) {
            glm::ivec3 last(95);
            last[axis] = 127;
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            return test::makeVolume({{0, 0, 0}, last}, [=](int x, int y, int z) {
                const glm::ivec3 at(x, y, z);
                return (at[u] & 15) < thick && (at[v] & 15) < thick ? 200 : test::kInactive;
            });
        };
        const Volume thinRods = rods(1);
        const Volume thickRods = rods(6);
        for (const double sign : {-1.0, 1.0}) {
            glm::dvec3 direction(0.0);
            direction[axis] = sign;
            direction[(axis + 1) % 3] = 0.45;
            direction[(axis + 2) % 3] = -0.35;
            const RenderOptions options = fromEye(Colors::kOne, 0.2, direction, 25);
            const RenderResult thin = render(thinRods, options);
            EXPECT_EQ(thin.stats.joined, 1) << axis << ' ' << sign;
            const RenderResult thick = render(thickRods, options);
            EXPECT_EQ(thick.stats.joined, 2) << axis << ' ' << sign;
            EXPECT_NEAR(sumOf(thick.image) / sumOf(unjoined(thickRods, options).image), 1, 0.01);
            // Across the rods nothing goes on.
            glm::dvec3 across(0.0);
            across[(axis + 1) % 3] = sign;
            across[axis] = 0.4;
            across[(axis + 2) % 3] = 0.3;
            EXPECT_EQ(render(thinRods, fromEye(Colors::kOne, 0.2, across, 25)).stats.joined, 2)
                << axis << ' ' << sign;
        }
    }
}

// Pixels around the frame change nothing of it, though they may show lines of sight along another
// axis.
TEST_F(Joined, overscanChangesNothing) {
    const Volume volume = test::randomVolume(kBox, 5, 0.5, {0.5, 0.5, 4});
    RenderOptions options = fromEye(Colors::kOne, 0.4, {1, 0.2, 0.1}, 60);
    options.camera.distanceWorld = 150;
    const int joined = render(volume, options).stats.joined;
    for (const int pixels : {8, 64, 200}) {
        options.camera.overscanPixels = glm::ivec2(pixels);
        EXPECT_EQ(render(volume, options).stats.joined, joined) << pixels;
    }
}

// What is even, but for values that alternate, is not rounded to steps that can be seen.
TEST_F(Joined, showsNoStepsInWhatIsEven) {
    const Volume volume = test::makeVolume({{0, 0, 0}, {127, 63, 127}},
                                           [](int x, int, int z) { return 40 + x + (z & 1); });
    RenderOptions options = optionsFor(Colors::kSeveral, 0.4, {0, 0, 1});
    options.camera.sizePixels = {60, 30};
    options.camera.frameWidthWorld = 150;
    options.splat.mostJoined = 8;
    for (const double extinction : {0.3, 0.05, 0.005}) {
        options.optics.extinctionScale = extinction;
        const RenderResult joined = render(volume, options);
        EXPECT_EQ(joined.stats.joined, 8);
        EXPECT_LT(largestDifference(joined.image, unjoined(volume, options).image), 1.0 / 255)
            << extinction;
    }
}

// Of however many classes, then.
TEST_F(Joined, joinsAnyNumberOfClasses) {
    const Volume volume = test::makeVolume(
        kBox, [&](int x, int y, int z) { return (x * 7 + y * 31 + z * 3 + 4000) % 9000; });
    RenderOptions options = optionsFor(Colors::kSeveral, 0.3, kOblique);
    options.optics.transferFunction.opacities = {{-1, 0, 0.5, 0}, {9000, 0.5, 0.5, 0}};
    for (auto& point : options.optics.transferFunction.colors) point.x *= 30;
    const RenderResult expected = unjoined(volume, options);
    for (const int most : {4, 8}) {
        options.splat.mostJoined = most;
        const RenderResult joined = render(volume, options);
        EXPECT_GE(joined.stats.joined, 2);
        EXPECT_NEAR(sumOf(joined.image) / sumOf(expected.image), 1, 0.01);
    }
    options.splat.mostJoined = 2;
    EXPECT_EQ(render(volume, options).stats.joined, 1);
}

TEST_F(Joined, notWhereLittleIsSaved) {
    const Volume volume = test::randomVolume(kBox, 5, 0.5);
    leastVoxelsJoined = volume.activeCount() + 1;
    const RenderOptions options = optionsFor(Colors::kSeveral, 0.3, kOblique);
    EXPECT_EQ(render(volume, options).stats.joined, 1);
    leastVoxelsJoined = volume.activeCount();
    EXPECT_EQ(render(volume, options).stats.joined, 2);
    // Nor more than two of several colours, but in a large volume.
    for (const Colors colors : {Colors::kOne, Colors::kSeveral}) {
        RenderOptions many = optionsFor(colors, 0.3, {0, 0, 1});
        many.splat.mostJoined = 8;
        leastVoxelsJoined = volume.activeCount() / 32 + 1;
        EXPECT_EQ(render(volume, many).stats.joined, colors == Colors::kOne ? 8 : 2);
        leastVoxelsJoined = volume.activeCount() / 32;
        EXPECT_EQ(render(volume, many).stats.joined, 8);
    }
}

// However many points say it, and in whatever space they are mixed.
TEST_F(Joined, oneColorIsWhatAllPointsHave) {
    const Volume volume = test::randomVolume(kBox, 5, 0.5);
    RenderOptions options = optionsFor(Colors::kOne, 0.3, {0, 0, 1});
    options.splat.mostJoined = 8;
    leastVoxelsJoined = volume.activeCount();
    const RenderResult expected = render(volume, options);
    EXPECT_EQ(expected.stats.joined, 8);
    TransferFunction& function = options.optics.transferFunction;
    function.colors.push_back({150, function.colors[0].rgb});
    function.colors.push_back({255, function.colors[0].rgb});
    for (const ColorSpace space : {ColorSpace::kRgb, ColorSpace::kHsv, ColorSpace::kHsvShortest,
                                   ColorSpace::kLab, ColorSpace::kDiverging}) {
        function.colorSpace = space;
        const RenderResult result = render(volume, options);
        EXPECT_EQ(result.stats.joined, 8);
        EXPECT_EQ(result.image.rgba, expected.image.rgba);
    }
}

TEST_F(Joined, notWhereVoxelsAreAskedFor) {
    const Volume volume = test::randomVolume(kBox, 5, 0.5);
    const RenderOptions plain = optionsFor(Colors::kSeveral, 0.3, kOblique);
    std::vector<RenderOptions> all(7, plain);
    all[0].splat.between = 0;
    all[1].splat.resolution = 1;
    all[2].splat.sigma = 0.5;
    all[3].splat.tolerance.relative = 0.01;
    all[4].splat.tolerance.value = 1;
    all[5].splat.footprintWidth = 1;
    all[6].splat.mostJoined = 1;
    EXPECT_EQ(render(volume, plain).stats.joined, 2);
    for (const RenderOptions& options : all) EXPECT_EQ(render(volume, options).stats.joined, 1);
    DeepImage deep;
    EXPECT_EQ(renderDeep(volume, plain, {}, deep).stats.joined, 1);
}

// From an eye, as far as its nearest voxel covers no more than three quarters of a pixel, and none
// lies beside or behind the eye, or before the near plane.
TEST_F(Joined, chosenFromAnEyeWhereAllVoxelsAreSmall) {
    const Volume volume = test::randomVolume(kBox, 5, 0.5);
    const auto joinedOf = [&](const RenderOptions& options) {
        return render(volume, options).stats.joined;
    };
    for (const Colors colors : {Colors::kOne, Colors::kSeveral}) {
        EXPECT_EQ(joinedOf(fromEye(colors, 0.55, kOblique, 10)), 1);
        EXPECT_EQ(joinedOf(fromEye(colors, 0.45, kOblique, 10)), 2);
        EXPECT_EQ(joinedOf(fromEye(colors, 0.45, kOblique, 50)), 1);
        EXPECT_EQ(joinedOf(fromEye(colors, 0.2, kOblique, 50)), 2);
    }
    RenderOptions cut = fromEye(Colors::kOne, 0.2, kOblique, 30);
    EXPECT_EQ(joinedOf(cut), 2);
    cut.camera.nearWorld = *cut.camera.distanceWorld;
    EXPECT_EQ(joinedOf(cut), 1);
    RenderOptions around;
    around.optics = someOptics(Colors::kOne);
    around.camera.projection = Projection::kLatlong;
    around.camera.sizePixels = {64, 32};
    EXPECT_EQ(joinedOf(around), 1);
    around.camera.eyeWorld = {20, 30, 140};
    EXPECT_EQ(joinedOf(around), 2);
    // Beside a thin layer, some of it is near.
    const Volume layer = test::randomVolume({{0, 0, 0}, {99, 1, 99}}, 5, 0.5);
    for (const double aside : {0.0, 5.0, 8.0, 30.0}) {
        around.camera.eyeWorld = {50 + aside, 7, 50};
        EXPECT_EQ(render(layer, around).stats.joined, 1) << aside;
    }
}

// Of several colours, steps have to be nearly as long as those that pairs are mixed for.
TEST_F(Joined, notFromAnEyeWhereStepsDifferALot) {
    for (const double spacing : {1.0, 5.0}) {
        const Volume volume = test::randomVolume(kBox, 5, 0.5, {spacing, 1, 1});
        for (const Colors colors : {Colors::kOne, Colors::kSeveral}) {
            RenderOptions options = optionsFor(colors, 0.1, {1, 0.6, 0.3});
            *options.camera.frameWidthWorld *= spacing;
            options = fromEye(options, 40);
            EXPECT_EQ(render(volume, options).stats.joined,
                      spacing == 5 && colors == Colors::kSeveral ? 1 : 2);
        }
    }
}

TEST_F(Joined, notFromAnEyeWhereVoxelsAreAskedFor) {
    const Volume volume = test::randomVolume(kBox, 5, 0.5);
    const RenderOptions plain = fromEye(Colors::kSeveral, 0.2, kOblique, 30);
    std::vector<RenderOptions> all(4, plain);
    all[0].splat.between = 0;
    all[1].splat.resolution = 1;
    all[2].splat.tolerance.relative = 0.01;
    all[3].splat.mostJoined = 1;
    EXPECT_EQ(render(volume, plain).stats.joined, 2);
    for (const RenderOptions& options : all) EXPECT_EQ(render(volume, options).stats.joined, 1);
    DeepImage deep;
    EXPECT_EQ(renderDeep(volume, plain, {}, deep).stats.joined, 1);
}

// Of several colours, pairs of classes have 16-bit numbers.
TEST_F(Joined, takesAsManyClassesAsHaveNumbers) {
    for (const int classes : {255, 256}) {
        const Volume volume = test::makeVolume(
            kBox, [&](int x, int y, int z) { return (x * 7 + y * 31 + z * 3 + 4000) % classes; });
        RenderOptions options = optionsFor(Colors::kSeveral, 0.3, kOblique);
        options.optics.transferFunction.opacities = {{-1, 0, 0.5, 0}, {300, 0.5, 0.5, 0}};
        EXPECT_EQ(render(volume, options).stats.joined, classes == 255 ? 2 : 1);
        options.optics = someOptics(Colors::kOne);
        options.optics.transferFunction.opacities = {{-1, 0, 0.5, 0}, {300, 0.5, 0.5, 0}};
        EXPECT_EQ(render(volume, options).stats.joined, 2);
    }
}

// Seen straight, nothing moves at all.
TEST_F(Joined, straightViewsShowTheSame) {
    const Volume volume = test::randomVolume(kBox, 6, 0.7);
    for (const Colors colors : {Colors::kOne, Colors::kSeveral}) {
        for (const double pixels : {0.4, 0.1}) {
            for (int axis = 0; axis < 3; ++axis) {
                for (const double sign : {1.0, -1.0}) {
                    glm::dvec3 direction(0);
                    direction[axis] = sign;
                    RenderOptions options = optionsFor(colors, pixels, direction);
                    options.optics.extinctionScale = 0.1;
                    const RenderResult joined = render(volume, options);
                    EXPECT_EQ(joined.stats.joined, 2);
                    const RenderResult expected = unjoined(volume, options);
                    EXPECT_LT(joined.stats.visible, expected.stats.visible);
                    EXPECT_LT(largestDifference(joined.image, expected.image), 4e-4)
                        << axis << ", " << sign;
                    options.splat.mostJoined = 8;
                    const RenderResult eight = render(volume, options);
                    EXPECT_EQ(eight.stats.joined, 8);
                    // Looks are rounded.
                    EXPECT_LT(largestDifference(eight.image, expected.image), 4e-3)
                        << axis << ", " << sign;
                    if (pixels > 0.125) continue;
                    options.splat.mostJoined = kMostJoined;
                    const RenderResult most = render(volume, options);
                    EXPECT_GE(most.stats.joined, 16);
                    // Squares of noise are a little denser.
                    EXPECT_LT(largestDifference(most.image, expected.image),
                              most.stats.resolution < 1 ? 0.025 : 4e-3)
                        << axis << ", " << sign;
                    EXPECT_NEAR(sumOf(most.image) / sumOf(expected.image), 1, 0.02)
                        << axis << ", " << sign;
                }
            }
        }
    }
}

struct Middle {
    double sum = 0;
    glm::dvec2 place{0.0};
};

Middle middleOf(const Image& image) {
    Middle middle;
    for (int y = 0; y < image.size.y; ++y) {
        for (int x = 0; x < image.size.x; ++x) {
            const double alpha = double(image.pixel(x, y)[3]);
            middle.sum += alpha;
            middle.place += alpha * glm::dvec2(x, y);
        }
    }
    middle.place /= middle.sum;
    return middle;
}

const glm::dvec3 kDirections[] = {{1, 1, -1},      {1, -0.3, 0.2}, {0.5, 0.5, 1},  {-0.2, 1, 0.9},
                                  {0.1, 0.05, -1}, {1, 0.7, 0.5},  {-1, 0.8, -0.6}};

// A voxel on its own stays where it is, and as opaque.
TEST_F(Joined, movesNothingByMoreThanAFifthOfAPixel) {
    double farthest = 0;
    double farthestFromEye = 0;
    std::vector<double> ratios;
    const glm::ivec3 places[] = {{0, 30, -20}, {-7, 21, -19}, {5, 33, -26}, {-2, 28, -15}};
    for (int i = 0; i < 8; ++i) {
        const Volume volume = test::makeVolume(
            kBox,
            [&](int x, int y, int z) {
                return glm::ivec3(x, y, z) == places[i / 2] ? 180 : test::kInactive;
            },
            i % 2 == 0 ? glm::dvec3(1) : glm::dvec3(0.5, 0.9, 5));
        for (const glm::dvec3& direction : kDirections) {
            // Voxels of both kinds are no wider than one world unit in most slices.
            RenderOptions options = optionsFor(Colors::kOne, 0.5, direction);
            options.splat.filter = PictureFilter::kGauss;
            options.camera.sizePixels = {120, 120};
            options.camera.frameWidthWorld = 240;
            for (const RenderOptions& one : {options, fromEye(options, 40)}) {
                const RenderResult joined = render(volume, one);
                if (joined.stats.joined == 1) continue;
                const Middle now = middleOf(joined.image);
                const Middle expected = middleOf(unjoined(volume, one).image);
                // From an eye a voxel on its own is read by more or fewer pixels, as it lies
                // between them.
                const double ratio = now.sum / expected.sum;
                EXPECT_NEAR(ratio, 1, one.camera.fovDegrees ? 0.1 : 0.03);
                if (one.camera.fovDegrees) ratios.push_back(ratio);
                const double moved = glm::length(now.place - expected.place);
                EXPECT_LE(moved, 0.2);
                double& most = one.camera.fovDegrees ? farthestFromEye : farthest;
                most = std::max(most, moved);
            }
        }
    }
    EXPECT_GT(farthest, 0.08);
    EXPECT_GT(farthestFromEye, 0.08);
    EXPECT_NEAR(std::accumulate(ratios.begin(), ratios.end(), 0.0) / double(ratios.size()), 1,
                0.03);
}

// What the picture of plates of one voxel adds up to, voxel by voxel and with slices joined.
struct PlateSums {
    double single;
    double joined;
};

constexpr int kPlate = 64;

// Pixels that a voxel covers, for so many slices to be joined.
double platePixels(int mostJoined) {
    return std::min(0.4, 4.0 / mostJoined);
}

PlateSums sumsOfPlates(int axis, bool isOne, double opacity, const glm::dvec3& direction,
                       Colors colors, bool isFromEye = false, int mostJoined = 2,
                       const glm::ivec3& dims = glm::ivec3(kPlate)) {
    const IndexBox box{glm::ivec3(0), dims - 1};
    const Volume plates = test::makeVolume(box, [&](int x, int y, int z) {
        const int at = glm::ivec3(x, y, z)[axis];
        return (isOne ? at == 30 : at % 8 == 3) ? 255 : test::kInactive;
    });
    const double pixels = platePixels(mostJoined);
    RenderOptions options = optionsFor(colors, pixels, direction);
    options.camera.frameWidthWorld = 60 / pixels;
    options.camera.sizePixels = {60, 60};
    if (isFromEye) options = fromEye(options, 25);
    options.optics.transferFunction.opacities = {{0, 0, 0.5, 0}, {255, opacity, 0.5, 0}};
    options.splat.mostJoined = mostJoined;
    const RenderResult joined = render(plates, options);
    return {sumOf(unjoined(plates, options).image), sumOf(joined.image)};
}

// So do eight slices: by no more than a quarter, and what a sheet's reading takes.
TEST_F(Joined, movesNothingOfEightSlicesByMoreThanAQuarterOfAPixel) {
    double farthest = 0;
    for (const glm::ivec3& place : {glm::ivec3(0, 30, -20), {-7, 21, -19}, {5, 33, -26}}) {
        const Volume volume = test::makeVolume(kBox, [&](int x, int y, int z) {
            return glm::ivec3(x, y, z) == place ? 180 : test::kInactive;
        });
        for (const glm::dvec3& direction : kDirections) {
            for (const Colors colors : {Colors::kOne, Colors::kSeveral}) {
                RenderOptions options = optionsFor(colors, 0.4, direction);
                options.splat.filter = PictureFilter::kGauss;
                options.camera.sizePixels = {120, 120};
                options.camera.frameWidthWorld = 300;
                options.splat.mostJoined = 8;
                const RenderResult joined = render(volume, options);
                if (joined.stats.joined == 2) continue;
                const Middle now = middleOf(joined.image);
                const Middle expected = middleOf(unjoined(volume, options).image);
                EXPECT_NEAR(now.sum / expected.sum, 1, 0.04);
                const double moved = glm::length(now.place - expected.place);
                EXPECT_LE(moved, 0.26);
                farthest = std::max(farthest, moved);
            }
        }
    }
    EXPECT_GT(farthest, 0.1);
}

// What the picture of plates adds up to in squares of voxels, by walking along lines of sight
// through solid voxels.
double truthOfPlates(int axis, double opacity, const glm::dvec3& direction) {
    const glm::dvec3 along = glm::normalize(direction);
    const glm::dvec3 aside = glm::normalize(glm::cross(along, glm::dvec3(0.1, 1, 0.2)));
    const glm::dvec3 up = glm::cross(aside, along);
    constexpr double kStep = 0.06;     // of a line of sight
    constexpr double kBetween = 0.61;  // lines of sight
    constexpr double kReach = 0.87 * kPlate;
    const double extinction = -std::log(1 - opacity);
    double sum = 0;
    for (double x = -kReach; x < kReach; x += kBetween) {
        for (double y = -kReach; y < kReach; y += kBetween) {
            double length = 0;
            for (double z = -kReach; z < kReach; z += kStep) {
                const glm::dvec3 place = 0.5 * kPlate + x * aside + y * up + z * along;
                const bool isIn = glm::all(glm::greaterThanEqual(place, glm::dvec3(0))) &&
                                  glm::all(glm::lessThan(place, glm::dvec3(kPlate)));
                if (isIn && int(place[axis]) % 8 == 3) length += kStep;
            }
            sum += 1 - std::exp(-extinction * length);
        }
    }
    return sum * std::pow(kBetween, 2);
}

// Many plates of one voxel are as dense as they are, also of more slices than two, wherever they
// are joined.
TEST_F(Joined, keepsManySlicesAsDense) {
    for (int axis = 0; axis < 3; ++axis) {
        for (const double opacity : {0.9, 0.05}) {
            for (const glm::dvec3& direction : kDirections) {
                const double inVoxels = truthOfPlates(axis, opacity, direction);
                for (const int most : {4, 8}) {
                    const PlateSums sums = sumsOfPlates(axis, false, opacity, direction,
                                                        Colors::kSeveral, false, most);
                    const double truth = inVoxels * std::pow(platePixels(most), 2);
                    EXPECT_NEAR(sums.joined / truth, 1, 0.045)
                        << axis << ' ' << opacity << ' ' << direction.x << ' ' << direction.y << ' '
                        << most;
                }
            }
        }
    }
}

// So are those that are joined where voxels are smaller, but for the fraction of a voxel at both
// ends of a plate, along lines of sight, by which they move.
TEST_F(Joined, keepsMostSlicesAsDense) {
    for (int axis = 0; axis < 3; ++axis) {
        for (const glm::dvec3& direction : kDirections) {
            for (const int most : {16, kMostJoined}) {
                glm::ivec3 dims(kPlate);
                for (int i = 0; i < 3; ++i)
                    if (std::abs(direction[i]) == 1) dims[i] = 8 * most;
                for (const double opacity : {0.9, 0.05}) {
                    const PlateSums sums = sumsOfPlates(axis, false, opacity, direction,
                                                        Colors::kSeveral, false, most, dims);
                    EXPECT_NEAR(sums.joined / sums.single, 1, 0.06)
                        << axis << ' ' << opacity << ' ' << direction.x << ' ' << direction.y << ' '
                        << most;
                }
            }
        }
    }
}

// Many plates hide what is behind them as before.
TEST_F(Joined, keepsPlatesAsDense) {
    for (int axis = 0; axis < 3; ++axis) {
        for (const double opacity : {0.9, 0.05}) {
            for (const glm::dvec3& direction : kDirections) {
                for (const Colors colors : {Colors::kOne, Colors::kSeveral}) {
                    for (const bool isFromEye : {false, true}) {
                        const PlateSums sums =
                            sumsOfPlates(axis, false, opacity, direction, colors, isFromEye);
                        EXPECT_NEAR(sums.joined / sums.single, 1, 0.05)
                            << axis << ' ' << opacity << ' ' << direction.x << ' ' << direction.y
                            << ' ' << isFromEye;
                    }
                }
            }
        }
    }
}

// One plate that is seen at a slant is denser than voxel by voxel, where reading sheets between
// their pixels has it lose more: no farther from the truth.
TEST_F(Joined, keepsOnePlateAsNearToTheTruth) {
    for (int axis = 0; axis < 3; ++axis) {
        for (const double opacity : {0.9, 0.05}) {
            for (const glm::dvec3& direction : kDirections) {
                const PlateSums sums = sumsOfPlates(axis, true, opacity, direction, Colors::kOne);
                const double across = std::abs(glm::normalize(direction)[axis]);
                if (across < 0.2) continue;  // its rim is most of what is seen
                const double alpha = 1 - std::pow(1 - opacity, 1 / across);
                const double truth = alpha * across * std::pow(kPlate * platePixels(2), 2);
                EXPECT_LE(std::abs(sums.joined / truth - 1),
                          std::abs(sums.single / truth - 1) + 0.03)
                    << axis << ' ' << opacity << ' ' << direction.x << ' ' << direction.y;
                EXPECT_NEAR(sums.joined / sums.single, 1, 0.12);
            }
        }
    }
}

// A ball that is thin, which hardly changes where voxels beside each other become one.
Volume thinBall() {
    return test::makeVolume({{-19, 5, -41}, {60, 83, 38}}, [](int x, int y, int z) {
        const double radius = std::hypot(x - 20.3, y - 44.1, z + 2.2);
        return radius < 30 ? 100 + int(50 * std::sin(0.2 * radius)) : test::kInactive;
    });
}

RenderOptions ofSquares(Colors colors, int within, const glm::dvec3& direction) {
    RenderOptions options = optionsFor(colors, within == 2 ? 0.18 : 0.06, direction);
    options.camera.sizePixels = {24, 24};
    options.camera.frameWidthWorld = within == 2 ? 24 / 0.18 : 24 / 0.06;
    options.optics.transferFunction.opacities = {{0, 0, 0.5, 0}, {255, 0.04, 0.5, 0}};
    options.splat.mostJoined = kMostJoined;
    return options;
}

// Voxels beside each other that become one are drawn in their middle, wherever the volume begins.
TEST_F(Joined, squaresAreDrawnInTheirMiddle) {
    const Volume ball = thinBall();
    int drawn = 0;
    for (const int within : {2, 4}) {
        for (const Colors colors : {Colors::kOne, Colors::kSeveral}) {
            for (const glm::dvec3& direction : kDirections) {
                RenderOptions options = ofSquares(colors, within, direction);
                options.splat.filter = PictureFilter::kGauss;
                const RenderResult squares = render(ball, options);
                // Not where lines of sight pass on by fewer voxels than become one.
                if (squares.stats.resolution == 1) continue;
                EXPECT_EQ(squares.stats.resolution, 1.0 / within);
                ++drawn;
                const Middle now = middleOf(squares.image);
                const Middle expected = middleOf(unjoined(ball, options).image);
                EXPECT_NEAR(now.sum / expected.sum, 1, 0.01);
                EXPECT_LT(glm::length(now.place - expected.place), 0.02);
            }
        }
    }
    EXPECT_GE(drawn, 20);  // of 28
}

TEST_F(Joined, squaresAreTheSameHoweverTheyAreMade) {
    const Volume ball = thinBall();
    for (const int within : {2, 4}) {
        for (const Colors colors : {Colors::kOne, Colors::kSeveral}) {
            for (const glm::dvec3& direction : {glm::dvec3(1, 0.7, 0.5), glm::dvec3(0, 0, -1)}) {
                const RenderOptions options = ofSquares(colors, within, direction);
                EXPECT_EQ(render(ball, options).stats.resolution, 1.0 / within);
                test::expectTheSameHoweverItIsMade(ball, options);
            }
        }
    }
}

TEST_F(Joined, MethodsThreadsAndSimdLevelsGiveTheSamePixels) {
    const Volume volume = test::randomVolume(kBox, 8, 0.5, {1, 1.2, 0.8});
    int joined = 0;
    for (const Colors colors : {Colors::kOne, Colors::kSeveral}) {
        for (const double pixels : {0.3, 0.05}) {
            for (const glm::dvec3& direction : kDirections) {
                RenderOptions options = optionsFor(colors, pixels, direction);
                EXPECT_EQ(render(volume, options).stats.joined, 2);
                test::expectTheSameHoweverItIsMade(volume, options);
                options.splat.mostJoined = pixels < 0.1 ? kMostJoined : 8;
                joined += render(volume, options).stats.joined;
                test::expectTheSameHoweverItIsMade(volume, options);
            }
            for (const double fov : {20.0, 60.0}) {
                const RenderOptions options = fromEye(colors, 0.2 * pixels, kOblique, fov);
                EXPECT_EQ(render(volume, options).stats.joined, 2);
                test::expectTheSameHoweverItIsMade(volume, options);
            }
        }
    }
    EXPECT_GT(joined, 300);  // of 28, most are 8 or 32
}

// From both ends of an axis, which share words where they may, and with other optics, which do so
// as well.
TEST_F(Joined, preparedScenesShowTheSame) {
    const auto volume =
        std::make_shared<const Volume>(test::randomVolume(kBox, 9, 0.5, {1, 1.2, 0.8}));
    for (const Method method : {Method::kAuto, Method::kSparse, Method::kDelta}) {
        for (const Colors colors : {Colors::kOne, Colors::kSeveral}) {
            for (const double pixels : {0.3, 0.05}) {
                RenderOptions options = optionsFor(colors, pixels, kOblique);
                options.splat.method = method;
                options.splat.mostJoined = pixels < 0.1 ? kMostJoined : 2;
                Optics recolored = options.optics;
                recolored.transferFunction.colors[0].rgb = {0.3, 0.6, 0};
                Optics thinner = recolored;
                thinner.extinctionScale = 0.3;
                Optics other = thinner;
                other.transferFunction.opacities[1].opacity = 0.1;
                Optics fewer = other;
                fewer.transferFunction.opacities[0].x = 100;
                PreparedScene scene({volume, options.optics}, options.splat);
                for (const Optics& optics :
                     {options.optics, recolored, thinner, other, fewer, options.optics}) {
                    scene = scene.withOptics(optics);
                    for (const double sign : {1.0, -1.0}) {
                        RenderOptions one = options;
                        one.optics = optics;
                        one.camera.direction = sign * kOblique;
                        const RenderResult expected = render(*volume, one);
                        EXPECT_EQ(expected.stats.joined, options.splat.mostJoined);
                        Image image(expected.camera.sizePixels);
                        scene.render(expected.camera, image);
                        EXPECT_EQ(image.rgba, expected.image.rgba) << sign;
                    }
                }
            }
        }
    }
}

// An eye that moves, and turns, sees other regions, whose words are made anew.
TEST_F(Joined, preparedScenesShowTheSameFromWhereverTheyAreSeen) {
    const auto volume =
        std::make_shared<const Volume>(test::randomVolume(kBox, 9, 0.5, {1, 1.2, 0.8}));
    RenderOptions options = fromEye(Colors::kSeveral, 0.12, kOblique, 40);
    const PreparedScene scene({volume, options.optics}, options.splat);
    Optics thinner = options.optics;
    thinner.extinctionScale = 0.3;
    const PreparedScene other = scene.withOptics(thinner);
    for (int i = 0; i < 12; ++i) {
        const int turn = i / 2;
        options.camera.azimuthDegrees = 11 * turn;
        *options.camera.distanceWorld += i % 3;
        options.camera.frameOffset = {0.1 * (i % 2), 0};
        const RenderResult expected = render(*volume, options);
        EXPECT_EQ(expected.stats.joined, 2);
        Image image(expected.camera.sizePixels);
        scene.render(expected.camera, image);
        EXPECT_EQ(image.rgba, expected.image.rgba) << i;
        RenderOptions thin = options;
        thin.optics = thinner;
        other.render(expected.camera, image);
        EXPECT_EQ(image.rgba, render(*volume, thin).image.rgba) << i;
    }
}

// Regions of slopes that are near to other whole numbers join others: nothing is lost or doubled
// where they meet. A wall of fog is as even as voxel by voxel, and pixels around the picture change
// none within.
TEST_F(Joined, regionsMeetWithoutASeam) {
    const IndexBox box{{-120, -120, 0}, {120, 120, 40}};
    const Volume fog = test::makeVolume(box, [](int, int, int) { return 120; });
    RenderOptions options = optionsFor(Colors::kSeveral, 0.3, {0.3, 0.2, -1});
    options.optics.transferFunction.opacities = {{0, 0, 0.5, 0}, {255, 0.02, 0.5, 0}};
    options.camera.sizePixels = {60, 60};
    options.camera.frameWidthWorld = 60 / 0.3;
    options = fromEye(options, 60);
    const RenderResult joined = render(fog, options);
    EXPECT_EQ(joined.stats.joined, 2);
    const Image& expected = unjoined(fog, options).image;
    for (int y = 10; y < 50; ++y) {
        for (int x = 10; x < 50; ++x) {
            for (int channel = 0; channel < 4; ++channel) {
                EXPECT_NEAR(joined.image.pixel(x, y)[channel], expected.pixel(x, y)[channel], 2e-3)
                    << x << ' ' << y;
            }
        }
    }
    RenderOptions wider = options;
    wider.camera.overscanPixels = {9, 7};
    const Image around = render(fog, wider).image;
    for (int y = 0; y < 60; ++y) {
        for (int x = 0; x < 60; ++x) {
            for (int channel = 0; channel < 4; ++channel)
                EXPECT_NEAR(around.pixel(x + 9, y + 7)[channel], joined.image.pixel(x, y)[channel],
                            1e-5);
        }
    }
}

}  // namespace
}  // namespace deltasplat
