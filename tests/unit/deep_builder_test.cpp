// SPDX-License-Identifier: Apache-2.0
#include "screen/deep_builder.h"

#include <gtest/gtest.h>

#include <vector>

#include "deltasplat/memory_limit.h"
#include "deltasplat/render_deep.h"
#include "picture/extras/render_deep.h"
#include "support/error_of.h"

namespace deltasplat {
namespace {

using test::errorOf;

// Looks along x, from 10 before its origin, at slices that lie 0.5 apart from x = 3 on.
std::shared_ptr<const SliceDepths> someDepths(glm::ivec2 size) {
    Camera camera;
    camera.direction = {1, 0, 0};
    camera.right = {0, 0, 1};
    camera.targetDistanceWorld = 10;
    camera.sizePixels = size;
    glm::dmat4 worldFromSlices(1);
    worldFromSlices[0] = {0.5, 0, 0, 0};
    worldFromSlices[3] = {3, 0, 0, 1};
    return std::make_shared<const SliceDepths>(camera, worldFromSlices);
}

// What one pixel's samples are, where a row looks like this after each stage.
std::vector<DeepSample> samplesOf(const std::vector<glm::vec4>& states) {
    DeepBuilder builder({1, 1}, 1);
    builder.begin(someDepths({1, 1}));
    Image image({1, 1});
    for (std::size_t i = 0; i < states.size(); ++i) {
        for (int c = 0; c < 4; ++c) image.rgba[std::size_t(c)] = states[i][c];
        builder.add(image, double(i), double(i) + 1);
    }
    const DeepImage deep = builder.finish();
    const auto samples = deep.pixel(0, 0);
    return {samples.begin(), samples.end()};
}

TEST(DeepBuilder, whatIsBehindIsSeenThroughWhatIsInFront) {
    const auto samples = samplesOf({{0.25f, 0, 0.5f, 0.5f}, {0.5f, 0.125f, 0.5f, 0.75f}});
    ASSERT_EQ(samples.size(), 2u);
    EXPECT_EQ(samples[0].rgba, glm::vec4(0.25f, 0, 0.5f, 0.5f));
    EXPECT_EQ(samples[1].rgba, glm::vec4(0.5f, 0.25f, 0, 0.5f));
    EXPECT_EQ(samples[0].z, 13.0f);
    EXPECT_EQ(samples[0].zBack, 13.5f);
    EXPECT_EQ(samples[1].z, 13.5f);
    EXPECT_EQ(samples[1].zBack, 14.0f);
}

TEST(DeepBuilder, aStageThatChangesNothingHasNoSample) {
    const glm::vec4 color(0.2f, 0.1f, 0, 0.3f);
    const auto samples = samplesOf({glm::vec4(0), color, color, color});
    ASSERT_EQ(samples.size(), 1u);
    EXPECT_EQ(samples[0].z, 13.5f);
}

TEST(DeepBuilder, lightWithoutAlphaIsKept) {
    const auto samples = samplesOf({{0.5f, 0, 0, 0}, {0.75f, 0.5f, 0, 0.5f}});
    ASSERT_EQ(samples.size(), 2u);
    EXPECT_EQ(samples[0].rgba, glm::vec4(0.5f, 0, 0, 0));
    EXPECT_EQ(samples[1].rgba, glm::vec4(0.25f, 0.5f, 0, 0.5f));
}

// What a filter shows behind it all the same is added to what is there.
TEST(DeepBuilder, nothingIsSeenBehindWhatIsOpaque) {
    for (const float opaque : {1.0f, 0.9999f}) {
        const glm::vec4 last(1, 0.5f, 0.75f, 1);
        const auto samples = samplesOf({{0.5f, 0.25f, 0.25f, 0.5f}, {1, 0.5f, 0.5f, opaque}, last});
        ASSERT_EQ(samples.size(), 2u);
        EXPECT_EQ(samples[1].rgba, glm::vec4(1, 0.5f, 1, 1));
        EXPECT_EQ(samples[1].zBack, 14.0f);
    }
    EXPECT_EQ(samplesOf({{1, 1, 1, 0.998f}, {1, 1, 1, 1}}).size(), 2u);
}

// A filter that overshoots may take away what it has shown before.
TEST(DeepBuilder, noSampleTakesLightAway) {
    const glm::vec4 last(0.25f, 0.5f, 0, 0.5f);
    const auto samples = samplesOf({{0.5f, 0.25f, 0, 0.75f}, {0.375f, 0.5f, 0, 0.625f}, last});
    glm::dvec4 sum(0);
    for (const DeepSample& sample : samples) {
        for (int c = 0; c < 4; ++c) EXPECT_GE(sample.rgba[c], 0);
        sum += (1 - sum.a) * glm::dvec4(sample.rgba);
    }
    for (int c = 0; c < 4; ++c) EXPECT_NEAR(sum[c], last[c], 1e-7) << c;
}

TEST(DeepBuilder, pixelsHaveTheSamplesThatAreTheirs) {
    const glm::ivec2 size(40, 3);
    DeepBuilder builder(size, 1);
    builder.begin(someDepths(size));
    Image image(size);
    // Near each other and far apart, and one stage of another row.
    for (const int x : {3, 5, 20, 39}) image.pixel(x, 1)[3] = 0.5f;
    builder.add(image, 0, 1);
    image.pixel(39, 2)[3] = 0.25f;
    builder.add(image, 1, 2);
    for (const int x : {4, 5, 39}) image.pixel(x, 1)[3] = 0.75f;
    builder.add(image, 2, 3);
    const DeepImage deep = builder.finish();
    EXPECT_EQ(deep.size, size);
    EXPECT_EQ(deep.samples(), 8u);
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            const bool isFirst = y == 1 && (x == 3 || x == 5 || x == 20 || x == 39);
            const bool isSecond = y == 2 && x == 39;
            const bool isThird = y == 1 && (x == 4 || x == 5 || x == 39);
            const auto samples = deep.pixel(x, y);
            ASSERT_EQ(samples.size(), std::size_t(isFirst + isSecond + isThird)) << x << "," << y;
            if (samples.empty()) continue;
            EXPECT_EQ(samples[0].z, isFirst ? 13.0f : isSecond ? 13.5f : 14.0f);
            EXPECT_EQ(samples.back().z, isThird ? 14.0f : samples[0].z);
        }
    }
}

TEST(DeepBuilder, depthsAreNeitherNegativeNorTurnedAround) {
    DeepBuilder builder({1, 1}, 1);
    builder.begin(someDepths({1, 1}));
    Image image({1, 1});
    const float alphas[] = {0.25f, 0.5f, 0.75f};
    const double fronts[] = {-100, -30, 1e9};
    const double backs[] = {-50, 2, 1e9 + 1e-3};
    for (int i = 0; i < 3; ++i) {
        image.rgba[3] = alphas[i];
        builder.add(image, fronts[i], backs[i]);
    }
    const DeepImage deep = builder.finish();
    const auto samples = deep.pixel(0, 0);
    ASSERT_EQ(samples.size(), 3u);
    EXPECT_EQ(samples[0].z, 0);
    EXPECT_EQ(samples[0].zBack, 0);
    EXPECT_EQ(samples[1].z, 0);
    EXPECT_EQ(samples[1].zBack, 14);
    EXPECT_GE(samples[2].zBack, samples[2].z);
}

TEST(DeepBuilder, saysHowMuchMemoryIsMissing) {
    DeepBuilder builder({1000, 1000}, 3);
    builder.begin(someDepths({1000, 1000}));
    Image image({1000, 1000});
    std::fill(image.rgba.begin(), image.rgba.end(), 0.5f);
    setMemoryLimit(1);
    const std::string error = errorOf([&] { builder.add(image, 0, 1); });
    setMemoryLimit(0);
    EXPECT_EQ(error.find("failed: samples of a deep picture, `slicesPerSample` 3: needs 15.3 MiB "
                         "of memory; expected at most 0 bytes"),
              0u)
        << error;
}

// Slabs of these slices each, of which all are seen.
std::vector<DeepCut> cutsOf(const std::vector<glm::ivec2>& slabs, bool frontToBack,
                            const Subdivision& parts, int slicesPerSample) {
    std::vector<SeenSlab> seen;
    for (const glm::ivec2& slab : slabs) seen.push_back({nullptr, slab.x, slab.y});
    return cutInDepth(seen, frontToBack, parts, slicesPerSample);
}

std::vector<glm::ivec2> rangesOf(const std::vector<DeepCut>& cuts) {
    std::vector<glm::ivec2> ranges;
    for (const DeepCut& cut : cuts) ranges.emplace_back(cut.firstSlice, cut.lastSlice);
    return ranges;
}

using Ranges = std::vector<glm::ivec2>;

TEST(DeepCut, samplesEndAtMultiplesWhereverSlabsDo) {
    const Ranges slabs = {{-3, 7}, {8, 15}, {16, 18}};
    const auto cuts = cutsOf(slabs, true, {}, 5);
    EXPECT_EQ(rangesOf(cuts), (Ranges{{-3, -1}, {0, 4}, {5, 9}, {10, 14}, {15, 18}}));
    ASSERT_EQ(cuts[2].slabs.size(), 2u);
    EXPECT_EQ(cuts[2].slabs[0].lastSlice, 7);
    EXPECT_EQ(cuts[2].slabs[1].firstSlice, 8);
    EXPECT_EQ(rangesOf(cutsOf(slabs, true, {}, kMostSlicesPerSample)), (Ranges{{-3, -1}, {0, 18}}));
    EXPECT_EQ(cutsOf(slabs, true, {}, 1).size(), 22u);
}

TEST(DeepCut, goesFromTheFrontOn) {
    const auto cuts = cutsOf({{8, 15}, {-3, 7}}, false, {}, 5);
    EXPECT_EQ(rangesOf(cuts), (Ranges{{15, 15}, {10, 14}, {5, 9}, {0, 4}, {-3, -1}}));
    ASSERT_EQ(cuts[2].slabs.size(), 2u);
    EXPECT_EQ(cuts[2].slabs[0].firstSlice, 8);
    EXPECT_EQ(cuts[2].slabs[1].lastSlice, 7);
}

TEST(DeepCut, countsSlicesOfWholeVoxels) {
    Subdivision parts{3, 2};
    parts.origin.x = 8;
    // Thin slices from voxel 8 on: of voxels 10 to 15.
    EXPECT_EQ(rangesOf(cutsOf({{6, 23}}, true, parts, 4)), (Ranges{{6, 11}, {12, 23}}));
}

}  // namespace
}  // namespace deltasplat
