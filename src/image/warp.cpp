// SPDX-License-Identifier: Apache-2.0
// Filters (filter_table.cpp) are applied along the raster's own axes. OpenImageIO's warp gives a
// like picture about 40 times slower (docs/decisions.md).
#include "image/warp.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <optional>
#include <vector>

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

// Knows which squares of a raster hold anything but zeros.
class RasterTiles {
  public:
    static constexpr int kTile = 8;

    explicit RasterTiles(const Raster& raster)
        : tiles_((raster.size + kTile - 1) / kTile),
          words_((tiles_.x + 63) / 64),
          full_(std::size_t(words_) * tiles_.y) {
        parallelFor(std::size_t(tiles_.y), [&](std::size_t row) { findRow(raster, int(row)); });
    }

    // Whether any pixel of [first, last], both inclusive, may not be zero.
    bool anyIn(glm::ivec2 first, glm::ivec2 last) const {
        first = glm::max(first / kTile, glm::ivec2(0));
        last = glm::min(last / kTile, tiles_ - 1);
        for (int row = first.y; row <= last.y; ++row) {
            for (int column = first.x; column <= last.x; ++column) {
                if (full_[std::size_t(words_) * row + column / 64] >> (column % 64) & 1)
                    return true;
            }
        }
        return false;
    }

  private:
    void findRow(const Raster& raster, int row) {
        const int lastY = std::min((row + 1) * kTile, raster.size.y);
        for (int y = row * kTile; y < lastY; ++y) {
            const glm::ivec2 span =
                raster.spans.empty() ? glm::ivec2(0, raster.size.x) : raster.spans[std::size_t(y)];
            if (span.x >= span.y) continue;
            const float* pixels = raster.values + std::size_t(raster.channels) * raster.size.x * y;
            for (int column = span.x / kTile; column <= (span.y - 1) / kTile; ++column) {
                const int first = raster.channels * column * kTile;
                const int last = raster.channels * std::min((column + 1) * kTile, raster.size.x);
                std::uint32_t bits = 0;  // of all values: faster than comparing each
                for (int i = first; i < last; ++i) bits |= std::bit_cast<std::uint32_t>(pixels[i]);
                full_[std::size_t(words_) * row + column / 64] |= std::uint64_t{bits != 0}
                                                                  << (column % 64);
            }
        }
    }

    glm::ivec2 tiles_;
    int words_;
    std::vector<std::uint64_t> full_;  // [tile row][words_]
};

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
          filterX_(wideX_ ? *wideX_ : narrowest(filter)),
          filterY_(wideY_ ? *wideY_ : narrowest(filter)) {}

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

    // The usual filters are made once.
    static const FilterTable& narrowest(WarpFilter filter) {
        static const FilterTable sharp(WarpFilter::kSharp, 1);
        static const FilterTable smooth(WarpFilter::kSmooth, 1);
        static const FilterTable linear(WarpFilter::kLinear, 1);
        return filter == WarpFilter::kSharp    ? sharp
               : filter == WarpFilter::kSmooth ? smooth
                                               : linear;
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
        for (int x = reached.first; x < inner.first; ++x) sample(x, y);
        sampleColumns(y, inner.first, inner.last);
        for (int x = inner.last; x < reached.last; ++x) sample(x, y);
    }

    void sampleColumns(int y, int first, int last) {
        if (first >= last) return;
        // A single pixel takes no step, which may be too long to be written as a fixed number.
        const glm::dvec2 along = last - first > 1 ? step() : glm::dvec2(0);
        sampleRun(raster_, filterX_, filterY_, fixed(positionOf(first, y)), fixed(along),
                  last - first, picture_.pixel(first, y));
    }

    static FixedPosition fixed(glm::dvec2 position) {
        const double unit = std::ldexp(1.0, 32);
        return {std::llround(position.x * unit), std::llround(position.y * unit)};
    }

    // Near the raster's edge: what lies outside counts as transparent.
    void sample(int x, int y) const {
        const FixedPosition position = fixed(positionOf(x, y));
        const glm::ivec2 first(filterX_.firstTap(int(position.x >> 32)),
                               filterY_.firstTap(int(position.y >> 32)));
        const float* weightX = filterX_.weights(std::uint32_t(position.x));
        const float* weightY = filterY_.weights(std::uint32_t(position.y));
        const glm::ivec2 taps{filterX_.taps(), filterY_.taps()};
        const glm::ivec2 begin = glm::max(glm::ivec2(0), -first);
        const glm::ivec2 end = glm::min(taps, raster_.size - first);
        float sum[4] = {};
        const int reached = filterX_.overshoots() ? taps.x : end.x;
        float low[4], high[4];
        for (int c = 0; c < raster_.channels; ++c) {
            low[c] = std::numeric_limits<float>::infinity();
            high[c] = -low[c];
        }
        for (int i = filterX_.overshoots() ? 0 : begin.x; i < reached; ++i) {
            const bool isInside = i >= begin.x && i < end.x;
            float column[4] = {};
            if (isInside) sumColumn(first + glm::ivec2(i, 0), weightY, begin.y, end.y, column);
            for (int c = 0; c < raster_.channels; ++c) {
                sum[c] += weightX[i] * column[c];
                if (!isInner(filterX_, i)) continue;
                low[c] = std::min(low[c], column[c]);
                high[c] = std::max(high[c], column[c]);
            }
        }
        for (int c = 0; filterX_.overshoots() && c < raster_.channels; ++c)
            sum[c] = std::min(std::max(sum[c], low[c]), high[c]);
        write(sum, picture_.pixel(x, y));
    }

    static bool isInner(const FilterTable& filter, int tap) {
        return tap >= filter.firstInnerTap() && tap < filter.firstInnerTap() + filter.innerTaps();
    }

    // Weighs a column from its first tap on, of which rows [begin, end) lie inside.
    void sumColumn(glm::ivec2 first, const float* weightY, int begin, int end,
                   float* column) const {
        for (int c = 0; c < raster_.channels; ++c) {
            float low = std::numeric_limits<float>::infinity();
            float high = -low;
            for (int j = 0; j < filterY_.taps(); ++j) {
                const float tap = j >= begin && j < end ? tapAt(first + glm::ivec2(0, j))[c] : 0;
                column[c] += weightY[j] * tap;
                if (!isInner(filterY_, j)) continue;
                low = std::min(low, tap);
                high = std::max(high, tap);
            }
            if (filterY_.overshoots()) column[c] = std::min(std::max(column[c], low), high);
        }
    }

    // Points to a tap that lies inside.
    const float* tapAt(glm::ivec2 p) const {
        return raster_.values + raster_.channels * (std::ptrdiff_t{raster_.size.x} * p.y + p.x);
    }

    void write(const float* sum, float* out) const {
        out[3] = sum[raster_.channels - 1];
        for (int c = 0; c < 3; ++c)
            out[c] = raster_.channels == 1 ? sum[0] * raster_.color[c] : sum[c];
    }

    const Raster& raster_;
    RasterTiles tiles_;
    const glm::dmat3& map_;
    Image& picture_;
    std::optional<FilterTable> wideX_;
    std::optional<FilterTable> wideY_;
    const FilterTable& filterX_;
    const FilterTable& filterY_;
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
