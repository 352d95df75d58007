// SPDX-License-Identifier: Apache-2.0
// Based on: Edwin Catmull and Raphael Rom, "A Class of Local Interpolating Splines", 1974; the
// filter is applied along the raster's own axes. OpenImageIO's warp gives the same picture about 40
// times slower (docs/decisions.md).
#include "image/warp.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "parallel.h"

namespace deltasplat {
namespace {

double catmullRom(double x) {
    x = std::abs(x);
    if (x < 1) return 1 + x * x * (1.5 * x - 2.5);
    if (x < 2) return 2 - x * (4 - x * (2.5 - 0.5 * x));
    return 0;
}

// Filter weights along one axis for every position between two lattice points, in steps of
// 1/kSteps.
class FilterTable {
  public:
    // stretch: lattice points a picture pixel, at least 1.
    explicit FilterTable(double stretch)
        : taps_(2 * int(std::ceil(2 * stretch))), weights_(std::size_t(taps_) * (kSteps + 1)) {
        for (int step = 0; step <= kSteps; ++step) {
            float* weights = &weights_[std::size_t(taps_) * step];
            std::vector<double> exact(taps_);
            double sum = 0;
            for (int tap = 0; tap < taps_; ++tap) {
                exact[tap] = catmullRom((tap - (taps_ / 2 - 1) - double(step) / kSteps) / stretch);
                sum += exact[tap];
            }
            for (int tap = 0; tap < taps_; ++tap) weights[tap] = float(exact[tap] / sum);
        }
    }

    int taps() const { return taps_; }
    // Splits a position into its first lattice point and the weights from there on.
    const float* at(double position, int& first) const {
        const double whole = std::floor(position);
        first = int(whole) - (taps_ / 2 - 1);
        return &weights_[std::size_t(taps_) * std::size_t((position - whole) * kSteps + 0.5)];
    }

  private:
    // Fine enough that rounding a position moves a value by less than 1/2000 of its slope.
    static constexpr int kSteps = 1024;
    int taps_;
    std::vector<float> weights_;
};

// The picture columns [first, last) whose positions a + b * (column + 0.5) lie within [low, high].
void clipColumns(double a, double b, double low, double high, double& first, double& last) {
    if (b == 0) {
        if (a < low || a > high) last = first;
        return;
    }
    const double x0 = (low - a) / b - 0.5;
    const double x1 = (high - a) / b - 0.5;
    first = std::max(first, std::ceil(std::min(x0, x1)));
    last = std::min(last, std::floor(std::max(x0, x1)) + 1);
}

class Warper {
  public:
    Warper(const Raster& raster, const glm::dmat3& rasterFromPixel, Image& picture)
        : raster_(raster),
          map_(rasterFromPixel),
          picture_(picture),
          filterX_(std::max(1.0, stretchOf(map_[0].x, map_[1].x))),
          filterY_(std::max(1.0, stretchOf(map_[0].y, map_[1].y))) {}

    void run() {
        parallelFor(std::size_t(picture_.size.y), [&](std::size_t y) { warpRow(int(y)); });
    }

  private:
    // How far a step of one picture pixel, in whichever direction is worst, moves along one raster
    // axis.
    static double stretchOf(double alongX, double alongY) { return std::hypot(alongX, alongY); }

    void warpRow(int y) {
        // Positions run relative to the raster's first pixel, so that large index offsets cost no
        // precision.
        const double x0 = map_[1].x * (y + 0.5) + map_[2].x - raster_.min.x;
        const double y0 = map_[1].y * (y + 0.5) + map_[2].y - raster_.min.y;
        double first = 0;
        double last = picture_.size.x;
        const double reachX = filterX_.taps() / 2;
        const double reachY = filterY_.taps() / 2;
        clipColumns(x0, map_[0].x, -reachX, raster_.size.x - 1 + reachX, first, last);
        clipColumns(y0, map_[0].y, -reachY, raster_.size.y - 1 + reachY, first, last);
        for (int x = int(first); x < last; ++x) {
            sample(x0 + map_[0].x * (x + 0.5), y0 + map_[0].y * (x + 0.5), picture_.pixel(x, y));
        }
    }

    void sample(double x, double y, float* out) const {
        int firstX = 0;
        int firstY = 0;
        const float* weightX = filterX_.at(x, firstX);
        const float* weightY = filterY_.at(y, firstY);
        const int beginX = std::max(0, -firstX);
        const int endX = std::min(filterX_.taps(), raster_.size.x - firstX);
        const int beginY = std::max(0, -firstY);
        const int endY = std::min(filterY_.taps(), raster_.size.y - firstY);
        std::array<float, 4> sum{};
        for (int j = beginY; j < endY; ++j) {
            const float* row = raster_.rgba + 4 * std::size_t(firstY + j) * raster_.size.x;
            std::array<float, 4> rowSum{};
            for (int i = beginX; i < endX; ++i) {
                const float* pixel = row + 4 * std::size_t(firstX + i);
                for (int c = 0; c < 4; ++c) rowSum[c] += weightX[i] * pixel[c];
            }
            for (int c = 0; c < 4; ++c) sum[c] += weightY[j] * rowSum[c];
        }
        for (int c = 0; c < 4; ++c) out[c] = std::max(sum[c], 0.0f);
        out[3] = std::min(out[3], 1.0f);
    }

    const Raster& raster_;
    const glm::dmat3& map_;
    Image& picture_;
    FilterTable filterX_;
    FilterTable filterY_;
};

}  // namespace

void warp(const Raster& raster, const glm::dmat3& rasterFromPixel, Image& picture) {
    if (raster.size.x > 0 && raster.size.y > 0) Warper(raster, rasterFromPixel, picture).run();
}

}  // namespace deltasplat
