// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/synth/analytic_volume.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "support/error_of.h"

namespace deltasplat {
namespace {

using test::errorOf;

// Calls visit(position) for the voxel centres of an n^3 grid.
template <typename Visit>
void forGrid(int n, Visit visit) {
    for (int k = 0; k < n; ++k) {
        for (int j = 0; j < n; ++j) {
            for (int i = 0; i < n; ++i) visit((2.0 * glm::dvec3(i, j, k) + 1.0) / double(n) - 1.0);
        }
    }
}

// At more than half of the voxels where either of two seeds has something they differ.
void expectOtherSeedsDiffer(const std::string& name, int n) {
    const auto one = makeAnalytic(name, 1).valueAt;
    const auto two = makeAnalytic(name, 2).valueAt;
    int differ = 0, either = 0;
    forGrid(n, [&](const glm::dvec3& p) {
        either += one(p) > 0 || two(p) > 0;
        differ += one(p) != two(p);
    });
    EXPECT_GT(differ, either / 2);
}

TEST(AnalyticVolume, EveryNameMakesAVolumeOfValuesFromZeroToOne) {
    EXPECT_EQ(analyticNames().size(), 10u);
    for (const std::string& name : analyticNames()) {
        const AnalyticVolume volume = makeAnalytic(name, 3, 0.2);
        EXPECT_EQ(volume.name, name);
        double low = 2, high = -1;
        forGrid(32, [&](const glm::dvec3& p) {
            const double value = volume.valueAt(p);
            EXPECT_EQ(value, volume.valueAt(p));
            low = std::min(low, value);
            high = std::max(high, value);
        });
        EXPECT_GE(low, 0) << name;
        EXPECT_LE(high, 1) << name;
        EXPECT_LT(low, 0.01) << name;
        EXPECT_GT(high, name == "body" ? 10 / 256.0 : 0.8) << name;  // labels are n / 255
    }
}

TEST(AnalyticVolume, RefusesUnknownNamesAndBadNoise) {
    EXPECT_EQ(
        errorOf([] { makeAnalytic("Engine"); }),
        "usage: `name`: got \"Engine\"; expected one of marschner-lobb, hydrogen, shepp-logan, "
        "engine, cloud, slab, vessels, body, fire, explosion");
    EXPECT_EQ(errorOf([] { makeAnalytic("engine", 1, -0.5); }),
              "usage: `noise`: got -0.500000; expected a number of at least 0");
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(errorOf([=] { makeAnalytic("engine", 1, nan); }),
              "usage: `noise`: got nan; expected a number of at least 0");
}

TEST(MarschnerLobb, HasThePublishedValues) {
    const auto valueAt = makeAnalytic("marschner-lobb").valueAt;
    // On the z axis the ripple is cos(2 pi 6 cos(0)) = 1.
    for (const double z : {-1.0, -0.3, 0.0, 0.5, 1.0}) {
        EXPECT_NEAR(valueAt({0, 0, z}), (1 - std::sin(std::numbers::pi * z / 2) + 0.5) / 2.5,
                    1e-12);
    }
    // cos(pi r / 2) = 3/4 makes the ripple cos(9 pi) = -1, and 1/2 makes it cos(6 pi) = 1.
    const double dark = std::acos(0.75) * 2 / std::numbers::pi;
    EXPECT_NEAR(valueAt({dark, 0, 0}), 1 / 2.5, 1e-12);
    EXPECT_NEAR(valueAt({0, -2.0 / 3, 0}), 1.5 / 2.5, 1e-12);
}

TEST(MarschnerLobb, IsTheSameAllAroundTheAxis) {
    const auto valueAt = makeAnalytic("marschner-lobb").valueAt;
    EXPECT_NEAR(valueAt({0.3, 0.4, 0.2}), valueAt({0.5, 0, 0.2}), 1e-12);
    EXPECT_NEAR(valueAt({-0.4, 0.3, 0.2}), valueAt({0, -0.5, 0.2}), 1e-12);
    EXPECT_EQ(valueAt({0.3, 0.4, 0.2}), valueAt({-0.3, -0.4, 0.2}));
}

TEST(Hydrogen, IsOneAtItsLobesAndAQuarterOfThatOnItsRing) {
    const auto valueAt = makeAnalytic("hydrogen").valueAt;
    const double six = 6.0 / 20;  // six Bohr radii
    EXPECT_NEAR(valueAt({0, six, 0}), 1, 1e-12);
    EXPECT_NEAR(valueAt({0, -six, 0}), 1, 1e-12);
    EXPECT_NEAR(valueAt({six, 0, 0}), 0.25, 1e-12);
    EXPECT_NEAR(valueAt({six * 0.6, 0, -six * 0.8}), 0.25, 1e-12);
    double largest = 0;
    forGrid(61, [&](const glm::dvec3& p) { largest = std::max(largest, valueAt(p)); });
    EXPECT_LE(largest, 1);
    EXPECT_GT(largest, 0.99);
}

TEST(Hydrogen, IsZeroOnItsNodalCone) {
    const auto valueAt = makeAnalytic("hydrogen").valueAt;
    for (const double r : {0.1, 0.3, 0.7}) {
        EXPECT_NEAR(valueAt({r, r, r}), 0, 1e-25);  // cos^2 of the polar angle is 1/3
        EXPECT_NEAR(valueAt({0, r / std::sqrt(2), -r}), 0, 1e-25);
    }
    EXPECT_EQ(valueAt({0, 0, 0}), 0);
}

TEST(Hydrogen, HasUnitProbability) {
    // |psi|^2 = peak * value, with R_32 = 4 / (81 sqrt(30)) r^2 exp(-r/3) and
    // Y_20 = sqrt(5 / (16 pi)) (3 cos^2 - 1), so its integral over space is 1.
    const auto valueAt = makeAnalytic("hydrogen").valueAt;
    const double radial = 4 / (81 * std::sqrt(30.0)) * 36 * std::exp(-2.0);
    const double peak = radial * radial * 5 / (16 * std::numbers::pi) * 4;
    double sum = 0;
    forGrid(80, [&](const glm::dvec3& p) { sum += valueAt(p * 2.0); });  // one Bohr radius a step
    EXPECT_NEAR(sum * peak, 1, 2e-3);
}

TEST(SheppLogan, HasToftsContrastsAtTheCentres) {
    const auto valueAt = makeAnalytic("shepp-logan").valueAt;
    EXPECT_EQ(valueAt({0, 0.9, 0}), 1.0);         // skull
    EXPECT_EQ(valueAt({0, -0.4, 0.1}), 0.2);      // brain
    EXPECT_EQ(valueAt({0.22, 0, 0}), 0.0);        // right ventricle
    EXPECT_EQ(valueAt({-0.22, 0, 0}), 0.0);       // left ventricle
    EXPECT_EQ(valueAt({0, 0.35, -0.15}), 0.3);    // large tumour
    EXPECT_EQ(valueAt({0, 0.1, 0.25}), 0.3);      // small tumours
    EXPECT_EQ(valueAt({0, -0.1, 0.25}), 0.3);     //
    EXPECT_EQ(valueAt({-0.08, -0.605, 0}), 0.3);  //
    EXPECT_EQ(valueAt({0, -0.606, 0}), 0.3);      //
    EXPECT_EQ(valueAt({0.06, -0.605, 0}), 0.3);   //
    EXPECT_EQ(valueAt({0.7, 0, 0}), 0.0);         // outside
}

TEST(SheppLogan, TurnsTheVentriclesAwayFromEachOther) {
    const auto valueAt = makeAnalytic("shepp-logan").valueAt;
    const double turn = 18 * std::numbers::pi / 180;
    const glm::dvec3 along(std::sin(turn), std::cos(turn), 0);
    EXPECT_EQ(valueAt(glm::dvec3(0.22, 0, 0) + 0.30 * along), 0.0);
    EXPECT_EQ(valueAt(glm::dvec3(0.22, 0, 0) + 0.32 * along), 0.2);
    EXPECT_EQ(valueAt(glm::dvec3(-0.22, 0, 0) - 0.40 * along * glm::dvec3(-1, 1, 1)), 0.0);
    EXPECT_EQ(valueAt(glm::dvec3(-0.22, 0, 0) - 0.40 * along), 0.2);
}

TEST(Engine, IsMadeOfTwoMaterialsWithHolesInThem) {
    const auto valueAt = makeAnalytic("engine").valueAt;
    EXPECT_EQ(valueAt({0, -0.62, 0}), 0.9);          // crank shaft
    EXPECT_EQ(valueAt({0, 0.56, 0}), 0.45);          // deck between the cylinders
    EXPECT_EQ(valueAt({-0.38, 0.55, 0}), 0.0);       // bore over the left piston
    EXPECT_EQ(valueAt({0.38 + 0.27, 0.2, 0}), 0.9);  // liner
    EXPECT_EQ(valueAt({0.38, 0, 0.35}), 0.0);        // water jacket
    EXPECT_EQ(valueAt({-0.95, 0.9, 0.9}), 0.0);      // outside
    std::set<double> values;
    forGrid(48, [&](const glm::dvec3& p) { values.insert(valueAt(p)); });
    EXPECT_EQ(values, (std::set<double>{0, 0.45, 0.9}));
}

TEST(Engine, NoiseIsNormalAndDependsOnSeedAndPositionAlone) {
    const auto clean = makeAnalytic("engine").valueAt;
    const auto noisy = makeAnalytic("engine", 5, 0.02).valueAt;
    const auto again = makeAnalytic("engine", 5, 0.02).valueAt;
    const auto other = makeAnalytic("engine", 6, 0.02).valueAt;
    double count = 0, sum = 0, squares = 0, same = 0, beyond = 0;
    forGrid(48, [&](const glm::dvec3& p) {
        EXPECT_EQ(noisy(p), again(p));
        if (clean(p) != 0.45) return;  // far from where noise is clamped
        const double noise = (noisy(p) - 0.45) / 0.02;
        ++count;
        sum += noise;
        squares += noise * noise;
        same += noisy(p) == other(p);
        beyond += std::abs(noise) > 2;
    });
    ASSERT_GT(count, 5000);
    EXPECT_NEAR(sum / count, 0, 0.05);
    EXPECT_NEAR(squares / count, 1, 0.05);
    EXPECT_NEAR(beyond / count, 0.0455, 0.01);  // two standard deviations
    EXPECT_LT(same, 3);
}

TEST(Engine, NoiseDoesNotSeeTheSignOfZero) {
    const auto noisy = makeAnalytic("engine", 1, 0.1).valueAt;
    EXPECT_EQ(noisy({0.0, -0.62, 0.0}), noisy({-0.0, -0.62, -0.0}));
}

TEST(Cloud, IsSparseAndInsideABall) {
    const auto valueAt = makeAnalytic("cloud").valueAt;
    int inside = 0, partly = 0;
    forGrid(64, [&](const glm::dvec3& p) {
        const double value = valueAt(p);
        inside += value > 0;
        partly += value > 0 && value < 1;
        if (p.x * p.x + p.y * p.y + p.z * p.z > 0.92 * 0.92) {
            EXPECT_EQ(value, 0);
        }
    });
    EXPECT_GT(inside, 64 * 64 * 64 / 25);
    EXPECT_LT(inside, 64 * 64 * 64 / 5);
    EXPECT_GT(partly, inside / 2);
}

TEST(Cloud, HasNoJumps) {
    const auto valueAt = makeAnalytic("cloud").valueAt;
    double steepest = 0;
    forGrid(40, [&](const glm::dvec3& p) {
        const glm::dvec3 near = p + glm::dvec3(1e-6, 1e-6, -1e-6);
        steepest = std::max(steepest, std::abs(valueAt(near) - valueAt(p)) / 1e-6);
    });
    EXPECT_LT(steepest, 100);
    EXPECT_GT(steepest, 1);
}

TEST(Cloud, SeedsAreDifferentClouds) {
    expectOtherSeedsDiffer("cloud", 24);
}

TEST(Slab, IsABox) {
    const auto valueAt = makeAnalytic("slab").valueAt;
    EXPECT_EQ(valueAt({0, 0, 0}), 1);
    EXPECT_EQ(valueAt({0.8, -0.8, 0.5}), 1);
    EXPECT_EQ(valueAt({0.81, 0, 0}), 0);
    EXPECT_EQ(valueAt({0, -0.81, 0}), 0);
    EXPECT_EQ(valueAt({0, 0, 0.51}), 0);
}

TEST(Vessels, FillAboutOneHundredthOfTheCube) {
    for (const std::uint64_t seed : {1u, 2u, 7u}) {
        const auto valueAt = makeAnalytic("vessels", seed).valueAt;
        int inside = 0, full = 0;
        forGrid(128, [&](const glm::dvec3& p) {
            const double value = valueAt(p);
            inside += value > 0;
            full += value == 1;
        });
        const double cube = 128.0 * 128 * 128;
        EXPECT_NEAR(inside / cube, 0.01, 0.002) << seed;
        EXPECT_GT(full, inside / 5) << seed;
    }
}

TEST(Vessels, BeginWithATrunk) {
    const auto valueAt = makeAnalytic("vessels").valueAt;
    constexpr double kRadius = 0.072;
    EXPECT_EQ(valueAt({0, -0.8, 0}), 1);
    EXPECT_EQ(valueAt({kRadius * 0.49, -0.8, 0}), 1);
    EXPECT_NEAR(valueAt({0, -0.8, kRadius * 0.75}), 0.5, 1e-12);
    EXPECT_EQ(valueAt({kRadius * 1.01, -0.8, 0}), 0);
}

TEST(Vessels, HaveNoJumps) {
    const auto valueAt = makeAnalytic("vessels").valueAt;
    int seen = 0;
    forGrid(32, [&](const glm::dvec3& p) {
        // Tubes are looked up by cells that end at multiples of 1/32.
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 before = p * 0.99;
            before[axis] = (p[axis] * 32 - 0.5) / 32 - 1e-10;
            glm::dvec3 after = before;
            after[axis] += 2e-10;
            seen += valueAt(before) > 0;
            EXPECT_NEAR(valueAt(before), valueAt(after), 1e-5);
        }
    });
    EXPECT_GT(seen, 500);
}

TEST(Vessels, SeedsAreDifferentTrees) {
    expectOtherSeedsDiffer("vessels", 48);
}

// Labels, of which both sides have the same where organs come in pairs.
TEST(AnalyticBody, HasOrgansWhereTheyBelong) {
    const auto labelAt = [valueAt = makeAnalytic("body").valueAt](const glm::dvec3& p) {
        const double label = valueAt(p) * 255;
        EXPECT_NEAR(label, std::round(label), 1e-12);
        return int(std::lround(label));
    };
    EXPECT_EQ(labelAt({0, 0.85, 0}), 10);         // brain
    EXPECT_EQ(labelAt({0, 0, -0.17}), 2);         // spine
    EXPECT_EQ(labelAt({0.2, 0.2, 0}), 3);         // lungs
    EXPECT_EQ(labelAt({-0.2, 0.2, 0}), 3);        //
    EXPECT_EQ(labelAt({0.06, 0.1, 0.07}), 4);     // heart, on the left
    EXPECT_EQ(labelAt({-0.15, -0.15, 0.05}), 5);  // liver, on the right
    EXPECT_EQ(labelAt({0.15, -0.3, -0.12}), 7);   // kidneys
    EXPECT_EQ(labelAt({-0.15, -0.3, -0.12}), 7);  //
    EXPECT_EQ(labelAt({0, -0.2, 0.16}), 1);       // skin
    EXPECT_EQ(labelAt({0.9, 0.9, 0.9}), 0);       // nothing
    int bones = 0;
    for (int i = 0; i < 20000; ++i) {
        const glm::dvec3 p(i % 20 / 21.0, i / 20 % 50 / 25.0 - 1, i / 1000 / 20.0 - 0.5);
        const bool isBone = labelAt(p) == 2;
        bones += isBone;
        EXPECT_EQ(labelAt({-p.x, p.y, p.z}) == 2, isBone);
    }
    EXPECT_GT(bones, 200);
}

}  // namespace
}  // namespace deltasplat
