// SPDX-License-Identifier: Apache-2.0
// Colours that voxels have of their own, against a renderer that shares no code, and under a
// tolerance.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "deltasplat/render.h"
#include "property/test_scene.h"
#include "support/make_volume.h"

namespace deltasplat::test {
namespace {

constexpr double kOpacity = 0.3;
constexpr ColorBy kLooks[] = {ColorBy::kX, ColorBy::kY, ColorBy::kZ, ColorBy::kIndex};

TestVolume noisyVolume() {
    TestVolume volume({-3, 0, 5}, {13, 17, 11});
    // Oblong, turned and mirrored.
    const glm::dvec3 a = glm::normalize(glm::dvec3(1, 0.2, -0.1));
    const glm::dvec3 b = glm::normalize(glm::cross(glm::dvec3(0.1, 0, 1), a));
    volume.worldFromIndex = glm::dmat4(glm::dmat3(1.2 * a, 0.9 * b, -1.1 * glm::cross(a, b)));
    volume.worldFromIndex[3] = {4, -2, 7, 1};
    std::mt19937 random(5);
    for (float& value : volume.values) value = random() % 5 < 2 ? float(1 + random() % 255) : 0;
    // The box of what is active is all of it.
    volume.at(volume.first) = volume.at(volume.first + volume.dims - 1) = 200;
    return volume;
}

// By the formulas of the documentation, written out.
reference::Vector colorOf(const TestVolume& volume, ColorBy look, const glm::ivec3& index) {
    const glm::dvec3 share = glm::dvec3(index - volume.first) / glm::dvec3(volume.dims - 1);
    if (look == ColorBy::kIndex) return {share.x, share.y, share.z};
    const int axis = look == ColorBy::kX ? 0 : look == ColorBy::kY ? 1 : 2;
    double low = 1e300;
    double high = -1e300;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::ivec3 end(corner & 1, corner >> 1 & 1, corner >> 2);
        const double place = volume.world(glm::dvec3(volume.first + end * (volume.dims - 1)))[axis];
        low = std::min(low, place);
        high = std::max(high, place);
    }
    const double t = (volume.world(glm::dvec3(index))[axis] - low) / (high - low);
    return {t, 0, 1 - t};
}

reference::Volume colored(const TestVolume& volume, ColorBy look) {
    reference::Volume voxels = referenceVolume(volume, kOpacity, 0.9);
    std::size_t i = 0;
    for (int z = 0; z < volume.dims.z; ++z) {
        for (int y = 0; y < volume.dims.y; ++y) {
            for (int x = 0; x < volume.dims.x; ++x)
                voxels.voxels[i++].color =
                    colorOf(volume, look, volume.first + glm::ivec3(x, y, z));
        }
    }
    return voxels;
}

TEST(ColorBy, agreesWithTheReference) {
    const TestVolume volume = noisyVolume();
    const Volume read = throughVdb(volume);
    for (const ColorBy look : kLooks) {
        const reference::Volume voxels = colored(volume, look);
        for (const glm::dvec3& direction :
             {glm::dvec3(0.1, 0.05, -1), glm::dvec3(-1, 0.6, 0.5), glm::dvec3(0.3, 1, -0.8)}) {
            TestView view;
            view.direction = direction;
            view.up = {0.2, 1, 0.3};
            view.target =
                volume.world(glm::dvec3(volume.first) + 0.5 * glm::dvec3(volume.dims - 1));
            view.pixelWorld = 0.2;
            view.size = {96, 80};
            RenderOptions options;
            options.camera = view.options();
            options.optics.transferFunction = testTransferFunction(kOpacity);
            options.optics.colorBy = look;
            options.splat.sigma = 0.4;
            options.splat.resolution = 2;
            const RenderResult result = render(read, options);
            const auto expected = reference::renderSampled(voxels, view.view(), 0.4, 2);
            EXPECT_GE(psnr(result.image, expected), 60) << colorByName(look);
        }
    }
}

// Opacity is not the look's business.
TEST(ColorBy, leavesOpacityToTheTransferFunction) {
    const Volume read = throughVdb(noisyVolume());
    for (const int between : {0, 1}) {
        RenderOptions options;
        options.optics.transferFunction = testTransferFunction(kOpacity);
        options.camera.sizePixels = {64, 64};
        options.splat.between = between;
        const RenderResult plain = render(read, options);
        for (const ColorBy look : kLooks) {
            options.optics.colorBy = look;
            const RenderResult own = render(read, options);
            EXPECT_EQ(own.stats.visible, plain.stats.visible);
            double most = 0;
            for (std::size_t i = 3; i < own.image.rgba.size(); i += 4) {
                const double difference = own.image.rgba[i] - plain.image.rgba[i];
                most = std::max(most, std::abs(difference));
            }
            EXPECT_LT(most, 1e-3);
        }
        options.optics.colorBy = ColorBy::kValue;
    }
}

// Nor is whether voxels are divided: labels are not, whatever they are coloured by.
TEST(ColorBy, dividesWhatTheTransferFunctionDivides) {
    const Volume labels = randomVolume({{0, 0, 0}, {12, 12, 12}}, 4, 0.2);
    RenderOptions options;
    options.camera.sizePixels = {80, 80};
    TransferFunction& function = options.optics.transferFunction;
    function.opacities = {{0, 0.9, 0.5, 0}, {255, 0.9, 0.5, 0}};
    for (const bool jump : {true, false}) {
        function.colors = {{0, {1, 0, 0}}, {100, {1, 0, 0}}, {100, {0, 1, 0}}, {255, {0, 1, 0}}};
        if (!jump) function.colors.erase(function.colors.begin() + 1);
        options.optics.colorBy = ColorBy::kValue;
        const int between = render(labels, options).stats.between;
        EXPECT_EQ(between, jump ? 0 : 1);
        options.optics.colorBy = ColorBy::kIndex;
        EXPECT_EQ(render(labels, options).stats.between, between);
    }
}

// Voxels of one value that differ in colour make deltas: along the axis that colours change on.
TEST(ColorBy, whatHasAnotherColorIsAChange) {
    const Volume block = makeVolume({{0, 0, 0}, {15, 15, 15}}, [](int, int, int) { return 100; });
    RenderOptions options;
    options.optics.transferFunction.opacities = {{0, 0.1, 0.5, 0}, {255, 0.1, 0.5, 0}};
    options.optics.transferFunction.colors = {{0, {1, 1, 1}}};
    options.splat.method = Method::kDelta;
    options.splat.between = 0;
    options.camera.view = "front";
    const auto deltasBy = [&](ColorBy look) {
        options.optics.colorBy = look;
        return render(block, options).stats.deltas;
    };
    const std::uint64_t still = deltasBy(ColorBy::kValue);
    EXPECT_EQ(deltasBy(ColorBy::kX), still);
    EXPECT_EQ(deltasBy(ColorBy::kY), still);
    EXPECT_EQ(deltasBy(ColorBy::kZ), std::uint64_t{16} * 16 * 16);
    EXPECT_EQ(deltasBy(ColorBy::kIndex), std::uint64_t{16} * 16 * 16);
    // A step of colours of a fifteenth is held until it is more than the tolerance.
    options.splat.tolerance.relative = 0.2;
    EXPECT_LT(deltasBy(ColorBy::kIndex), std::uint64_t{16} * 16 * 16);
}

TEST(ColorBy, staysWithinTheBoundOfATolerance) {
    for (const ColorBy look : kLooks) {
        const Volume volume = randomVolume({{-4, 0, 3}, {25, 30, 34}}, 6, 0.2);
        for (const glm::dvec3& direction : {glm::dvec3(0, 0, -1), glm::dvec3(1, 0.3, -0.2)}) {
            for (const double t : {0.02, 0.1, 0.3}) {
                RenderOptions options;
                options.camera.direction = direction;
                options.camera.up = glm::dvec3(0.1, 1, 0.2);
                options.camera.sizePixels = {96, 80};
                options.optics.colorBy = look;
                options.optics.transferFunction.opacities = {{60, 0, 0.5, 0}, {255, 0.4, 0.5, 0}};
                options.optics.transferFunction.colors = {{0, {1, 0, 0.5}}};
                const RenderResult exact = render(volume, options);
                options.splat.tolerance.relative = t;
                const RenderResult held = render(volume, options);
                double most[2] = {0, 0};
                for (std::size_t i = 0; i < exact.image.rgba.size(); ++i) {
                    const double difference = exact.image.rgba[i] - held.image.rgba[i];
                    most[i % 4 == 3] = std::max(most[i % 4 == 3], std::abs(difference));
                }
                EXPECT_LE(most[0], held.stats.errorBoundColor + 1e-5);
                EXPECT_LE(most[1], held.stats.errorBoundAlpha + 1e-5);
                EXPECT_LE(held.stats.errorBoundColor, 1.7 * (t + 2 * t / (1 - t)));
                EXPECT_LE(held.stats.deltas, exact.stats.deltas);
            }
        }
    }
}

TEST(ColorBy, takesWhatHasNoExtent) {
    RenderOptions options;
    // Fog that is hardly there.
    options.optics.extinctionScale = 1e-305;
    options.optics.transferFunction.opacities = {{0, 0.5, 0.5, 0}, {255, 0.5, 0.5, 0}};
    options.optics.transferFunction.colors = {{0, {1, 1, 1}}};
    options.optics.colorBy = ColorBy::kX;
    const Image thin = render(randomVolume({{0, 0, 0}, {9, 9, 9}}, 4, 0.2), options).image;
    for (const float value : thin.rgba) ASSERT_LE(std::abs(value), 1e-30F);
    options.optics.extinctionScale = 1;
    options.camera.sizePixels = {20, 20};
    options.optics.transferFunction.opacities = {{0, 0.5, 0.5, 0}, {255, 0.5, 0.5, 0}};
    options.optics.transferFunction.colors = {{0, {1, 1, 1}}};
    const Volume one = makeVolume({{3, 4, 5}, {3, 4, 5}}, [](int, int, int) { return 9; });
    const Volume none = makeVolume({}, [](int, int, int) { return 9; });
    for (const ColorBy look : kLooks) {
        options.optics.colorBy = look;
        options.splat.between = 0;
        EXPECT_EQ(render(one, options).stats.visible, 1u);
        const Image image = render(none, options).image;
        EXPECT_TRUE(std::all_of(image.rgba.begin(), image.rgba.end(),
                                [](float value) { return value == 0; }));
    }
}

}  // namespace
}  // namespace deltasplat::test
