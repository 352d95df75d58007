// SPDX-License-Identifier: Apache-2.0
#include "../tools/bench/bench_runs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "../tools/bench/bench_words.h"
#include "../tools/render/render_stats.h"
#include "support/make_volume.h"

namespace deltasplat {
namespace {

Image imageOf(std::vector<float> rgba) {
    Image image(glm::ivec2(int(rgba.size() / 4), 1));
    image.rgba = std::move(rgba);
    return image;
}

TEST(Timing, MedianIsInTheMiddle) {
    EXPECT_EQ(timingOf({3, 1, 7}).median, 3);
    EXPECT_EQ(timingOf({3, 1, 7}).min, 1);
    EXPECT_EQ(timingOf({8, 1, 4, 2}).median, 3);
    EXPECT_EQ(timingOf({8, 1, 4, 2}).min, 1);
    EXPECT_EQ(timingOf({5}).median, 5);
    EXPECT_EQ(timingOf({}).median, 0);
    EXPECT_EQ(timingOf({}).min, 0);
}

TEST(PictureDifference, IsTheLargestOfColorAndOfAlpha) {
    const PictureDifference difference = differenceOf(imageOf({0, 0.5F, 1, 1, 0, 0, 0, 0.25F}),
                                                      imageOf({0.125F, 0.5F, 1, 1, 0, -2, 0, 1}));
    EXPECT_EQ(difference.color, 2);
    EXPECT_EQ(difference.alpha, 0.75);
}

TEST(BenchRun, ComparesMediansAndCounts) {
    BenchRun run;
    run.methods[0].stamps = 4;
    run.methods[0].splat = {1e-9, 2e-9};
    run.methods[0].render = {4, 6};
    run.methods[2].render = {1, 2};
    EXPECT_EQ(run.speedup(Method::kTraditional, Method::kDelta), 3);
    EXPECT_TRUE(std::isnan(run.speedup(Method::kTraditional, Method::kSparse)));
    EXPECT_EQ(run.methods[0].nanosecondsPerStamp(), 0.5);
    EXPECT_EQ(run.methods[1].nanosecondsPerStamp(), 0);
    EXPECT_EQ(run.comparability(), 1);
    run.stats.voxels = 8;
    run.stats.deltas = 2;
    EXPECT_EQ(run.comparability(), 0.75);
}

// A volume in which every method has other stamps.
Volume twoBlocks() {
    return test::makeVolume({glm::ivec3(0), glm::ivec3(19, 15, 39)}, [](int x, int y, int z) {
        return z > 10 && z < 30 && (x < 4 || y > 12) ? 200 : 0;
    });
}

RenderOptions optionsFor(const Volume& volume) {
    RenderOptions options;
    options.camera.sizePixels = {24, 20};
    options.optics.transferFunction = defaultRamp(volume);
    options.optics.transferFunction.opacities = {{0, 0}, {255, 0.5}};
    return options;
}

TEST(MeasureMethods, RendersWhatRenderRenders) {
    const Volume volume = twoBlocks();
    const RenderOptions options = optionsFor(volume);
    const BenchRun run = measureMethods(volume, options, 2);
    EXPECT_TRUE(run.identical);
    EXPECT_EQ(run.maxDifference, 0);
    EXPECT_EQ(run.repeats, 2);
    EXPECT_EQ(run.dims, glm::ivec3(20, 16, 40));
    EXPECT_FALSE(run.tolerance);
    for (std::size_t i = 0; i < kBenchMethods.size(); ++i) {
        RenderOptions one = options;
        one.splat.method = kBenchMethods[i];
        const RenderResult result = render(volume, one);
        EXPECT_EQ(run.methods[i].method, kBenchMethods[i]);
        EXPECT_EQ(run.methods[i].stamps, result.stats.stamps);
        EXPECT_EQ(run.picture.rgba, result.image.rgba);
        EXPECT_EQ(run.stats.deltas, result.stats.deltas);
        EXPECT_GE(run.methods[i].render.min, 0);
        EXPECT_LE(run.methods[i].render.min, run.methods[i].render.median);
        EXPECT_FALSE(run.methods[i].differs);
    }
    EXPECT_GT(run.of(Method::kSparse).stamps, run.of(Method::kDelta).stamps);
}

TEST(MeasureMethods, MeasuresTheExactPictureBesideATolerance) {
    // Two values near enough for one to be held in place of the other.
    const Volume volume =
        test::makeVolume({glm::ivec3(0), glm::ivec3(19, 15, 39)}, [](int x, int y, int z) {
            return z > 10 && z < 30 && (x < 4 || y > 12) ? 180 + 20 * (z % 2) : 0;
        });
    RenderOptions options = optionsFor(volume);
    options.optics.transferFunction.colors = {{0, {1, 1, 1}}};
    options.splat.tolerance.relative = 0.25;
    const BenchRun run = measureMethods(volume, options, 1);
    ASSERT_TRUE(run.tolerance);
    EXPECT_EQ(run.tolerance->tolerance.relative, 0.25);
    options.splat.tolerance = {};
    options.splat.method = Method::kDelta;
    const RenderResult exact = render(volume, options);
    EXPECT_EQ(run.tolerance->exact.rgba, exact.image.rgba);
    EXPECT_EQ(run.tolerance->exactStamps, exact.stats.stamps);
    EXPECT_GT(run.tolerance->exactStamps, run.stats.stamps);
    EXPECT_GT(run.tolerance->measured.alpha, 0);
    EXPECT_LE(run.tolerance->measured.color, run.tolerance->bound.color);
    EXPECT_LE(run.tolerance->measured.alpha, run.tolerance->bound.alpha);
}

TEST(MeasureMethods, ReportsBetweenPicturesAndCanBeStopped) {
    const Volume volume = twoBlocks();
    std::vector<double> shares;
    Listener listener;
    listener.progress = [&](double share) {
        if (shares.empty() || shares.back() != share) shares.push_back(share);
    };
    measureMethods(volume, optionsFor(volume), 1, listener);
    ASSERT_EQ(shares.size(), 9u);
    for (std::size_t i = 0; i < shares.size(); ++i) EXPECT_EQ(shares[i], double(i) / 8);

    listener.progress = [](double share) {
        if (share > 0.5) throw std::runtime_error("stopped");
    };
    EXPECT_THROW(measureMethods(volume, optionsFor(volume), 1, listener), std::runtime_error);
}

TEST(BenchWords, AreExactAboutNumbers) {
    EXPECT_EQ(millisecondsText(0.0123456), "12.35");
    EXPECT_EQ(millisecondsText(0.0000123), "0.012");
    EXPECT_EQ(millisecondsText(0), "0.000");
    EXPECT_EQ(fixedText(std::numeric_limits<double>::quiet_NaN(), 2), "-");
    EXPECT_EQ(errorText(0.0123456), "0.0123");
    EXPECT_EQ(errorText(std::numeric_limits<double>::infinity()), "none known");
    EXPECT_EQ(groupedText(999), "999");
    EXPECT_EQ(groupedText(1234567), "1\u202f234\u202f567");
    EXPECT_EQ(toleranceText({0.5, 2}), "0.5 of the colour and 2 data units");
    EXPECT_EQ(toleranceText({0, 2}), "2 data units");
    EXPECT_EQ(toleranceText({}), "0");
}

TEST(BenchWords, SayWhenPixelsDiffer) {
    BenchRun run;
    run.repeats = 3;
    EXPECT_EQ(identityText(run), "the same, bit for bit: all methods, 4 rounds each");
    run.identical = false;
    run.maxDifference = 0.25;
    EXPECT_EQ(identityText(run), "DIFFERENT by up to 0.25: all methods, 4 rounds each");
}

}  // namespace
}  // namespace deltasplat
