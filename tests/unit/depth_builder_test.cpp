// SPDX-License-Identifier: Apache-2.0
#include "screen/deep_builder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "deltasplat/memory_limit.h"
#include "deltasplat/render_aovs.h"
#include "support/error_of.h"

namespace deltasplat {
namespace {

using Growth = DepthBuilder::Growth;

// Looks along x, from 10 before its origin.
Camera someCamera() {
    Camera camera;
    camera.direction = {1, 0, 0};
    camera.right = {0, 0, 1};
    camera.targetDistanceWorld = 10;
    camera.sizePixels = {1, 1};
    return camera;
}

struct Told {
    float front;
    float back;
    float mean;
    float samples;
};

// Of a pixel that has these alphas after each stage, one slice each: slices lie 0.5 apart from a
// depth of 13 on.
Told toldOf(const std::vector<float>& alphas, double opacity, Growth growth = Growth::kFog) {
    DepthBuilder builder(someCamera(), opacity, growth);
    glm::dmat4 worldFromSlices(1);
    worldFromSlices[0] = {0.5, 0, 0, 0};
    worldFromSlices[3] = {3, 0, 0, 1};
    builder.begin(std::make_shared<const SliceDepths>(someCamera(), worldFromSlices));
    Image image({1, 1});
    for (std::size_t i = 0; i < alphas.size(); ++i) {
        image.rgba[3] = alphas[i];
        builder.add(image, double(i), double(i) + 1);
    }
    return {builder.front()[0], builder.back()[0], builder.mean()[0], builder.samples()[0]};
}

TEST(DepthBuilder, fogIsPassedWhereItsAlphaIs) {
    // Half of what is left in each slice.
    const std::vector<float> alphas{0.5f, 0.75f, 0.875f};
    for (const double opacity : {0.2, 0.5, 0.6, 0.8}) {
        const double slices = -std::log2(1 - opacity);
        EXPECT_NEAR(toldOf(alphas, opacity).front, 13 + 0.5 * slices, 1e-6);
    }
    EXPECT_EQ(toldOf(alphas, 0.9).front, kNoDepth);
    // What is opaque begins where its slice does.
    EXPECT_EQ(toldOf({0.25f, 1}, 0.9).front, 13.5f);
}

TEST(DepthBuilder, whatIsTakenAwayAgainWasNotPassed) {
    EXPECT_GT(toldOf({0.25f, 0.5625f, 0.4375f, 0.75f}, 0.5).front, 14.5f);
    EXPECT_EQ(toldOf({0.5625f, 0.4375f}, 0.5).front, kNoDepth);
    EXPECT_EQ(toldOf({0.5f, 0}, 0.3).mean, kNoDepth);
}

TEST(DepthBuilder, theBackIsWhereAlphaHasGrownForTheLastTime) {
    EXPECT_EQ(toldOf({0, 0.5f, 0.5f, 0.6f, 0.6f}, 0.5).back, 15.0f);
    EXPECT_EQ(toldOf({0, 0.5f, 0.5005f}, 0.5).back, 14.0f);
    // What grows slowly does so all the same.
    EXPECT_EQ(toldOf({0, 0.5f, 0.5005f, 0.501f}, 0.5).back, 15.0f);
    EXPECT_EQ(toldOf({0, 0}, 0.5).back, kNoDepth);
}

TEST(DepthBuilder, theMeanIsByGrowth) {
    EXPECT_FLOAT_EQ(toldOf({0.5f}, 0.5).mean, 13.25f);
    EXPECT_FLOAT_EQ(toldOf({0.25f, 0.25f, 1}, 0.5).mean, 0.25f * 13.25f + 0.75f * 14.25f);
    // It stays between the first and the last.
    EXPECT_FLOAT_EQ(toldOf({0.5f, 0.001f}, 0.5).mean, 13.25f);
    EXPECT_FLOAT_EQ(toldOf({0.5f, 0.75f, 0.01f}, 0.5).mean, 13.25f + 0.5f / 3);
}

// What a surface's voxel hides it does evenly from the front of its slice to the back.
TEST(DepthBuilder, surfacesAreMetWithinTheirSlices) {
    const Told told = toldOf({0, 0.25f, 1}, 0.5, Growth::kSurface);
    EXPECT_NEAR(told.front, 13 + 0.5 * (2 + 0.25 / 0.75), 1e-6);
    EXPECT_NEAR(toldOf({0, 0.5f, 1}, 0.5, Growth::kSurface).front, 13 + 0.5 * 2, 1e-6);
    EXPECT_NEAR(toldOf({0, 0.5f, 1}, 0.5, Growth::kSurface).mean, 13 + 0.5 * 2, 1e-6);
}

TEST(DepthBuilder, samplesAreStagesThatAreSeen) {
    EXPECT_EQ(toldOf({0, 0.5f, 0.5f, 0.75f, 0}, 0.5).samples, 2);
    EXPECT_EQ(toldOf({0.5f, 0.9995f, 1}, 0.5).samples, 2);
    EXPECT_EQ(toldOf({0, 0}, 0.5).samples, 0);
}

TEST(DepthBuilder, saysHowMuchMemoryIsMissing) {
    Camera camera = someCamera();
    camera.sizePixels = {1000, 1000};
    setMemoryLimit(1);
    const std::string error = test::errorOf([&] { DepthBuilder(camera, 0.5, Growth::kFog); });
    setMemoryLimit(0);
    EXPECT_EQ(error.find("failed: `aovs` of depth: needs 38.1 MiB of memory; expected at most 0 "),
              0u)
        << error;
}

}  // namespace
}  // namespace deltasplat
