// SPDX-License-Identifier: Apache-2.0
// Volumes finer than the screen, of which voxels share sheet pixels, look as they do voxel by
// voxel, only softer.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "deltasplat/render.h"
#include "support/make_volume.h"

namespace deltasplat {
namespace {

// So faint that it matters little what is behind what.
constexpr double kOpacity = 0.02;

RenderOptions optionsFor(double pixelsPerVoxel, bool hasColors) {
    RenderOptions options;
    options.camera.sizePixels = {160, 160};
    options.camera.frameWidthWorld = 160 / pixelsPerVoxel;
    TransferFunction& function = options.optics.transferFunction;
    function.colors = {{0, {1, 0.2, 0.5}}};
    if (hasColors) function.colors.push_back({255, {0.2, 1, 0.1}});
    function.opacities = {{0, 0, 0.5, 0}, {255, kOpacity, 0.5, 0}};
    return options;
}

Image rendered(const Volume& volume, RenderOptions options, double resolution) {
    options.resolution = resolution;
    const RenderResult result = render(volume, options);
    EXPECT_EQ(result.stats.resolution, resolution);
    return result.image;
}

// A row of voxels in a slice, one thick, that rises by `slope` a column; in slices behind it, too.
Volume wireOf(double slope) {
    const IndexBox box{{-100, -100, -1}, {100, 100, 1}};
    return test::makeVolume(
        box, [&](int x, int y, int) { return y == int(std::lround(slope * x)) ? 255 : 0; });
}

// What columns of a picture add up to, of those that a wire crosses for sure.
std::vector<double> columnSums(const Image& image, double pixelsPerVoxel) {
    std::vector<double> sums;
    const int reach = int(90 * pixelsPerVoxel) - 2;
    for (int x = 80 - reach; x < 80 + reach; ++x) {
        double sum = 0;
        for (int y = 0; y < image.size.y; ++y) sum += double(image.pixel(x, y)[3]);
        sums.push_back(sum);
    }
    return sums;
}

double meanOf(const std::vector<double>& sums) {
    return std::accumulate(sums.begin(), sums.end(), 0.0) / double(sums.size());
}

// How far columns are from their mean, at most, as a share of it.
double unevenness(const std::vector<double>& sums) {
    double worst = 0;
    for (const double sum : sums) worst = std::max(worst, std::abs(sum / meanOf(sums) - 1));
    return worst;
}

// A wire neither fades nor flickers along its way, at whatever angle it crosses pixels: no more
// than if its voxels are drawn one by one.
TEST(Coarse, ThinWiresAreWholeAtEveryAngle) {
    for (const double pixels : {0.49, 0.3, 0.2, 0.1}) {
        for (const double slope : {0.0, 0.03, 0.11, 0.35, 0.5, 0.77, 1.0}) {
            SCOPED_TRACE(std::to_string(pixels) + " pixels, slope " + std::to_string(slope));
            const Volume volume = wireOf(slope);
            RenderOptions options = optionsFor(pixels, true);
            // One without lobes, which brighten thin things.
            options.filter = PictureFilter::kGauss;
            const std::vector<double> fine = columnSums(rendered(volume, options, 1), pixels);
            const std::vector<double> coarse =
                columnSums(rendered(volume, options, pixels < 0.15 ? 0.25 : 0.5), pixels);
            // Of three slices of a wire of one voxel a column.
            const double whole = (1 - std::pow(1 - kOpacity, 3)) * pixels;
            EXPECT_NEAR(meanOf(coarse) / whole, 1, 0.02);
            EXPECT_LT(unevenness(coarse), std::max(unevenness(fine), 0.05) + 0.04);
        }
    }
}

// Where a cloud lies and how much of it there is hardly changes, in any channel: what is averaged
// over a cell hides a little more than thick and thin side by side.
TEST(Coarse, SumsAndMiddlesStay) {
    const IndexBox box{{-60, -50, -40}, {70, 65, 60}};
    const Volume volume = test::makeVolume(box, [](int x, int y, int z) {
        const double squares = (x - 5) * (x - 5) + 1.5 * (y + 3) * (y + 3) + (z - 9) * (z - 9);
        return int(255 * std::exp(-squares / 300) * (x % 7 == 0 ? 1 : 0.9));
    });
    for (const bool hasColors : {false, true}) {
        for (const double resolution : {0.5, 0.25, 0.125}) {
            for (const glm::dvec3& direction : {glm::dvec3(0, 0, -1), {1, 0.3, -0.2}}) {
                for (const Projection projection : {Projection::kOrtho, Projection::kPerspective}) {
                    RenderOptions options = optionsFor(0.7, hasColors);
                    options.camera.direction = direction;
                    options.camera.projection = projection;
                    if (projection == Projection::kPerspective)
                        options.camera.frameWidthWorld.reset();
                    const Image fine = rendered(volume, options, 1);
                    const Image coarse = rendered(volume, options, resolution);
                    for (int c = 0; c < 4; ++c) {
                        glm::dvec3 moments[2] = {};
                        for (int y = 0; y < 160; ++y) {
                            for (int x = 0; x < 160; ++x) {
                                const glm::dvec3 at(1, x, y);
                                moments[0] += double(fine.pixel(x, y)[c]) * at;
                                moments[1] += double(coarse.pixel(x, y)[c]) * at;
                            }
                        }
                        EXPECT_NEAR(moments[1][0] / moments[0][0], 1, 0.05) << resolution;
                        for (int k = 1; k < 3; ++k) {
                            EXPECT_NEAR(moments[1][k] / moments[1][0],
                                        moments[0][k] / moments[0][0], 0.2)
                                << resolution;
                        }
                    }
                }
            }
        }
    }
}

// Walls seen edge-on: what is wrong of voxels that share pixels (docs/method.md), and why they do
// so only where that is asked for.
TEST(Coarse, IsNeverChosenForItHidesTooMuch) {
    const Volume walls = test::makeVolume({{0, 0, 0}, {127, 127, 127}},
                                          [](int x, int, int) { return x % 8 == 0 ? 255 : 0; });
    RenderOptions options = optionsFor(0.3, true);
    options.optics.transferFunction.opacities = {{0, 0, 0.5, 0}, {255, 1, 0.5, 0}};
    const auto sumOfAlpha = [&](const RenderResult& result) {
        double sum = 0;
        for (std::size_t i = 3; i < result.image.rgba.size(); i += 4)
            sum += double(result.image.rgba[i]);
        return sum;
    };
    const RenderResult chosen = render(walls, options);
    EXPECT_EQ(chosen.stats.resolution, 1);
    options.resolution = 0.5;
    EXPECT_GT(sumOfAlpha(render(walls, options)), 1.5 * sumOfAlpha(chosen));
}

// Cells lie where they lie in index space: what else is in the volume moves none.
TEST(Coarse, CellsDoNotDependOnTheBox) {
    const auto ball = [](int x, int y, int z) {
        return x * x + y * y + z * z < 200 ? 30 * (1 + ((x ^ y ^ z) & 7)) : 0;
    };
    RenderOptions options = optionsFor(0.3, true);
    options.camera.targetWorld = glm::dvec3(0);
    const Volume tight = test::makeVolume({{-15, -15, -15}, {15, 15, 15}}, ball);
    const Volume wide = test::makeVolume({{-77, -30, -18}, {19, 41, 90}}, ball);
    for (const double resolution : {0.5, 0.25, 0.125}) {
        const Image a = rendered(tight, options, resolution);
        const Image b = rendered(wide, options, resolution);
        double worst = 0;
        for (std::size_t i = 0; i < a.rgba.size(); ++i)
            worst = std::max(worst, std::abs(double(a.rgba[i]) - b.rgba[i]));
        EXPECT_LT(worst, 1e-4) << resolution;
    }
}

}  // namespace
}  // namespace deltasplat
