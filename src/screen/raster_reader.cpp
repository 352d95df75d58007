// SPDX-License-Identifier: Apache-2.0
#include "screen/raster_reader.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

#include "base/parallel.h"

namespace deltasplat {
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

// Weighs a column from its first tap on, of which rows [begin, end) lie inside.
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

// Points to a tap that lies inside.
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
    // In the order of their names' declaration.
    static const FilterTable tables[] = {{WarpFilter::kSharp, 1},
                                         {WarpFilter::kMitchell, 1},
                                         {WarpFilter::kGauss, 1},
                                         {WarpFilter::kBox, 1}};
    return tables[std::size_t(filter)];
}

}  // namespace deltasplat
