// SPDX-License-Identifier: Apache-2.0
#include "splat/sheet_cover.h"

#include <algorithm>
#include <bit>

namespace deltasplat {

void SheetCover::set(const CoveredCells& cells, const SheetReading& first, const SheetReading& last,
                     const SheetLayout& layout) {
    cells_ = &cells;
    for (int axis = 0; axis < 2; ++axis) {
        const auto cellsReading = [&](glm::ivec2 pixels) {
            glm::ivec2 readers = readersOf(first, axis, pixels.x, pixels.y, cells.box());
            if (&first != &last) {
                const glm::ivec2 others = readersOf(last, axis, pixels.x, pixels.y, cells.box());
                readers = {std::min(readers.x, others.x), std::max(readers.y, others.y)};
            }
            return cells.cellsOf(axis, readers);
        };
        blocks_[axis].clear();
        for (int i = 0; i < layout.blocks[axis]; ++i)
            blocks_[axis].push_back(cellsReading(pixelsReached(layout, i)));
        tiles_[axis].clear();
        for (int i = 0; i < layout.tiles()[axis]; ++i)
            tiles_[axis].push_back(cellsReading({kTilePixels * i, kTilePixels * (i + 1)}));
    }
}

void SheetCover::clearHidden(int tileRow, std::size_t words, std::span<std::uint64_t> rows) const {
    for (std::size_t i = 0; i < words; ++i) {
        std::uint64_t any = 0;
        for (std::size_t place = i; place < rows.size(); place += words) any |= rows[place];
        std::uint64_t hidden = 0;
        for (std::uint64_t rest = any; rest != 0; rest &= rest - 1) {
            const int bit = std::countr_zero(rest);
            if (hidesTile({int(64 * i) + bit, tileRow})) hidden |= std::uint64_t{1} << bit;
        }
        if (hidden == 0) continue;
        for (std::size_t place = i; place < rows.size(); place += words) rows[place] &= ~hidden;
    }
}

}  // namespace deltasplat
