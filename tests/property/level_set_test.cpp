// SPDX-License-Identifier: Apache-2.0
// Level sets whose bands are thin or lopsided: what is inside is solid, and their surface is where
// it is whatever the band. And what surfaces look like beside their outlines.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "deltasplat/cut/cut_volume.h"
#include "deltasplat/openvdb_grid.h"
#include "deltasplat/render.h"
#include "volume/code_tree.h"

namespace deltasplat::test {
namespace {

const openvdb::Vec3d kMiddle(0.3, -0.1, 0.1);

// What a voxel that is inside and not active holds.
enum class Inside { kEndOfBand, kMinusBackground, kTiles };

// Distances to a ball, active from `inner` voxels inside to `outer` outside.
template <typename Grid>
typename Grid::Ptr ball(double radius, double inner, double outer, Inside inside,
                        double voxel = 1) {
    openvdb::initialize();
    using T = typename Grid::ValueType;
    const auto width = T(std::max(3.0, outer) * voxel);
    auto grid = Grid::create(width);
    grid->setName("ball");
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(voxel));
    const auto hidden = inside == Inside::kMinusBackground ? T(-width) : T(-inner * voxel);
    const int half = int(radius) + 6;
    for (int x = -half; x <= half; ++x) {
        for (int y = -half; y <= half; ++y) {
            for (int z = -half; z <= half; ++z) {
                const openvdb::Coord place(x, y, z);
                const double distance = (place.asVec3d() - kMiddle).length() - radius;
                if (distance > -inner && distance < outer) {
                    grid->tree().setValueOn(place, T(distance * voxel));
                } else if (distance <= -inner) {
                    grid->tree().setValueOff(place, hidden);
                }
            }
        }
    }
    if (inside == Inside::kTiles) grid->pruneGrid();
    return grid;
}

Volume read(const openvdb::GridBase::Ptr& grid, std::optional<LevelSetSurface> surface,
            std::vector<std::string>* warnings = nullptr) {
    ReadOptions options;
    options.levelSetToFog = false;
    options.levelSetSurface = surface;
    Listener listener;
    listener.warning = [&](const std::string& text) {
        if (warnings) warnings->push_back(text);
    };
    return makeVolume(grid, options, listener);
}

RenderOptions surfaceFrom(const glm::dvec3& direction, double voxel = 1) {
    RenderOptions options;
    options.optics.surface = Surface{0, glm::dvec3(0.8)};
    options.camera.direction = direction;
    options.camera.targetWorld = voxel * glm::dvec3(kMiddle.x(), kMiddle.y(), kMiddle.z());
    options.camera.frameWidthWorld = 32 * voxel;
    options.camera.sizePixels = {320, 320};
    return options;
}

// Distance of a pixel's middle from the picture's, in voxels.
double radiusOf(int x, int y) {
    return std::hypot(x + 0.5 - 160, y + 0.5 - 160) / 10;
}

// The least that is covered of what is nearer to the middle.
double leastWithin(const Image& image, double radius) {
    double least = 1;
    for (int y = 0; y < 320; ++y)
        for (int x = 0; x < 320; ++x)
            if (radiusOf(x, y) < radius) least = std::min<double>(least, image.pixel(x, y)[3]);
    return least;
}

// The radius of a disc that covers as much.
double coveredRadius(const Image& image) {
    double covered = 0;
    for (int y = 0; y < image.size.y; ++y)
        for (int x = 0; x < image.size.x; ++x) covered += image.pixel(x, y)[3];
    return std::sqrt(covered / 3.14159265358979) * 32 / image.size.x;
}

const std::vector<glm::dvec3> kDirections{{0, 0, -1}, {-1, -0.7, -0.4}};

TEST(LevelSetBand, ThinOrLopsidedIsSolidAndWhereItIs) {
    for (const glm::dvec3& direction : kDirections) {
        const RenderOptions options = surfaceFrom(direction);
        const auto even = ball<openvdb::FloatGrid>(10, 3, 3, Inside::kEndOfBand);
        const double radius = coveredRadius(render(read(even, LevelSetSurface{}), options).image);
        const auto expectIt = [&](const openvdb::GridBase::Ptr& grid, double near = 0.05) {
            const Image image = render(read(grid, LevelSetSurface{}), options).image;
            EXPECT_GT(leastWithin(image, 9), 0.999);
            EXPECT_NEAR(coveredRadius(image), radius, near);
        };
        for (const double inner : {0.2, 0.6, 1.0, 1.5}) {
            for (const double outer : {0.2, 0.5, 1.0, 3.0}) {
                for (const Inside inside :
                     {Inside::kEndOfBand, Inside::kMinusBackground, Inside::kTiles}) {
                    SCOPED_TRACE(std::to_string(inner) + " " + std::to_string(outer) + " " +
                                 std::to_string(int(inside)));
                    // Few voxels of a band of 0.4 have another beside them.
                    const bool isThinnest = inner + outer < 0.5;
                    expectIt(ball<openvdb::FloatGrid>(10, inner, outer, inside),
                             isThinnest ? 0.15 : 0.05);
                }
            }
        }
        SCOPED_TRACE("outward");
        expectIt(ball<openvdb::DoubleGrid>(10, 3, 0.2, Inside::kEndOfBand));
    }
}

// Units and size do not matter; what becomes active is said.
TEST(LevelSetBand, IsContinuedAsItsValuesGoOn) {
    for (const double voxel : {0.01, 1.0, 30.0}) {
        const auto thin = ball<openvdb::FloatGrid>(10, 0.6, 3, Inside::kMinusBackground, voxel);
        std::vector<std::string> warnings;
        const Volume volume = read(thin, LevelSetSurface{}, &warnings);
        ASSERT_EQ(warnings.size(), 1u);
        const std::uint64_t added = volume.activeCount() - thin->activeVoxelCount();
        EXPECT_EQ(warnings[0], "OpenVDB grid: the level set's band ends too near to the surface; " +
                                   std::to_string(added) +
                                   " voxels beside it go on as their values do");
        EXPECT_GT(added, 900u);
        EXPECT_LT(added, 1800u);
        double worst = 0;
        for (auto value = volume.codes()->tree().cbeginValueOn(); value; ++value) {
            const double distance = (value.getCoord().asVec3d() - kMiddle).length() - 10;
            const double got = volume.codeBook().valueOf(*value) / voxel;
            worst = std::max(worst, std::abs(got - distance));
            EXPECT_GT(distance * got, -1e-6);
            EXPECT_GT(distance, -2.3);
        }
        EXPECT_LT(worst, 0.35);
    }
}

// The grid that was given stays as it was, and a band that reaches far enough is what it was.
TEST(LevelSetBand, ThatIsWideIsLeftAlone) {
    for (const double half : {2.0, 3.0}) {
        const auto even = ball<openvdb::FloatGrid>(10, half, half, Inside::kMinusBackground);
        std::vector<std::string> warnings;
        const Volume volume = read(even, LevelSetSurface{}, &warnings);
        EXPECT_TRUE(warnings.empty());
        EXPECT_EQ(volume.histogram(), read(even, {}).histogram());
    }
    const auto thin = ball<openvdb::FloatGrid>(10, 0.6, 3, Inside::kMinusBackground);
    const std::uint64_t count = thin->activeVoxelCount();
    EXPECT_GT(read(thin, LevelSetSurface{}).activeCount(), count);
    EXPECT_EQ(thin->activeVoxelCount(), count);
    EXPECT_EQ(read(thin, {}).activeCount(), count);
}

// A volume's own end is no surface.
TEST(LevelSetBand, EndsWhereAVolumeDoes) {
    openvdb::initialize();
    auto grid = openvdb::FloatGrid::create(3);
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    for (int x = 0; x < 16; ++x)
        for (int y = 0; y < 16; ++y)
            for (int z = 0; z < 16; ++z)
                if (std::abs(y - 7.5F) < 3)
                    grid->tree().setValueOn(openvdb::Coord(x, y, z), float(y) - 7.5F);
    EXPECT_EQ(read(grid, LevelSetSurface{}).histogram(), read(grid, {}).histogram());
}

// What is going to be cut is solid to its middle.
TEST(LevelSetBand, IsFilledWhereItIsCut) {
    for (const Inside inside : {Inside::kEndOfBand, Inside::kTiles}) {
        const auto thin = ball<openvdb::FloatGrid>(12, 0.6, 3, inside);
        const Volume volume = read(thin, LevelSetSurface{0, true});
        std::uint64_t within = 0;
        for (auto value = volume.codes()->tree().cbeginValueOn(); value; ++value)
            within += volume.codeBook().valueOf(*value) < 0 ? value.getVoxelCount() : 0;
        EXPECT_NEAR(double(within), 4.0 / 3 * 3.14159265 * 12 * 12 * 12, 100);
        Cut cut;
        cut.clipPlanes = {{{0, 0.5, 0}, {0, -1, 0}}};
        RenderOptions options = surfaceFrom({0, -1, 0});
        options.camera.up = glm::dvec3(0, 0, -1);
        const Image image = render(cutVolume(volume, cut), options).image;
        EXPECT_GT(leastWithin(image, 11), 0.999);
    }
}

// Outlines are neither larger nor smaller than what they are of, whatever the size of a ball.
TEST(SurfaceOutline, IsThatOfTheBall) {
    for (const double radius : {4.0, 10.0, 13.0}) {
        const auto grid = ball<openvdb::FloatGrid>(radius, 3, 3, Inside::kMinusBackground);
        const Volume volume = read(grid, LevelSetSurface{});
        for (const glm::dvec3& direction : kDirections) {
            for (const int pixels : {96, 320, 480}) {
                for (const int between : {0, 1, 3}) {
                    RenderOptions options = surfaceFrom(direction);
                    options.camera.sizePixels = {pixels, pixels};
                    options.splat.between = between;
                    const double got = coveredRadius(render(volume, options).image);
                    EXPECT_NEAR(got, radius, radius > 5 || between > 0 ? 0.07 : 0.12)
                        << direction.x << " " << pixels << " between " << between;
                }
            }
        }
    }
}

// Where no light comes to, ambient light is all there is, up to the outline and beyond.
TEST(SurfaceOutline, IsNotLitFromBehind) {
    const auto grid = ball<openvdb::FloatGrid>(10, 3, 3, Inside::kMinusBackground);
    const Volume volume = read(grid, LevelSetSurface{});
    for (const glm::dvec3& travels : {glm::dvec3(1, 0, 0), glm::dvec3(0.5, 0, 1)}) {
        for (const glm::dvec3& direction : kDirections) {
            for (const int between : {0, 1}) {
                RenderOptions options = surfaceFrom(direction);
                options.splat.between = between;
                Shading& shading = options.optics.shading.emplace();
                shading.lights = {Light{LightFrame::kView, travels}};
                const Image image = render(volume, options).image;
                for (int y = 0; y < 320; ++y) {
                    for (int x = 0; x < 320; ++x) {
                        const float* rgba = image.pixel(x, y);
                        // Of a ball's half that is away from the light.
                        if (x < 200 || std::abs(y - 160) > x - 160 || rgba[3] < 0.05F) continue;
                        const double across = (x + 0.5 - 160) / 100;
                        const double towards = std::sqrt(std::max(0.0, 1 - across * across));
                        const double facing = -(across * travels.x + towards * travels.z);
                        if (facing > -0.25) continue;
                        ASSERT_NEAR(rgba[0] / rgba[3], 0.8 * shading.ambient, 0.01)
                            << x << " " << y << " between " << between;
                    }
                }
            }
        }
    }
}

}  // namespace
}  // namespace deltasplat::test
