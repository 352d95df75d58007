// SPDX-License-Identifier: Apache-2.0
// Channels beside a picture: parts of its light add up to it, depths and places are where things
// are.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "deltasplat/render_aovs.h"
#include "support/changed_volume.h"
#include "support/error_of.h"
#include "support/some_scene.h"

namespace deltasplat {
namespace {

using test::Colors;
using test::errorOf;

using Channels = std::map<std::string, std::vector<float>>;

Channels channelsOf(const Volume& volume, const RenderOptions& options, const Camera& camera,
                    const std::vector<Aov>& aovs) {
    Channels channels;
    for (ImageChannel& channel : renderAovs(volume, options, camera, aovs))
        channels[channel.name] = std::move(channel.values);
    return channels;
}

RenderOptions optionsOf(Colors colors, const CameraOptions& camera) {
    RenderOptions options;
    options.optics = test::someOptics(colors);
    options.camera = camera;
    return options;
}

TEST(Aovs, ofLightAddUpToThePicture) {
    const auto volume = test::someVolume();
    for (const CameraOptions& camera : test::someCameras()) {
        RenderOptions options = optionsOf(Colors::kFire, camera);
        options.optics.scattering->ambient = glm::dvec3(0.1, 0.2, 0.3);
        options.optics.scattering->lights.push_back(
            {LightFrame::kWorld, {-1, -1, -1}, {0.2, 0.5, 1}, 2});
        const RenderResult beauty = render(*volume, options);
        const Channels channels =
            channelsOf(*volume, options, beauty.camera,
                       {Aov::kDirect, Aov::kEmission, Aov::kAmbient, Aov::kTransmittance});
        EXPECT_EQ(channels.size(), 3u * 5 + 1);
        double brightest = 0;
        for (const float value : beauty.image.rgba) brightest = std::max<double>(brightest, value);
        std::map<std::string, double> sums;
        double squares = 0;
        for (std::size_t i = 0; i < beauty.image.rgba.size() / 4; ++i) {
            for (int c = 0; c < 3; ++c) {
                const std::string part = std::string(".") + "RGB"[c];
                const auto at = [&](const std::string& name) {
                    const float value = channels.at(name + part)[i];
                    sums[name] += value;
                    return double(value);
                };
                const double direct = at("direct");
                const double sum = direct + at("emission") + at("ambient");
                const double value = beauty.image.rgba[4 * i + std::size_t(c)];
                const double one = at("direct_1") + at("direct_2");
                // The warp keeps each within what is beside it: at edges, of which this volume has
                // more than any other, parts are cut off otherwise than their sum.
                EXPECT_NEAR(sum, value, 0.05 * brightest);
                EXPECT_NEAR(one, direct, 0.05 * brightest);
                squares += (sum - value) * (sum - value) + (one - direct) * (one - direct);
            }
            EXPECT_NEAR(channels.at("transmittance")[i], 1 - beauty.image.rgba[4 * i + 3], 1e-4);
        }
        const double numbers = 2 * 0.75 * double(beauty.image.rgba.size());
        EXPECT_LT(std::sqrt(squares / numbers), 3e-3 * brightest);
        for (const char* name : {"direct", "direct_1", "direct_2", "emission", "ambient"})
            EXPECT_GT(sums[name], 1) << name;
    }
}

// It is the picture's, if that is there, and otherwise as it is within rounding.
TEST(Aovs, transmittanceIsReadFromThePicture) {
    const auto volume = test::someVolume();
    const RenderOptions options = optionsOf(Colors::kFire, test::someCameras()[1]);
    RenderResult beauty = render(*volume, options);
    // Not what there would be without it.
    for (float& value : beauty.image.rgba) value *= 0.5f;
    AovOptions aovOptions;
    aovOptions.picture = &beauty.image;
    const std::vector<ImageChannel> channels =
        renderAovs(*volume, options, beauty.camera, std::vector{Aov::kTransmittance}, aovOptions);
    ASSERT_EQ(channels.size(), 1u);
    EXPECT_EQ(channels[0].name, "transmittance");
    for (std::size_t i = 0; i < channels[0].values.size(); ++i)
        ASSERT_EQ(channels[0].values[i], 1 - beauty.image.rgba[4 * i + 3]);
    const Image other({3, 3});
    aovOptions.picture = &other;
    EXPECT_EQ(test::errorOf([&] {
                  renderAovs(*volume, options, beauty.camera, std::vector{Aov::kTransmittance},
                             aovOptions);
              }),
              "usage: `picture`: got 3x3 pixels; expected 90x70, those of the camera");
}

// Without lights all that is shown shines.
TEST(Aovs, emissionOfWhatShinesIsThePicture) {
    const auto volume = test::someVolume();
    const RenderOptions options = optionsOf(Colors::kSeveral, test::someCameras()[1]);
    const RenderResult beauty = render(*volume, options);
    const Channels channels = channelsOf(*volume, options, beauty.camera, {Aov::kEmission});
    for (std::size_t i = 0; i < beauty.image.rgba.size() / 4; ++i)
        EXPECT_EQ(channels.at("emission.G")[i], beauty.image.rgba[4 * i + 1]);
}

// Of a plate that is one voxel thick, where lines of sight meet it.
TEST(Aovs, depthAndPlaceAreThoseOfAPlate) {
    Volume volume = test::makeVolume({{0, 0, 0}, {40, 40, 12}},
                                     [](int, int, int z) { return z == 7 ? 200 : 0; });
    test::changed(volume)->worldFromIndex = glm::dmat4(0.5);
    test::changed(volume)->worldFromIndex[3] = {-10, 3, 20, 1};
    const double plate = 20 + 7 * 0.5;
    int unseen = 0;
    for (const Projection projection :
         {Projection::kOrtho, Projection::kPerspective, Projection::kLatlong}) {
        RenderOptions options;
        options.optics = test::someOptics(Colors::kOne);
        options.camera.projection = projection;
        options.camera.sizePixels = {40, 40};
        options.camera.direction = glm::dvec3(0.1, -0.2, -1);
        if (projection == Projection::kPerspective) options.camera.distanceWorld = 25;
        if (projection == Projection::kLatlong) {
            options.camera.sizePixels = {128, 64};
            options.camera.eyeWorld = glm::dvec3(1, 12, 29);
        }
        const RenderResult beauty = render(volume, options);
        const Channels channels =
            channelsOf(volume, options, beauty.camera, {Aov::kDepth, Aov::kPosition});
        const Camera& camera = beauty.camera;
        int seen = 0;
        for (int y = 0; y < options.camera.sizePixels.y; ++y) {
            for (int x = 0; x < options.camera.sizePixels.x; ++x) {
                const auto i = std::size_t(y * options.camera.sizePixels.x + x);
                const glm::dvec3 place(channels.at("P.X")[i], channels.at("P.Y")[i],
                                       channels.at("P.Z")[i]);
                if (beauty.image.rgba[4 * i + 3] == 0) {
                    EXPECT_EQ(channels.at("Z")[i], kNoDepth);
                    EXPECT_EQ(place, glm::dvec3(0));
                    ++unseen;
                    continue;
                }
                // Of half a voxel, more is seen of the nearer side.
                EXPECT_NEAR(place.z, plate, 0.15);
                const glm::dvec3 away = place - camera.eyeWorld();
                const double depth = projection == Projection::kLatlong
                                         ? glm::length(away)
                                         : glm::dot(away, camera.direction);
                EXPECT_NEAR(channels.at("Z")[i], depth, 1e-3);
                // Away from the plate's rim, the line of sight goes through it.
                const glm::dvec2 index((place.x + 10) / 0.5, (place.y - 3) / 0.5);
                if (std::min({index.x, index.y, 40 - index.x, 40 - index.y}) < 4) continue;
                const glm::dvec2 pixel(x + 0.5, y + 0.5);
                const glm::dvec3 start = projection == Projection::kOrtho
                                             ? camera.worldFromPixel(pixel)
                                             : camera.eyeWorld();
                const glm::dvec3 ray =
                    projection == Projection::kOrtho ? camera.direction : camera.rayThrough(pixel);
                const glm::dvec3 met = start + (place.z - start.z) / ray.z * ray;
                // The flatter the ray, the farther it goes through half a voxel.
                const double flatness = glm::length(ray) / std::abs(ray.z);
                EXPECT_LT(glm::distance(met, place), 0.1 * flatness) << projectionName(projection);
                ++seen;
            }
        }
        EXPECT_GT(seen, 100);
    }
    EXPECT_GT(unseen, 100);
}

TEST(Aovs, areRefusedWhereThereAreNone) {
    const auto volume = test::someVolume();
    const auto errorWith = [&](Colors colors, Aov aov, const auto& change) {
        RenderOptions options = optionsOf(colors, {});
        change(options);
        const Camera camera = test::cameraOf(*volume, options.camera);
        return errorOf([&] { renderAovs(*volume, options, camera, std::vector{aov}); });
    };
    const auto none = [](RenderOptions&) {};
    EXPECT_EQ(errorWith(Colors::kOne, Aov::kDirect, none),
              "usage: `aovs` direct: got what shines by itself; expected `scattering`, light in "
              "fog");
    EXPECT_EQ(errorWith(Colors::kLit, Aov::kEmission, none),
              "usage: `aovs` emission: got what reflects lights; expected what shines by itself, "
              "or fog");
    const Camera camera = test::cameraOf(*volume, {});
    for (const double opacity : {0.0, 1.01, std::nan("")}) {
        const std::string error = errorOf([&] {
            renderAovs(*volume, optionsOf(Colors::kOne, {}), camera, std::vector{Aov::kFront},
                       {opacity});
        });
        EXPECT_EQ(error.substr(0, 26), "usage: `depthOpacity`: got");
        EXPECT_EQ(error.substr(error.find(';')), "; expected a number within 0.001..1");
    }
    EXPECT_EQ(errorWith(Colors::kOne, Aov::kDepth,
                        [](RenderOptions& options) { options.mode = Mode::kXray; }),
              "usage: `aovs` depth: got `mode` xray; expected composite");
}

}  // namespace
}  // namespace deltasplat
