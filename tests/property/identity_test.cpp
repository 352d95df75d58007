// SPDX-License-Identifier: Apache-2.0
// The promise: the same pixels, bit for bit, for every method, number of threads and SIMD level,
// and wherever in index space a volume lies.
#include <gtest/gtest.h>

#include <cmath>

#include "deltasplat/error.h"
#include "deltasplat/render.h"
#include "deltasplat/simd.h"
#include "deltasplat/threads.h"
#include "support/make_volume.h"
#include "support/simd_levels.h"

namespace deltasplat {
namespace {

constexpr Method kMethods[] = {Method::kAuto, Method::kDelta, Method::kSparse,
                               Method::kTraditional};

RenderOptions optionsFor(const glm::dvec3& direction) {
    RenderOptions options;
    options.camera.direction = direction;
    options.camera.up = glm::dvec3(0.1, 1, 0.2);
    options.camera.sizePixels = {150, 110};
    TransferFunction& function = options.optics.transferFunction;
    function.colors = {{0, {1, 0, 0.5}}, {255, {0.2, 1, 0}}};
    function.opacities = {{60, 0, 0.5, 0}, {200, 0.4, 0.5, 0}, {255, 1, 0.5, 0}};
    return options;
}

const glm::dvec3 kDirections[] = {{0, 0, -1}, {1, 0.3, -0.2}, {-0.4, 1, 0.9}, {0.7, -0.2, 0.8}};

double mean(const Image& image) {
    double sum = 0;
    for (const float value : image.rgba) sum += value;
    return sum / double(image.rgba.size());
}

// Renders by all methods, numbers of threads and SIMD levels; under a sanitizer, which looks at the
// memory that is touched and not at pixels, by each of them once.
void expectSamePixels(const Volume& volume, RenderOptions options) {
    const Image expected = render(volume, options).image;
    EXPECT_GT(mean(expected), 0.02);
    for (const Method method : kMethods) {
        options.splat.method = method;
        for (const int threads : {1, 2, 3, 8}) {
            if (test::kIsSanitized && threads != 3) continue;
            const ThreadLimit limit(threads);
            ASSERT_EQ(threadCount(), threads);
            EXPECT_EQ(render(volume, options).image.rgba, expected.rgba)
                << methodName(method) << ", " << threads << " threads";
        }
        for (const std::string& level : test::testedSimdLevels()) {
            if (test::kIsSanitized && method != Method::kDelta) continue;
            setSimdLevel(level);
            EXPECT_EQ(render(volume, options).image.rgba, expected.rgba)
                << methodName(method) << ", " << level;
        }
        setSimdLevel("auto");
    }
}

const IndexBox kBoxes[] = {{{0, 0, 0}, {40, 21, 33}}, {{-19, 5, -60}, {0, 70, 2}}};

// At one pixel a voxel: 5x5 and 7x7, which are summed up as cells, and more, which is stamped.
constexpr double kWideSigmas[] = {0.6, 0.9, 1.4};

// At resolution 1 a footprint of one pixel is written, of 3x3 summed up, as at 2; below 1 voxels
// share pixels, 3 and 4 sum up cells, and 5 stamps footprints.
TEST(Identity, MethodsThreadsAndSimdLevelsGiveTheSamePixels) {
    for (const IndexBox& box : kBoxes) {
        const Volume volume = test::randomVolume(box, 17, 0.5, {1, 1.5, 0.8});
        for (const glm::dvec3& direction : kDirections) {
            RenderOptions options = optionsFor(direction);
            for (const double resolution : {1.0, 2.0, 3.0, 4.0, 5.0}) {
                // Large sheets, of which one view has to do.
                if (resolution > 3 && direction != kDirections[0]) continue;
                options.splat.resolution = resolution;
                expectSamePixels(volume, options);
            }
            options.splat.resolution = 2;
            options.splat.sigma = 0.6;
            expectSamePixels(volume, options);
            options.splat.resolution = 1;
            for (const int width : {1, 3}) {
                options.splat.footprintWidth = width;
                expectSamePixels(volume, options);
            }
            options.splat.footprintWidth = {};
            for (const double sigma : kWideSigmas) {
                options.splat.sigma = sigma;
                expectSamePixels(volume, options);
            }
            options.splat.footprintWidth = 6;
            expectSamePixels(volume, options);
        }
    }
}

TEST(Identity, AlsoOfOneColorAndUnderATolerance) {
    for (const IndexBox& box : kBoxes) {
        const Volume volume = test::randomVolume(box, 18, 0.5, {1, 1.5, 0.8});
        for (const glm::dvec3& direction : kDirections) {
            for (const double resolution : {1.0, 2.0, 3.0}) {
                RenderOptions options = optionsFor(direction);
                options.splat.resolution = resolution;
                options.splat.tolerance = {0.05, 0};
                expectSamePixels(volume, options);
                options.splat.tolerance = {0.1, 12};
                expectSamePixels(volume, options);
                options.optics.transferFunction.colors = {{0, {0.5, 0.7, 0.2}}};
                expectSamePixels(volume, options);
                options.splat.tolerance = {};
                expectSamePixels(volume, options);
            }
        }
    }
}

// Opacities and colours over many powers of ten, so that colours take both digits, and both planes
// if they are bright as well.
void makeWide(TransferFunction& function, bool bright) {
    function.linearColors = true;
    function.colors = {{0, {1, 0, 0.001}}, {255, {0.2, bright ? 1e6 : 1, 0}}};
    function.opacities = {{60, 0, 0.5, 0},      {61, 1e-6, 0.5, 0}, {100, 1e-5, 0.5, 0},
                          {101, 0.002, 0.5, 0}, {200, 0.4, 0.5, 0}, {255, 1, 0.5, 0}};
}

TEST(Identity, AlsoOfColorsThatTakeSeveralDigits) {
    for (const IndexBox& box : kBoxes) {
        const Volume volume = test::randomVolume(box, 20, 0.5, {1, 1.5, 0.8});
        for (const glm::dvec3& direction : {kDirections[0], kDirections[1]}) {
            RenderOptions options = optionsFor(direction);
            TransferFunction& function = options.optics.transferFunction;
            for (const bool bright : {false, true}) {
                makeWide(function, bright);
                for (const double resolution : {1.0, 2.0, 3.0}) {
                    options.splat.resolution = resolution;
                    options.splat.tolerance = {resolution == 2 ? 0.1 : 0.0, 0};
                    expectSamePixels(volume, options);
                }
                options.splat.resolution = 1;
                for (const double sigma : kWideSigmas) {
                    options.splat.sigma = sigma;
                    expectSamePixels(volume, options);
                }
                options.splat.sigma.reset();
            }
            makeWide(function, false);
            function.colors = {{0, {0.5, 0.7, 0.2}}};
            expectSamePixels(volume, options);
        }
    }
}

// On one plane and on two, by all ways of splatting, divided and not.
TEST(Identity, AlsoOfLooksThatVoxelsHaveOfTheirOwn) {
    for (const std::optional<ColorBy> look :
         {std::optional(ColorBy::kIndex), std::optional(ColorBy::kZ), std::optional<ColorBy>()}) {
        const Volume volume = test::randomVolume(kBoxes[0], 21, 0.5, {1, 1.5, 0.8});
        for (const glm::dvec3& direction : {kDirections[0], kDirections[1]}) {
            RenderOptions options = optionsFor(direction);
            if (look) {
                options.optics.colorBy = *look;
            } else {
                options.optics.shading.emplace();
            }
            for (const bool wide : {false, true}) {
                if (wide) makeWide(options.optics.transferFunction, false);
                for (const double resolution : {1.0, 2.0, 3.0, 5.0}) {
                    if (resolution > 3 && direction != kDirections[0]) continue;
                    // What is lit is splatted as what has colours.
                    if (resolution > 1 && !look) continue;
                    options.splat.resolution = resolution;
                    options.splat.tolerance = {resolution == 2 ? 0.1 : 0.0,
                                               resolution == 3 ? 20.0 : 0.0};
                    expectSamePixels(volume, options);
                }
            }
            options.splat.resolution.reset();
            options.splat.between = 1;
            options.splat.tolerance = {};
            expectSamePixels(volume, options);
            options.splat.tolerance = {0.1, 0};
            expectSamePixels(volume, options);
        }
    }
}

// Of surfaces, whose voxels are seen in part; and where gradients say how opaque they are.
TEST(Identity, AlsoOfWhatIsSeenInPart) {
    const Volume volume = test::randomVolume(kBoxes[0], 21, 0.5, {1, 1.5, 0.8});
    for (const bool isSurface : {false, true}) {
        for (const glm::dvec3& direction : {kDirections[0], kDirections[1]}) {
            RenderOptions options = optionsFor(direction);
            if (isSurface) {
                options.optics.surface = Surface{120.5, {0.7, 0.6, 0.5}};
                options.optics.shading.emplace();
            } else {
                options.optics.gradientOpacity = {{20, 0.1}, {60, 0.8}};
            }
            for (const int between : {0, 1, 3}) {
                options.splat.between = between;
                expectSamePixels(volume, options);
            }
        }
    }
}

// From an eye what is lit changes from slice to slice, though values do not.
TEST(Identity, AlsoOfWhatIsLitFromAnEye) {
    const Volume volume = test::makeVolume({{0, 0, 0}, {24, 22, 26}}, [](int x, int y, int z) {
        return std::max({std::abs(x - 12), std::abs(y - 11), std::abs(z - 13)}) < 9 ? 200 : 20;
    });
    for (const Projection projection : {Projection::kPerspective, Projection::kLatlong}) {
        for (const bool isSurface : {false, true}) {
            RenderOptions options = optionsFor(kDirections[0]);
            options.camera.projection = projection;
            if (projection == Projection::kLatlong) {
                options.camera.sizePixels = {64, 32};
                options.camera.eyeWorld = glm::dvec3(2, 3, 1);
            } else {
                options.camera.fovDegrees = 70;
            }
            options.camera.frameWidthWorld.reset();
            options.optics.shading.emplace();
            if (isSurface) options.optics.surface = Surface{120, {0.7, 0.6, 0.5}};
            for (const int between : {0, 1}) {
                options.splat.between = between;
                expectSamePixels(volume, options);
            }
        }
    }
}

// Of solid shapes little changes: slabs are joined, and small footprints are stamped too. They
// begin and end between blocks, at negative indices; one hides the other, and a few voxels come and
// go.
Volume solidShapes() {
    const IndexBox box{{-21, 3, -30}, {50, 40, 33}};
    const auto isInside = [](glm::dvec3 p, glm::dvec3 centre, glm::dvec3 radii) {
        const glm::dvec3 d = (p - centre) / radii;
        return glm::dot(d, d) < 1;
    };
    return test::makeVolume(box,
                            [&](int x, int y, int z) {
                                const glm::dvec3 p(x, y, z);
                                if (isInside(p, {20, 20, 5}, {12, 9, 14})) return 240;
                                if (isInside(p, {8, 21, 0}, {26, 16, 27})) return 130;
                                return (x * 7 + y * 13 + z * 29) % 997 == 0 ? 200 : test::kInactive;
                            },
                            {1, 1.2, 0.9});
}

TEST(Identity, AlsoWhereLittleChanges) {
    const Volume volume = solidShapes();
    for (const glm::dvec3& direction : kDirections) {
        RenderOptions options = optionsFor(direction);
        options.splat.method = Method::kDelta;
        options.splat.between = 0;
        const RenderStats stats = render(volume, options).stats;
        EXPECT_LE(stats.slabs, 3);
        EXPECT_LT(6 * stats.deltas, stats.visible);
        for (const double resolution : {1.0, 2.0, 3.0}) {
            options.splat.resolution = resolution;
            expectSamePixels(volume, options);
        }
        options.splat.resolution = 1;
        const auto expectAlsoOfWideFootprints = [&] {
            options.splat.sigma.reset();
            expectSamePixels(volume, options);
            options.splat.sigma = kWideSigmas[1];
            expectSamePixels(volume, options);
        };
        expectAlsoOfWideFootprints();
        options.optics.transferFunction.colors = {{0, {0.5, 0.7, 0.2}}};
        expectAlsoOfWideFootprints();
        makeWide(options.optics.transferFunction, true);
        expectAlsoOfWideFootprints();
    }
}

// Rows are long, so that words are passed over many at a time; the cover has holes and an edge.
TEST(Identity, AlsoWhereMuchIsCovered) {
    const Volume volume = test::makeVolume({{-30, 2, -3}, {370, 41, 28}}, [](int x, int y, int z) {
        const bool isHole = x % 97 < 5 && y % 19 < 6;
        const bool isEdge = x > 340 && z < 20;
        if (isHole || isEdge) return z % 5 == 0 ? 90 + x % 7 : test::kInactive;
        return z < 2 || z > 24 ? 255 : 100 + (x * 7 + y * 13 + z * 29) % 90;
    });
    for (const glm::dvec3& direction : {glm::dvec3(0.1, 0, -1), glm::dvec3(-0.1, 0.2, 1)}) {
        RenderOptions options = optionsFor(direction);
        options.optics.extinctionScale = 4;
        options.splat.between = 0;
        for (const double resolution : {1.0, 2.0}) {
            options.splat.resolution = resolution;
            expectSamePixels(volume, options);
        }
        options.optics.shading.emplace();
        expectSamePixels(volume, options);
    }
}

// Sheet and layer are cut into so many strips that two threads get strips of even rows, three
// strips of the same work.
TEST(Identity, AlsoOfManyStrips) {
    const Volume volume = test::makeVolume({{0, 0, 0}, {999, 899, 9}}, [](int x, int y, int z) {
        const bool isDense = y > 200 && y < 700 && x > 200;
        return isDense || (x / 30 + y / 50) % 9 == 0 ? 60 + (x + 3 * y + 7 * z) % 190
                                                     : test::kInactive;
    });
    RenderOptions options = optionsFor({0.3, 0.4, -1});
    options.splat.between = 0;
    const Image expected = render(volume, options).image;
    EXPECT_GT(mean(expected), 0.02);
    for (const Method method : kMethods) {
        options.splat.method = method;
        for (const int threads : {1, 2, 3}) {
            const ThreadLimit limit(threads);
            EXPECT_EQ(render(volume, options).image.rgba, expected.rgba)
                << methodName(method) << ", " << threads << " threads";
        }
    }
}

// Opacity times a colour is what the four channels give, but for rounding.
TEST(Identity, OneColorIsTheSameAsFourChannels) {
    const Volume volume = test::randomVolume(kBoxes[0], 19, 0.5);
    RenderOptions options = optionsFor(kDirections[1]);
    TransferFunction& function = options.optics.transferFunction;
    function.linearColors = true;
    function.colors = {{0, {0.5, 0.7, 0.2}}};
    const Image one = render(volume, options).image;
    // A colour that is hardly another one.
    function.colors = {{0, {0.5, 0.7, 0.2}}, {255, {0.5 + 1e-9, 0.7, 0.2}}};
    const Image four = render(volume, options).image;
    for (std::size_t i = 0; i < one.rgba.size(); ++i) {
        ASSERT_NEAR(one.rgba[i], four.rgba[i], 3e-4);
    }
}

TEST(Identity, MethodsStampWhatTheySay) {
    const Volume volume = test::randomVolume({{0, 0, 0}, {30, 30, 30}}, 5, 0.5);
    RenderOptions options = optionsFor(kDirections[1]);
    const auto statsOf = [&](Method method) {
        options.splat.method = method;
        return render(volume, options).stats;
    };
    const RenderStats delta = statsOf(Method::kDelta);
    EXPECT_EQ(statsOf(Method::kTraditional).stamps, delta.voxels);
    EXPECT_EQ(statsOf(Method::kSparse).stamps, delta.visible);
    EXPECT_EQ(delta.stamps, delta.deltas);
    // All blocks change in each slice: whole slices have no more of them, and fewer stamps.
    EXPECT_LT(delta.visible, delta.deltas);
    EXPECT_EQ(statsOf(Method::kAuto).stamps, delta.visible);
}

// Positions in a picture are rounded once in doubles, and the warp reads its filter from a table:
// no more may differ.
TEST(Identity, VolumesFarFromTheIndexOriginLookTheSame) {
    const auto block = [](int offset) {
        const IndexBox box{glm::ivec3(offset), glm::ivec3(offset + 11)};
        return test::makeVolume(box, [&](int x, int y, int z) {
            return ((x - offset) * 31 + (y - offset) * 17 + (z - offset) * 7) % 256;
        });
    };
    for (const glm::dvec3& direction : kDirections) {
        const RenderOptions options = optionsFor(direction);
        const Image here = render(block(0), options).image;
        EXPECT_GT(mean(here), 0.05);
        for (const int offset : {1 << 20, 1 << 29, -(1 << 29)}) {
            const Image there = render(block(offset), options).image;
            for (std::size_t i = 0; i < here.rgba.size(); ++i) {
                ASSERT_NEAR(there.rgba[i], here.rgba[i], 2e-3) << offset << ' ' << i;
            }
        }
    }
}

// Cost goes by voxels: a face of 2^60 of them that has one, seen squarely, is as cheap as that one.
TEST(Identity, SheetsGoByWhatIsThere) {
    Volume volume = test::makeVolume({{0, 0, 0}, {0, 0, 0}}, [](int, int, int) { return 200; });
    test::changed(volume)->box = {{-(1 << 29), -(1 << 29), 0}, {1 << 29, 1 << 29, 0}};
    for (const int resolution : {1, 8, 16}) {
        RenderOptions options = optionsFor(kDirections[0]);
        options.splat.resolution = resolution;
        EXPECT_NO_THROW(render(volume, options)) << resolution;
    }
}

TEST(Identity, AlsoWithSlicesBetween) {
    for (const int between : {0, 2, 3}) {
        SCOPED_TRACE(between);
        const Volume volume = test::randomVolume(kBoxes[1], 21, 0.5);
        RenderOptions options = optionsFor(kDirections[3]);
        options.splat.between = between;
        expectSamePixels(volume, options);
        options.splat.tolerance.relative = 0.1;
        expectSamePixels(volume, options);
    }
}

TEST(Identity, AlsoWithVoxelsDivided) {
    const Volume volume = test::randomVolume(kBoxes[0], 22, 0.5);
    for (const glm::dvec3& direction : kDirections) {
        RenderOptions options = optionsFor(direction);
        for (const int resolution : {2, 4}) {
            options.splat.between = 1;
            options.splat.resolution = resolution;
            expectSamePixels(volume, options);
        }
        makeWide(options.optics.transferFunction, false);
        expectSamePixels(volume, options);
    }
}

}  // namespace
}  // namespace deltasplat
