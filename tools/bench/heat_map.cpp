// SPDX-License-Identifier: Apache-2.0
#include "bench/heat_map.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "image/srgb.h"

namespace deltasplat {
namespace {

// Evenly spaced, each brighter than the one before.
constexpr std::array<Rgb, 5> kHeat = {
    {{8, 6, 18}, {72, 24, 122}, {182, 50, 112}, {248, 134, 84}, {254, 246, 190}}};

}  // namespace

Rgb heatColor(double share) {
    constexpr int kParts = int(kHeat.size()) - 1;
    const double place = std::clamp(share, 0.0, 1.0) * kParts;
    const int part = std::min(int(place), kParts - 1);
    const auto mixed = [&](std::uint8_t Rgb::*channel) {
        return std::uint8_t(
            std::lround(std::lerp(kHeat[part].*channel, kHeat[part + 1].*channel, place - part)));
    };
    return {mixed(&Rgb::r), mixed(&Rgb::g), mixed(&Rgb::b)};
}

std::string heatGradient() {
    std::string stops;
    for (const Rgb& color : kHeat) {
        stops += ",rgb(" + std::to_string(color.r) + "," + std::to_string(color.g) + "," +
                 std::to_string(color.b) + ")";
    }
    return "linear-gradient(to right" + stops + ")";
}

Image heatMap(const Image& a, const Image& b, double full) {
    Image map(a.size);
    for (std::size_t i = 0; i < map.rgba.size(); i += 4) {
        double largest = 0;
        for (std::size_t channel = i; channel < i + 4; ++channel)
            largest =
                std::max(largest, std::abs(double(a.rgba[channel]) - double(b.rgba[channel])));
        const Rgb color = heatColor(full > 0 ? largest / full : 0);
        map.rgba[i] = float(linearFromSrgb(color.r / 255.0));
        map.rgba[i + 1] = float(linearFromSrgb(color.g / 255.0));
        map.rgba[i + 2] = float(linearFromSrgb(color.b / 255.0));
        map.rgba[i + 3] = 1;
    }
    return map;
}

}  // namespace deltasplat
