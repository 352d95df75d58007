// SPDX-License-Identifier: Apache-2.0
// What the light of a point comes through on its way to voxels: against a closed form, and against
// single ways.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <vector>

#include "base/affine.h"
#include "deltasplat/threads.h"
#include "lighting/light_depths.h"
#include "support/lit_fog.h"
#include "volume/placement.h"

namespace deltasplat {
namespace {

using test::aroundMiddle;
using test::Ball;
using test::fogOf;
using test::fogOptics;
using test::pointAt;

// Calls use(p) for all voxels of a cube.
template <typename Use>
void forCube(int n, const Use& use) {
    for (int z = 0; z < n; ++z) {
        for (int y = 0; y < n; ++y) {
            for (int x = 0; x < n; ++x) use(glm::ivec3(x, y, z));
        }
    }
}

double largestOf(const glm::dvec3& v) {
    const glm::dvec3 parts = glm::abs(v);
    return std::max({parts.x, parts.y, parts.z});
}

glm::dvec3 placeIn(const glm::dmat4& world, const glm::dvec3& p) {
    return glm::inverse(glm::dmat3(world)) * (p - glm::dvec3(world[3]));
}

// What a light comes through on its way to the voxels of a volume.
class Depths {
  public:
    Depths(const Volume& volume, const Light& light)
        : classes_(classify(volume, fogOptics({}), smallestSize(volume))),
          depths_(volume, classes_, {light}, 0) {}

    bool hasBlock(const glm::ivec3& p) const { return depths_.blocks().find(p / 8) >= 0; }
    double at(const glm::ivec3& p) const {
        const glm::ivec3 in = p % 8;
        const double root =
            depths_.of(0, depths_.blocks().find(p / 8))[64 * in.x + 8 * in.y + in.z] / 2048.0;
        return root * root;
    }
    const LitBlocks::Reach& reach() const { return depths_.reach(0); }

  private:
    ClassTable classes_;
    LightDepths depths_;
};

// The largest error of what light has left, of any voxel of a cube with a ball in it.
double errorOfBall(const Ball& ball, int n, const glm::dmat4& world, const glm::dvec3& light) {
    const Volume volume =
        fogOf(glm::ivec3(n), world, [&](const auto& p) { return ball.extinctionAt(p); });
    const Depths depths(volume, pointAt(light));
    const glm::dvec3 lightIndex = placeIn(world, light);
    double most = 0;
    forCube(n, [&](const glm::ivec3& p) {
        const glm::dvec3 place(world * glm::dvec4(p, 1));
        // Half of its own slice lies before a voxel's middle, and does not count.
        const double slices = largestOf(glm::dvec3(p) - lightIndex);
        const double own = std::min(0.5, slices) / std::max(slices, 1e-9) *
                           glm::distance(place, light) * ball.extinctionAt(place);
        const double left = std::exp(-depths.at(p) - own);
        most = std::max(most, std::abs(left - std::exp(-ball.depthBetween(light, place))));
    });
    return most;
}

// In the middle, on a voxel, between voxels, anywhere inside, outside, beside the volume, on the
// border between two sixths of space, and ever farther away.
std::vector<glm::dvec3> places() {
    return {glm::dvec3(0), glm::dvec3(0.25), {0.5, 0.5, 0.5},  {3.3, -7.1, 1.9}, {20, 25, -18},
            {-40, 0, 0},   {36, 36, 2},      {60, -70, 61},    {0.1, 0, 31.9},   {-33, 7, 33},
            {300, 10, 20}, {1e4, 2e3, -1e4}, {1e7, 2e7, -3e6}, {-1e20, 3e19, 0}};
}

TEST(PointDepths, ofASmoothBallAreTheClosedForm) {
    const Ball ball{0.12, 7};
    for (const glm::dvec3& light : places())
        EXPECT_LT(errorOfBall(ball, 64, aroundMiddle(64, 1), light), 0.004) << light.x;
    // Voxels half as large: about a quarter of the error.
    for (const glm::dvec3& light : {glm::dvec3(0.25), {60, -70, 61}})
        EXPECT_LT(errorOfBall(ball, 128, aroundMiddle(128, 0.5), light), 0.001) << light.x;
}

// Voxels that are neither cubes nor upright nor at right angles, nor right-handed.
TEST(PointDepths, areMeasuredInTheWorld) {
    const glm::dmat3 turn(glm::rotate(glm::dmat4(1), 0.7, glm::normalize(glm::dvec3(1, -2, 0.5))));
    const glm::dmat3 shapes[] = {
        glm::dmat3({0.8, 0, 0}, {0, 1.3, 0}, {0, 0, 0.9}),
        turn,
        turn * glm::dmat3({0.9, 0.2, 0}, {-0.3, 1.1, 0.25}, {0.1, 0, 1.2}),
        glm::dmat3({-1, 0, 0}, {0, 0, 1}, {0.4, 1, 0}),
    };
    const Ball ball{0.12, 7};
    for (const glm::dmat3& shape : shapes) {
        glm::dmat4 world(shape);
        world[3] = glm::dvec4(shape * glm::dvec3(-31.5), 1);
        for (const glm::dvec3& light :
             {glm::dvec3(0), {3.3, -7.1, 1.9}, {40, -50, 61}, {1e4, 2e3, -1e4}})
            EXPECT_LT(errorOfBall(ball, 64, world, light), 0.006) << light.x << " " << shape[0].x;
    }
}

// A single way, read once a slice between four voxels.
double depthOfWay(const std::vector<double>& extinctions, int n, const glm::dvec3& light,
                  const glm::ivec3& p) {
    const glm::dvec3 way = glm::dvec3(p) - light;
    const double slices = largestOf(way);
    if (slices == 0) return 0;
    int axis = 0;
    while (std::abs(way[axis]) != slices) ++axis;
    double sum = 0;
    for (int slice = 0; slice < n; ++slice) {
        const double before = way[axis] > 0 ? slice - light[axis] : light[axis] - slice;
        const double share = std::clamp(before + 0.5, 0.0, 1.0);
        if (share == 0 || before > slices - 0.5) continue;
        glm::dvec3 place = light + way / slices * (share < 1 ? share / 2 : before);
        place[axis] = slice;
        const glm::dvec3 first = glm::floor(place);
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 voxel = first + glm::dvec3(corner & 1, corner >> 1 & 1, corner >> 2);
            if (std::min({voxel.x, voxel.y, voxel.z}) < 0 || largestOf(voxel) > n - 1) continue;
            const glm::dvec3 near = 1.0 - glm::abs(place - voxel);
            sum += share * near.x * near.y * near.z *
                   extinctions[std::size_t((voxel.z * n + voxel.y) * n + voxel.x)];
        }
    }
    return sum * glm::length(way) / slices;
}

// Of what changes from voxel to voxel, each way meets something else: planes that have a node for
// each voxel show it as well as voxels can.
TEST(PointDepths, ofSharpThingsAreThoseOfSingleWays) {
    constexpr int n = 64;
    const glm::dmat4 world = aroundMiddle(n, 1);
    const auto extinctionAt = [](const glm::dvec3& p) {
        const glm::uvec3 cell = glm::uvec3(glm::floor(p + 100.0)) / 4u;
        const unsigned number = (cell.x * 73856093) ^ (cell.y * 19349663) ^ (cell.z * 83492791);
        return number % 7 == 0 ? 0.25 : 0.0;
    };
    const Volume volume = fogOf(glm::ivec3(n), world, extinctionAt);
    std::vector<double> extinctions;
    forCube(n, [&](const glm::ivec3& p) {
        extinctions.push_back(extinctionAt(glm::dvec3(world * glm::dvec4(p, 1))));
    });
    for (const glm::dvec3& light :
         {glm::dvec3(0.3, 0.2, 0.4), {0.5, 0.5, 0.5}, {-20, 7, 0}, {-40, 7, 0}, {60, -70, 61}}) {
        const Depths depths(volume, pointAt(light));
        double squares = 0;
        double squaresNear = 0;
        int count = 0;
        int countNear = 0;
        forCube(n, [&](const glm::ivec3& p) {
            if (!depths.hasBlock(p)) return;
            const glm::dvec3 lightIndex = placeIn(world, light);
            const double off =
                std::exp(-depths.at(p)) - std::exp(-depthOfWay(extinctions, n, lightIndex, p));
            const bool isNear = largestOf(glm::dvec3(p) - lightIndex) < 6;
            (isNear ? squaresNear : squares) += off * off;
            ++(isNear ? countNear : count);
        });
        EXPECT_LT(std::sqrt(squares / count), 0.03) << light.x;
        if (countNear > 0) {
            EXPECT_LT(std::sqrt(squaresNear / countNear), 0.002) << light.x;
        }
    }
}

// From one sixth of space to the next nothing jumps, however the light stands among voxels.
TEST(PointDepths, haveNoSeams) {
    constexpr int n = 48;
    for (const glm::dvec3& light :
         {glm::dvec3(0), {0.5, 0.5, 0.5}, {0.3, -0.2, 0.1}, {-9.5, 3.5, 8.5}, {30, 31, -30}}) {
        const Volume volume =
            fogOf(glm::ivec3(n), aroundMiddle(n, 1), [](const auto&) { return 0.05; });
        const Depths depths(volume, pointAt(light));
        const glm::dvec3 lightIndex = placeIn(aroundMiddle(n, 1), light);
        if (largestOf(light) > 0.5 * n) {
            EXPECT_EQ(depths.at(glm::ivec3(n - 1, n - 1, 0)), 0);
            continue;
        }
        forCube(n, [&](const glm::ivec3& p) {
            const glm::dvec3 way = glm::dvec3(p) - lightIndex;
            const double slices = largestOf(way);
            const double length = slices > 0 ? glm::length(way) / slices : 0;
            const double expected = 0.05 * length * std::max(slices - 0.5, 0.0);
            EXPECT_NEAR(depths.at(p), expected, 0.002 * expected + 0.0005);
        });
    }
}

// On however many threads, bit for bit.
TEST(PointDepths, doNotDependOnThreads) {
    const Ball ball{0.3, 9};
    const Volume volume = fogOf(glm::ivec3(61), aroundMiddle(61, 1),
                                [&](const auto& p) { return ball.extinctionAt(p); });
    for (const glm::dvec3& light : places()) {
        std::vector<double> first;
        for (const int threads : {1, 3, 16}) {
            const ThreadLimit limit(threads);
            const Depths depths(volume, pointAt(light));
            std::vector<double> all;
            forCube(61, [&](const glm::ivec3& p) { all.push_back(depths.at(p)); });
            if (threads == 1) first = all;
            EXPECT_EQ(all, first) << threads;
        }
    }
}

// An opaque voxel leaves nothing behind it, and is all that is in the way.
TEST(PointDepths, ofAnOpaqueVoxelAreItsShadow) {
    constexpr int n = 40;
    const auto isOpaque = [](const glm::dvec3& p) { return p == glm::dvec3(3.5, 0.5, 0.5); };
    const Volume volume = fogOf(glm::ivec3(n), aroundMiddle(n, 1), [&](const auto& p) {
        return isOpaque(p) ? std::numeric_limits<double>::infinity() : 1e-4;
    });
    const Depths depths(volume, pointAt({0.5, 0.5, 0.5}));
    for (int x = 24; x < n; ++x) {
        EXPECT_GT(depths.at({x, 20, 20}), 9);
        // It is as wide as it is to be, and some of it is in voxels beside.
        const int wide = (x - 20) / 3;
        EXPECT_LT(depths.at({x, 20 + wide + 1, 20}), 0.01) << x;
        EXPECT_LT(depths.at({x, 20, 20 - wide - 1}), 0.01) << x;
    }
    EXPECT_LT(depths.at({16, 20, 20}), 0.01);
}

// How near and how far voxels are that can be seen.
TEST(PointDepths, knowHowFarVoxelsAre) {
    const auto isThere = [](const glm::dvec3& p) { return p.x > 5 && p.y > 2; };
    const Volume volume = fogOf(glm::ivec3(32), aroundMiddle(32, 1),
                                [&](const auto& p) { return isThere(p) ? 0.1 : 0.0; });
    const Depths depths(volume, pointAt({0.5, 0, 0.5}));
    EXPECT_NEAR(depths.reach().nearest, std::hypot(5.0, 2.5), 1e-9);
    EXPECT_GT(depths.reach().farthest, std::sqrt(2 * 15 * 15 + 15.5 * 15.5));
    EXPECT_LT(depths.reach().farthest, 40);
}

}  // namespace
}  // namespace deltasplat
