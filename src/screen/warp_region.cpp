// SPDX-License-Identifier: Apache-2.0
// Based on: Philippe Lacroute and Marc Levoy, "Fast Volume Rendering Using a Shear-Warp
// Factorization of the Viewing Transformation", 1994, the warp of perspective projections.
// Deviates: a picture may consist of several factorizations' regions, like the faces of a cube.
#include "screen/warp_region.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/gtc/type_precision.hpp>
#include <glm/matrix.hpp>
#include <glm/vector_relational.hpp>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <span>

#include "base/parallel.h"
#include "base/portable_math.h"
#include "deltasplat/delta/delta_grid.h"
#include "view/picture_rays.h"

namespace deltasplat {

namespace {

// Filters of growing width, made on demand.
class FilterLadder {
  public:
    explicit FilterLadder(WarpFilter filter) : filter_(filter) {}

    // Returns the rung of the filter for a squared number of raster pixels per picture pixel.
    static int rungOf(double squaredStretch) {
        if (!(squaredStretch > 1)) return 0;
        // The leading bits of a float are nearly its logarithm: off by less than a rung.
        const auto bits = std::bit_cast<std::uint32_t>(float(std::min(squaredStretch, kMost)));
        constexpr std::uint32_t kOne = 0x3F800000;
        return int((bits - kOne + (1u << 20)) >> 21);
    }

    const FilterTable& at(int rung) {
        if (rung == 0) return narrowestFilter(filter_);
        const auto i = std::size_t(rung);
        std::call_once(made_[i], [&] {
            const double stretch = portable::exp(0.69314718055994531 / kRungs * rung);
            filters_[i] = std::make_unique<FilterTable>(filter_, stretch);
        });
        return *filters_[i];
    }

    // The largest gain of the filters made so far.
    double gain() const {
        double largest = narrowestFilter(filter_).gain();
        for (const auto& filter : filters_) {
            if (filter) largest = std::max(largest, filter->gain());
        }
        return largest;
    }

  private:
    static constexpr int kRungs = 8;                  // per doubling of the width
    static constexpr double kMost = double(1 << 28);  // 16384 squared
    static constexpr std::size_t kCount = 14 * 8 + 2;

    WarpFilter filter_;
    std::array<std::once_flag, kCount> made_;
    std::array<std::unique_ptr<FilterTable>, kCount> filters_;
};

class RegionWarper {
  public:
    RegionWarper(const Raster& raster, const Camera& camera, const Factorization& view,
                 const Factorization& thin, const BasePlane& plane, WarpFilter filter,
                 const PicturePart& part)
        : raster_(raster),
          tiles_(raster),
          order_(sliceOrder(view.sliceAxis)),
          slopeStep_(view.slopeStep),
          rays_(camera, glm::inverse(view.worldFromStep)),
          slopeScale_(thin.slopeLimit / view.slopeLimit),
          flat_(camera.projection == Projection::kPerspective),
          plane_(plane),
          part_(part),
          ladder_(filter) {
        // Elsewhere the raster ends because nothing more is there.
        const glm::ivec2 end = raster.origin() + raster.extent();
        for (int axis = 0; axis < 2; ++axis) {
            if (raster.origin()[axis] <= plane.limits().min[axis]) goesOnBefore_[axis] = true;
            if (end[axis] >= plane.limits().max[axis]) goesOnBehind_[axis] = true;
        }
    }

    void run() {
        const int first = part_.first.y / kBand;
        const int end = (part_.last().y + kBand - 1) / kBand;
        parallelFor(std::size_t(std::max(end - first, 0)), [&](std::size_t band) {
            const int y = (first + int(band)) * kBand;
            for (int x = part_.first.x / kStretch * kStretch; x < part_.last().x; x += kStretch)
                warpTile({x, y});
        });
    }

    double gain() const { return ladder_.gain() * ladder_.gain(); }

  private:
    // Size of the tiles that are tested for emptiness.
    static constexpr int kBand = 8;
    static constexpr int kStretch = 16;

    struct Place {
        glm::dvec2 position{0.0};  // on the raster, from its origin
        glm::u8vec2 rungs{0};      // filters along the raster's axes
        bool belongs = false;
    };

    // Raster position, from the raster's origin, for a line of sight in steps.
    glm::dvec2 positionOf(const glm::dvec3& steps) const {
        const glm::dvec2 slope = slopeScale_ * glm::dvec2(steps.z, steps.y) / steps.x;
        return plane_.pixelOf(slope) - glm::dvec2(raster_.origin());
    }

    // Whether the region includes a line of sight's slope.
    bool hasSlope(const glm::dvec3& steps) const {
        return !slopeStep_ || (isNearSlope(slopeStep_->x, steps.y, steps.x) &&
                               isNearSlope(slopeStep_->y, steps.z, steps.x));
    }

    // @param alongX,alongY  change of steps from one pixel to the next
    Place placeOf(const glm::dvec3& steps, const glm::dvec3& alongX,
                  const glm::dvec3& alongY) const {
        Place place;
        place.belongs = belongs(steps, order_) && hasSlope(steps);
        if (!place.belongs) return place;
        place.position = positionOf(steps);
        const double rasterPerStep = slopeScale_ / plane_.spacing() / steps.x;
        const glm::dvec2 slope = glm::dvec2(steps.z, steps.y) / steps.x;
        const auto moved = [&](const glm::dvec3& along) {
            return rasterPerStep * (glm::dvec2(along.z, along.y) - slope * along.x);
        };
        const glm::dvec2 x = moved(alongX);
        const glm::dvec2 y = moved(alongY);
        // In the worst direction.
        glm::dvec2 squares = x * x + y * y;
        for (int axis = 0; axis < 2; ++axis) {
            const double most = mostStretch(place.position, axis);
            squares[axis] = std::min(squares[axis], most * most);
        }
        place.rungs = {FilterLadder::rungOf(squares.x), FilterLadder::rungOf(squares.y)};
        return place;
    }

    // Where the plane ends but the volume goes on, filters stay on the plane. There a pixel may be
    // wider than the rest of the plane, if its region or its angle is wide.
    double mostStretch(glm::dvec2 position, int axis) const {
        constexpr double kReach = 2.1;  // of a filter of stretch 1, with rounded rungs
        double room = std::numeric_limits<double>::infinity();
        if (goesOnBefore_[axis]) room = std::min(room, position[axis]);
        if (goesOnBehind_[axis]) room = std::min(room, raster_.extent()[axis] - 1 - position[axis]);
        return std::max(room, 0.0) / kReach;
    }

    // Whether a tile is empty by its corners: in flat pictures, its rays lie between theirs.
    bool isEmpty(glm::ivec2 first, glm::ivec2 last) const {
        if (!flat_ || last - first != glm::ivec2(kStretch, kBand) - 1) return false;
        glm::dvec2 low(0), high(0);
        const glm::ivec2 corners[] = {first, {last.x, first.y}, last, {first.x, last.y}};
        for (int i = 0; i < 4; ++i) {
            const glm::dvec3 steps = rays_.at(corners[i].x, corners[i].y);
            if (!(steps.x > 0)) return false;
            const glm::dvec2 place = positionOf(steps);
            low = i == 0 ? place : glm::min(low, place);
            high = i == 0 ? place : glm::max(high, place);
        }
        // Filters reach as many picture pixels as they have taps at their narrowest.
        const glm::dvec2 reach = 3.0 + 3.0 * (high - low) / double(kBand - 1);
        const glm::dvec2 before(raster_.min - raster_.origin());
        low = glm::max(glm::floor(low - reach) - before, glm::dvec2(0));
        high = glm::min(glm::ceil(high + reach) - before, glm::dvec2(raster_.size - 1));
        return !(low.x <= high.x && low.y <= high.y) ||
               !tiles_.anyIn(glm::ivec2(low), glm::ivec2(high));
    }

    // Tiles do not depend on the part.
    void warpTile(glm::ivec2 first) {
        glm::ivec2 last = glm::min(first + glm::ivec2(kStretch, kBand), part_.size);
        if (isEmpty(first, last - 1)) return;
        first = glm::max(first, part_.first);
        last = glm::min(last, part_.last());
        std::array<Place, kStretch> places;
        for (int y = first.y; y < last.y; ++y) {
            for (int x = first.x; x < last.x; ++x) {
                places[std::size_t(x - first.x)] =
                    placeOf(rays_.at(x, y), rays_.alongX(x, y), rays_.alongY(x, y));
            }
            warpRow({first.x, y}, std::span(places).first(std::size_t(last.x - first.x)));
        }
    }

    // Samples pixels with equal filters and inner taps together, other pixels one by one.
    void warpRow(glm::ivec2 first, std::span<const Place> places) {
        std::array<FixedPosition, kStretch> run;
        std::size_t count = 0;
        const auto flush = [&](std::size_t end) {
            if (count == 0) return;
            const glm::u8vec2 rungs = places[end - 1].rungs;
            sampleAt(raster_, ladder_.at(rungs.x), ladder_.at(rungs.y), run.data(), int(count),
                     part_.pixel(first.x + int(end - count), first.y));
            count = 0;
        };
        for (std::size_t i = 0; i < places.size(); ++i) {
            const Place& place = places[i];
            if (count > 0 && place.rungs != places[i - 1].rungs) flush(i);
            if (!place.belongs) {
                flush(i);
                continue;
            }
            const FilterTable& filterX = ladder_.at(place.rungs.x);
            const FilterTable& filterY = ladder_.at(place.rungs.y);
            const glm::dvec2 reach(filterX.taps() / 2, filterY.taps() / 2);
            const glm::dvec2 last(raster_.extent() - 1);
            const double padded = filterX.paddedTaps() - filterX.taps() + 1;
            if (all(glm::greaterThanEqual(place.position, reach)) &&
                all(glm::lessThanEqual(place.position, last - reach - glm::dvec2(padded, 1)))) {
                run[count++] = fixedPosition(place.position, raster_);
                continue;
            }
            flush(i);
            if (all(glm::greaterThan(place.position, -reach)) &&
                all(glm::lessThan(place.position, last + reach))) {
                EdgeSampler(raster_, filterX, filterY)
                    .sample(fixedPosition(place.position, raster_),
                            part_.pixel(first.x + int(i), first.y));
            }
        }
        flush(places.size());
    }

    const Raster& raster_;
    RasterTiles tiles_;
    glm::ivec3 order_;
    std::optional<glm::ivec2> slopeStep_;
    PictureRays rays_;
    double slopeScale_;
    bool flat_;
    const BasePlane& plane_;
    const PicturePart& part_;
    FilterLadder ladder_;
    glm::bvec2 goesOnBefore_{false};  // along each axis: whether the plane's limit ends the raster
    glm::bvec2 goesOnBehind_{false};
};

}  // namespace

double warpRegion(const Raster& raster, const Camera& camera, const Factorization& view,
                  const Factorization& thin, const BasePlane& plane, WarpFilter filter,
                  const PicturePart& part) {
    if (raster.size.x <= 0 || raster.size.y <= 0) return 1;
    RegionWarper warper(raster, camera, view, thin, plane, filter, part);
    warper.run();
    return warper.gain();
}

PlaneBox readByRegion(const Camera& camera, const Factorization& view, const Factorization& thin,
                      const BasePlane& plane, const PixelBox& pixels) {
    // A filter reaches twice its stretch; the rest allows for rounded rungs and extra taps.
    constexpr double kReach = 2.5;
    constexpr double kLeast = 8;
    constexpr double kFar = 1 << 30;
    const PictureRays rays(camera, glm::inverse(view.worldFromStep));
    const glm::ivec3 order = sliceOrder(view.sliceAxis);
    const double slopeScale = thin.slopeLimit / view.slopeLimit;
    glm::dvec2 low(kFar), high(-kFar);
    for (int y = pixels.min.y; y < pixels.max.y; ++y) {
        for (int x = pixels.min.x; x < pixels.max.x; ++x) {
            const glm::dvec3 steps = rays.at(x, y);
            if (!belongs(steps, order)) continue;
            const glm::dvec2 slope = glm::dvec2(steps.z, steps.y) / steps.x;
            const auto moved = [&](const glm::dvec3& along) {
                return glm::dvec2(along.z, along.y) - slope * along.x;
            };
            const glm::dvec2 right = moved(rays.alongX(x, y));
            const glm::dvec2 down = moved(rays.alongY(x, y));
            const double scale = slopeScale / plane.spacing() / steps.x;
            const glm::dvec2 reach =
                kReach * scale * glm::sqrt(right * right + down * down) + kLeast;
            const glm::dvec2 position = plane.pixelOf(slopeScale * slope);
            low = glm::min(low, position - reach);
            high = glm::max(high, position + reach);
        }
    }
    if (high.x < low.x) return {};
    return {glm::ivec2(glm::clamp(glm::floor(low), -kFar, kFar)),
            glm::ivec2(glm::clamp(glm::ceil(high), -kFar, kFar)) + 1};
}

namespace {

bool isInner(const FilterTable& filter, int tap) {
    return tap >= filter.firstInnerTap() && tap < filter.firstInnerTap() + filter.innerTaps();
}

}  // namespace

RasterTiles::RasterTiles(const Raster& raster)
    : tiles_((raster.size + kTile - 1) / kTile),
      words_((tiles_.x + 63) / 64),
      full_(std::size_t(words_) * tiles_.y) {
    parallelFor(std::size_t(tiles_.y), [&](std::size_t row) { findRow(raster, int(row)); });
}

bool RasterTiles::anyIn(glm::ivec2 first, glm::ivec2 last) const {
    first = glm::max(first / kTile, glm::ivec2(0));
    last = glm::min(last / kTile, tiles_ - 1);
    for (int row = first.y; row <= last.y; ++row) {
        for (int column = first.x; column <= last.x; ++column) {
            if (full_[std::size_t(words_) * row + column / 64] >> (column % 64) & 1) return true;
        }
    }
    return false;
}

void RasterTiles::findRow(const Raster& raster, int row) {
    const int lastY = std::min((row + 1) * kTile, raster.size.y);
    for (int y = row * kTile; y < lastY; ++y) {
        const glm::ivec2 span = raster.span(y);
        if (span.x >= span.y) continue;
        const float* pixels = raster.row(y);
        for (int column = span.x / kTile; column <= (span.y - 1) / kTile; ++column) {
            const int first = raster.channels * std::max(column * kTile, span.x);
            const int last = raster.channels * std::min((column + 1) * kTile, span.y);
            std::uint32_t bits = 0;  // of all values: faster than comparing each
            for (int i = first; i < last; ++i) bits |= std::bit_cast<std::uint32_t>(pixels[i]);
            full_[std::size_t(words_) * row + column / 64] |= std::uint64_t{bits != 0}
                                                              << (column % 64);
        }
    }
}

void EdgeSampler::sample(FixedPosition position, float* out) const {
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
    write(sum, out);
}

// Sums a column from its first tap on; rows [begin, end) lie inside.
void EdgeSampler::sumColumn(glm::ivec2 first, const float* weightY, int begin, int end,
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

// Returns a tap inside the raster.
const float* EdgeSampler::tapAt(glm::ivec2 p) const {
    return raster_.values + raster_.channels * (std::ptrdiff_t{raster_.size.x} * p.y + p.x);
}

void EdgeSampler::write(const float* sum, float* out) const {
    out[3] = sum[raster_.channels - 1];
    for (int c = 0; c < 3; ++c) out[c] = raster_.channels == 1 ? sum[0] * raster_.color[c] : sum[c];
}

FixedPosition fixedPosition(glm::dvec2 position) {
    const double unit = std::ldexp(1.0, 32);
    return {std::llround(position.x * unit), std::llround(position.y * unit)};
}

FixedPosition fixedPosition(glm::dvec2 position, const Raster& raster) {
    FixedPosition fixed = fixedPosition(position);
    const glm::i64vec2 before = glm::i64vec2(raster.min) - glm::i64vec2(raster.origin());
    fixed.x -= before.x * (std::int64_t{1} << 32);
    fixed.y -= before.y * (std::int64_t{1} << 32);
    return fixed;
}

const FilterTable& narrowestFilter(WarpFilter filter) {
    // In the order of the enum.
    static const FilterTable tables[] = {{WarpFilter::kSharp, 1},
                                         {WarpFilter::kMitchell, 1},
                                         {WarpFilter::kGauss, 1},
                                         {WarpFilter::kBox, 1}};
    return tables[std::size_t(filter)];
}

}  // namespace deltasplat
