// SPDX-License-Identifier: Apache-2.0
// Mattes of layers: how much each of them hides.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "deltasplat/render_aovs.h"
#include "support/same_picture.h"
#include "support/some_scene.h"

namespace deltasplat {
namespace {

using test::Colors;

// What is clear up to 20, and then fog of an extinction that grows to one of 255.
TransferFunction ramp(const glm::dvec3& color, double opacity) {
    TransferFunction function;
    function.colors = {{0, color}};
    function.opacities = {{20, 0, 0.5, 0}, {255, opacity, 0.5, 0}};
    return function;
}

MediumPart layer(std::shared_ptr<const Volume> volume, const TransferFunction& function,
                 double strength) {
    MediumPart part;
    part.volume = std::move(volume);
    part.kind = MediumPart::Kind::kAbsorption;
    part.transferFunction = function;
    part.strength = strength;
    return part;
}

std::vector<ImageChannel> mattesOf(const Volume& volume, const RenderOptions& options,
                                   const Camera& camera) {
    return renderAovs(volume, options, camera, std::vector{Aov::kMattes});
}

RenderOptions optionsOf(const CameraOptions& camera) {
    RenderOptions options;
    options.camera = camera;
    options.optics.transferFunction = ramp({1, 0.3, 0}, 0.3);
    return options;
}

// Of layers of other grids, with fire between them, which hides nothing.
TEST(AovMattes, addUpToAlpha) {
    const auto volume = test::someVolume();
    for (const CameraOptions& camera : test::someCameras()) {
        RenderOptions options = optionsOf(camera);
        for (int i = 0; i < 2; ++i) {
            const IndexBox box{{2 * i, 3, 4}, {25, 22 + i, 30}};
            options.optics.parts.push_back(layer(std::make_shared<const Volume>(test::randomVolume(
                                                     box, 7 + unsigned(i), 0.5, {1, 1.2, 0.8})),
                                                 ramp({0, 0.5 * i, 1}, 0.2), 1 + i));
            if (i == 0) options.optics.parts.push_back(test::someOptics(Colors::kFire).parts[0]);
        }
        const RenderResult beauty = render(*volume, options);
        const std::vector<ImageChannel> mattes = mattesOf(*volume, options, beauty.camera);
        ASSERT_EQ(mattes.size(), 3u);
        std::vector<double> sums(mattes.size());
        double squares = 0;
        for (std::size_t i = 0; i < beauty.image.rgba.size() / 4; ++i) {
            double sum = 0;
            for (std::size_t n = 0; n < mattes.size(); ++n) {
                EXPECT_EQ(mattes[n].name, "matte_" + std::to_string(n + 1));
                sum += mattes[n].values[i];
                sums[n] += mattes[n].values[i];
            }
            const double alpha = beauty.image.rgba[4 * i + 3];
            // The warp keeps each within what is beside it.
            EXPECT_NEAR(sum, alpha, 0.05);
            squares += (sum - alpha) * (sum - alpha);
        }
        EXPECT_LT(std::sqrt(squares / double(mattes[0].values.size())), 3e-3);
        for (const double sum : sums) EXPECT_GT(sum, 10);
    }
}

// Fogs of one grid hide by their extinctions, four of them as two.
TEST(AovMattes, areSharesOfExtinction) {
    const auto volume = std::make_shared<const Volume>(test::makeVolume(
        {{0, 0, 0}, {24, 20, 22}}, [](int x, int y, int z) { return 40 + x + 3 * y + 5 * z; }));
    for (const std::size_t layers : {2u, 4u}) {
        for (const int camera : {1, 6, 8}) {
            RenderOptions options = optionsOf(test::someCameras()[std::size_t(camera)]);
            std::vector<double> strengths{1};
            for (std::size_t i = 1; i < layers; ++i) {
                strengths.push_back(double(i) + 0.5);
                options.optics.parts.push_back(
                    layer(volume, ramp({0, 1, 1}, 0.3), strengths.back()));
            }
            double all = 0;
            for (const double strength : strengths) all += strength;
            const RenderResult beauty = render(*volume, options);
            const std::vector<ImageChannel> mattes = mattesOf(*volume, options, beauty.camera);
            ASSERT_EQ(mattes.size(), layers);
            int seen = 0;
            for (std::size_t i = 0; i < beauty.image.rgba.size() / 4; ++i) {
                const double alpha = beauty.image.rgba[4 * i + 3];
                seen += alpha > 0.5;
                for (std::size_t n = 0; n < layers; ++n)
                    EXPECT_NEAR(mattes[n].values[i], strengths[n] / all * alpha,
                                4e-3 * alpha + 1e-6);
            }
            EXPECT_GT(seen, 500);
        }
    }
}

// A volume by itself is all of what hides.
TEST(AovMattes, ofOneVolumeIsAlpha) {
    const auto volume = test::someVolume();
    for (const Colors colors : {Colors::kSeveral, Colors::kLit, Colors::kFire}) {
        RenderOptions options;
        options.optics = test::someOptics(colors);
        options.camera = test::someCameras()[4];
        const RenderResult beauty = render(*volume, options);
        const std::vector<ImageChannel> mattes = mattesOf(*volume, options, beauty.camera);
        ASSERT_EQ(mattes.size(), 1u);
        for (std::size_t i = 0; i < mattes[0].values.size(); ++i)
            EXPECT_NEAR(mattes[0].values[i], beauty.image.rgba[4 * i + 3], 4e-3);
    }
}

// Where colours jump voxels are not divided, and so they are not in mattes, which are white.
TEST(AovMattes, areDrawnAsThePictureIs) {
    const auto volume = test::someVolume();
    RenderOptions options;
    options.optics = test::someOptics(Colors::kOne);
    options.optics.transferFunction.colors = {
        {0, {1, 0, 0}}, {200, {1, 0, 0}}, {200, {0, 1, 0}}, {255, {0, 1, 0}}};
    options.camera = test::someCameras()[0];
    const RenderResult beauty = render(*volume, options);
    EXPECT_EQ(beauty.stats.between, 0);
    const std::vector<ImageChannel> mattes = mattesOf(*volume, options, beauty.camera);
    for (std::size_t i = 0; i < mattes[0].values.size(); ++i)
        EXPECT_NEAR(mattes[0].values[i], beauty.image.rgba[4 * i + 3], 4e-3);
    options.optics.transferFunction.colors = {{0, {1, 0, 0}}};
    EXPECT_EQ(render(*volume, options).stats.between, 1);
}

TEST(AovMattes, areTheSameForEveryMethodAndThread) {
    const auto volume = test::someVolume();
    RenderOptions options = optionsOf(test::someCameras()[6]);
    options.optics.parts.push_back(layer(volume, ramp({0, 1, 1}, 0.4), 0.5));
    test::expectTheSameHoweverMade([&](Method method) {
        options.splat.method = method;
        return mattesOf(*volume, options, test::cameraOf(*volume, options.camera))[1].values;
    });
}

}  // namespace
}  // namespace deltasplat
