// SPDX-License-Identifier: Apache-2.0
#include "reference/reference_rays.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "reference/formulas.h"

namespace reference {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// What a place reads of the eight voxels around it.
struct Reading {
    double sum = 0;     // of values by weights
    double weight = 0;  // of those that are active
};

Reading readAt(const ValueVolume& volume, const Vector& place) {
    Reading reading;
    for (int corner = 0; corner < 8; ++corner) {
        double weight = 1;
        std::array<int, 3> at{};
        bool inside = true;
        for (int k = 0; k < 3; ++k) {
            const int voxel = int(std::floor(place[k])) + (corner >> k & 1);
            weight *= tent(place[k] - voxel);
            at[k] = voxel - volume.first[k];
            inside = inside && at[k] >= 0 && at[k] < volume.dims[k];
        }
        if (!inside) continue;
        const std::size_t n =
            (std::size_t(at[2]) * volume.dims[1] + at[1]) * volume.dims[0] + at[0];
        if (!volume.active[n]) continue;
        reading.sum += weight * volume.values[n];
        reading.weight += weight;
    }
    return reading;
}

double emptyValue(const ValueVolume& volume) {
    double least = 0;
    for (std::size_t i = 0; i < volume.values.size(); ++i) {
        if (volume.active[i]) least = std::min(least, volume.values[i]);
    }
    return least;
}

Vector placeAt(const Vector& from, const Vector& ray, double t) {
    return {from[0] + t * ray[0], from[1] + t * ray[1], from[2] + t * ray[2]};
}

// Where a line crosses planes of voxels, from the first that can be read to the last.
std::vector<double> crossings(const ValueVolume& volume, const Vector& from, const Vector& ray,
                              double nearest) {
    double low = nearest, high = kInfinity;
    for (int k = 0; k < 3; ++k) {
        const double a = volume.first[k] - 1 - from[k];
        const double b = volume.first[k] + volume.dims[k] - from[k];
        if (ray[k] == 0) {
            if (a > 0 || b < 0) return {};
            continue;
        }
        low = std::max(low, std::min(a / ray[k], b / ray[k]));
        high = std::min(high, std::max(a / ray[k], b / ray[k]));
    }
    if (!(low < high)) return {};
    std::vector<double> ends{low, high};
    for (int k = 0; k < 3; ++k) {
        for (int plane = volume.first[k]; plane < volume.first[k] + volume.dims[k]; ++plane) {
            const double t = (plane - from[k]) / ray[k];
            if (t > low && t < high) ends.push_back(t);
        }
    }
    std::sort(ends.begin(), ends.end());
    return ends;
}

double worldLength(const ValueVolume& volume, const Vector& ray) {
    Vector world{};
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) world[i] += ray[k] * volume.axes[k][i];
    return std::sqrt(dot(world, world));
}

// Keeps what a place adds to the largest and the smallest.
void offer(const Reading& reading, double empty, Seen& seen) {
    if (reading.weight < 1e-6) return;
    const double high = reading.sum + (1 - reading.weight) * empty;
    const double low = reading.sum / reading.weight;
    seen.highest = seen.met ? std::max(seen.highest, high) : high;
    seen.lowest = seen.met ? std::min(seen.lowest, low) : low;
    seen.met = true;
}

}  // namespace

Seen followLine(const ValueVolume& volume, const Vector& from, const Vector& ray, double nearest,
                int between) {
    Seen seen;
    const double empty = emptyValue(volume);
    const std::vector<double> ends = crossings(volume, from, ray, nearest);
    double sum = 0, weights = 0;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        const double length = ends[i + 1] - ends[i];
        // Simpson's rule is exact for what is between two planes.
        for (const auto& [share, weight] : {std::pair{0.0, 1.0}, {0.5, 4.0}, {1.0, 1.0}}) {
            const Reading read = readAt(volume, placeAt(from, ray, ends[i] + share * length));
            sum += length * weight / 6 * read.sum;
            weights += length * weight / 6 * read.weight;
        }
        for (int n = 0; n <= between; ++n)
            offer(readAt(volume, placeAt(from, ray, ends[i] + length * n / between)), empty, seen);
    }
    seen.integral = sum * worldLength(volume, ray);
    seen.mean = weights > 0 ? sum / weights : 0;
    return seen;
}

std::vector<Seen> parallelLines(const ValueVolume& volume, const View& view, int between) {
    const Vector ray = indexComponents(volume.axes, view.direction);
    std::vector<Seen> picture;
    for (int y = 0; y < view.height; ++y) {
        for (int x = 0; x < view.width; ++x)
            picture.push_back(followLine(volume,
                                         indexOfPixel(view, volume.axes, volume.origin, x, y), ray,
                                         -kInfinity, between));
    }
    return picture;
}

std::vector<double> marchedHighest(const ValueVolume& volume, const View& view, double step,
                                   double share) {
    const Vector ray = indexComponents(volume.axes, view.direction);
    const double empty = emptyValue(volume);
    std::vector<double> picture;
    for (int y = 0; y < view.height; ++y) {
        for (int x = 0; x < view.width; ++x) {
            const Vector from = indexOfPixel(view, volume.axes, volume.origin, x, y);
            const std::vector<double> ends = crossings(volume, from, ray, -kInfinity);
            Seen seen;
            if (!ends.empty()) {
                for (double t = ends.front() + share * step; t < ends.back(); t += step)
                    offer(readAt(volume, placeAt(from, ray, t)), empty, seen);
            }
            picture.push_back(seen.highest);
        }
    }
    return picture;
}

}  // namespace reference
