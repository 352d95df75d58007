// SPDX-License-Identifier: Apache-2.0
#include "base/portable_math.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "synth/noise.h"

namespace deltasplat {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kSamples = 100000;

// Seeded numbers from `low` to `high`; every second one is nearer to 0 by up to 40 powers of 2.
std::vector<double> samples(double low, double high) {
    std::vector<double> result;
    for (std::uint64_t i = 0; i < kSamples; ++i) {
        const std::uint64_t hash = mixBits(i + 1);
        const double x = low + (high - low) * unitFromBits(hash);
        const double smaller = std::ldexp(x, -int(hash % 40));
        result.push_back(i % 2 == 0 || smaller < low || smaller > high ? x : smaller);
    }
    return result;
}

// How far `got` is from the exact value, in units of the last place of the nearest double.
double ulpsOff(double got, long double exact) {
    const double nearest = std::abs(double(exact));
    const double ulp = std::nextafter(nearest, kInfinity) - nearest;
    return double(std::abs((long double)(got)-exact) / ulp);
}

using OfDouble = double (*)(double);
using OfLong = long double (*)(long double);

double worst(OfDouble got, OfLong exact, double low, double high) {
    double most = 0;
    for (const double x : samples(low, high)) most = std::max(most, ulpsOff(got(x), exact(x)));
    return most;
}

// long double has at least 64 bits of precision where this is compiled, so that the C library's
// functions of it stand for the exact ones.
static_assert(std::numeric_limits<long double>::digits >= 64);

TEST(PortableMath, IsWithinAnUlpOfTheTrueValue) {
    EXPECT_LT(worst(portable::exp, std::exp, -700, 700), 0.8);
    EXPECT_LT(worst(portable::exp, std::exp, -1, 1), 0.8);
    EXPECT_LT(worst(portable::expm1, std::expm1, -40, 700), 1);
    EXPECT_LT(worst(portable::expm1, std::expm1, -1, 1), 1);
    EXPECT_LT(worst(portable::log, std::log, 1e-300, 1e300), 0.8);
    EXPECT_LT(worst(portable::log, std::log, 0.5, 2), 0.8);
    EXPECT_LT(worst(portable::log1p, std::log1p, -1, 1), 0.8);
    EXPECT_LT(worst(portable::log1p, std::log1p, -1e-6, 1e6), 0.8);
    EXPECT_LT(worst(portable::sin, std::sin, -1e6, 1e6), 0.8);
    EXPECT_LT(worst(portable::sin, std::sin, -4, 4), 0.8);
    EXPECT_LT(worst(portable::cos, std::cos, -1e6, 1e6), 0.8);
    EXPECT_LT(worst(portable::cos, std::cos, -4, 4), 0.8);
}

TEST(PortableMath, HasPowersWithinAnUlp) {
    double most = 0;
    for (const double power : {1 / 2.4, 2.4, 1 / 3.0, 11.0, -3.7, 68.0, 1e-9, 1e9}) {
        for (double x : samples(0, 10)) {
            if (std::abs(power) > 100) x = 1 + x * 1e-9;
            most =
                std::max(most, ulpsOff(portable::pow(x, power), std::pow((long double)x, power)));
        }
    }
    EXPECT_LT(most, 0.8);
}

TEST(PortableMath, HasLengthsWithinTwoUlps) {
    double most = 0;
    const std::vector<double> xs = samples(-1e5, 1e5);
    for (int i = 1; i < kSamples; ++i) {
        const double x = xs[std::size_t(i)], y = xs[std::size_t(i - 1)];
        const long double exact = std::hypot((long double)x, (long double)y);
        most = std::max(most, ulpsOff(portable::hypot(x, y), exact));
    }
    EXPECT_LT(most, 2);
    EXPECT_EQ(portable::hypot(3e300, -4e300), 5e300);
    EXPECT_EQ(portable::hypot(0, 0), 0);
    EXPECT_EQ(portable::hypot(-kInfinity, 1), kInfinity);
    EXPECT_TRUE(std::isnan(portable::hypot(std::nan(""), 1)));
}

TEST(PortableMath, HasAnglesWithinFourUlps) {
    double most = 0;
    const std::vector<double> xs = samples(-10, 10);
    for (int i = 1; i < kSamples; ++i) {
        const double x = xs[std::size_t(i)], y = xs[std::size_t(i - 1)];
        const long double exact = std::atan2((long double)y, (long double)x);
        most = std::max(most, ulpsOff(portable::atan2(y, x), exact));
    }
    EXPECT_LT(most, 4);
    for (const double y : {0.0, -0.0, 1.0, -1.0, kInfinity}) {
        for (const double x : {0.0, -0.0, 1.0, -1.0, -kInfinity})
            EXPECT_NEAR(portable::atan2(y, x), std::atan2(y, x), 1e-15) << y << ' ' << x;
    }
    EXPECT_TRUE(std::isnan(portable::atan2(std::nan(""), 1)));
}

TEST(PortableMath, IsExactWhereTheValueIs) {
    EXPECT_EQ(portable::exp(0), 1);
    EXPECT_EQ(portable::expm1(0), 0);
    EXPECT_EQ(portable::expm1(-50), -1);
    EXPECT_EQ(portable::log(1), 0);
    EXPECT_EQ(portable::log1p(0), 0);
    EXPECT_EQ(portable::pow(1, 2.4), 1);
    EXPECT_EQ(portable::pow(0, 2.4), 0);
    EXPECT_EQ(portable::pow(0, 0), 1);
    EXPECT_EQ(portable::pow(1.5, 2), 2.25);
    EXPECT_EQ(portable::pow(4, 0.5), 2);
    EXPECT_EQ(portable::sin(0), 0);
    EXPECT_EQ(portable::cos(0), 1);
}

TEST(PortableMath, SaysWhatIsBeyond) {
    EXPECT_EQ(portable::exp(-800), 0);
    EXPECT_EQ(portable::exp(800), kInfinity);
    EXPECT_EQ(portable::exp(-kInfinity), 0);
    EXPECT_EQ(portable::expm1(kInfinity), kInfinity);
    EXPECT_EQ(portable::log(0), -kInfinity);
    EXPECT_EQ(portable::log(kInfinity), kInfinity);
    EXPECT_EQ(portable::log1p(-1), -kInfinity);
    EXPECT_EQ(portable::pow(0, -1), kInfinity);
    EXPECT_EQ(portable::pow(10, 400), kInfinity);
    EXPECT_EQ(portable::pow(10, -400), 0);
    for (const double got :
         {portable::exp(std::nan("")), portable::expm1(std::nan("")), portable::log(-1),
          portable::log(std::nan("")), portable::log1p(-2), portable::pow(-1, 2.5),
          portable::pow(2, std::nan("")), portable::sin(2e6), portable::cos(kInfinity)}) {
        EXPECT_TRUE(std::isnan(got)) << got;
    }
}

// One number for all results: it changes when a single bit of one of them does.
TEST(PortableMath, HasTheSameBitsEverywhere) {
    std::uint64_t hash = 0;
    const auto add = [&](double value) {
        hash = mixBits(hash ^ std::bit_cast<std::uint64_t>(value)) + 1;
    };
    for (const OfDouble function : {portable::exp, portable::expm1, portable::sin, portable::cos}) {
        for (const double x : samples(-30, 30)) add(function(x));
    }
    for (const double x : samples(0, 3)) {
        add(portable::log(x));
        add(portable::log1p(x));
        add(portable::pow(x, 2.4));
        add(portable::hypot(x, 1));
    }
    EXPECT_EQ(hash, 0x333f56b6e534217du);
}

}  // namespace
}  // namespace deltasplat
