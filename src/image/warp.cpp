// SPDX-License-Identifier: Apache-2.0
// Based on: Edwin Catmull and Raphael Rom, "A Class of Local Interpolating Splines", 1974; the
// filter is applied along the raster's own axes. OpenImageIO's warp gives the same picture about 40
// times slower (docs/decisions.md).
#include "image/warp.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <vector>

#include "image/warp_kernels.h"
#include "parallel.h"

namespace deltasplat {
namespace {

double catmullRom(double x) {
    x = std::abs(x);
    if (x < 1) return 1 + x * x * (1.5 * x - 2.5);
    if (x < 2) return 2 - x * (4 - x * (2.5 - 0.5 * x));
    return 0;
}

// Filter weights along one axis for any position between two lattice points.
class AxisFilter {
  public:
    // stretch: lattice points a picture pixel, at least 1.
    explicit AxisFilter(double stretch)
        : stretch_(stretch), weights_(std::size_t(2 * int(std::ceil(2 * stretch)))) {}

    int taps() const { return int(weights_.size()); }
    // Splits a position into its first lattice point and the weights from there on.
    const std::vector<float>& at(double position, int& first) {
        const double whole = std::floor(position);
        first = int(whole) - (taps() / 2 - 1);
        double sum = 0;
        for (int tap = 0; tap < taps(); ++tap) {
            sum += catmullRom((first + tap - position) / stretch_);
        }
        for (int tap = 0; tap < taps(); ++tap) {
            weights_[tap] = float(catmullRom((first + tap - position) / stretch_) / sum);
        }
        return weights_;
    }

  private:
    double stretch_;
    std::vector<float> weights_;
};

const FourTapTable& fourTapTable() {
    static const FourTapTable kTable = [] {
        FourTapTable table;
        for (int step = 0; step <= FourTapTable::kSteps; ++step) {
            std::array<float, 4> plain;
            for (int tap = 0; tap < 4; ++tap) {
                plain[tap] = float(catmullRom(tap - 1 - double(step) / FourTapTable::kSteps));
            }
            table.plain.push_back(plain);
            auto& repeated = table.repeated.emplace_back();
            for (int i = 0; i < 16; ++i) repeated[i] = plain[i / 4];
        }
        return table;
    }();
    return kTable;
}

// Columns [first, last) of a picture row.
struct Columns {
    int first = 0;
    int last = 0;
};

// Narrows columns to those whose position a + b * (column + 0.5) lies within [low, high].
Columns clipColumns(const Columns& columns, double a, double b, double low, double high) {
    if (b == 0) return a >= low && a <= high ? columns : Columns{};
    const double x0 = (low - a) / b - 0.5;
    const double x1 = (high - a) / b - 0.5;
    const double first = std::ceil(std::min(x0, x1));
    const double last = std::floor(std::max(x0, x1)) + 1;
    if (first >= columns.last || last <= columns.first) return {};
    return {int(std::max<double>(first, columns.first)), int(std::min<double>(last, columns.last))};
}

class Warper {
  public:
    Warper(const Raster& raster, const glm::dmat3& rasterFromPixel, Image& picture)
        : raster_(raster),
          map_(rasterFromPixel),
          picture_(picture),
          stretch_(std::max(1.0, stretchOf(map_[0].x, map_[1].x)),
                   std::max(1.0, stretchOf(map_[0].y, map_[1].y))) {}

    void run() {
        parallelFor(std::size_t(picture_.size.y), [&](std::size_t y) { warpRow(int(y)); });
    }

  private:
    // How far a step of one picture pixel, in whichever direction is worst, moves along one raster
    // axis.
    static double stretchOf(double alongX, double alongY) { return std::hypot(alongX, alongY); }

    glm::dvec2 step() const { return map_[0]; }
    // Positions run relative to the raster's first pixel, so that large index offsets cost no
    // precision.
    glm::dvec2 rowStart(int y) const {
        return glm::dvec2(map_[1]) * (y + 0.5) + glm::dvec2(map_[2]) - glm::dvec2(raster_.min);
    }
    glm::dvec2 positionOf(int x, int y) const { return rowStart(y) + step() * (x + 0.5); }

    // The columns whose positions keep at least `margin` lattice points inside the raster's edge.
    Columns columnsWithin(int y, glm::dvec2 margin) const {
        const glm::dvec2 start = rowStart(y);
        Columns columns{0, picture_.size.x};
        for (int axis = 0; axis < 2; ++axis) {
            columns = clipColumns(columns, start[axis], step()[axis], margin[axis],
                                  raster_.size[axis] - 1 - margin[axis]);
        }
        return columns;
    }

    void warpRow(int y) {
        const Columns reached = columnsWithin(y, -2.0 * stretch_);
        Columns inner = stretch_ == glm::dvec2(1) ? columnsWithin(y, glm::dvec2(1.001)) : Columns{};
        if (inner.first >= inner.last) inner = {reached.last, reached.last};
        AxisFilter filterX(stretch_.x);
        AxisFilter filterY(stretch_.y);
        for (int x = reached.first; x < inner.first; ++x) sample(x, y, filterX, filterY);
        if (inner.first < inner.last) {
            sampleRun(raster_, fourTapTable(), positionOf(inner.first, y), step(),
                      inner.last - inner.first, picture_.pixel(inner.first, y));
        }
        for (int x = inner.last; x < reached.last; ++x) sample(x, y, filterX, filterY);
        for (int x = reached.first; x < reached.last; ++x) clamp(picture_.pixel(x, y));
    }

    // Any filter width, any place: what lies outside counts as transparent.
    void sample(int x, int y, AxisFilter& filterX, AxisFilter& filterY) const {
        const glm::dvec2 position = positionOf(x, y);
        glm::ivec2 first;
        const std::vector<float>& weightX = filterX.at(position.x, first.x);
        const std::vector<float>& weightY = filterY.at(position.y, first.y);
        const glm::ivec2 taps{filterX.taps(), filterY.taps()};
        const glm::ivec2 begin = glm::max(glm::ivec2(0), -first);
        const glm::ivec2 end = glm::min(taps, raster_.size - first);
        float* out = picture_.pixel(x, y);
        for (int j = begin.y; j < end.y; ++j) {
            const float* row = raster_.rgba + 4 * std::size_t(first.y + j) * raster_.size.x;
            for (int i = begin.x; i < end.x; ++i) {
                const float* pixel = row + 4 * std::size_t(first.x + i);
                for (int c = 0; c < 4; ++c) out[c] += weightY[j] * weightX[i] * pixel[c];
            }
        }
    }

    static void clamp(float* pixel) {
        for (int c = 0; c < 4; ++c) pixel[c] = std::max(pixel[c], 0.0f);
        pixel[3] = std::min(pixel[3], 1.0f);
    }

    const Raster& raster_;
    const glm::dmat3& map_;
    Image& picture_;
    glm::dvec2 stretch_;  // lattice points a picture pixel along each raster axis, at least 1
};

}  // namespace

void warp(const Raster& raster, const glm::dmat3& rasterFromPixel, Image& picture) {
    if (raster.size.x > 0 && raster.size.y > 0) Warper(raster, rasterFromPixel, picture).run();
}

}  // namespace deltasplat
