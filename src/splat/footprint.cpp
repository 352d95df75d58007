// SPDX-License-Identifier: Apache-2.0
// Based on: Lee Westover, "Footprint Evaluation for Volume Rendering", 1990, with a Gaussian
// kernel: its integral along a line is a Gaussian again, here written in slice coordinates.
// Deviates in that weights are integers that add up exactly for each phase.
#include "deltasplat/splat/footprint.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <string>

#include "base/parallel.h"
#include "base/portable_math.h"
#include "base/text.h"
#include "deltasplat/error.h"

namespace deltasplat {
namespace {

// The Gaussian with covariance sigma^2 (I + d d^T), not normalized.
struct SlicePlaneGaussian {
    double sigma;
    glm::dvec2 d;

    // The inverse of I + d d^T is I - d d^T / (1 + |d|^2) (Sherman and Morrison 1950).
    double at(double u, double v) const {
        const double along = d.x * u + d.y * v;
        const double squared = u * u + v * v - along * along / (1 + d.x * d.x + d.y * d.y);
        return portable::exp(-squared / (2 * sigma * sigma));
    }
};

// Returns the smallest radius, in sheet pixels, that omits at most kFootprintTail of the weight.
int radiusFor(const SlicePlaneGaussian& gaussian, int resolution) {
    const double widest = gaussian.sigma * std::sqrt(1 + glm::dot(gaussian.d, gaussian.d));
    const int reach = int(std::ceil(6 * widest * resolution)) + 1;
    // weightOfRing[k]: weight at distance k in the larger of both directions.
    std::vector<double> weightOfRing(reach + 1, 0.0);
    for (int v = -reach; v <= reach; ++v) {
        for (int u = -reach; u <= reach; ++u) {
            weightOfRing[std::max(std::abs(u), std::abs(v))] +=
                gaussian.at(double(u) / resolution, double(v) / resolution);
        }
    }
    double left = std::accumulate(weightOfRing.begin(), weightOfRing.end(), 0.0) * kFootprintTail;
    int radius = reach;
    while (radius > 0 && weightOfRing[radius] <= left) left -= weightOfRing[radius--];
    // Every phase must have a voxel within reach.
    return std::max(radius, resolution / 2);
}

// Scales the weights at places to a sum of Footprint::kOne, rounding by the largest remainder.
void normalizePhase(const std::vector<double>& real, const std::vector<int>& places,
                    std::vector<std::int32_t>& weights) {
    double sum = 0;
    for (const int place : places) sum += real[place];
    std::int32_t missing = Footprint::kOne;
    std::vector<std::pair<double, int>> remainders;
    for (const int place : places) {
        const double exact = real[place] / sum * Footprint::kOne;
        weights[place] = std::int32_t(std::floor(exact));
        missing -= weights[place];
        remainders.emplace_back(exact - weights[place], place);
    }
    // Ties go to the earlier place, so that the table is the same everywhere.
    std::sort(remainders.begin(), remainders.end(), [](const auto& a, const auto& b) {
        return a.first != b.first ? a.first > b.first : a.second < b.second;
    });
    for (std::int32_t i = 0; i < missing; ++i) ++weights[remainders[i].second];
}

}  // namespace

Footprint makeFootprint(double sigmaVoxels, glm::dvec2 shiftPerSlice, int resolution,
                        std::optional<int> width, int perVoxel) {
    const DefaultFloats floats;
    if (!(sigmaVoxels * perVoxel >= kMinSigma && sigmaVoxels <= kMaxSigma)) {
        throw Error(
            ErrorCode::kUsage, "`sigma`", numberText(sigmaVoxels),
            "a number of voxels from " + numberText(kMinSigma) + " to " + numberText(kMaxSigma));
    }
    // Every phase must have a voxel within reach.
    if (width && (*width < resolution || *width > kMaxFootprintWidth)) {
        throw Error(ErrorCode::kUsage, "footprint width", std::to_string(*width),
                    "pixels from " + std::to_string(resolution) + " to " +
                        std::to_string(kMaxFootprintWidth));
    }
    const SlicePlaneGaussian gaussian{sigmaVoxels * perVoxel, shiftPerSlice};
    Footprint footprint;
    footprint.resolution = resolution;
    footprint.width = width.value_or(2 * radiusFor(gaussian, resolution) + 1);
    const double middle = 0.5 * (footprint.width - 1);
    std::vector<double> real(std::size_t(footprint.width) * footprint.width);
    std::vector<std::vector<int>> placesOfPhase(std::size_t(resolution) * resolution);
    for (int y = 0; y < footprint.width; ++y) {
        for (int x = 0; x < footprint.width; ++x) {
            const int place = y * footprint.width + x;
            real[place] = gaussian.at((x - middle) / resolution, (y - middle) / resolution);
            placesOfPhase[(y % resolution) * resolution + x % resolution].push_back(place);
        }
    }
    footprint.weights.resize(real.size());
    for (const auto& places : placesOfPhase) normalizePhase(real, places, footprint.weights);
    return footprint;
}

}  // namespace deltasplat
