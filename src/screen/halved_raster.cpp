// SPDX-License-Identifier: Apache-2.0
#include "screen/halved_raster.h"

#include <algorithm>
#include <utility>

#include "base/bits.h"
#include "base/parallel.h"
#include "screen/halving_kernels.h"

namespace deltasplat {
namespace {

struct Range {
    int first, end;

    int size() const { return std::max(end - first, 0); }
};

Range overlapOf(const Range& a, const Range& b) {
    return {std::max(a.first, b.first), std::min(a.end, b.end)};
}

// The pixels of an axis from which pixels are made.
Range sourcesOf(const Range& made, bool isHalved) {
    return isHalved ? Range{2 * made.first - 1, 2 * made.end + 1} : made;
}

// The pixels made of some pixels of an axis.
Range madeOf(const Range& sources, bool isHalved) {
    return isHalved ? Range{floorDiv(sources.first - 1, 2), floorDiv(sources.end, 2) + 1} : sources;
}

// Makes rows of a halved raster, with its own buffers.
class RowHalver {
  public:
    RowHalver(const Raster& whole, glm::bvec2 along, const Range& columns)
        : whole_(whole), along_(along), columns_(columns) {
        if (along.y) zeros_.resize(floatsOf(whole.size.x));
        if (along.x) sums_.resize(floatsOf(sourcesOf(columns, true).size()));
    }

    // Writes a row, and returns the columns outside of which it is zero.
    // @param out  of the first column
    Range makeRow(int y, float* out) {
        const Range filled = readRows(sourcesOf({y, y + 1}, along_.y));
        Range made = overlapOf(madeOf(filled, along_.x), columns_);
        if (filled.size() == 0 || made.size() == 0) made = {columns_.first, columns_.first};
        float* const firstMade = out + floatsOf(made.first - columns_.first);
        float* const endMade = firstMade + floatsOf(made.size());
        std::fill(out, firstMade, 0.0f);
        if (made.size() > 0)
            along_.x ? addColumns(filled, made, firstMade) : addRows(made, firstMade);
        std::fill(endMade, out + floatsOf(columns_.size()), 0.0f);
        return made;
    }

  private:
    std::size_t floatsOf(int pixels) const { return std::size_t(whole_.channels) * pixels; }

    // Finds rows, and returns the columns outside of which all are zero.
    Range readRows(const Range& rows) {
        Range filled{whole_.min.x + whole_.size.x, whole_.min.x};
        for (int y = rows.first; y < rows.end; ++y) {
            const int row = y - whole_.min.y;
            const bool isInside = row >= 0 && row < whole_.size.y;
            const glm::ivec2 span = isInside ? whole_.span(row) : glm::ivec2(0);
            rows_[y - rows.first] = isInside ? whole_.row(row) : zeros_.data();
            if (span.x >= span.y) continue;
            filled.first = std::min(filled.first, whole_.min.x + span.x);
            filled.end = std::max(filled.end, whole_.min.x + span.y);
        }
        return filled;
    }

    void addRows(const Range& columns, float* out) {
        const std::size_t first = floatsOf(columns.first - whole_.min.x);
        const std::size_t count = floatsOf(columns.size());
        if (!along_.y) {
            std::copy_n(rows_[0] + first, count, out);
            return;
        }
        const float* const rows[4] = {rows_[0] + first, rows_[1] + first, rows_[2] + first,
                                      rows_[3] + first};
        addFourRows(rows, count, out);
    }

    void addColumns(const Range& filled, const Range& made, float* out) {
        const Range sources = sourcesOf(made, true);
        const Range known = overlapOf(sources, filled);
        float* const sums = sums_.data();
        std::fill(sums, sums + floatsOf(known.first - sources.first), 0.0f);
        addRows(known, sums + floatsOf(known.first - sources.first));
        std::fill(sums + floatsOf(known.end - sources.first), sums + floatsOf(sources.size()),
                  0.0f);
        addFourColumns(sums, whole_.channels, made.size(), out);
    }

    const Raster& whole_;
    const glm::bvec2 along_;
    const Range columns_;
    const float* rows_[4] = {};
    std::vector<float> zeros_;  // a row outside the raster
    std::vector<float> sums_;   // of rows, for the source columns
};

}  // namespace

HalvedRaster::HalvedRaster(const Raster& raster, glm::bvec2 along, const LatticeBox& wanted,
                           std::pmr::memory_resource& memory)
    : halved_(raster) {
    const auto halve = [&](glm::ivec2& min, glm::ivec2& size) {
        const Range columns = madeOf({min.x, min.x + size.x}, along.x);
        const Range rows = madeOf({min.y, min.y + size.y}, along.y);
        min = {columns.first, rows.first};
        size = {columns.size(), rows.size()};
        return std::pair(columns, rows);
    };
    if (raster.wholeSize.x > 0) halve(halved_.wholeMin, halved_.wholeSize);
    const std::pair made = halve(halved_.min, halved_.size);
    const Range columns = made.first, rows = made.second;
    const std::size_t rowFloats = std::size_t(raster.channels) * columns.size();
    values_ = UnclearedArray<float>(rowFloats * rows.size(), memory);
    spans_.resize(std::size_t(rows.size()));
    halved_.values = &values_[0];
    halved_.spans = spans_;
    const Range wantedColumns = overlapOf(columns, {wanted.min.x, wanted.max.x});
    const Range wantedRows = overlapOf(rows, {wanted.min.y, wanted.max.y});
    if (wantedColumns.size() == 0) return;
    parallelForChunks(std::size_t(wantedRows.size()), [&](std::size_t begin, std::size_t last) {
        RowHalver halver(raster, along, wantedColumns);
        for (std::size_t i = begin; i < last; ++i) {
            const int y = wantedRows.first + int(i);
            const Range filled = halver.makeRow(y, pixel({wantedColumns.first, y}));
            if (filled.size() == 0) continue;
            spans_[std::size_t(y - rows.first)] = {filled.first - columns.first,
                                                   filled.end - columns.first};
        }
    });
}

float* HalvedRaster::pixel(glm::ivec2 point) {
    const glm::ivec2 place = point - halved_.min;
    const std::size_t index = std::size_t(halved_.size.x) * place.y + place.x;
    return &values_[std::size_t(halved_.channels) * index];
}

}  // namespace deltasplat
