// SPDX-License-Identifier: Apache-2.0
// Based on: Philippe Lacroute and Marc Levoy, "Fast Volume Rendering Using a Shear-Warp
// Factorization of the Viewing Transformation", 1994, the base plane.
#include "rays/ray_band.h"

#include <algorithm>

namespace deltasplat {
namespace {

// Slices of a layer are at most 7 apart and shift by at most a pixel each; then there is a row of
// blocks at each end that is in the band in part, and one more that is read.
int stripRows(int rows) {
    return (rows + 7) / 8 + 4;
}

// A voxel that is the only one counts as much as any, so none may that only rounding brings in.
glm::vec2 snapped(const glm::dvec2& fraction) {
    constexpr double kRounding = 0x1p-20;
    const auto snap = [](double share) {
        return share < kRounding ? 0.0f : share > 1 - kRounding ? 1.0f : float(share);
    };
    return {snap(fraction.x), snap(fraction.y)};
}

}  // namespace

RayBand::RayBand(const RayInput& input, int rows)
    : input_(input),
      blocks_(input.layout.blocks),
      strip_(input.volume, input.rule, input.layout.firstVoxel / 8, blocks_, stripRows(rows)),
      runs_(2 * std::size_t(stripRows(rows))),
      met_(std::size_t(rows) * (blocks_.x + 1)) {}

double RayBand::bytes(const RayInput& input, int rows) {
    return RayStrip::bytes(input.layout.blocks, stripRows(rows));
}

void RayBand::run(int firstRow, int lastRow, RayPlanes& planes) {
    const IndexBox& box = input_.volume.box;
    firstRow_ = firstRow;
    if (input_.rule == RayRule::kSum)
        rest_.assign(std::size_t(lastRow - firstRow) * std::size_t(planes.values.box.size().x),
                     0.0f);
    for (int layer = box.min.x >> 3; layer <= box.max.x >> 3; ++layer) {
        findSlices(layer);
        const auto [low, high] = std::minmax(slices_.front().offset.y, slices_.back().offset.y);
        const int firstCell = std::max((firstRow + low) >> 3, -1);
        const int lastCell = std::min((lastRow - 1 + high) >> 3, blocks_.y - 1);
        if (firstCell > lastCell || !strip_.read(layer, firstCell, lastCell + 1)) continue;
        findRuns(firstCell, lastCell);
        for (const Slice& slice : slices_) addSlice(slice, firstRow, lastRow, planes);
    }
}

void RayBand::findSlices(int layer) {
    const IndexBox& box = input_.volume.box;
    const bool isMean = input_.rule == RayRule::kMaxActive;
    slices_.clear();
    for (int s = std::max(8 * layer, box.min.x); s <= std::min(8 * layer + 7, box.max.x); ++s) {
        const SheetReading shift = readingOf(input_.plane, input_.layout, s);
        slices_.push_back({s & 7,
                           {float(s - box.min.x), !input_.plane.frontToBack()},
                           shift.offset - input_.layout.marginPixels,
                           isMean ? snapped(shift.fraction) : glm::vec2(shift.fraction)});
    }
}

void RayBand::findRuns(int firstCell, int lastCell) {
    firstCell_ = firstCell;
    lastCell_ = lastCell;
    for (int row = firstCell; row <= lastCell; ++row) {
        for (const bool both : {false, true}) {
            std::vector<CellRun>& runs = runsOf(row, both);
            runs.clear();
            for (int column = -1; column < blocks_.x; ++column) {
                const RayStrip::Fill fill = cellFill(row, column, both);
                if (fill == RayStrip::kNone) continue;
                const bool goesOn =
                    !runs.empty() && runs.back().last == column && runs.back().fill == fill;
                if (!goesOn) runs.push_back({column, column, fill});
                ++runs.back().last;
            }
        }
    }
}

// What is active of the blocks that a cell reads, those of the next row only if `both`.
RayStrip::Fill RayBand::cellFill(int row, int column, bool both) const {
    RayStrip::Fill least = RayStrip::kAll;
    RayStrip::Fill most = RayStrip::kNone;
    for (int r = row; r <= row + both; ++r) {
        for (int c = column; c <= column + 1; ++c) {
            least = std::min(least, strip_.fill(r, c));
            most = std::max(most, strip_.fill(r, c));
        }
    }
    // Sums take what is not active for 0.
    if (most == RayStrip::kNone || least == RayStrip::kAll) return most;
    return input_.rule == RayRule::kSum ? RayStrip::kAll : RayStrip::kSome;
}

void RayBand::addSlice(const Slice& slice, int firstRow, int lastRow, RayPlanes& planes) {
    spans_.clear();
    metBytes_ = 0;
    const int first = std::max(firstRow, 8 * firstCell_ - slice.offset.y);
    const int last = std::min(lastRow, 8 * (lastCell_ + 1) - slice.offset.y);
    for (int y = first; y < last; ++y) addRow(slice, y, planes);
    input_.rule == RayRule::kSum
        ? sumSpans(spans_, slice.fraction)
        : maxSpans(spans_, slice.fraction, slice.mark, input_.rule == RayRule::kMaxActive);
}

void RayBand::addRow(const Slice& slice, int y, RayPlanes& planes) {
    RayPlane& plane = planes.values;
    const int u = y + slice.offset.y;
    const bool both = (u & 7) == 7 && slice.fraction.y != 0;
    for (const CellRun& run : runsOf(u >> 3, both)) {
        const int v = 8 * run.first;
        const int x = v - slice.offset.x - plane.box.min.x;
        spans_.push_back({strip_.values(slice.index, u) + v,
                          // Where only one row is read, it stands for both.
                          strip_.values(slice.index, u + (slice.fraction.y != 0)) + v,
                          plane.row(y) + x, rest_.empty() ? nullptr : restRow(y, plane) + x,
                          8 * std::size_t(run.last - run.first),
                          run.fill == RayStrip::kAll ? nullptr : findMet(slice, u, run),
                          planes.places ? planes.places->row(y) + x : nullptr});
    }
}

float* RayBand::restRow(int y, const RayPlane& plane) {
    return &rest_[std::size_t(y - firstRow_) * std::size_t(plane.box.size().x)];
}

// Which pixels of a run read an active voxel with a weight that is not 0.
const std::uint8_t* RayBand::findMet(const Slice& slice, int u, const CellRun& run) {
    std::uint8_t* const met = &met_[metBytes_];
    metBytes_ += std::size_t(run.last - run.first);
    const std::uint8_t* const here = strip_.active(slice.index, u);
    const std::uint8_t* const below = strip_.active(slice.index, u + (slice.fraction.y != 0));
    for (int cell = run.first; cell < run.last; ++cell) {
        unsigned bits = here[cell] | below[cell];
        if (slice.fraction.x != 0)
            bits |= bits >> 1 | unsigned(here[cell + 1] | below[cell + 1]) << 7;
        met[cell - run.first] = std::uint8_t(bits);
    }
    return met;
}

}  // namespace deltasplat
