// SPDX-License-Identifier: Apache-2.0
// Based on: Edwin Catmull and Raphael Rom, "A Class of Local Interpolating Splines", 1974; Don
// Mitchell and Arun Netravali, "Reconstruction Filters in Computer Graphics", 1988.
#include "screen/filter_table.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/portable_math.h"

namespace deltasplat {
namespace {

// Rounding a position moves a value by less than 1/1000 of its change over the filter's width.
constexpr double kStepsPerWidth = 1024;

double catmullRom(double x) {
    x = std::abs(x);
    if (x < 1) return 1 + x * x * (1.5 * x - 2.5);
    if (x < 2) return 2 - x * (4 - x * (2.5 - 0.5 * x));
    return 0;
}

double mitchell(double x) {
    x = std::abs(x);
    if (x < 1) return (16 + x * x * (21 * x - 36)) / 18;
    if (x < 2) return (32 - x * (60 - x * (36 - 7 * x))) / 18;
    return 0;
}

constexpr double kGaussReach = 1.5;

// Standard deviation 1/2, minus the value at the end.
double gauss(double x) {
    return std::max(0.0, portable::exp(-2 * x * x) - portable::exp(-2 * kGaussReach * kGaussReach));
}

// Overlap of a square of width `width` with one of width 1 at distance x.
double boxOverlap(double x, double width) {
    return std::max(0.0, std::min(x + 0.5, 0.5 * width) - std::max(x - 0.5, -0.5 * width));
}

// Reach of a filter widened by `stretch`, in lattice points.
double reachOf(WarpFilter filter, double stretch) {
    switch (filter) {
        case WarpFilter::kGauss:
            return kGaussReach * stretch;
        case WarpFilter::kBox:
            return 0.5 + 0.5 * stretch;
        default:
            return 2 * stretch;
    }
}

double weightAt(WarpFilter filter, double x, double stretch) {
    switch (filter) {
        case WarpFilter::kSharp:
            return catmullRom(x / stretch);
        case WarpFilter::kMitchell:
            return mitchell(x / stretch);
        case WarpFilter::kGauss:
            return gauss(x / stretch);
        case WarpFilter::kBox:
            return boxOverlap(x, stretch);
    }
    return 0;
}

// Weights of lattice points from `first` on.
struct Weights {
    int first;
    std::vector<double> values;

    double at(int point) const {
        const int i = point - first;
        return i >= 0 && i < int(values.size()) ? values[std::size_t(i)] : 0;
    }
};

Weights weightsOf(WarpFilter filter, double position, double stretch, int first, int count) {
    Weights weights{first, std::vector<double>(std::size_t(count))};
    for (int i = 0; i < count; ++i)
        weights.values[std::size_t(i)] = weightAt(filter, first + i - position, stretch);
    return weights;
}

// Returns weights for half as many points, `count` from `first` on. A halved point stands for the
// four points it was made of; the weights are the least-squares fit.
Weights halvedWeights(const Weights& whole, int first, int count) {
    // Dot products of two neighbours' coefficients, and of a point's own, times 64.
    constexpr double kWithNext = 1 * 3 + 3 * 1;
    constexpr double kWithItself = 1 * 1 + 3 * 3 + 3 * 3 + 1 * 1;
    Weights halved{first, std::vector<double>(std::size_t(count))};
    // Gaussian elimination of a tridiagonal matrix.
    std::vector<double> pivots(std::size_t(count), kWithItself);
    for (int i = 0; i < count; ++i) {
        const int source = 2 * (first + i) - 1;
        halved.values[i] = 8 * (whole.at(source) + 3 * whole.at(source + 1) +
                                3 * whole.at(source + 2) + whole.at(source + 3));
        if (i == 0) continue;
        const double factor = kWithNext / pivots[i - 1];
        pivots[i] -= factor * kWithNext;
        halved.values[i] -= factor * halved.values[i - 1];
    }
    for (int i = count - 1; i >= 0; --i) {
        if (i + 1 < count) halved.values[i] -= kWithNext * halved.values[i + 1];
        halved.values[i] /= pivots[i];
    }
    return halved;
}

// Halvings that weights correct. Earlier halvings drop only details far finer than pixels, and
// soften details as fine as pixels by a thirtieth.
constexpr int kMostMadeUpFor = 2;
// Extra points beside the filter's, so that weights do not change where further points are read.
constexpr int kBeside = 4;

// Weights of `count` points from `first` on, after halvings.
Weights weightsAfter(int halvings, WarpFilter filter, double position, double stretch, int first,
                     int count) {
    if (halvings == 0) return weightsOf(filter, position, stretch, first, count);
    // The points' sources, and the rest of the filter's reach.
    const double before = 2 * position + 0.5;
    const int reach = int(std::ceil(reachOf(filter, 2 * stretch))) + kBeside;
    const Weights whole = weightsAfter(halvings - 1, filter, before, 2 * stretch,
                                       int(std::floor(before)) - (reach - 1), 2 * reach);
    return halvedWeights(whole, first, count);
}

// Fades weights from the filter's end to the last point. Positive weights fade from the filter's
// first zero on, because the filter has none there: edges would show beyond it.
void fade(Weights& weights, double position, double stretch, double end) {
    constexpr double kFade = 0.5;
    const double last = 0.5 * double(weights.values.size());
    for (std::size_t i = 0; i < weights.values.size(); ++i) {
        const double distance = std::abs(weights.first + int(i) - position);
        double& weight = weights.values[i];
        weight *= std::clamp((last - distance) / (last - end), 0.0, 1.0);
        if (weight > 0) weight *= std::clamp((stretch - distance) / kFade + 1, 0.0, 1.0);
    }
}

// Changes weights slightly, in proportion, so that linear ramps stay in place.
void balance(Weights& weights, double position) {
    double moment = 0;
    double sizes[3] = {};  // sums of |weight| times the distance's powers 0, 1 and 2
    for (std::size_t i = 0; i < weights.values.size(); ++i) {
        const double distance = weights.first + int(i) - position;
        const double size = std::abs(weights.values[i]);
        moment += weights.values[i] * distance;
        sizes[0] += size;
        sizes[1] += size * distance;
        sizes[2] += size * distance * distance;
    }
    // The sum stays, and the moment becomes 0.
    const double slope = -moment * sizes[0] / (sizes[0] * sizes[2] - sizes[1] * sizes[1]);
    const double middle = sizes[1] / sizes[0];
    for (std::size_t i = 0; i < weights.values.size(); ++i) {
        const double distance = weights.first + int(i) - position;
        weights.values[i] += std::abs(weights.values[i]) * slope * (distance - middle);
    }
}

// Weights of `taps` points after halvings: closest to the filter, but faded and balanced.
Weights halvedFilter(WarpFilter filter, double position, double stretch, int halvings, int taps) {
    const int first = -(taps / 2 - 1);
    Weights weights = weightsAfter(std::min(halvings, kMostMadeUpFor), filter, position, stretch,
                                   first - kBeside, taps + 2 * kBeside);
    weights.values.erase(weights.values.begin(), weights.values.begin() + kBeside);
    weights.values.resize(std::size_t(taps));
    weights.first = first;
    fade(weights, position, stretch, reachOf(filter, stretch));
    balance(weights, position);
    return weights;
}

// A raster smaller than a pixel by more than this adds nothing visible.
constexpr double kMaxStretch = 16384;

}  // namespace

FilterTable::FilterTable(WarpFilter filter, double wantedStretch, int halvings) {
    const double stretch = std::ldexp(std::min(wantedStretch, kMaxStretch), -halvings);
    // Room for weights to fade.
    const double beyond = halvings > 0 ? 0.25 : 0;
    taps_ = 2 * int(std::ceil(reachOf(filter, stretch) + beyond));
    paddedTaps_ = (taps_ + 3) / 4 * 4;
    innerTaps_ = filter == WarpFilter::kMitchell ? taps_ : 2 * int(std::ceil(stretch));
    overshoots_ = filter == WarpFilter::kSharp || filter == WarpFilter::kMitchell;
    const int steps = int(std::bit_floor(unsigned(std::max(4.0, kStepsPerWidth / stretch))));
    shift_ = 32 - std::countr_zero(unsigned(steps));
    ownWeights_.resize(std::size_t(steps + 1) * paddedTaps_);
    weights_ = ownWeights_.data();
    for (int step = 0; step <= steps; ++step) {
        const double position = double(step) / steps;
        const std::vector<double> exact =
            (halvings > 0 ? halvedFilter(filter, position, stretch, halvings, taps_)
                          : weightsOf(filter, position, stretch, firstTap(0), taps_))
                .values;
        double sum = 0;
        for (const double weight : exact) sum += weight;
        double magnitude = 0;
        for (const double weight : exact) magnitude += std::abs(weight / sum);
        gain_ = std::max(gain_, magnitude);
        for (int tap = 0; tap < taps_; ++tap) {
            const std::size_t place = std::size_t(step) * paddedTaps_ + tap;
            ownWeights_[place] = float(exact[tap] / sum);
        }
    }
}

}  // namespace deltasplat
