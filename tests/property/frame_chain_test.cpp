// SPDX-License-Identifier: Apache-2.0
// Frames that take from the frame before what has not changed are those that are rendered anew.
#include "deltasplat/frame_chain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <glm/vector_relational.hpp>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "deltasplat/error.h"
#include "deltasplat/threads.h"
#include "support/error_of.h"
#include "support/small_joined.h"
#include "support/some_scene.h"

namespace deltasplat {
namespace {

using test::Colors;
using test::someCameras;
using test::someOptics;

constexpr IndexBox kBox{{-3, 0, 5}, {44, 37, 52}};

// What of the volume is something else than at first.
struct Change {
    IndexBox box{};  // no voxels
    int code = 0;    // there, and the next ones
    int most = 254;  // code of one voxel that has more than all others
    IndexBox whole = kBox;
};

// Blocks of 3x2x3 voxels of even codes up to 250, a quarter of them inactive.
int codeAt(const glm::ivec3& p) {
    std::uint32_t hash = std::uint32_t((p.x + 30) / 3) * 73856093u ^
                         std::uint32_t((p.y + 30) / 2) * 19349663u ^
                         std::uint32_t((p.z + 30) / 3) * 83492791u;
    hash = (hash ^ (hash >> 13)) * 0x5bd1e995u;
    hash ^= hash >> 15;
    return hash % 4 == 0 ? test::kInactive : int(hash / 4 % 126) * 2;
}

Volume volumeOf(const Change& change) {
    return test::makeVolume(change.whole,
                            [&](int x, int y, int z) {
                                const glm::ivec3 p(x, y, z);
                                const IndexBox& box = change.box;
                                if (p == glm::ivec3(0, 1, 6)) return change.most;
                                const bool isChanged =
                                    glm::all(glm::greaterThanEqual(p, box.min)) &&
                                    glm::all(glm::lessThanEqual(p, box.max));
                                return isChanged ? change.code + (x + y + z) % 3 * 2 : codeAt(p);
                            },
                            {1, 1.2, 0.8});
}

// At rest, whole blocks, beside which gradients change as well, the same again, others in the
// middle and of codes that were not there before.
std::vector<Change> someChanges() {
    return {{},
            {{{32, 24, 40}, {39, 31, 47}}, 120},
            {{{32, 24, 40}, {39, 31, 47}}, 120},
            {{{10, 15, 20}, {16, 19, 25}}, 121},
            {}};
}

RenderOptions optionsFor(Colors colors, const CameraOptions& camera) {
    RenderOptions options;
    options.optics = someOptics(colors);
    options.camera = camera;
    return options;
}

// Renders frames in a chain, and expects what is rendered by itself.
std::vector<RenderStats> statsOfChain(const std::vector<Volume>& frames,
                                      const RenderOptions& options) {
    FrameChain chain(frames.size());
    std::vector<RenderStats> stats;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const RenderResult result = chain.begin(i).render(frames[i], options);
        const RenderResult expected = render(frames[i], options);
        EXPECT_EQ(result.image.rgba, expected.image.rgba) << "frame " << i;
        EXPECT_FALSE(expected.stats.changed);
        stats.push_back(result.stats);
    }
    return stats;
}

std::vector<Volume> volumesOf(const std::vector<Change>& changes) {
    std::vector<Volume> volumes;
    for (const Change& change : changes) volumes.push_back(volumeOf(change));
    return volumes;
}

bool scatters(Colors colors) {
    return colors == Colors::kFog || colors == Colors::kFire;
}

TEST(FrameChain, givesThePixelsOfFramesByThemselves) {
    const test::SmallJoined joined;
    const std::vector<Volume> frames = volumesOf(someChanges());
    for (const Colors colors : {Colors::kOne, Colors::kSeveral, Colors::kOwn, Colors::kLit,
                                Colors::kFog, Colors::kFire}) {
        for (const CameraOptions& camera : test::smallCamerasToo()) {
            const std::vector<RenderStats> stats = statsOfChain(frames, optionsFor(colors, camera));
            EXPECT_FALSE(stats[0].changed);
            EXPECT_EQ(stats[0].kept, 0);
            EXPECT_EQ(stats[2].changed.has_value(), !scatters(colors));
            EXPECT_EQ(stats[2].kept, scatters(colors) ? 0 : 1);
            if (scatters(colors)) continue;
            EXPECT_EQ(*stats[2].changed, 0);
            EXPECT_GT(*stats[1].changed, 0);
            EXPECT_LT(*stats[1].changed, 0.5);
        }
    }
}

TEST(FrameChain, keepsTheRowsThatSeeNothingNew) {
    const std::vector<Volume> frames = volumesOf(someChanges());
    for (const Method method :
         {Method::kAuto, Method::kTraditional, Method::kSparse, Method::kDelta}) {
        for (const double tolerance : {0.0, 0.1}) {
            for (const Colors colors : {Colors::kOne, Colors::kSeveral, Colors::kLit}) {
                RenderOptions options = optionsFor(colors, someCameras()[0]);
                options.method = method;
                options.camera.sizePixels = {44, 36};  // voxels are not divided
                options.tolerance.relative = tolerance;
                const std::vector<RenderStats> stats = statsOfChain(frames, options);
                // 8 of 38 rows differ, and more by their footprints and gradients.
                EXPECT_GT(stats[1].kept, 0.4) << methodName(method);
                EXPECT_LT(stats[1].kept, 0.9) << methodName(method);
                // Classes are numbered otherwise where there are more of them.
                ASSERT_EQ(stats[3].parts, 1);
                EXPECT_LT(*stats[3].changed, 0.5);
                if (colors == Colors::kLit)
                    EXPECT_EQ(stats[3].kept, 0);
                else
                    EXPECT_GT(stats[3].kept, 0.3) << methodName(method);
            }
        }
    }
}

TEST(FrameChain, keepsRowsOfSheetsThatVoxelsShare) {
    const std::vector<Volume> frames = volumesOf(someChanges());
    for (const double resolution : {0.5, 0.25, 0.125, 2.0}) {
        for (const std::size_t camera : {0, 1, 3, 5}) {
            RenderOptions options = optionsFor(Colors::kSeveral, someCameras()[camera]);
            options.camera.sizePixels = {44, 36};
            options.resolution = resolution;
            const std::vector<RenderStats> stats = statsOfChain(frames, options);
            EXPECT_EQ(stats[2].changed, 0.0);
            EXPECT_EQ(stats[2].kept, 1.0);
        }
    }
}

// All voxels are of one class; what they reflect depends on their gradients.
TEST(FrameChain, seesThatLooksHaveChanged) {
    const IndexBox box{{12, 12, 20}, {12, 12, 20}};
    const std::vector<Volume> frames = volumesOf({{box, 100}, {box, 200}, {box, 200}});
    RenderOptions options = optionsFor(Colors::kLit, someCameras()[0]);
    options.camera.sizePixels = {44, 36};
    options.optics.transferFunction.colors = {{0, {1, 0, 0.5}}};
    options.optics.transferFunction.opacities = {{0, 0.3, 0.5, 0}, {255, 0.3, 0.5, 0}};
    const std::vector<RenderStats> stats = statsOfChain(frames, options);
    ASSERT_EQ(stats[1].parts, 1);
    EXPECT_EQ(stats[0].visible, stats[1].visible);
    ASSERT_TRUE(stats[1].changed);
    EXPECT_GT(*stats[1].changed, 0);
    EXPECT_LT(*stats[1].changed, 0.5);
    EXPECT_EQ(stats[2].changed, 0.0);
}

TEST(FrameChain, rendersAnewWhatIsStatedInOtherUnits) {
    Change brighter;
    brighter.most = 255;
    Change larger;
    larger.whole.max.y += 8;
    const std::vector<Volume> frames = volumesOf({{}, brighter, {}, larger, {}});
    for (const Colors colors : {Colors::kOne, Colors::kSeveral, Colors::kOwn, Colors::kLit}) {
        RenderOptions options = optionsFor(colors, someCameras()[5]);
        // A level of opacity for each code.
        options.optics.transferFunction.opacities = {{0, 0, 0.5, 0}, {255, 0.4, 0.5, 0}};
        const std::vector<RenderStats> stats = statsOfChain(frames, options);
        for (std::size_t i = 1; i < stats.size(); ++i) {
            EXPECT_EQ(stats[i].kept, 0) << i;
            // Another box has other slices and slabs.
            EXPECT_EQ(stats[i].changed.has_value(), i < 3) << i;
        }
    }
}

TEST(FrameChain, seesWhereTheCameraHasMoved) {
    const Volume volume = volumeOf({});
    FrameChain chain(4);
    for (std::size_t i = 0; i < 4; ++i) {
        const RenderOptions options = optionsFor(Colors::kLit, someCameras()[2 * i]);
        const RenderResult result = chain.begin(i).render(volume, options);
        EXPECT_EQ(result.image.rgba, render(volume, options).image.rgba);
        EXPECT_EQ(result.stats.kept, 0);
    }
}

// Of every third frame there is none, and every fifth fails.
TEST(FrameChain, isRenderedByManyThreads) {
    constexpr std::size_t kFrames = 30;
    const std::vector<Volume> volumes = volumesOf(someChanges());
    const RenderOptions options = optionsFor(Colors::kSeveral, someCameras()[1]);
    std::vector<Image> expected;
    for (const Volume& volume : volumes) expected.push_back(render(volume, options).image);
    std::vector<RenderResult> results(kFrames);
    const auto isAbsent = [](std::size_t i) { return i % 3 == 2; };
    const auto fails = [](std::size_t i) { return i % 5 == 3; };
    {
        FrameChain chain(kFrames);
        std::atomic<std::size_t> next{0};
        const auto work = [&] {
            const ThreadLimit limit(2);
            for (std::size_t i = next++; i < kFrames; i = next++) {
                Listener listener;
                listener.progress = [&](double share) {
                    if (fails(i) && share > 0.3) throw std::runtime_error("stopped");
                };
                FrameChain::Frame frame = chain.begin(i);
                try {
                    if (!isAbsent(i))
                        results[i] = frame.render(volumes[i % volumes.size()], options, listener);
                } catch (const std::runtime_error&) {
                    results[i] = {};
                }
            }
        };
        std::vector<std::jthread> threads;
        for (int i = 0; i < 4; ++i) threads.emplace_back(work);
    }
    for (std::size_t i = 0; i < kFrames; ++i) {
        if (isAbsent(i) || fails(i)) {
            EXPECT_TRUE(results[i].image.rgba.empty()) << i;
            continue;
        }
        EXPECT_EQ(results[i].image.rgba, expected[i % volumes.size()].rgba) << i;
        EXPECT_EQ(results[i].stats.changed.has_value(), i > 0 && !isAbsent(i - 1)) << i;
    }
}

TEST(FrameChain, goesOnBehindAnEmptyFrame) {
    const Volume nothing = test::makeVolume({}, [](int, int, int) { return test::kInactive; });
    const Volume volume = volumeOf({});
    RenderOptions options = optionsFor(Colors::kOne, someCameras()[0]);
    options.camera.targetWorld = {20, 20, 20};
    options.camera.frameWidthWorld = 60;
    FrameChain chain(5);
    std::size_t frame = 0;
    for (const Volume* one : {&nothing, &volume, &nothing, &nothing, &volume}) {
        const RenderResult result = chain.begin(frame++).render(*one, options);
        EXPECT_EQ(result.image.rgba, render(*one, options).image.rgba);
        EXPECT_FALSE(result.stats.changed);
    }
}

TEST(FrameChain, refusesModesThatHaveNoLayers) {
    RenderOptions options;
    options.mode = Mode::kMip;
    FrameChain chain(1);
    EXPECT_EQ(test::errorOf([&] { chain.begin(0).render(volumeOf({}), options); }),
              "usage: mode of a frame after another: got mip; expected composite");
}

}  // namespace
}  // namespace deltasplat
