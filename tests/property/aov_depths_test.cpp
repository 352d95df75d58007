// SPDX-License-Identifier: Apache-2.0
// Depths that channels tell: where a fog's alpha passes a number, where what is seen ends, and
// where surfaces lie.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "deltasplat/render_aovs.h"
#include "deltasplat/render_deep.h"
#include "support/changed_volume.h"
#include "support/error_of.h"
#include "support/same_picture.h"
#include "support/some_scene.h"

namespace deltasplat {
namespace {

using Channels = std::map<std::string, std::vector<float>>;

Channels channelsOf(const Volume& volume, const RenderOptions& options, const Camera& camera,
                    const std::vector<Aov>& aovs, double opacity = 0.5) {
    Channels channels;
    for (ImageChannel& channel : renderAovs(volume, options, camera, aovs, {opacity}))
        channels[channel.name] = std::move(channel.values);
    return channels;
}

struct Sight {
    glm::dvec3 from;
    glm::dvec3 way;
    double depthOfOne;  // that one length of `way` goes
};

Sight sightOf(const Camera& camera, int x, int y) {
    const glm::dvec2 pixel(x + 0.5, y + 0.5);
    Sight sight;
    const bool isParallel = camera.projection == Projection::kOrtho;
    sight.way = isParallel ? camera.direction : glm::normalize(camera.rayThrough(pixel));
    sight.from = camera.eyeWorld();
    if (isParallel) sight.from += camera.worldFromPixel(pixel) - camera.targetWorld;
    sight.depthOfOne =
        camera.projection == Projection::kLatlong ? 1 : glm::dot(sight.way, camera.direction);
    return sight;
}

std::size_t indexOf(const Camera& camera, int x, int y) {
    return std::size_t(y) * std::size_t(camera.sizePixels.x) + std::size_t(x);
}

// Parallel, straight and oblique, from an eye outside, and all around from one inside.
std::vector<CameraOptions> cameras(const glm::dvec3& inside) {
    std::vector<CameraOptions> cameras(4);
    for (CameraOptions& camera : cameras) camera.sizePixels = {48, 40};
    cameras[1].direction = glm::dvec3(0.2, -0.3, -1);
    cameras[2].direction = glm::dvec3(0.1, -0.15, -1);
    cameras[2].projection = Projection::kPerspective;
    cameras[2].fovDegrees = 35;
    cameras[3].projection = Projection::kLatlong;
    cameras[3].sizePixels = {96, 48};
    cameras[3].eyeWorld = inside;
    return cameras;
}

// Where a way comes into a box along one axis, and where it goes out, if it is not near any other
// side.
std::optional<glm::dvec2> waysThrough(const Sight& sight, const glm::dvec3& low,
                                      const glm::dvec3& high, double margin) {
    glm::dvec2 ways(0, 1e30);
    const double toLow = (low.z - sight.from.z) / sight.way.z;
    const double toHigh = (high.z - sight.from.z) / sight.way.z;
    ways = {std::max(0.0, std::min(toLow, toHigh)), std::max(toLow, toHigh)};
    if (ways.x >= ways.y) return {};
    for (const double way : {ways.x, ways.y}) {
        const glm::dvec3 place = sight.from + way * sight.way;
        for (int axis = 0; axis < 2; ++axis)
            if (place[axis] < low[axis] + margin || place[axis] > high[axis] - margin) return {};
    }
    return ways;
}

double errorOf(float got, double expected) {
    return std::abs(double(got) - expected);
}

// Of a fog that is everywhere alike, as deep as extinction says.
TEST(AovDepths, ofFogAreThoseOfItsExtinction) {
    const glm::dvec3 size(1, 1.2, 0.7);
    const IndexBox box{{-3, 2, 5}, {44, 41, 60}};
    const Volume volume = test::makeVolume(
        box, [](int, int, int) { return 100; }, size);
    const glm::dvec3 low = size * (glm::dvec3(box.min) - 0.5);
    const glm::dvec3 high = size * (glm::dvec3(box.max) + 0.5);
    RenderOptions options;
    options.optics.transferFunction.opacities = {{0, 0.5, 0.5, 0}};
    options.optics.transferFunction.colors = {{0, {1, 0.5, 0.2}}};
    options.optics.unitDistance = 1;
    for (const CameraOptions& cameraOptions : cameras(0.5 * (low + high))) {
        options.camera = cameraOptions;
        const Camera camera = test::cameraOf(volume, cameraOptions);
        for (const auto& [extinction, opacity] :
             {std::pair(0.04, 0.3), {0.04, 0.9}, {0.4, 0.001}, {0.4, 0.5}, {0.4, 0.9}}) {
            options.optics.extinctionScale = extinction / std::log(2);
            const Channels channels = channelsOf(volume, options, camera,
                                                 {Aov::kFront, Aov::kBack, Aov::kSamples}, opacity);
            ASSERT_EQ(channels.size(), 3u);
            int seen = 0;
            for (int y = 0; y < camera.sizePixels.y; ++y) {
                for (int x = 0; x < camera.sizePixels.x; ++x) {
                    const Sight sight = sightOf(camera, x, y);
                    const auto ways = waysThrough(sight, low, high, 4);
                    if (!ways) continue;
                    ++seen;
                    const auto i = indexOf(camera, x, y);
                    const double steep = sight.depthOfOne / std::abs(sight.way.z);
                    const double passed = -std::log(1 - opacity) / extinction;
                    const double all = ways->y - ways->x;
                    if (passed > 1.01 * all) {
                        EXPECT_EQ(channels.at("depth_front.Z")[i], kNoDepth);
                    } else if (passed < 0.99 * all) {
                        EXPECT_LT(errorOf(channels.at("depth_front.Z")[i],
                                          sight.depthOfOne * (ways->x + passed)),
                                  0.05);
                    }
                    // Seen straight on, as long as it is clear enough, one for each slice.
                    if (!cameraOptions.direction && extinction < 0.1 && !cameraOptions.eyeWorld) {
                        EXPECT_EQ(channels.at("samples")[i], box.dims().z);
                    }
                    // Where it ends, or so little is left that it does not count.
                    const double back = channels.at("ZBack")[i] / sight.depthOfOne - ways->x;
                    const double left = std::exp(-extinction * back);
                    EXPECT_LT(back, all + size.z * steep);
                    EXPECT_LT(left - std::exp(-extinction * all), 1.1 * 0x1p-10);
                    if (back < all - size.z * steep) {
                        EXPECT_GT(left, 0x1p-16);
                    }
                }
            }
            EXPECT_GT(seen, 200);
        }
    }
}

// Where there is nothing, and where alpha does not get there.
TEST(AovDepths, areNoneWhereNothingIsMet) {
    const auto volume = test::someVolume();
    RenderOptions options;
    options.optics = test::someOptics(test::Colors::kSeveral);
    options.optics.extinctionScale = 0.01;
    options.camera = test::someCameras()[1];
    const RenderResult beauty = render(*volume, options);
    const Channels channels =
        channelsOf(*volume, options, beauty.camera, {Aov::kDepth, Aov::kFront, Aov::kBack}, 0.1);
    int some = 0;
    int none = 0;
    for (std::size_t i = 0; i < beauty.image.rgba.size() / 4; ++i) {
        const float alpha = beauty.image.rgba[4 * i + 3];
        if (std::abs(alpha - 0.1) > 1e-4) {
            EXPECT_EQ(channels.at("depth_front.Z")[i]<kNoDepth, alpha> 0.1);
            (alpha > 0.1 ? some : none) += 1;
        }
        if (alpha == 0) {
            EXPECT_EQ(channels.at("ZBack")[i], kNoDepth);
        }
        if (channels.at("ZBack")[i] == kNoDepth) continue;
        // What is behind "back" may be just what is missing.
        if (alpha > 0.1 + 0x1p-10 && channels.at("depth_front.Z")[i] < kNoDepth) {
            EXPECT_GE(channels.at("ZBack")[i], channels.at("depth_front.Z")[i]);
        }
    }
    EXPECT_GT(some, 100);
    EXPECT_GT(none, 100);
}

// What samples of a deep picture say by themselves.
// @param least  share of the pixels that are the same: but for what filters take away again
void expectThoseOfADeepPicture(std::optional<double> sigma, double least) {
    const auto volume = test::someVolume();
    for (CameraOptions cameraOptions : test::someCameras()) {
        if (cameraOptions.projection == Projection::kOrtho) cameraOptions.distanceWorld = 100;
        RenderOptions options;
        options.optics = test::someOptics(test::Colors::kSeveral);
        options.camera = cameraOptions;
        options.splat.between = 0;
        options.splat.sigma = sigma;
        const double opacity = 0.7;
        DeepImage deep;
        const RenderResult flat = renderDeep(*volume, options, {1}, deep);
        const Channels channels = channelsOf(*volume, options, flat.camera,
                                             {Aov::kFront, Aov::kBack, Aov::kSamples}, opacity);
        int met = 0;
        int same = 0;
        double samples = 0;
        for (int y = 0; y < deep.size.y; ++y) {
            for (int x = 0; x < deep.size.x; ++x) {
                const auto i = indexOf(flat.camera, x, y);
                const float back = channels.at("ZBack")[i];
                samples += channels.at("samples")[i];
                double alpha = 0;
                double front = kNoDepth;
                double alphaAtBack = 0;
                for (const DeepSample& sample : deep.pixel(x, y)) {
                    const double next = alpha + (1 - alpha) * sample.rgba.a;
                    if (alpha < opacity && next >= opacity) {
                        const double share = std::log((1 - opacity) / (1 - alpha)) /
                                             std::log((1 - next) / (1 - alpha));
                        front = sample.z + (next < 1 ? share : 0) * (sample.zBack - sample.z);
                    }
                    alpha = next;
                    if (sample.zBack < back + 1e-3) alphaAtBack = alpha;
                }
                EXPECT_LT(alpha - alphaAtBack, 0.002);
                if (front == kNoDepth) continue;
                ++met;
                same += errorOf(channels.at("depth_front.Z")[i], front) < 1e-2;
            }
        }
        EXPECT_GT(met, 500);
        EXPECT_GT(same, least * met);
        // Of colours that filters take away again a deep picture has samples as well.
        EXPECT_LT(samples, double(deep.samples()));
        EXPECT_GT(samples, 0.93 * double(deep.samples()));
    }
}

TEST(AovDepths, areThoseOfADeepPicture) {
    expectThoseOfADeepPicture(0.3, 0.93);
}

// Voxels with a sheet pixel of their own are sharper, and filters take away more.
TEST(AovDepths, areThoseOfADeepPictureOfSinglePixels) {
    expectThoseOfADeepPicture({}, 0.92);
}

TEST(AovDepths, areTheSameForEveryMethodAndThread) {
    const auto volume = test::someVolume();
    for (const int camera : {1, 6}) {
        RenderOptions options;
        options.optics = test::someOptics(test::Colors::kLit);
        options.camera = test::someCameras()[std::size_t(camera)];
        test::expectTheSameHoweverMade([&](Method method) {
            options.splat.method = method;
            return channelsOf(*volume, options, test::cameraOf(*volume, options.camera),
                              {Aov::kDepth, Aov::kFront, Aov::kBack, Aov::kSamples});
        });
    }
}

// Fog in two halves lies where the whole does.
TEST(AovDepths, ofTwoLayersAreThoseOfTheirSum) {
    const auto volume = std::make_shared<const Volume>(
        test::makeVolume({{0, 0, 0}, {30, 30, 30}}, [](int x, int y, int z) {
            return int(1000 * std::exp(-0.01 * double((x - 15) * (x - 15) + (y - 12) * (y - 12) +
                                                      (z - 17) * (z - 17))));
        }));
    RenderOptions whole;
    whole.optics.transferFunction.opacities = {{0, 0, 0.5, 0}, {1000, 0.3, 0.5, 0}};
    whole.optics.transferFunction.colors = {{0, glm::dvec3(1)}};
    whole.optics.unitDistance = 1;
    whole.splat.between = 0;
    RenderOptions halves = whole;
    halves.optics.extinctionScale = 0.5;
    MediumPart half;
    half.volume = volume;
    half.kind = MediumPart::Kind::kAbsorption;
    half.transferFunction = whole.optics.transferFunction;
    half.strength = 0.5;
    halves.optics.parts = {half};
    for (const CameraOptions& cameraOptions : cameras({15, 12, 17})) {
        const Camera camera = test::cameraOf(*volume, cameraOptions);
        const std::vector<Aov> aovs{Aov::kDepth, Aov::kFront, Aov::kBack, Aov::kPosition};
        const Channels a = channelsOf(*volume, whole, camera, aovs);
        const Channels b = channelsOf(*volume, halves, camera, aovs);
        int met = 0;
        for (std::size_t i = 0; i < a.at("Z").size(); ++i) {
            // At the ends of the volume a mean of indices is one of voxels that are mostly beside
            // it.
            bool isInside = a.at("ZBack")[i] < kNoDepth && b.at("ZBack")[i] < kNoDepth;
            for (const char* axis : {"P.X", "P.Y", "P.Z"})
                isInside = isInside && std::abs(a.at(axis)[i] - 15) < 13;
            if (!isInside) continue;
            ++met;
            EXPECT_NEAR(a.at("Z")[i], b.at("Z")[i], 0.3);
            EXPECT_NEAR(a.at("P.X")[i], b.at("P.X")[i], 0.3);
            EXPECT_NEAR(a.at("P.Z")[i], b.at("P.Z")[i], 0.3);
            if (a.at("depth_front.Z")[i] == kNoDepth) continue;
            EXPECT_NEAR(a.at("depth_front.Z")[i], b.at("depth_front.Z")[i], 0.02);
        }
        EXPECT_GT(met, 300);
    }
}

// A ball of values that fall off evenly from its middle.
Volume ball(double radius) {
    const double middle = 24;
    Volume volume = test::makeVolume({{0, 0, 0}, {48, 48, 48}}, [&](int x, int y, int z) {
        const double r = glm::length(glm::dvec3(x, y, z) - middle);
        return int(30000 + 1000 * (radius - r));
    });
    test::changed(volume)->worldFromIndex = glm::dmat4(0.5);
    test::changed(volume)->worldFromIndex[3] = {-12, -12, -12, 1};
    return volume;
}

TEST(AovDepths, ofASurfaceAreWhereItIsMet) {
    const double radius = 18;
    const double voxel = 0.5;
    const double r = voxel * radius;
    const Volume volume = ball(radius);
    for (const int between : {0, 1}) {
        for (const CameraOptions& cameraOptions : cameras({1, 2, 18})) {
            RenderOptions options;
            options.optics.surface = Surface{30000, {0.5, 0.5, 0.5}};
            options.camera = cameraOptions;
            options.splat.between = between;
            const Camera camera = test::cameraOf(volume, cameraOptions);
            const Channels channels = channelsOf(
                volume, options, camera, {Aov::kDepth, Aov::kFront, Aov::kBack, Aov::kPosition});
            int met = 0;
            int missed = 0;
            for (int y = 0; y < camera.sizePixels.y; ++y) {
                for (int x = 0; x < camera.sizePixels.x; ++x) {
                    const auto i = indexOf(camera, x, y);
                    const Sight sight = sightOf(camera, x, y);
                    const double along = -glm::dot(sight.from, sight.way);
                    const double square = glm::dot(sight.from, sight.from) - along * along;
                    const float front = channels.at("depth_front.Z")[i];
                    if (square > 1.15 * r * r || along < 0) {
                        EXPECT_EQ(front, kNoDepth);
                        ++missed;
                    }
                    // Not where it is met at a grazing angle.
                    if (square > 0.8 * r * r || along < 0) continue;
                    ++met;
                    const double depth = sight.depthOfOne * (along - std::sqrt(r * r - square));
                    for (const char* name : {"Z", "depth_front.Z"})
                        EXPECT_LT(errorOf(channels.at(name)[i], depth), 0.5 * voxel) << name;
                    EXPECT_GE(channels.at("ZBack")[i], front);
                    EXPECT_LT(channels.at("ZBack")[i], depth + 5 * voxel);
                    const glm::dvec3 place(channels.at("P.X")[i], channels.at("P.Y")[i],
                                           channels.at("P.Z")[i]);
                    EXPECT_LT(std::abs(glm::length(place) - r),
                              (between == 0 ? 0.25 : 0.15) * voxel);
                    EXPECT_LT(glm::length(glm::cross(place - sight.from, sight.way)), 1e-5);
                }
            }
            EXPECT_GT(met, 150);
            EXPECT_GT(missed, 150);
        }
    }
}

}  // namespace
}  // namespace deltasplat
