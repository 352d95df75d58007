// SPDX-License-Identifier: Apache-2.0
// Slices put between those of a volume: against the same slices made by hand, against closed forms
// and against a ray caster of a few lines.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "deltasplat/error.h"
#include "deltasplat/render.h"
#include "optics/label_function.h"
#include "property/test_scene.h"
#include "support/make_volume.h"

namespace deltasplat::test {
namespace {

TestVolume noise(const glm::ivec3& dims) {
    std::mt19937 random(3);
    TestVolume volume({0, 0, 0}, dims);
    for (float& value : volume.values) value = float(random() % 256);
    return volume;
}

// The same with voxels divided along x, y and z, values mixed by hand; the ends keep theirs.
TestVolume withThinVoxels(const TestVolume& volume, const glm::ivec3& parts) {
    TestVolume thin({0, 0, 0}, volume.dims * parts);
    const glm::dvec3 spacing = 1.0 / glm::dvec3(parts);
    thin.worldFromIndex = spaced(spacing, 0.5 * spacing - 0.5);
    TestVolume source = volume;
    for (int z = 0; z < thin.dims.z; ++z) {
        for (int y = 0; y < thin.dims.y; ++y) {
            for (int x = 0; x < thin.dims.x; ++x) {
                const glm::dvec3 place = (glm::dvec3(x, y, z) + 0.5) * spacing - 0.5;
                const glm::dvec3 low = glm::floor(place);
                double sum = 0;
                for (int corner = 0; corner < 8; ++corner) {
                    const glm::ivec3 side(corner & 1, corner >> 1 & 1, corner >> 2);
                    const glm::dvec3 share = 1.0 - glm::abs(place - low - glm::dvec3(side));
                    sum += share.x * share.y * share.z *
                           source.at(
                               glm::clamp(glm::ivec3(low) + side, glm::ivec3(0), volume.dims - 1));
                }
                thin.at({x, y, z}) = float(sum);
            }
        }
    }
    return thin;
}

TEST(Between, isTheVolumeWithValuesMixedByHand) {
    const TestVolume plain = noise({19, 14, 21});
    const Volume volume = throughRaw(plain, glm::dvec3(1));
    for (const int between : {1, 2, 3}) {
        for (const int within : {1, 2}) {
            const Volume thin = throughVdb(withThinVoxels(plain, {within, within, between + 1}));
            for (const double up : {1, -1}) {
                RenderOptions options;
                // Straight along z, so that footprints are the same.
                options.camera.direction = glm::dvec3(0, 0, -1);
                options.camera.up = glm::dvec3(0.3, up, 0);
                options.camera.targetWorld = glm::dvec3(9, 6.5, 10);
                options.camera.frameWidthWorld = 24;
                options.camera.sizePixels = {60, 60};
                options.optics.transferFunction = testTransferFunction(0.7);
                options.optics.unitDistance = 1;
                options.splat.between = between;
                options.splat.resolution = within;
                const RenderResult mixed = render(volume, options);
                options.splat.between = 0;
                options.splat.resolution = 1;
                const RenderResult expected = render(thin, options);
                EXPECT_EQ(mixed.stats.slices, 21 * (between + 1));
                EXPECT_EQ(mixed.stats.resolution, within);
                EXPECT_EQ(mixed.stats.visible, expected.stats.visible);
                double largest = 0;
                double sum = 0;
                for (std::size_t i = 0; i < expected.image.rgba.size(); ++i) {
                    largest = std::max<double>(
                        largest, std::abs(mixed.image.rgba[i] - expected.image.rgba[i]));
                    sum += expected.image.rgba[i];
                }
                EXPECT_GT(sum, 1000);
                // Mixed by thirds, values fall on the nearest of the levels there are.
                EXPECT_LT(largest, between == 2 ? 4e-3 : 1e-3) << between;
            }
        }
    }
}

// One sheet pixel a voxel leaves no room for values within slices, two do; what the screen asks for
// is chosen where nothing is said.
TEST(Between, isOneWhereTheScreenAsksForTwoPixelsAVoxel) {
    const Volume volume = throughRaw(noise({24, 24, 24}), glm::dvec3(1));
    RenderOptions options;
    options.optics.transferFunction = testTransferFunction(0.7);
    options.camera.frameWidthWorld = 40;
    const auto statsAt = [&](double pixelsPerVoxel) {
        options.camera.sizePixels = glm::ivec2(int(40 * pixelsPerVoxel));
        return render(volume, options).stats;
    };
    EXPECT_EQ(statsAt(1.4).between, 0);
    EXPECT_EQ(statsAt(1.4).resolution, 1);
    EXPECT_EQ(statsAt(1.6).between, 1);
    EXPECT_EQ(statsAt(1.6).resolution, 2);
    EXPECT_EQ(statsAt(1.6).voxels, 8u * 24 * 24 * 24);
    options.splat.resolution = 2;
    EXPECT_EQ(statsAt(1.6).between, 0);
    options.splat.resolution = {};
    options.splat.between = 1;
    EXPECT_EQ(statsAt(1).resolution, 2);
    options.splat.between = 0;
    EXPECT_EQ(statsAt(1.6).voxels, 24u * 24 * 24);
    // What is thin stays as it is,
    options.splat.between = {};
    options.optics.transferFunction = testTransferFunction(0.2);
    EXPECT_EQ(statsAt(1.6).between, 0);
    EXPECT_EQ(statsAt(1.6).resolution, 1);
    EXPECT_EQ(statsAt(5).between, 0);
    EXPECT_EQ(statsAt(5).resolution, 2);
    options.optics.extinctionScale = 1.4;
    EXPECT_EQ(statsAt(1.6).between, 1);
    // and labels, which have no values between them.
    options.optics.transferFunction.colors = {
        {0, {1, 0, 0}}, {100, {1, 0, 0}}, {100, {0, 1, 0}}, {255, {0, 1, 0}}};
    EXPECT_EQ(statsAt(1.6).between, 0);
}

// Voxels of more than 65536 blocks with something to see stay whole, with one sheet pixel each
// while that blurs no more than two do.
TEST(Between, isNotChosenWhereThereAreTooManyBlocks) {
    for (const int edge : {40, 41}) {
        const bool areTooMany = edge > 40;
        const Volume volume = makeVolume(
            {{0, 0, 0}, glm::ivec3(8 * edge - 1)},
            [](int x, int y, int z) { return ((x | y | z) & 7) == 0 ? 255 : kInactive; });
        std::vector<std::string> warnings;
        Listener listener;
        listener.warning = [&](const std::string& line) { warnings.push_back(line); };
        RenderOptions options;
        options.optics.transferFunction = testTransferFunction(0.7);
        options.camera.frameWidthWorld = 30;
        const auto statsAt = [&](double pixelsPerVoxel) {
            options.camera.sizePixels = glm::ivec2(int(30 * pixelsPerVoxel));
            return render(volume, options, listener).stats;
        };
        for (const double pixels : {1.6, 2.9}) {
            const RenderStats stats = statsAt(pixels);
            EXPECT_EQ(stats.between, areTooMany ? 0 : 1) << pixels;
            EXPECT_EQ(stats.resolution, areTooMany ? 1 : 2) << pixels;
            EXPECT_EQ(stats.footprint, 1) << pixels;
        }
        EXPECT_EQ(statsAt(4.9).resolution, areTooMany ? 1 : 2);
        EXPECT_EQ(statsAt(4.9).footprint > 1, areTooMany);
        EXPECT_EQ(statsAt(5.1).resolution, 2);
        // Who asks for something gets what the screen asks for.
        options.splat.sigma = 0.3;
        EXPECT_EQ(statsAt(2).resolution, 2);
        options.splat.sigma = {};
        options.splat.between = 0;
        EXPECT_EQ(statsAt(2).resolution, 2);
        ASSERT_EQ(warnings.size(), areTooMany ? 6u : 0u);
        if (areTooMany) {
            EXPECT_EQ(warnings[0],
                      "voxels are too many to be divided (68921 blocks of 8x8x8 can be seen, at "
                      "most 65536 are): drawn as they are; `between` 1 divides them");
        }
    }
}

// No voxel changes how others are drawn: only the transfer function tells what is thin.
TEST(Between, doesNotDependOnWhatIsSeen) {
    TestVolume faint({0, 0, 0}, {16, 16, 16});
    std::fill(faint.values.begin(), faint.values.end(), 2.0f);
    RenderOptions options;
    options.optics.transferFunction.opacities = {{0, 0, 0.5, 0}, {255, 1, 0.5, 0}};
    options.optics.transferFunction.colors = {{0, {1, 1, 1}}};
    options.camera.sizePixels = {64, 64};
    EXPECT_EQ(render(throughRaw(faint, glm::dvec3(1)), options).stats.between, 1);
    faint.values.front() = 255;
    EXPECT_EQ(render(throughRaw(faint, glm::dvec3(1)), options).stats.between, 1);
}

// What blocks of 8 voxels begin where makes no difference: values that lie across a corner count.
// Between labels 1 and 5 lies no 3, and beside the only one that is seen nothing of it.
TEST(Between, isNoneOfLabels) {
    const Volume volume = makeVolume({{0, 0, 0}, {15, 15, 15}}, [](int x, int y, int z) {
        const glm::dvec3 away = glm::dvec3(x, y, z) - 7.5;
        return glm::dot(away, away) < 25 ? 5 : 1;
    });
    RenderOptions options;
    options.camera.sizePixels = {64, 64};
    for (const std::vector<LabelLook>& looks :
         {std::vector<LabelLook>{{1, {1, 0, 0}, 0}, {3, {0, 1, 0}, 1}, {5, {0, 0, 1}, 1}},
          std::vector<LabelLook>{{5, {0, 0, 1}, 1}}}) {
        options.optics.transferFunction = labelFunction(looks);
        const RenderResult result = render(volume, options);
        EXPECT_EQ(result.stats.between, 0);
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x) ASSERT_EQ(result.image.pixel(x, y)[1], 0) << x << ' ' << y;
    }
}

TEST(Between, findsWhatIsSeenAcrossCorners) {
    RenderOptions options;
    options.splat.between = 1;
    options.camera.direction = {0, 0, -1};
    options.camera.frameWidthWorld = 8;
    options.camera.sizePixels = {32, 32};
    options.optics.transferFunction.colors = {{0, {1, 1, 1}}};
    // Clear on both sides of a band.
    options.optics.transferFunction.opacities = {
        {2.9, 0, 0.5, 0}, {3, 1, 0.5, 0}, {8, 1, 0.5, 0}, {8.1, 0, 0.5, 0}};
    std::optional<std::uint64_t> visible;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::ivec3 at(corner & 1 ? 7 : 3, corner & 2 ? 7 : 3, corner & 4 ? 7 : 3);
        TestVolume volume(at, {2, 2, 1});
        volume.at(at) = 1;
        volume.at(at + glm::ivec3(0, 1, 0)) = 2;
        volume.at(at + glm::ivec3(1, 1, 0)) = 33;
        options.camera.targetWorld = glm::dvec3(at);
        const std::uint64_t found = render(throughVdb(volume), options).stats.visible;
        EXPECT_GT(found, 0u);
        EXPECT_EQ(visible.value_or(found), found) << corner;
        visible = found;
    }
}

TEST(Between, GoesByVoxelsNotByTheBox) {
    Volume volume = throughRaw(noise({8, 8, 8}), glm::dvec3(1));
    test::changed(volume)->box.max.x = volume.box().min.x + (1 << 29);
    RenderOptions options;
    options.optics.transferFunction = testTransferFunction(0.7);
    options.camera.sizePixels = {16, 16};
    options.camera.frameWidthWorld = 8;
    for (const int between : {1, 7}) {
        options.splat.between = between;
        EXPECT_NO_THROW(render(volume, options)) << between;
    }
}

// Whatever is put between its slices, a homogeneous slab stays what it is, active or dense.
TEST(Between, leavesAHomogeneousSlabAlone) {
    TestVolume slab({0, 0, 0}, {40, 40, 7});
    std::fill(slab.values.begin(), slab.values.end(), 200.0f);
    for (const Volume& volume : {throughVdb(slab), throughRaw(slab, glm::dvec3(1))}) {
        for (const double degrees : {0.0, 25.0, 44.0}) {
            const double angle = degrees * std::acos(-1.0) / 180;
            RenderOptions options;
            options.camera.direction = glm::dvec3(-std::sin(angle), 0, -std::cos(angle));
            options.camera.up = glm::dvec3(0, 1, 0);
            options.camera.frameWidthWorld = 2;
            options.camera.sizePixels = {8, 8};
            options.optics.transferFunction = testTransferFunction(0.5);
            options.optics.unitDistance = 3;
            for (const int between : {0, 1, 2, 3, 7}) {
                options.splat.between = between;
                const double opacity = 0.5 * 200 / 255;
                const double expected =
                    1 - std::exp(std::log(1 - opacity) * 7 / 3 / std::cos(angle));
                const Image image = render(volume, options).image;
                for (int i = 0; i < 64; ++i)
                    ASSERT_NEAR(image.rgba[4 * i + 3], expected, 2e-4) << between;
            }
        }
    }
}

double valueAt(TestVolume& volume, const glm::dvec3& place) {
    const glm::ivec3 low(glm::floor(place));
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::ivec3 at = low + glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
        if (glm::any(glm::lessThan(at, glm::ivec3(0))) ||
            glm::any(glm::greaterThanEqual(at, volume.dims)))
            continue;
        const glm::dvec3 share = 1.0 - glm::abs(place - glm::dvec3(at));
        sum += share.x * share.y * share.z * volume.at(at);
    }
    return sum;
}

// Brightness along a cylinder: the mean across it, for places half a voxel apart.
struct Cylinder {
    double radius;
    glm::dvec3 along{glm::normalize(glm::dvec3(0.9, 0.3, 0.25))};
    glm::dvec3 direction{glm::normalize(glm::dvec3(0.02, -0.25, -0.97))};
    static constexpr int kDims = 56;
    static constexpr double kPixel = 0.5;

    TestVolume volume() const {
        TestVolume made({0, 0, 0}, glm::ivec3(kDims));
        for (int z = 0; z < kDims; ++z) {
            for (int y = 0; y < kDims; ++y) {
                for (int x = 0; x < kDims; ++x) {
                    const glm::dvec3 p = glm::dvec3(x, y, z) - middle();
                    const double distance = glm::length(p - glm::dot(p, along) * along);
                    made.at({x, y, z}) =
                        float(std::floor(255 * std::clamp(radius + 0.5 - distance, 0.0, 1.0)));
                }
            }
        }
        return made;
    }
    static glm::dvec3 middle() { return glm::dvec3(0.5 * (kDims - 1) - 0.137); }
    // In the picture: along the cylinder's image, and across.
    glm::dvec3 onScreen() const {
        return glm::normalize(along - glm::dot(along, direction) * direction);
    }
    glm::dvec3 across() const { return glm::cross(direction, onScreen()); }
};

// Largest less smallest of the means, over their mean.
template <typename BrightnessAt>
double rippleOf(const Cylinder& cylinder, const BrightnessAt& brightnessAt) {
    double low = 1e9, high = 0, sum = 0;
    constexpr int kPlaces = 96;
    for (int i = 0; i < kPlaces; ++i) {
        double mean = 0;
        constexpr int kAcross = 24;
        for (int j = 0; j < kAcross; ++j) {
            const double side = (j + 0.5) / kAcross * 2 - 1;
            mean += brightnessAt(0.25 * (i - kPlaces / 2), side * (cylinder.radius + 1)) / kAcross;
        }
        low = std::min(low, mean);
        high = std::max(high, mean);
        sum += mean / kPlaces;
    }
    return (high - low) / sum;
}

// Thin things seen obliquely are no strings of beads: at two pixels a voxel, their brightness
// ripples no more than in a ray march of the trilinear volume with steps of half a voxel, and 2 %.
TEST(Between, cylindersRippleNoMoreThanARayMarch) {
    TransferFunction function;
    function.linearColors = true;
    function.colors = {{0, {0, 0, 0}},      {56, {.2, .3, .6}}, {115, {.9, .6, .3}},
                       {166, {.9, .7, .4}}, {204, {1, 1, .9}},  {255, {1, 1, 1}}};
    function.opacities = {{56, 0, 0.5, 0},
                          {115, 0.03, 0.5, 0},
                          {166, 0.03, 0.5, 0},
                          {204, 0.4, 0.5, 0},
                          {255, 0.6, 0.5, 0}};
    for (const double radius : {1.0, 1.5, 2.0}) {
        const Cylinder cylinder{radius};
        TestVolume plain = cylinder.volume();
        const double march = rippleOf(cylinder, [&](double t, double side) {
            const glm::dvec3 start = cylinder.middle() + t * cylinder.onScreen() +
                                     side * cylinder.across() - 40.0 * cylinder.direction;
            double light = 0;
            double left = 1;
            for (int i = 0; i < 160; ++i) {
                const double value = valueAt(plain, start + 0.5 * i * cylinder.direction);
                const double opacity = 1 - std::sqrt(1 - function.opacityAt(value));
                light += left * opacity * function.colorAt(value).x;
                left *= 1 - opacity;
            }
            return light;
        });
        RenderOptions options;
        options.camera.direction = cylinder.direction;
        options.camera.up = cylinder.across();
        options.camera.targetWorld = cylinder.middle();
        options.camera.frameWidthWorld = 64;
        options.camera.sizePixels = {128, 128};
        options.optics.transferFunction = function;
        const Image image = render(throughRaw(plain, glm::dvec3(1)), options).image;
        const double splatted = rippleOf(cylinder, [&](double t, double side) {
            // Up is across, and right is direction x up: along the image or against it.
            const glm::dvec3 right = glm::cross(cylinder.direction, cylinder.across());
            const double x = 64 + t * glm::dot(right, cylinder.onScreen()) / Cylinder::kPixel - 0.5;
            const double y = 64 - side / Cylinder::kPixel - 0.5;
            const int i = int(std::floor(x)), j = int(std::floor(y));
            const double fx = x - i, fy = y - j;
            return (1 - fy) * ((1 - fx) * image.pixel(i, j)[0] + fx * image.pixel(i + 1, j)[0]) +
                   fy * ((1 - fx) * image.pixel(i, j + 1)[0] + fx * image.pixel(i + 1, j + 1)[0]);
        });
        EXPECT_LE(splatted, march + 0.02) << radius;
        EXPECT_GT(march, 0.01);
        RecordProperty("march" + std::to_string(radius), std::to_string(march));
        std::printf("radius %.1f: march %.3f, splatted %.3f\n", radius, march, splatted);
    }
}

// Magnified, an analytic Gaussian shows neither squares nor steps, along an axis or not.
TEST(Between, aMagnifiedGaussianIsSmooth) {
    TestVolume blob({0, 0, 0}, glm::ivec3(36));
    const glm::dvec3 middle(17.5);
    for (int z = 0; z < 36; ++z) {
        for (int y = 0; y < 36; ++y) {
            for (int x = 0; x < 36; ++x) {
                const glm::dvec3 p = glm::dvec3(x, y, z) - middle;
                blob.at({x, y, z}) = float(255 * std::exp(-glm::dot(p, p) / 50));
            }
        }
    }
    TransferFunction function;
    function.linearColors = true;
    function.colors = {{0, {1, 1, 1}}};
    function.opacities = {{0, 0, 0.5, 0}, {255, 0.02, 0.5, 0}};
    const Volume volume = throughVdb(blob);
    for (const double pixelsPerVoxel : {1.2, 2.0, 2.9, 5.0, 20.0, 50.0}) {
        for (const glm::dvec3 direction : {glm::dvec3(0, 0, -1), glm::dvec3(-1, 0.8, -0.6)}) {
            RenderOptions options;
            options.camera.direction = direction;
            options.camera.up = glm::dvec3(0, 1, 0.1);
            options.camera.targetWorld = middle;
            options.camera.sizePixels = {120, 120};
            options.camera.frameWidthWorld = 120 / pixelsPerVoxel;
            options.optics.transferFunction = function;
            const Image image = render(volume, options).image;
            // A smooth picture's second differences over half a voxel are those of a Gaussian.
            const int step = std::max(1, int(pixelsPerVoxel / 2));
            double worst = 0;
            for (int y = step; y < 120 - step; ++y) {
                for (int x = step; x < 120 - step; ++x) {
                    const auto bend = [&](const auto& at) {
                        return at(x - step, y) - 2 * at(x, y) + at(x + step, y);
                    };
                    const double got =
                        bend([&](int i, int j) { return double(image.pixel(i, j)[3]); });
                    const double expected = bend([&](int i, int j) {
                        const double r = std::hypot(i - 59.5, j - 59.5) / pixelsPerVoxel;
                        double depth = 0;
                        for (double t = -25; t <= 25; t += 0.25)
                            depth -= 0.25 * std::log1p(-0.02 * std::exp(-(r * r + t * t) / 50));
                        return 1 - std::exp(-depth);
                    });
                    worst = std::max(worst, std::abs(got - expected));
                }
            }
            // Below, voxels have a sheet pixel of their own, and nothing smooths them.
            const double most = pixelsPerVoxel < 3 ? 1.4e-3 : 6e-4;
            EXPECT_LT(worst, most) << pixelsPerVoxel << " pixels a voxel, " << direction.x;
        }
    }
}

TEST(Between, aNumberOutOfRangeIsRefused) {
    const Volume volume = throughRaw(noise({8, 8, 8}), glm::dvec3(1));
    RenderOptions options;
    options.optics.transferFunction = testTransferFunction(0.2);
    for (const int between : {-1, kMostBetween + 1}) {
        options.splat.between = between;
        EXPECT_THROW(render(volume, options), Error);
    }
}

}  // namespace
}  // namespace deltasplat::test
