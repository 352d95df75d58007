// SPDX-License-Identifier: Apache-2.0
// Based on: Edwin Catmull and Raphael Rom, "A Class of Local Interpolating Splines", 1974; the
// filter is applied along the raster's own axes. OpenImageIO's warp gives the same picture about 40
// times slower (docs/decisions.md).
#include "image/warp.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "image/warp_kernels.h"
#include "parallel.h"

namespace deltasplat {
namespace {

// Columns [first, last) of a picture row.
struct Columns {
    int first = 0;
    int last = 0;
};

// Narrows columns to those whose position a + b * (column + 0.5) lies within [low, high].
Columns clipColumns(const Columns& columns, double a, double b, double low, double high) {
    if (!(low <= high)) return {};
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
          filterX_(std::max(1.0, stretchOf(map_[0].x, map_[1].x))),
          filterY_(std::max(1.0, stretchOf(map_[0].y, map_[1].y))) {}

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

    // The columns whose positions lie within [low, high] on both raster axes.
    Columns columnsWithin(int y, glm::dvec2 low, glm::dvec2 high) const {
        const glm::dvec2 start = rowStart(y);
        Columns columns{0, picture_.size.x};
        for (int axis = 0; axis < 2; ++axis) {
            columns = clipColumns(columns, start[axis], step()[axis], low[axis], high[axis]);
        }
        return columns;
    }

    void warpRow(int y) {
        const glm::dvec2 last = raster_.size - 1;
        const glm::dvec2 reach(filterX_.taps() / 2, filterY_.taps() / 2);
        const Columns reached = columnsWithin(y, -reach, last + reach);
        // A thousandth of a pixel more, so that rounding lets no tap fall outside.
        const glm::dvec2 padded(filterX_.paddedTaps() - filterX_.taps(), 0);
        Columns inner = columnsWithin(y, reach - 0.999, last - reach - padded - 0.001);
        if (inner.first >= inner.last) inner = {reached.last, reached.last};
        for (int x = reached.first; x < inner.first; ++x) sample(x, y);
        if (inner.first < inner.last) {
            sampleRun(raster_, filterX_, filterY_, positionOf(inner.first, y), step(),
                      inner.last - inner.first, picture_.pixel(inner.first, y));
        }
        for (int x = inner.last; x < reached.last; ++x) sample(x, y);
        for (int x = reached.first; x < reached.last; ++x) clamp(picture_.pixel(x, y));
    }

    // Near the raster's edge: what lies outside counts as transparent.
    void sample(int x, int y) const {
        const glm::dvec2 position = positionOf(x, y);
        const glm::ivec2 whole(glm::floor(position));
        const glm::ivec2 first(filterX_.firstTap(whole.x), filterY_.firstTap(whole.y));
        const float* weightX = filterX_.weights(position.x - whole.x);
        const float* weightY = filterY_.weights(position.y - whole.y);
        const glm::ivec2 taps{filterX_.taps(), filterY_.taps()};
        const glm::ivec2 begin = glm::max(glm::ivec2(0), -first);
        const glm::ivec2 end = glm::min(taps, raster_.size - first);
        float* out = picture_.pixel(x, y);
        for (int j = begin.y; j < end.y; ++j) {
            const float* row = raster_.rgba + 4 * std::size_t(first.y + j) * raster_.size.x;
            for (int i = begin.x; i < end.x; ++i) {
                const float* pixel = row + 4 * std::size_t(first.x + i);
                const float weight = weightY[4 * j] * weightX[4 * i];
                for (int c = 0; c < 4; ++c) out[c] += weight * pixel[c];
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
    FilterTable filterX_;
    FilterTable filterY_;
};

}  // namespace

void warp(const Raster& raster, const glm::dmat3& rasterFromPixel, Image& picture) {
    if (raster.size.x > 0 && raster.size.y > 0) Warper(raster, rasterFromPixel, picture).run();
}

}  // namespace deltasplat
