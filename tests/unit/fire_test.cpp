// SPDX-License-Identifier: Apache-2.0
// Samples of several grids: what burns, and what it makes hot.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "deltasplat/synth/analytic_volume.h"

namespace deltasplat {
namespace {

using Function = std::function<double(const glm::dvec3&)>;

// Calls visit(position) for the voxel centres of an n^3 grid.
template <typename Visit>
void forGrid(int n, Visit visit) {
    for (int k = 0; k < n; ++k) {
        for (int j = 0; j < n; ++j) {
            for (int i = 0; i < n; ++i) visit((2.0 * glm::dvec3(i, j, k) + 1.0) / double(n) - 1.0);
        }
    }
}

// Calls visit(position) for places on all six walls of the cube.
template <typename Visit>
void forWalls(int n, Visit visit) {
    for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
            const double u = 2.0 * i / (n - 1) - 1, v = 2.0 * j / (n - 1) - 1;
            for (const double wall : {-1.0, 1.0}) {
                visit(glm::dvec3(wall, u, v));
                visit(glm::dvec3(u, wall, v));
                visit(glm::dvec3(u, v, wall));
            }
        }
    }
}

Function gridOf(const AnalyticVolume& volume, const std::string& name) {
    for (const AnalyticGrid& other : volume.others) {
        if (other.name == name) return other.valueAt;
    }
    ADD_FAILURE() << "no grid " << name;
    return volume.valueAt;
}

std::vector<std::string> namesOf(const AnalyticVolume& volume) {
    std::vector<std::string> names;
    for (const AnalyticGrid& other : volume.others) names.push_back(other.name);
    return names;
}

// Along no line through the cube a function changes by more than `perUnit` a unit, and along some
// it does change.
void expectNoJumps(const Function& valueAt, double perUnit) {
    constexpr int kLines = 8, kSteps = 8000;  // lines along each edge of a wall, steps of a line
    double largest = 0;
    for (int line = 0; line < kLines * kLines; ++line) {
        const int row = line / kLines;
        const double u = (2.0 * (line % kLines) + 1) / kLines - 1;
        const double v = (2.0 * row + 1) / kLines - 1;
        const auto at = [&](int step) {
            const double t = 2.0 * step / kSteps - 1;
            // Obliquely, for what may jump does so at cylinders and planes.
            return valueAt({0.8 * u + 0.2 * t * v, t, 0.8 * v - 0.2 * t * u});
        };
        double before = at(0);
        for (int step = 1; step <= kSteps; ++step) {
            const double now = at(step);
            largest = std::max(largest, std::abs(now - before));
            before = now;
        }
    }
    EXPECT_LT(largest * kSteps / 2, perUnit);
    EXPECT_GT(largest * kSteps / 2, perUnit / 100);
}

// At more than a third of the places where either has something they differ.
void expectDiffer(const Function& one, const Function& two, double nothing) {
    int differ = 0, either = 0;
    forGrid(24, [&](const glm::dvec3& p) {
        either += one(p) > nothing || two(p) > nothing;
        differ += one(p) != two(p);
    });
    EXPECT_GT(either, 0);
    EXPECT_GT(differ, either / 3);
}

struct Fire {
    explicit Fire(std::uint64_t seed = 1)
        : volume(makeAnalytic("fire", seed)),
          smoke(volume.valueAt),
          temperature(gridOf(volume, "temperature")),
          flame(gridOf(volume, "flame")) {}
    AnalyticVolume volume;
    Function smoke, temperature, flame;
};

TEST(Fire, HasTemperatureAndFlameBesideSmoke) {
    const Fire fire;
    EXPECT_EQ(namesOf(fire.volume), (std::vector<std::string>{"temperature", "flame"}));
    EXPECT_EQ(fire.volume.others[0].threshold, 500);
    EXPECT_EQ(fire.volume.others[1].threshold, 0);
    EXPECT_FALSE(fire.volume.colorAt);
}

TEST(Fire, BurnsWhereItIsHotAndSmokesWhereItDoesNotBurn) {
    for (const std::uint64_t seed : {1u, 2u, 3u, 9u}) {
        const Fire fire(seed);
        int flames = 0, full = 0, hot = 0;
        forGrid(64, [&](const glm::dvec3& p) {
            const double temperature = fire.temperature(p), flame = fire.flame(p);
            ASSERT_GE(flame, 0);
            ASSERT_LE(flame, 1);
            ASSERT_GE(temperature, 300);
            ASSERT_LE(temperature, 2200);
            if (flame > 0) {
                ASSERT_GE(temperature, 800);
            }
            if (temperature > 1200) {
                ASSERT_GT(flame, 0);
            }
            if (flame >= 0.5) {
                ASSERT_EQ(fire.smoke(p), 0);
            }
            flames += flame > 0;
            full += flame == 1;
            hot += temperature > 1200;
        });
        EXPECT_GT(flames, 64 * 64 * 64 / 100) << seed;
        EXPECT_GT(full, flames / 20) << seed;
        EXPECT_GT(hot, flames / 4) << seed;
    }
}

TEST(Fire, IsHottestBelowAndSmokesAbove) {
    const Fire fire;
    double hottest[4] = {0, 0, 0, 0};  // by quarters of the height
    double smoke = 0, ofSmoke = 0, flame = 0, ofFlame = 0, alone = 0;
    forGrid(64, [&](const glm::dvec3& p) {
        double& of = hottest[std::min(3, int(2 * (p.y + 1)))];
        of = std::max(of, fire.temperature(p));
        smoke += fire.smoke(p);
        ofSmoke += fire.smoke(p) * p.y;
        flame += fire.flame(p);
        ofFlame += fire.flame(p) * p.y;
        if (fire.smoke(p) == 0) alone += fire.flame(p);
        if (p.y < -0.53) {
            ASSERT_EQ(fire.smoke(p), 0);
        }
    });
    EXPECT_GT(hottest[0], 2000);
    for (int quarter = 0; quarter < 3; ++quarter)
        EXPECT_GT(hottest[quarter], hottest[quarter + 1] + 50);
    EXPECT_LT(hottest[3], 1000);
    EXPECT_GT(ofSmoke / smoke, ofFlame / flame + 0.6);
    EXPECT_GT(alone, 0.5 * flame);
}

TEST(Fire, ReachesNoWall) {
    for (const std::uint64_t seed : {1u, 5u}) {
        const Fire fire(seed);
        forWalls(80, [&](const glm::dvec3& p) {
            ASSERT_EQ(fire.smoke(p), 0);
            ASSERT_EQ(fire.flame(p), 0);
            ASSERT_EQ(fire.temperature(p), 300);
        });
    }
}

TEST(Fire, HasNoJumps) {
    const Fire fire;
    expectNoJumps(fire.smoke, 110);
    expectNoJumps(Fire(10).smoke, 110);  // these two reach the end of where smoke can be
    expectNoJumps(Fire(21).smoke, 110);
    expectNoJumps(fire.flame, 100);
    expectNoJumps(fire.temperature, 100 * 2200);
}

TEST(Fire, SeedsAreDifferentFires) {
    const Fire one(1), two(2);
    expectDiffer(one.smoke, two.smoke, 0);
    expectDiffer(one.flame, two.flame, 0);
    expectDiffer(one.temperature, two.temperature, 300);
}

struct Explosion {
    explicit Explosion(std::uint64_t seed = 1)
        : volume(makeAnalytic("explosion", seed)),
          smoke(volume.valueAt),
          temperature(gridOf(volume, "temperature")) {}
    AnalyticVolume volume;
    Function smoke, temperature;
};

TEST(Explosion, IsHottestInItsMiddle) {
    const Explosion ball;
    EXPECT_EQ(namesOf(ball.volume), std::vector<std::string>{"temperature"});
    EXPECT_EQ(ball.volume.others[0].threshold, 500);
    EXPECT_EQ(ball.smoke({0, 0, 0}), 1);
    EXPECT_EQ(ball.temperature({0, 0, 0}), 2200);
    forGrid(48, [&](const glm::dvec3& p) {
        ASSERT_GE(ball.temperature(p), 300);
        ASSERT_LE(ball.temperature(p), 2200);
        if (glm::length(p) >= 0.98) {
            ASSERT_EQ(ball.smoke(p), 0);
            ASSERT_EQ(ball.temperature(p), 300);
        }
    });
}

// Halfway to the outside most is warm at most, and some, in the cracks, as hot as inside.
TEST(Explosion, HasHotCracks) {
    for (const std::uint64_t seed : {1u, 2u, 8u}) {
        const Explosion ball(seed);
        int there = 0, warm = 0, hot = 0;
        forGrid(64, [&](const glm::dvec3& p) {
            const double radius = glm::length(p);
            if (radius < 0.6 || radius > 0.66) return;
            ++there;
            warm += ball.temperature(p) < 1000;
            hot += ball.temperature(p) > 1300;
        });
        EXPECT_GT(warm, there / 2) << seed;
        EXPECT_GT(hot, there / 50) << seed;
        EXPECT_LT(hot, there / 4) << seed;
    }
}

TEST(Explosion, IsBrownInItsCracksAndGreyOutside) {
    const Explosion ball;
    double outside = 0, light = 0, cracks = 0, dark = 0;
    forGrid(64, [&](const glm::dvec3& p) {
        if (ball.smoke(p) == 0) return;
        const glm::dvec3 color = ball.volume.colorAt(p);
        ASSERT_LE(color.r, 1);
        ASSERT_GE(color.r, color.g);
        ASSERT_GE(color.g, color.b);
        ASSERT_GT(color.b, 0);
        const double radius = glm::length(p);
        if (radius < 0.58) return;
        const bool crack = ball.temperature(p) > 1300;
        (crack ? cracks : outside) += 1;
        (crack ? dark : light) += color.g;
    });
    EXPECT_GT(light / outside, 2 * dark / cracks);
}

TEST(Explosion, HasNoJumps) {
    const Explosion ball;
    expectNoJumps(ball.smoke, 200);
    expectNoJumps(ball.temperature, 200 * 2200);
    for (int channel = 0; channel < 3; ++channel) {
        expectNoJumps([&](const glm::dvec3& p) { return ball.volume.colorAt(p)[channel]; }, 50);
    }
}

TEST(Explosion, SeedsAreDifferentExplosions) {
    const Explosion one(1), two(2);
    expectDiffer(one.smoke, two.smoke, 0);
    expectDiffer(one.temperature, two.temperature, 300);
    expectDiffer([&](const glm::dvec3& p) { return one.volume.colorAt(p).g; },
                 [&](const glm::dvec3& p) { return two.volume.colorAt(p).g; }, 0);
}

}  // namespace
}  // namespace deltasplat
