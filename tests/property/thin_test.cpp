// SPDX-License-Identifier: Apache-2.0
// What is thin or dark is as right beside something opaque or bright as it is alone: closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "deltasplat/render.h"
#include "support/make_volume.h"

namespace deltasplat {
namespace {

// The share of itself by which alpha and colour may differ.
constexpr double kShare = 0.005;

// What a code of a volume looks like; those of codes between do not occur.
struct TestLook {
    double opacity;  // over a voxel
    glm::dvec3 color;
};

// Code i + 1 looks like looks[i].
RenderOptions optionsOf(const std::vector<TestLook>& looks, glm::ivec2 size) {
    RenderOptions options;
    options.camera.direction = glm::dvec3(0, 0, -1);
    options.camera.up = glm::dvec3(0, 1, 0);
    options.camera.sizePixels = size;
    options.camera.frameWidthWorld = size.x;
    options.optics.unitDistance = 1;
    TransferFunction& function = options.optics.transferFunction;
    function.linearColors = true;
    for (std::size_t i = 0; i < looks.size(); ++i) {
        const double code = double(i + 1);
        function.colors.push_back({code, looks[i].color});
        function.opacities.push_back({code, looks[i].opacity, 0.5, 0});
    }
    return options;
}

double opacityOf(double opacity, int slices) {
    return opacity >= 1 ? 1 : -std::expm1(slices * std::log1p(-opacity));
}

// Fog behind, in front of and around one voxel that looks otherwise, if it is there.
constexpr glm::ivec3 kFogSize(64, 64, 400);
constexpr glm::ivec3 kVoxel(20, 41, 203);

Volume fog(bool withVoxel) {
    return test::makeVolume({glm::ivec3(0), kFogSize - 1}, [&](int x, int y, int z) {
        return withVoxel && glm::ivec3(x, y, z) == kVoxel ? 2 : 1;
    });
}

// Looks at the middle of the fog, a pixel a voxel.
RenderOptions fogOptions(const TestLook& fogLook, const TestLook& voxel,
                         const glm::dvec3& direction) {
    RenderOptions options = optionsOf({fogLook, voxel}, glm::ivec2(kFogSize));
    options.camera.direction = direction;
    return options;
}

const glm::dvec3 kDirections[] = {{0, 0, -1}, {0.3, -0.2, -1}};

const TestLook kFogs[] = {{2e-5, {1, 1, 1}}, {1e-6, {0.9, 0.5, 0.2}}, {3e-3, {0.001, 0.02, 0.3}}};
const TestLook kVoxels[] = {{1, {1, 1, 1}}, {1, {1000, 1, 0.001}}, {0.3, {0.9, 0.5, 0.2}}};

TEST(Thin, FogBesideAnOpaqueVoxelIsAsIfItWereAlone) {
    const Volume volume = fog(true);
    for (const TestLook& look : kFogs) {
        const double alpha = opacityOf(look.opacity, kFogSize.z);
        for (const TestLook& voxel : kVoxels) {
            const Image image = render(volume, fogOptions(look, voxel, kDirections[0])).image;
            // Away from the border and from the voxel.
            for (int y = 2; y < 62; ++y) {
                for (int x = 30; x < 62; ++x) {
                    const float* pixel = image.pixel(x, y);
                    ASSERT_NEAR(pixel[3], alpha, kShare * alpha) << x << ' ' << y;
                    for (int c = 0; c < 3; ++c) {
                        const double color = look.color[c] * alpha;
                        ASSERT_NEAR(pixel[c], color, kShare * color) << x << ' ' << y;
                    }
                }
            }
        }
    }
}

TEST(Thin, FogDoesNotChangeWhereABrightVoxelIsNot) {
    const Volume alone = fog(false);
    const Volume both = fog(true);
    for (const glm::dvec3& direction : kDirections) {
        for (const TestLook& look : kFogs) {
            const RenderOptions options = fogOptions(look, kVoxels[1], direction);
            const RenderResult expected = render(alone, options);
            const Image image = render(both, options).image;
            const glm::dvec2 voxel = expected.camera.pixelFromWorld(glm::dvec3(kVoxel));
            int compared = 0;
            for (int y = 0; y < image.size.y; ++y) {
                for (int x = 0; x < image.size.x; ++x) {
                    if (glm::distance(glm::dvec2(x, y) + 0.5, voxel) < 6) continue;
                    ++compared;
                    for (int c = 0; c < 4; ++c) {
                        const double value = expected.image.pixel(x, y)[c];
                        ASSERT_NEAR(image.pixel(x, y)[c], value, kShare * std::abs(value) + 1e-12)
                            << x << ' ' << y << ' ' << c;
                    }
                }
            }
            EXPECT_GT(compared, 3000);
        }
    }
}

// Blocks of 12x12x40 voxels with 4 between them, side by side.
constexpr int kDepth = 40;
Volume blocks(int count) {
    return test::makeVolume({{0, 0, 0}, {16 * count - 5, 11, kDepth - 1}}, [](int x, int, int) {
        return x % 16 < 12 ? x / 16 + 1 : test::kInactive;
    });
}

// Compares the middles of all blocks.
void expectBlocks(const std::vector<TestLook>& looks) {
    const Volume volume = blocks(int(looks.size()));
    RenderOptions options = optionsOf(looks, {16 * int(looks.size()) - 4, 12});
    for (const int resolution : {1, 2, 3}) {
        options.splat.resolution = resolution;
        const Image image = render(volume, options).image;
        for (int i = 0; i < int(looks.size()); ++i) {
            const double alpha = opacityOf(looks[i].opacity, kDepth);
            const float* pixel = image.pixel(16 * i + 6, 6);
            EXPECT_NEAR(pixel[3], alpha, kShare * alpha) << "opacity " << looks[i].opacity;
            for (int c = 0; c < 3; ++c) {
                const double color = looks[i].color[c] * alpha;
                EXPECT_NEAR(pixel[c], color, kShare * color)
                    << "opacity " << looks[i].opacity << " color " << looks[i].color[c];
            }
        }
    }
}

TEST(Thin, OpacitiesFromAMillionthToOneAreRightSideBySide) {
    std::vector<TestLook> white;
    std::vector<TestLook> colored;
    for (double opacity = 1e-6; opacity < 0.7; opacity *= 1.93) {
        white.push_back({opacity, {1, 1, 1}});
        colored.push_back({opacity, {0.9, 0.5, 0.2 + opacity}});
    }
    white.push_back({1, {1, 1, 1}});
    colored.push_back({1, {0.3, 0.5, 0.2}});
    expectBlocks(white);
    expectBlocks(colored);
}

TEST(Thin, BrightAndDarkColorsAreRightSideBySide) {
    for (const double opacity : {1.0, 1e-3, 1e-6}) {
        std::vector<TestLook> looks;
        for (const double light : {1e-3, 0.04, 1.0, 31.0, 1e3}) {
            looks.push_back({opacity, {light, 1, 1 / light}});
            looks.push_back({1, {1, 1 / light, light}});
        }
        expectBlocks(looks);
    }
}

}  // namespace
}  // namespace deltasplat
