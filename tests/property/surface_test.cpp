// SPDX-License-Identifier: Apache-2.0
// Surfaces where values pass one value, against the closed form of a ball, and what must stay the
// same.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <random>
#include <string>

#include "deltasplat/cut/cut_volume.h"
#include "deltasplat/render.h"
#include "support/error_of.h"
#include "support/make_volume.h"
#include "support/mirrored.h"
#include "support/sight_line.h"

namespace deltasplat::test {
namespace {

constexpr double kSurface = 2000;

// A ball whose values fall across its surface by 500 a world unit.
Volume ball(double radius, const glm::dvec3& spacing = glm::dvec3(1), bool isSparse = false) {
    const glm::ivec3 half = glm::ivec3((radius + 5) / spacing) + 1;
    Volume volume = test::makeVolume(
        {-half, half},
        [&](int x, int y, int z) {
            const double depth = radius - glm::length(spacing * glm::dvec3(x, y, z));
            const int value = int(std::lround(kSurface + 500 * std::clamp(depth, -4.0, 4.0)));
            return isSparse && value == 0 ? test::kInactive : value;
        },
        spacing);
    test::changed(volume)->hasBackground = isSparse;
    return volume;
}

RenderOptions surfaceAt(double isovalue) {
    RenderOptions options;
    options.optics.surface = Surface{isovalue, glm::dvec3(0.8, 0.5, 0.3)};
    options.optics.shading.emplace();
    options.camera.sizePixels = {192, 192};
    return options;
}

// What a ball about the origin reflects along a line of sight: Lambert's law and Blinn's highlight
// of a light on the camera. Nothing where it is missed.
glm::dvec3 seenOfBall(const glm::dvec3& start, const glm::dvec3& ray, double radius,
                      const Optics& optics) {
    const double b = glm::dot(start, ray);
    const double beyond = b * b - glm::dot(start, start) + radius * radius;
    if (beyond <= 0) return glm::dvec3(0);
    const glm::dvec3 normal = (start - (b + std::sqrt(beyond)) * ray) / radius;
    const double cosine = glm::dot(normal, -ray);
    const Shading& shading = *optics.shading;
    return optics.surface->color * (shading.ambient + shading.diffuse * cosine) +
           shading.specular * std::pow(cosine, shading.shininess);
}

// In decibels, of all pixels, the outline among them: each is compared with the mean of a closed
// form at 8x8 places within it.
double agreement(const RenderResult& result, double radius, const Optics& optics) {
    const Camera& camera = result.camera;
    const glm::ivec2 size = camera.sizePixels;
    double squares = 0;
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            glm::dvec3 expected(0);
            for (int n = 0; n < 64; ++n) {
                const glm::dvec2 pixel(x + (n % 8 + 0.5) / 8, y + (n / 8 + 0.5) / 8);
                const auto [start, ray] = sightLineOf(camera, pixel, 500);
                expected += seenOfBall(start, ray, radius, optics) / 64.0;
            }
            const float* rgba = result.image.pixel(x, y);
            const glm::dvec3 difference = glm::dvec3(rgba[0], rgba[1], rgba[2]) - expected;
            squares += glm::dot(difference, difference) / 3;
        }
    }
    return -10 * std::log10(squares / (double(size.x) * size.y));
}

TEST(Surface, ofABallIsTheClosedForm) {
    constexpr double kRadius = 64;
    const Volume volume = ball(kRadius);
    for (const glm::dvec3& direction :
         {glm::dvec3(0, 0, -1), glm::dvec3(-1, -0.7, -0.4), glm::dvec3(1, 1, -1)}) {
        for (const int between : {0, 1}) {
            RenderOptions options = surfaceAt(kSurface);
            options.camera.direction = direction;
            options.splat.between = between;
            const double agrees = agreement(render(volume, options), kRadius, options.optics);
            EXPECT_GT(agrees, between == 0 ? 39 : 45) << direction.x << " between " << between;
        }
    }
    RenderOptions options = surfaceAt(kSurface);
    options.camera.projection = Projection::kPerspective;
    options.camera.direction = glm::dvec3(-1, -0.7, -0.4);
    options.camera.distanceWorld = 170;
    options.camera.fovDegrees = 50;
    EXPECT_GT(agreement(render(volume, options), kRadius, options.optics), 40);
}

// Voxels that are oblong, and thin as those of a coarse scan.
TEST(Surface, ofABallOfOblongVoxelsIsTheClosedForm) {
    constexpr double kRadius = 30;
    for (const glm::dvec3& spacing : {glm::dvec3(1, 0.6, 2), glm::dvec3(0.5, 0.5, 5)}) {
        const Volume volume = ball(kRadius, spacing);
        RenderOptions options = surfaceAt(kSurface);
        options.camera.direction = glm::dvec3(-1, -0.7, -0.4);
        options.splat.between = 1;
        EXPECT_GT(agreement(render(volume, options), kRadius, options.optics),
                  spacing.z > 4 ? 24 : 36)
            << spacing.z;
    }
}

// Below 0 is inside, and what is far from it is not active on either side.
TEST(Surface, ofALevelSetIsThatOfItsDistances) {
    constexpr double kRadius = 40;
    constexpr int kHalf = 46;
    constexpr int kSteps = 4000;  // a voxel
    const auto distance = [](int x, int y, int z) {
        return glm::length(glm::dvec3(x, y, z)) - kRadius;
    };
    Volume volume =
        test::makeVolume({glm::ivec3(-kHalf), glm::ivec3(kHalf)}, [&](int x, int y, int z) {
            const double d = distance(x, y, z);
            return std::abs(d) < 3 ? int(std::lround((d + 3) * kSteps)) : test::kInactive;
        });
    std::vector<double> values;
    for (int code = 0; code <= 6 * kSteps; ++code) values.push_back(double(code) / kSteps - 3);
    test::changed(volume)->codeBook = CodeBook::ofTable(std::move(values));
    test::changed(volume)->valueMin = -3;
    test::changed(volume)->valueMax = 3;
    test::changed(volume)->gridClass = "level set";
    test::changed(volume)->hasBackground = true;
    test::changed(volume)->background = 3;
    EXPECT_TRUE(isLevelSet(volume));
    RenderOptions options = surfaceAt(0);
    options.camera.direction = glm::dvec3(-1, -0.7, -0.4);
    options.splat.between = 1;
    EXPECT_GT(agreement(render(volume, options), kRadius, options.optics), 44);
    // Of another distance.
    options.optics.surface->isovalue = -1;
    EXPECT_GT(agreement(render(volume, options), kRadius - 1, options.optics), 44);
}

// What is inactive has the background's value.
TEST(Surface, ofSparseValuesIsThatOfDenseOnes) {
    RenderOptions options = surfaceAt(kSurface);
    options.camera.view = "iso";
    const glm::dvec3 spacing(1, 1.3, 0.8);
    for (const int between : {0, 1}) {
        options.splat.between = between;
        const Image dense = render(ball(20, spacing), options).image;
        const Image sparse = render(ball(20, spacing, true), options).image;
        EXPECT_EQ(dense.rgba, sparse.rgba);
    }
}

// What is cut off is not there, and leaves nothing of itself; what is left looks as it did.
TEST(Surface, isCutAsItsVoxelsAre) {
    for (const bool isSparse : {false, true}) {
        const Volume whole = ball(20, glm::dvec3(1), isSparse);
        for (const int between : {0, 1}) {
            RenderOptions options = surfaceAt(kSurface);
            options.camera.view = "right";
            options.camera.targetWorld = glm::dvec3(0);
            options.camera.frameWidthWorld = 60;
            options.splat.between = between;
            const Image image = render(whole, options).image;
            const auto cutAt = [&](double y) {
                Cut cut;
                cut.clipPlanes = {{{0, y, 0}, {0, -1, 0}}};
                return render(cutVolume(whole, cut), options).image;
            };
            EXPECT_EQ(cutAt(100).rgba, image.rgba);
            const Image half = cutAt(-3.5);
            // 3.2 pixels a world unit, y up: as far above the cut, and below, as footprints reach.
            for (int x = 0; x < 192; ++x) {
                for (int y = 0; y < 98; ++y) ASSERT_LT(half.pixel(x, y)[3], 1e-3);
                for (int y = 118; y < 192; ++y)
                    ASSERT_NEAR(half.pixel(x, y)[0], image.pixel(x, y)[0], 1e-5);
            }
        }
    }
}

// Where all that is not active would be inside, what is active is all that is shown.
TEST(Surface, endsWhereABackgroundInsideBegins) {
    Volume volume = ball(12, glm::dvec3(1), true);
    test::changed(volume)->background = 3000;
    RenderOptions options = surfaceAt(kSurface);
    options.splat.between = 0;
    EXPECT_LE(render(volume, options).stats.visible, volume.activeCount());
}

// What reaches the end of the volume is closed there.
TEST(Surface, isClosedWhereTheVolumeEnds) {
    const Volume volume =
        test::makeVolume({{3, 3, 3}, {34, 34, 34}}, [](int, int, int) { return 100; });
    RenderOptions options = surfaceAt(50);
    const RenderResult result = render(volume, options);
    const float* middle = result.image.pixel(96, 96);
    // Of values that do not change there is no normal: lit as by all directions.
    const Shading& shading = *options.optics.shading;
    EXPECT_NEAR(middle[0], 0.8 * (shading.ambient + shading.diffuse / 2), 1e-3);
    EXPECT_NEAR(middle[3], 1, 1e-4);
    EXPECT_EQ(result.stats.visible, 32u * 32 * 32 * std::uint64_t(result.stats.parts));
}

TEST(Surface, mirrorsWithTheScene) {
    Volume volume = test::randomVolume({{0, 0, 0}, {30, 25, 28}}, 4, 0.3, {1, 1.2, 0.8});
    for (const int between : {0, 1}) {
        RenderOptions options = surfaceAt(120);
        options.camera.sizePixels = {64, 64};
        options.camera.direction = glm::dvec3(-0.3, -0.4, -1);
        options.camera.targetWorld = glm::dvec3(15, 14, 11);
        options.splat.between = between;
        const Image image = render(volume, options).image;
        test::changed(volume)->worldFromIndex[0] = -volume.worldFromIndex()[0];
        options.camera.direction->x = -options.camera.direction->x;
        options.camera.targetWorld->x = -options.camera.targetWorld->x;
        const Image other = render(volume, options).image;
        test::changed(volume)->worldFromIndex[0] = -volume.worldFromIndex()[0];
        EXPECT_EQ(mirrored(other).rgba, image.rgba);
    }
}

// Transfer function, extinction and tolerance have no say.
TEST(Surface, isOpaqueAndExact) {
    const Volume volume = ball(12);
    RenderOptions options = surfaceAt(kSurface);
    const Image image = render(volume, options).image;
    options.splat.tolerance = {0.3, 0};
    options.optics.extinctionScale = 0.01;
    options.optics.unitDistance = 100;
    const RenderResult result = render(volume, options);
    EXPECT_EQ(result.image.rgba, image.rgba);
    EXPECT_EQ(result.stats.errorBoundColor, 0);
    EXPECT_NEAR(image.pixel(96, 96)[3], 1, 1e-6);
}

// However thin, what a voxel's own value says to be inside is seen, divided or not.
TEST(Surface, nothingInsideVanishes) {
    const Volume volume = makeVolume({glm::ivec3(0), glm::ivec3(14)}, [](int x, int y, int z) {
        const bool isPlate = y == 7;
        const bool isWire = y == 3 && z == 3;
        return isPlate || isWire || (x == 4 && y == 11 && z == 11) ? 255 : 0;
    });
    RenderOptions options = surfaceAt(200);
    options.camera.view = "front";
    options.camera.frameWidthWorld = 15;
    for (const int size : {15, 22, 30, 60}) {
        for (const std::optional<int> between : {std::optional<int>(), std::optional(3)}) {
            SCOPED_TRACE(std::to_string(size) + " " + std::to_string(between.value_or(-1)));
            options.camera.sizePixels = {size, size};
            options.splat.between = between;
            const Image image = render(volume, options).image;
            // From the front z goes up.
            const auto alphaAt = [&](double x, double z) {
                const int column = int((x + 0.5) * size / 15), row = int((14.5 - z) * size / 15);
                return image.pixel(column, row)[3];
            };
            EXPECT_GT(alphaAt(7, 7), 0.7);   // the plate lies across the line of sight,
            EXPECT_GT(alphaAt(7, 3), 0.7);   // behind the wire,
            EXPECT_GT(alphaAt(4, 11), 0.7);  // and before the voxel
        }
    }
    // The plate taken away, the wire and the voxel are what is left.
    const Volume thin = makeVolume({glm::ivec3(0), glm::ivec3(14)}, [](int x, int y, int z) {
        return (y == 3 && z == 3) || (x == 4 && y == 11 && z == 11) ? 255 : 0;
    });
    options.camera.sizePixels = {60, 60};
    options.splat.between.reset();
    const Image image = render(thin, options).image;
    EXPECT_GT(image.pixel(30, 46)[3], 0.6);
    EXPECT_GT(image.pixel(18, 14)[3], 0.5);
    EXPECT_EQ(image.pixel(30, 20)[3], 0);
}

// Without light it is of one colour.
TEST(Surface, withoutShadingIsFlat) {
    RenderOptions options = surfaceAt(kSurface);
    options.optics.shading.reset();
    const Image image = render(ball(12), options).image;
    for (const int x : {96, 60, 120}) EXPECT_NEAR(image.pixel(x, 96)[0], 0.8, 1e-4);
}

// Six decades, steep beyond all measure, of one value, and nowhere.
TEST(Surface, isFiniteWhateverTheValues) {
    for (const double large : {1e-6, 1.0, 1e30, 1e300}) {
        std::mt19937 random(3);
        Volume volume = test::makeVolume({{0, 0, 0}, {8, 8, 8}},
                                         [&](int, int, int) { return int(random() % 3); });
        test::changed(volume)->codeBook = CodeBook::ofTable({0, 1e-3 * large, large});
        test::changed(volume)->valueMin = 0;
        test::changed(volume)->valueMax = large;
        for (const double isovalue : {0.0, 1e-3 * large, 0.5 * large, large, 2 * large}) {
            RenderOptions options = surfaceAt(isovalue);
            options.camera.view = "iso";
            const RenderResult result = render(volume, options);
            double most = 0;
            for (const float value : result.image.rgba) {
                ASSERT_TRUE(std::isfinite(value));
                most = std::max(most, double(value));
            }
            if (isovalue > large) {
                EXPECT_EQ(most, 0);
            } else {
                EXPECT_GT(most, 0.1) << large << " at " << isovalue;
            }
        }
    }
}

TEST(Surface, refusesWhatIsNone) {
    const Volume volume = ball(5);
    const auto messageOf = [&](const auto& change) {
        RenderOptions options = surfaceAt(1);
        change(options.optics);
        return errorOf([&] { render(volume, options); });
    };
    EXPECT_EQ(messageOf([](Optics& optics) { optics.surface->isovalue = NAN; }),
              "usage: `surface.isovalue`: got nan; expected a finite number");
    EXPECT_EQ(messageOf([](Optics& optics) { optics.surface->color.y = -1; }),
              "usage: `surface.color`: got -1; expected a number within 0..1e6");
    EXPECT_EQ(messageOf([](Optics& optics) {
                  optics.gradientOpacity = {{0, 1}};
              }),
              "usage: `surface`: got `gradientOpacity` besides; expected one of the two");
    EXPECT_EQ(messageOf([](Optics& optics) {
                  optics.shading.reset();
                  optics.colorBy = ColorBy::kX;
              }),
              "usage: `surface`: got `colorBy` x besides; expected `colorBy` value");
}

}  // namespace
}  // namespace deltasplat::test
