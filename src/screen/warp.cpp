// SPDX-License-Identifier: Apache-2.0
// Filters (filter_table.cpp) run along the raster's axes; much finer rasters are halved first
// (halved_raster.h). OpenImageIO's warp is similar and 40 times slower (docs/decisions.md).
#include "screen/warp.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <optional>
#include <vector>

#include "base/parallel.h"
#include "base/portable_math.h"
#include "screen/clear_image.h"
#include "screen/halved_raster.h"
#include "screen/warp_kernels.h"
#include "screen/warp_region.h"

namespace deltasplat {
namespace {

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

Columns bothOf(const Columns& a, const Columns& b) {
    return {std::max(a.first, b.first), std::min(a.last, b.last)};
}

// Bounds of raster positions of a box of pixel centres.
struct PositionBox {
    glm::dvec2 low, high;
};

template <class PositionOf>
PositionBox positionsOf(glm::ivec2 first, glm::ivec2 last, const PositionOf& positionOf) {
    const glm::dvec2 corner = positionOf(first);
    PositionBox box{corner, corner};
    for (const glm::ivec2 other : {glm::ivec2(last.x, first.y), {first.x, last.y}, last}) {
        const glm::dvec2 position = positionOf(other);
        box = {glm::min(box.low, position), glm::max(box.high, position)};
    }
    return box;
}

// The filter along a raster axis under a map into a picture.
class AxisFilter {
  public:
    // @param alongX, alongY  movement along the axis per picture pixel
    AxisFilter(WarpFilter filter, double alongX, double alongY)
        : AxisFilter(filter, portable::hypot(alongX, alongY)) {}

    // Halvings of the raster along the axis.
    int halvings() const { return halvings_; }
    const FilterTable& table() const { return wide_ ? *wide_ : *narrow_; }

  private:
    // Least halved pixels per picture pixel; fewer would lose visible details.
    static constexpr double kLeastHalved = 1.5;
    static constexpr int kMostHalvings = 12;

    AxisFilter(WarpFilter filter, double stretch) : narrow_(&narrowestFilter(filter)) {
        if (!(stretch > 1)) return;
        if (filter == WarpFilter::kSharp) {
            for (double halved = stretch / 2; halved >= kLeastHalved; halved /= 2) {
                if (++halvings_ == kMostHalvings) break;
            }
        }
        wide_.emplace(filter, stretch, halvings_);
    }

    int halvings_ = 0;
    const FilterTable* narrow_;
    std::optional<FilterTable> wide_;
};

struct AxisFilters {
    AxisFilter x, y;

    AxisFilters(const glm::dmat3& rasterFromPixel, WarpFilter filter)
        : x(filter, rasterFromPixel[0].x, rasterFromPixel[1].x),
          y(filter, rasterFromPixel[0].y, rasterFromPixel[1].y) {}
    double gain() const { return x.table().gain() * y.table().gain(); }
    // Lattice points that are read to either side of a place.
    glm::ivec2 reach() const { return glm::ivec2(x.table().taps(), y.table().taps()) / 2 + 1; }
};

// A raster with the filters' halvings, and the map to its lattice.
class FilteredRaster {
  public:
    FilteredRaster(const Raster& raster, const glm::dmat3& rasterFromPixel,
                   const AxisFilters& filters, const PicturePart& part,
                   std::pmr::memory_resource& memory)
        : raster_(raster), map_(rasterFromPixel) {
        const int most = std::max(filters.x.halvings(), filters.y.halvings());
        for (int done = 0; done < most; ++done) {
            const glm::bvec2 along(done < filters.x.halvings(), done < filters.y.halvings());
            for (int axis = 0; axis < 2; ++axis) {
                if (!along[axis]) continue;
                for (int column = 0; column < 2; ++column) map_[column][axis] /= 2;
                map_[2][axis] = HalvedRaster::halved(map_[2][axis]);
            }
            // Of n points beside the shown ones, (n - 3.5) / 2 stay defined.
            const glm::ivec2 beside = (filters.reach() + 4) << (most - done - 1);
            HalvedRaster halved(raster_, along, pointsBehind(part, beside), memory);
            halved_.emplace(std::move(halved));
            raster_ = halved_->raster();
        }
    }
    FilteredRaster(const FilteredRaster&) = delete;
    FilteredRaster& operator=(const FilteredRaster&) = delete;

    const Raster& raster() const { return raster_; }
    const glm::dmat3& map() const { return map_; }

  private:
    // The lattice points that a part shows, and a margin.
    LatticeBox pointsBehind(const PicturePart& part, glm::ivec2 beside) const {
        const PositionBox shown = positionsOf(part.first, part.last() - 1, [&](glm::ivec2 pixel) {
            return glm::dvec2(map_ * glm::dvec3(glm::dvec2(pixel) + 0.5, 1));
        });
        const glm::dvec2 far(1 << 30);
        const glm::dvec2 first = glm::clamp(glm::floor(shown.low), -far, far);
        const glm::dvec2 last = glm::clamp(glm::ceil(shown.high), -far, far);
        return {glm::ivec2(first) - beside, glm::ivec2(last) + beside + 1};
    }

    Raster raster_;
    glm::dmat3 map_;
    std::optional<HalvedRaster> halved_;
};

class Warper {
  public:
    Warper(const Raster& raster, const glm::dmat3& rasterFromPixel, const AxisFilters& filters,
           const PicturePart& part)
        : raster_(raster),
          tiles_(raster),
          map_(rasterFromPixel),
          part_(part),
          filterX_(filters.x.table()),
          filterY_(filters.y.table()),
          reach_(filters.reach()),
          sampler_(raster, filterX_, filterY_) {}

    void run() {
        const int first = part_.first.y / kBand;
        const int end = (part_.last().y + kBand - 1) / kBand;
        parallelFor(std::size_t(std::max(end - first, 0)),
                    [&](std::size_t band) { warpBand((first + int(band)) * kBand); });
    }

  private:
    // Size of the tiles that are tested for emptiness.
    static constexpr int kBand = 8;
    static constexpr int kStretch = 16;

    glm::dvec2 step() const { return map_[0]; }
    // Positions run relative to the raster's origin, so that large index offsets cost no precision.
    glm::dvec2 rowStart(int y) const {
        return glm::dvec2(map_[1]) * (y + 0.5) + glm::dvec2(map_[2]) - glm::dvec2(raster_.origin());
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

    // Warps kBand rows except empty stretches. Bands and stretches do not depend on the part.
    void warpBand(int firstRow) {
        const int lastRow = std::min(firstRow + kBand, part_.size.y);
        std::vector<Columns> stretches;
        for (int x = part_.first.x / kStretch * kStretch; x < part_.last().x; x += kStretch) {
            const int next = std::min(x + kStretch, part_.size.x);
            if (isEmpty({x, firstRow}, {next - 1, lastRow - 1})) continue;
            const Columns columns{std::max(x, part_.first.x), std::min(next, part_.last().x)};
            if (!stretches.empty() && stretches.back().last == x) {
                stretches.back().last = columns.last;
            } else {
                stretches.push_back(columns);
            }
        }
        for (int y = std::max(firstRow, part_.first.y); y < std::min(lastRow, part_.last().y); ++y)
            warpRow(y, stretches);
    }

    bool isEmpty(glm::ivec2 first, glm::ivec2 last) const {
        const PositionBox shown = positionsOf(
            first, last, [&](glm::ivec2 pixel) { return positionOf(pixel.x, pixel.y); });
        const glm::dvec2 edge = raster_.size - 1;
        const glm::dvec2 before = raster_.min - raster_.origin();
        const glm::dvec2 low = glm::max(glm::floor(shown.low) - before - reach_, glm::dvec2(0));
        const glm::dvec2 high = glm::min(glm::floor(shown.high) - before + reach_, edge);
        return !(low.x <= high.x && low.y <= high.y) ||
               !tiles_.anyIn(glm::ivec2(low), glm::ivec2(high));
    }

    void warpRow(int y, const std::vector<Columns>& stretches) {
        const Columns all{part_.first.x, part_.last().x};
        if (stretches.empty()) return clearColumns(y, all);
        const glm::dvec2 last = raster_.extent() - 1;
        const glm::dvec2 reach(filterX_.taps() / 2, filterY_.taps() / 2);
        const Columns reached = columnsWithin(y, {0, part_.size.x}, -reach, last + reach);
        // The thousandth of a pixel keeps rounded taps inside.
        const glm::dvec2 padded(filterX_.paddedTaps() - filterX_.taps(), 0);
        Columns inner = columnsWithin(y, reached, reach - 0.999, last - reach - padded - 0.001);
        if (inner.first >= inner.last) inner = {reached.last, reached.last};
        int written = all.first;
        for (const Columns& stretch : stretches) {
            const Columns columns = bothOf(stretch, reached);
            if (columns.first >= columns.last) continue;
            clearColumns(y, {written, columns.first});
            written = columns.last;
            sampleSingly(y, bothOf(columns, {reached.first, inner.first}));
            sampleColumns(y, inner, bothOf(columns, inner));
            sampleSingly(y, bothOf(columns, {inner.last, reached.last}));
        }
        clearColumns(y, {written, all.last});
    }

    void clearColumns(int y, const Columns& columns) {
        if (columns.first >= columns.last) return;
        std::fill_n(part_.pixel(columns.first, y), 4 * (columns.last - columns.first), 0.0f);
    }

    void sampleSingly(int y, const Columns& columns) {
        for (int x = columns.first; x < columns.last; ++x)
            sampler_.sample(fixedPosition(positionOf(x, y), raster_), part_.pixel(x, y));
    }

    // Samples columns of a row, with positions counted from the first column of `inner`.
    void sampleColumns(int y, const Columns& inner, const Columns& columns) {
        if (columns.first >= columns.last) return;
        // A single pixel needs no step, which might overflow a fixed number.
        const FixedPosition along =
            fixedPosition(inner.last - inner.first > 1 ? step() : glm::dvec2(0));
        FixedPosition position = fixedPosition(positionOf(inner.first, y), raster_);
        position.x += along.x * (columns.first - inner.first);
        position.y += along.y * (columns.first - inner.first);
        sampleRun(raster_, filterX_, filterY_, position, along, columns.last - columns.first,
                  part_.pixel(columns.first, y));
    }

    const Raster& raster_;
    RasterTiles tiles_;
    const glm::dmat3& map_;
    const PicturePart& part_;
    const FilterTable& filterX_;
    const FilterTable& filterY_;
    const glm::dvec2 reach_;
    EdgeSampler sampler_;
};

}  // namespace

double warp(const Raster& raster, const glm::dmat3& rasterFromPixel, WarpFilter filter,
            const PicturePart& part, std::pmr::memory_resource& memory) {
    const AxisFilters filters(rasterFromPixel, filter);
    if (raster.size.x > 0 && raster.size.y > 0) {
        const FilteredRaster filtered(raster, rasterFromPixel, filters, part, memory);
        Warper(filtered.raster(), filtered.map(), filters, part).run();
    } else {
        clearImage(part.image);
    }
    return filters.gain();
}

}  // namespace deltasplat
