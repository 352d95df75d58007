// SPDX-License-Identifier: Apache-2.0
// Filters (filter_table.cpp) are applied along the raster's own axes. OpenImageIO's warp gives a
// like picture about 40 times slower (docs/decisions.md).
#include "image/warp.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <optional>
#include <vector>

#include "image/raster_reader.h"
#include "image/warp_kernels.h"
#include "parallel.h"
#include "portable_math.h"

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
    Warper(const Raster& raster, const glm::dmat3& rasterFromPixel, WarpFilter filter,
           Image& picture)
        : raster_(raster),
          tiles_(raster),
          map_(rasterFromPixel),
          picture_(picture),
          wideX_(tableFor(filter, stretchOf(map_[0].x, map_[1].x))),
          wideY_(tableFor(filter, stretchOf(map_[0].y, map_[1].y))),
          filterX_(wideX_ ? *wideX_ : narrowestFilter(filter)),
          filterY_(wideY_ ? *wideY_ : narrowestFilter(filter)),
          sampler_(raster, filterX_, filterY_) {}

    double gain() const { return filterX_.gain() * filterY_.gain(); }
    void run() {
        const int bands = (picture_.size.y + kBand - 1) / kBand;
        parallelFor(std::size_t(bands), [&](std::size_t band) { warpBand(int(band) * kBand); });
    }

  private:
    // What is looked at at once to find out whether the raster is empty there.
    static constexpr int kBand = 8;
    static constexpr int kStretch = 16;

    // How far a step of one picture pixel, in whichever direction is worst, moves along one raster
    // axis.
    static double stretchOf(double alongX, double alongY) {
        return portable::hypot(alongX, alongY);
    }

    static std::optional<FilterTable> tableFor(WarpFilter filter, double stretch) {
        if (!(stretch > 1)) return std::nullopt;
        return std::optional<FilterTable>(std::in_place, filter, stretch);
    }

    glm::dvec2 step() const { return map_[0]; }
    // Positions run relative to the raster's first pixel, so that large index offsets cost no
    // precision.
    glm::dvec2 rowStart(int y) const {
        return glm::dvec2(map_[1]) * (y + 0.5) + glm::dvec2(map_[2]) - glm::dvec2(raster_.min);
    }
    glm::dvec2 positionOf(int x, int y) const { return rowStart(y) + step() * (x + 0.5); }

    // The columns whose positions lie within [low, high] on both raster axes.
    Columns columnsWithin(int y, Columns columns, glm::dvec2 low, glm::dvec2 high) const {
        const glm::dvec2 start = rowStart(y);
        for (int axis = 0; axis < 2; ++axis) {
            columns = clipColumns(columns, start[axis], step()[axis], low[axis], high[axis]);
        }
        return columns;
    }

    // Warps kBand rows, but for stretches where the raster is empty.
    void warpBand(int firstRow) {
        const int lastRow = std::min(firstRow + kBand, picture_.size.y);
        std::vector<Columns> stretches;
        for (int x = 0; x < picture_.size.x; x += kStretch) {
            const int next = std::min(x + kStretch, picture_.size.x);
            if (isEmpty({x, firstRow}, {next - 1, lastRow - 1})) continue;
            if (!stretches.empty() && stretches.back().last == x) {
                stretches.back().last = next;
            } else {
                stretches.push_back({x, next});
            }
        }
        for (int y = firstRow; y < lastRow; ++y) {
            for (const Columns& columns : stretches) warpRow(y, columns);
        }
    }

    bool isEmpty(glm::ivec2 first, glm::ivec2 last) const {
        const glm::dvec2 corners[] = {positionOf(first.x, first.y), positionOf(last.x, first.y),
                                      positionOf(first.x, last.y), positionOf(last.x, last.y)};
        glm::dvec2 low = corners[0];
        glm::dvec2 high = corners[0];
        for (const glm::dvec2& corner : corners) {
            low = glm::min(low, corner);
            high = glm::max(high, corner);
        }
        const glm::dvec2 reach(filterX_.taps() / 2 + 1, filterY_.taps() / 2 + 1);
        const glm::dvec2 edge = raster_.size - 1;
        low = glm::max(glm::floor(low) - reach, glm::dvec2(0));
        high = glm::min(glm::floor(high) + reach, edge);
        return !(low.x <= high.x && low.y <= high.y) ||
               !tiles_.anyIn(glm::ivec2(low), glm::ivec2(high));
    }

    void warpRow(int y, const Columns& within) {
        const glm::dvec2 last = raster_.size - 1;
        const glm::dvec2 reach(filterX_.taps() / 2, filterY_.taps() / 2);
        const Columns reached = columnsWithin(y, within, -reach, last + reach);
        // A thousandth of a pixel more, so that rounding lets no tap fall outside.
        const glm::dvec2 padded(filterX_.paddedTaps() - filterX_.taps(), 0);
        Columns inner = columnsWithin(y, reached, reach - 0.999, last - reach - padded - 0.001);
        if (inner.first >= inner.last) inner = {reached.last, reached.last};
        for (int x = reached.first; x < inner.first; ++x)
            sampler_.sample(fixedPosition(positionOf(x, y)), picture_.pixel(x, y));
        sampleColumns(y, inner.first, inner.last);
        for (int x = inner.last; x < reached.last; ++x)
            sampler_.sample(fixedPosition(positionOf(x, y)), picture_.pixel(x, y));
    }

    void sampleColumns(int y, int first, int last) {
        if (first >= last) return;
        // A single pixel takes no step, which may be too long to be written as a fixed number.
        const glm::dvec2 along = last - first > 1 ? step() : glm::dvec2(0);
        sampleRun(raster_, filterX_, filterY_, fixedPosition(positionOf(first, y)),
                  fixedPosition(along), last - first, picture_.pixel(first, y));
    }

    const Raster& raster_;
    RasterTiles tiles_;
    const glm::dmat3& map_;
    Image& picture_;
    std::optional<FilterTable> wideX_;
    std::optional<FilterTable> wideY_;
    const FilterTable& filterX_;
    const FilterTable& filterY_;
    EdgeSampler sampler_;
};

}  // namespace

void warp(const Raster& raster, const glm::dmat3& rasterFromPixel, WarpFilter filter,
          Image& picture) {
    if (raster.size.x > 0 && raster.size.y > 0)
        Warper(raster, rasterFromPixel, filter, picture).run();
}

double warpGain(const glm::dmat3& rasterFromPixel) {
    const Raster none;
    Image picture;
    return Warper(none, rasterFromPixel, WarpFilter::kSharp, picture).gain();
}

}  // namespace deltasplat
