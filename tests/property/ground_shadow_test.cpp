// SPDX-License-Identifier: Apache-2.0
// The shadow of fog on a plane, against what is reckoned along single ways, and what must stay the
// same.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "deltasplat/ground_shadow.h"
#include "support/error_of.h"
#include "support/lit_fog.h"
#include "support/make_volume.h"
#include "support/mirrored.h"
#include "support/same_picture.h"
#include "support/sight_line.h"
#include "support/some_scene.h"

namespace deltasplat {
namespace {

using test::aroundMiddle;
using test::Ball;
using test::errorOf;
using test::fogOf;
using test::fogOptics;

constexpr Ball kBall{0.25, 4};

Volume ballVolume() {
    constexpr int kAcross = 48;
    return fogOf(glm::ivec3(kAcross), aroundMiddle(kAcross, 0.75),
                 [](const auto& p) { return kBall.extinctionAt(p); });
}

Light pointLight(const glm::dvec3& world, double strength, const glm::dvec3& color,
                 double radius = 0) {
    Light light = test::pointAt(world);
    light.strength = strength;
    light.color = color;
    light.radiusWorld = radius;
    return light;
}

const std::vector<Light> kTwoSuns{{LightFrame::kWorld, {-1, -3, 0.5}, {1, 0.4, 0.1}, 3},
                                  {LightFrame::kWorld, {2, -2, -1}, {0.1, 0.5, 1}, 2}};

// Beneath the ball, and oblique.
const Ground kSlope{{0, -18, 0}, {0.2, 1, -0.15}};

RenderOptions seenFrom(Projection projection, const std::vector<Light>& lights) {
    RenderOptions options;
    Scattering fog;
    fog.lights = lights;
    options.optics = fogOptics(fog);
    options.camera.projection = projection;
    options.camera.sizePixels = {60, 45};
    options.camera.direction = glm::dvec3(-0.4, -0.8, -0.6);
    options.camera.targetWorld = glm::dvec3(0, -12, 0);
    if (projection == Projection::kOrtho) options.camera.frameWidthWorld = 90;
    if (projection == Projection::kPerspective) {
        options.camera.distanceWorld = 70;
        options.camera.fovDegrees = 60;
    }
    if (projection == Projection::kLatlong) {
        options.camera.sizePixels = {64, 32};
        options.camera.eyeWorld = glm::dvec3(20, 6, 15);
        options.camera.targetWorld.reset();
    }
    return options;
}

Camera cameraOf(const Volume& volume, const RenderOptions& options) {
    return test::cameraOf(volume, options.camera);
}

// By the documentation: which light there is, and what of it gets through the ball.
glm::dvec4 expectedAt(const glm::dvec3& p, const Scattering& fog, const glm::dvec3& normal) {
    glm::dvec3 all = fog.ambient;
    glm::dvec3 lost(0);
    for (const Light& light : fog.lights) {
        glm::dvec3 way = glm::normalize(light.direction);
        double share = 1;
        double depth = kBall.depthAt(p, way);
        if (light.positionWorld) {
            const double r = glm::distance(p, *light.positionWorld);
            way = (p - *light.positionWorld) / r;
            share = std::pow(std::max(r, light.radiusWorld), -2);
            depth = kBall.depthBetween(*light.positionWorld, p);
        }
        const double cosine = std::max(0.0, -glm::dot(way, normal));
        const glm::dvec3 color = cosine * share * light.strength * light.color;
        all += color;
        lost += color * -std::expm1(-depth);
    }
    const auto luminance = [](const glm::dvec3& c) {
        return 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b;
    };
    return {lost / all, luminance(lost) / luminance(all)};
}

struct Agreement {
    double worst = 0;
    double darkest = 0;  // of what is expected, least of any channel
    int unseen = 0;
};

Agreement agreementOf(const Image& shadow, const Camera& camera, const Scattering& fog,
                      const Ground& ground) {
    const glm::dvec3 normal = glm::normalize(ground.normalWorld);
    Agreement result;
    glm::dvec4 darkest(0);
    for (int y = 0; y < camera.sizePixels.y; ++y) {
        for (int x = 0; x < camera.sizePixels.x; ++x) {
            const auto line = test::sightLineOf(camera, {x + 0.5, y + 0.5}, 1000);
            const double t =
                glm::dot(ground.pointWorld - line.start, normal) / glm::dot(line.ray, normal);
            glm::dvec4 expected(0);
            if (t > 0 && glm::dot(line.ray, normal) < 0) {
                expected = expectedAt(line.start + t * line.ray, fog, normal);
            } else {
                ++result.unseen;
            }
            darkest = glm::max(darkest, expected);
            for (int c = 0; c < 4; ++c) {
                const double got = shadow.pixel(x, y)[c];
                result.worst = std::max(result.worst, std::abs(got - expected[c]));
            }
        }
    }
    result.darkest = std::min({darkest.r, darkest.g, darkest.b, darkest.a});
    return result;
}

Agreement agreementWith(Projection projection, const std::vector<Light>& lights,
                        const glm::dvec3& ambient = glm::dvec3(0)) {
    const Volume volume = ballVolume();
    RenderOptions options = seenFrom(projection, lights);
    options.optics.scattering->ambient = ambient;
    const Camera camera = cameraOf(volume, options);
    return agreementOf(renderGroundShadow(volume, options, camera, kSlope), camera,
                       *options.optics.scattering, kSlope);
}

TEST(GroundShadow, isThatOfABallInTwoSuns) {
    for (const Projection projection :
         {Projection::kOrtho, Projection::kPerspective, Projection::kLatlong}) {
        const Agreement found = agreementWith(projection, kTwoSuns);
        // Of a panorama pixels are as large as three voxels.
        const double most = projection == Projection::kLatlong ? 0.01 : 0.006;
        EXPECT_LT(found.worst, most) << projectionName(projection);
        EXPECT_GT(found.darkest, 0.3) << projectionName(projection);
        if (projection == Projection::kLatlong) {
            EXPECT_GT(found.unseen, 800);
        }
    }
    const Agreement dim = agreementWith(Projection::kPerspective, kTwoSuns, {2, 0.1, 0.5});
    EXPECT_LT(dim.worst, 0.006);
    EXPECT_GT(dim.darkest, 0.2);
}

// Beside the ball, near it, in it, below the plane, and so far away that light is parallel.
TEST(GroundShadow, isThatOfABallUnderPointLights) {
    const glm::dvec3 white(1);
    const glm::dvec3 red(1, 0.2, 0.1);
    for (const std::vector<Light>& lights :
         {std::vector{pointLight({15, 60, -10}, 900, white)},
          std::vector{pointLight({3, 8, 2}, 300, red), pointLight({-3, 30, 1}, 300, white)},
          std::vector{pointLight({1, 0.5, 0}, 300, white, 2), kTwoSuns[1]},
          std::vector{pointLight({1, -40, 0}, 300, red), kTwoSuns[0]},
          std::vector{pointLight({1e6, 3e6, 2e5}, 1e6, white)},
          std::vector{pointLight({3, 5, -2}, 100, red, 40), kTwoSuns[0]}}) {
        for (const Projection projection : {Projection::kOrtho, Projection::kPerspective}) {
            const Agreement found = agreementWith(projection, lights);
            EXPECT_LT(found.worst, 0.012) << lights.front().positionWorld->y;
            EXPECT_GT(found.darkest, 0.3) << lights.front().positionWorld->y;
        }
    }
}

// Where the plane cuts the ball, what lies below throws no shadow.
TEST(GroundShadow, ofWhatIsCutIsThatOfWhatIsAbove) {
    const Volume volume = ballVolume();
    const RenderOptions options = seenFrom(Projection::kPerspective, kTwoSuns);
    const Camera camera = cameraOf(volume, options);
    const Ground ground{{0, 1, 0}, {0, 2, 0}};
    std::vector<std::string> warnings;
    const Listener listener{{}, [&](const std::string& line) { warnings.push_back(line); }};
    const Image shadow = renderGroundShadow(volume, options, camera, ground, listener);
    const Agreement found = agreementOf(shadow, camera, *options.optics.scattering, ground);
    // Voxels are above the plane or not: off by a tenth of an extinction at most.
    EXPECT_LT(found.worst, 0.05);
    EXPECT_GT(found.darkest, 0.3);
    EXPECT_EQ(warnings, std::vector<std::string>{
                            "`ground`: the volume's box reaches 18.625 below it; what lies there "
                            "is seen as if there were no ground, and throws no shadow"});
}

TEST(GroundShadow, isNothingWhereNothingFallsOrIsSeen) {
    const Volume volume = ballVolume();
    const auto warningWith = [&](const Ground& ground, const auto& change) {
        RenderOptions options = seenFrom(Projection::kPerspective, kTwoSuns);
        change(options);
        std::string warnings;
        const Listener listener{{}, [&](const std::string& line) { warnings += line; }};
        const Image shadow =
            renderGroundShadow(volume, options, cameraOf(volume, options), ground, listener);
        for (const float share : shadow.rgba) EXPECT_EQ(share, 0);
        return warnings;
    };
    const auto none = [](RenderOptions&) {};
    EXPECT_EQ(warningWith({{0, -20, 0}, {0, -1, 0}}, none),
              "`ground`: no line of sight meets it from above: it has no shadow here");
    EXPECT_EQ(warningWith({{0, 20, 0}, {0, 1, 0}}, none),
              "`ground`: the volume's box reaches 37.625 below it, all of it; what lies there is "
              "seen as if there were no ground, and throws no shadow");
    EXPECT_EQ(warningWith(kSlope,
                          [](RenderOptions& options) {
                              options.optics.scattering->lights = {
                                  pointLight({0, -30, 0}, 10, glm::dvec3(1)),
                                  {LightFrame::kWorld, {0, 1, 0}}};
                          }),
              "`ground`: no light shines on it from above: it has no shadow");
    EXPECT_EQ(warningWith(kSlope, [](RenderOptions& options) { options.camera.nearWorld = 1e4; }),
              "`ground`: no line of sight meets it from above: it has no shadow here");
    EXPECT_EQ(warningWith({{0, -19, 0}, {0, 1, 0}},
                          [](RenderOptions& options) { options.optics.extinctionScale = 0; }),
              "");
}

struct Scene {
    Volume volume;
    RenderOptions options;
    Ground ground;
};

Scene someScene() {
    Scene scene{*test::someVolume(),
                seenFrom(Projection::kPerspective, kTwoSuns),
                {{10, -9, 12}, {0.1, 1, 0.2}}};
    scene.options.optics = test::someOptics(test::Colors::kFire);
    scene.options.optics.scattering->lights.push_back(
        pointLight({11, 50, 9}, 900, glm::dvec3(0.3, 0.5, 1)));
    scene.options.optics.scattering->lights.push_back(
        pointLight({11, 21, 9}, 300, glm::dvec3(0.3, 1, 1)));
    scene.options.camera.targetWorld = glm::dvec3(16, 0, 12);
    return scene;
}

Image shadowOf(const Scene& scene) {
    return renderGroundShadow(scene.volume, scene.options, cameraOf(scene.volume, scene.options),
                              scene.ground);
}

double sumOf(const Image& image) {
    double sum = 0;
    for (const float value : image.rgba) sum += value;
    return sum;
}

Scene mirroredScene(Scene scene) {
    for (int i = 0; i < 4; ++i) test::changed(scene.volume)->worldFromIndex[i].x *= -1;
    scene.options.camera.direction->x *= -1;
    scene.options.camera.targetWorld->x *= -1;
    scene.ground.pointWorld.x *= -1;
    scene.ground.normalWorld.x *= -1;
    for (Light& light : scene.options.optics.scattering->lights) {
        light.direction.x *= -1;
        if (light.positionWorld) light.positionWorld->x *= -1;
    }
    return scene;
}

// Bit for bit: whatever the method, on however many threads, at every SIMD level.
TEST(GroundShadow, isTheSameHoweverItIsMade) {
    Scene scene = someScene();
    EXPECT_GT(sumOf(shadowOf(scene)), 300);
    test::expectTheSameHoweverMade([&](Method method) {
        scene.options.splat.method = method;
        return shadowOf(scene).rgba;
    });
}

// Bit for bit, with a light within the volume, which sees all around.
TEST(GroundShadow, mirrorsWithTheScene) {
    const Scene scene = someScene();
    const Image shadow = shadowOf(scene);
    EXPECT_GT(sumOf(shadow), 300);
    EXPECT_EQ(test::mirrored(shadowOf(mirroredScene(scene))).rgba, shadow.rgba);
}

// Fire and colours hide nothing.
TEST(GroundShadow, isOfWhatHidesAlone) {
    Scene scene = someScene();
    const Image shadow = shadowOf(scene);
    scene.options.optics.parts.clear();
    scene.options.optics.transferFunction.colors = {{0, {0.3, 0.7, 0}}};
    scene.options.optics.scattering->albedo = glm::dvec3(0.2);
    EXPECT_EQ(shadowOf(scene).rgba, shadow.rgba);
}

TEST(GroundShadow, goesIntoChannelsAndBehindPictures) {
    Image shadow({2, 1});
    shadow.rgba = {0.1f, 0.2f, 0.3f, 0.5f, 0, 0, 0, 0};
    const std::vector<ImageChannel> channels = shadowChannels(shadow);
    ASSERT_EQ(channels.size(), 3u);
    EXPECT_EQ(channels[1].name, "shadow.G");
    EXPECT_EQ(channels[2].values, (std::vector<float>{0.3f, 0}));
    Image picture({2, 1});
    picture.rgba = {0.1f, 0.1f, 0, 0.25f, 0.3f, 0, 0, 0.5f};
    putShadowBehind(picture, shadow);
    EXPECT_EQ(picture.rgba, (std::vector<float>{0.1f, 0.1f, 0, 0.625f, 0.3f, 0, 0, 0.5f}));
    Image other({1, 1});
    EXPECT_EQ(errorOf([&] { putShadowBehind(other, shadow); }),
              "usage: shadow: got 2x1 pixels; expected 1x1, those of the picture");
}

TEST(GroundShadow, refusesWhatCannotBe) {
    const Scene scene = someScene();
    const auto errorWith = [&](const auto& change) {
        Scene changed = scene;
        change(changed);
        return errorOf([&] { shadowOf(changed); });
    };
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(errorWith([](Scene& s) { s.options.mode = Mode::kXray; }),
              "usage: `ground`: got `mode` xray; expected `mode` composite");
    EXPECT_EQ(errorWith([](Scene& s) { s.options.optics.scattering.reset(); }),
              "usage: `ground`: got what shines by itself; expected `scattering`, whose lights "
              "throw shadows");
    EXPECT_EQ(errorWith([](Scene& s) { s.ground.normalWorld = glm::dvec3(0); }),
              "usage: `ground`: got point 10,-9,12 and normal 0,0,0; expected finite numbers, and "
              "a normal other than 0,0,0");
    EXPECT_EQ(errorWith([](Scene& s) { s.ground.pointWorld.y = kNan; }),
              "usage: `ground`: got point 10,nan,12 and normal 0.1,1,0.2; expected finite numbers, "
              "and a normal other than 0,0,0");
}

}  // namespace
}  // namespace deltasplat
