// SPDX-License-Identifier: Apache-2.0
#include "rays/ray_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <string>

#include "deltasplat/ingest/slot.h"
#include "deltasplat/simd.h"
#include "rays/block_kernels.h"
#include "support/simd_levels.h"

namespace deltasplat {
namespace {

using test::atEveryLevel;

std::vector<float> randomValues(std::size_t count, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(-2, 3);
    std::vector<float> values(count);
    for (float& value : values) value = uniform(random);
    return values;
}

TEST(RayKernels, BlocksAreReadInSliceOrder) {
    std::vector<Code> codes(512);
    std::iota(codes.begin(), codes.end(), Code(65535 - 511));
    std::vector<float> table(kCodeCount);
    for (int code = 0; code < kCodeCount; ++code) table[code] = std::sqrt(float(code));
    for (const bool direct : {false, true}) {
        const CodeValues values{table.data(), -1000, direct};
        for (int axis = 0; axis < 3; ++axis) {
            atEveryLevel([&] {
                const std::size_t rowStep = 24;
                const std::size_t sliceStep = 8 * rowStep + 3;
                std::vector<float> out(8 * sliceStep, -7);
                readBlockValues(codes.data(), axis, values, {&out[5], sliceStep, rowStep});
                for (int s = 0; s < 8; ++s) {
                    for (int u = 0; u < 8; ++u) {
                        for (int v = -1; v < 9; ++v) {
                            const float got = out[5 + s * sliceStep + u * rowStep + v];
                            if (v == -1 || v == 8) {
                                ASSERT_EQ(got, -7) << "beside the block";
                                continue;
                            }
                            const glm::ivec3 xyz = fromSliceOrder({s, u, v}, axis);
                            const Code code = codes[64 * xyz.x + 8 * xyz.y + xyz.z];
                            ASSERT_EQ(got, direct ? float(code - 1000) : table[code]);
                        }
                    }
                }
            });
        }
    }
}

// Slices of random values, or equal ones, and rays through them.
struct Scene {
    static constexpr int kSlices = 6, kU = 24, kV = 27;
    static constexpr std::size_t kRays = 64;
    std::vector<float> values, active, tops;
    std::vector<std::size_t> bundles;
    std::vector<std::int32_t> wholeU, wholeV;
    std::vector<float> u, v, slopeU, slopeV, firstSlice, found, rest, met;

    explicit Scene(float start) : values(randomValues(kSlices * kU * kV + 4, 1)) {
        std::mt19937 random(7);
        std::uniform_real_distribution<float> uniform(0, 1);
        for (std::size_t i = 0; i < kRays; ++i) {
            wholeU.push_back(2 + int(i % 12));
            wholeV.push_back(2 + int(i * 7 % 14));
            u.push_back(uniform(random));
            v.push_back(uniform(random));
            // Straight, from corner to corner, nearly straight, and anything.
            slopeU.push_back(i < 16 ? float(i & 1) : i < 32 ? 0x1p-20f : uniform(random));
            slopeV.push_back(i < 16 ? float(i >> 1 & 1) : i < 32 ? 0.4f : uniform(random));
            if (i % 5 == 0) u.back() = 0;
            firstSlice.push_back(-100);
        }
        for (std::size_t i = 0; i < kRays / kRayBundle; ++i) bundles.push_back(i);
        found.assign(kRays, start);
        rest.assign(kRays, 0);
        met.assign(kRays, 0);
    }
    RayPatch patch(bool leavesOut = false) {
        RayPatch patch;
        patch.values = values.data();
        patch.active = active.empty() ? nullptr : active.data();
        patch.sliceStep = kU * kV;
        patch.slices = kSlices;
        patch.sizeU = kU;
        patch.sizeV = kV;
        patch.leavesOut = leavesOut;
        patch.topsU = (kU + kTopCell - 1) / kTopCell;
        patch.topsV = (kV + kTopCell - 1) / kTopCell;
        tops.assign(std::size_t(kSlices * patch.topsU * patch.topsV), 1e30f);
        patch.tops = tops.data();
        return patch;
    }
    RayRun run() {
        return {bundles.data(),    bundles.size(), wholeU.data(), wholeV.data(),
                u.data(),          v.data(),       slopeU.data(), slopeV.data(),
                firstSlice.data(), found.data(),   rest.data(),   met.data()};
    }
    // Reads a slice bilinearly at the place where a ray is on its way.
    double read(const std::vector<float>& of, std::size_t ray, int slice, double way) const {
        const double x = wholeU[ray] + double(u[ray]) + way * double(slopeU[ray]);
        const double y = wholeV[ray] + double(v[ray]) + way * double(slopeV[ray]);
        double sum = 0;
        for (int i = 0; i < kU; ++i) {
            for (int j = 0; j < kV; ++j) {
                const double weight =
                    std::max(0.0, 1 - std::abs(x - i)) * std::max(0.0, 1 - std::abs(y - j));
                if (weight > 0) sum += weight * double(of[std::size_t((slice * kU + i) * kV + j)]);
            }
        }
        return sum;
    }
};

// The integral of each slice's share, by the rule of the midpoint.
TEST(RayKernels, SlicesAddTheIntegralOfTheirShare) {
    Scene scene(3);
    scene.firstSlice[5] = 2;
    std::vector<double> expected;
    constexpr int kSteps = 1000;
    for (std::size_t ray = 0; ray < Scene::kRays; ++ray) {
        double sum = 3;
        for (int slice = int(std::max(scene.firstSlice[ray], 0.0f)); slice < Scene::kSlices;
             ++slice) {
            for (int k = 0; k < kSteps; ++k) {
                const double off = -1 + 2 * (k + 0.5) / kSteps;
                sum += (1 - std::abs(off)) * 2 / kSteps *
                       scene.read(scene.values, ray, slice, slice + off);
            }
        }
        expected.push_back(sum);
    }
    std::vector<float> first;
    atEveryLevel([&] {
        Scene again = scene;
        sumSlices(again.patch(), again.run());
        for (std::size_t i = 0; i < Scene::kRays; ++i)
            ASSERT_NEAR(again.found[i], expected[i], 1e-4) << i;
        if (first.empty()) first = again.found;
        ASSERT_EQ(again.found, first);
    });
}

// The largest of what is read every eighth of a slice; where only active voxels take part, of their
// means by weights.
TEST(RayKernels, LargestValuesAreThoseThatAreRead) {
    for (const bool leavesOut : {false, true}) {
        Scene scene(-100);
        for (std::size_t i = 0; i < scene.values.size(); ++i) {
            scene.active.push_back(i * 7919 % 11 < 2 ? 0.0f : 1.0f);
            if (leavesOut && scene.active[i] == 0) scene.values[i] = 0;
        }
        scene.firstSlice[5] = 1.5f;
        std::vector<double> expected;
        for (std::size_t ray = 0; ray < Scene::kRays; ++ray) {
            double largest = -100;
            for (int k = 0; k < kRaySteps * (Scene::kSlices - 1); ++k) {
                const double way = double(k) / kRaySteps;
                if (way < double(scene.firstSlice[ray])) continue;
                const int slice = int(way);
                const auto between = [&](const std::vector<float>& of) {
                    const double here = scene.read(of, ray, slice, way);
                    return here + (way - slice) * (scene.read(of, ray, slice + 1, way) - here);
                };
                const double share = between(scene.active);
                if (leavesOut && share < 1e-5) continue;
                largest = std::max(largest, between(scene.values) / (leavesOut ? share : 1));
            }
            expected.push_back(largest);
        }
        std::vector<float> first;
        atEveryLevel([&] {
            Scene again = scene;
            maxSlices(again.patch(leavesOut), again.run());
            for (std::size_t i = 0; i < Scene::kRays; ++i) {
                ASSERT_NEAR(again.found[i], expected[i], 2e-4) << i;
                ASSERT_EQ(again.met[i], 1);
            }
            if (first.empty()) first = again.found;
            ASSERT_EQ(again.found, first);
        });
    }
}

// Whether anything is met is a matter of active voxels, and what is met of the first of equal ones.
TEST(RayKernels, OnlyActiveVoxelsAreMet) {
    Scene scene(-100);
    std::fill(scene.values.begin(), scene.values.end(), 2.0f);
    scene.active.assign(scene.values.size(), 0.0f);
    atEveryLevel([&] {
        Scene none = scene, all = scene;
        maxSlices(none.patch(), none.run());
        std::fill(all.active.begin(), all.active.end(), 1.0f);
        maxSlices(all.patch(), all.run());
        for (std::size_t i = 0; i < Scene::kRays; ++i) {
            ASSERT_EQ(none.met[i], 0);
            ASSERT_EQ(all.met[i], 1);
            ASSERT_NEAR(all.found[i], 2, 1e-6);
            ASSERT_LE(all.rest[i], 4);
        }
    });
}

// Sums of very many slices are off by no more than one rounding.
TEST(RayKernels, SumsKeepWhatRoundingTakes) {
    Scene scene(0);
    std::fill(scene.values.begin(), scene.values.end(), 0.1f);
    std::fill(scene.slopeU.begin(), scene.slopeU.end(), 0.0f);
    std::fill(scene.slopeV.begin(), scene.slopeV.end(), 0.0f);
    std::fill(scene.u.begin(), scene.u.end(), 0.0f);
    std::fill(scene.v.begin(), scene.v.end(), 0.0f);
    atEveryLevel([&] {
        Scene again = scene;
        constexpr int kTimes = 100'000;
        for (int i = 0; i < kTimes; ++i) sumSlices(again.patch(), again.run());
        const double sum = double(0.1f) * kTimes * Scene::kSlices;
        for (const float value : again.found) ASSERT_NEAR(value, sum, 0x1p-23 * sum);
    });
}

}  // namespace
}  // namespace deltasplat
