// SPDX-License-Identifier: Apache-2.0
// Based on: Thomas Porter and Tom Duff, "Compositing Digital Images", 1984, the operator over;
// Philippe Lacroute and Marc Levoy, "Fast Volume Rendering Using a Shear-Warp Factorization of the
// Viewing Transformation", 1994, the base plane.
#include "composite/layer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>

#include "parallel.h"

namespace deltasplat {
namespace {

// Calls emit(first, last) for every run of set bits [first, last) in a row of words.
template <typename Emit>
void forEachRun(const std::vector<std::uint64_t>& words, const Emit& emit) {
    const int bits = int(64 * words.size());
    const auto nextBit = [&](int from, bool set) {
        while (from < bits) {
            const std::uint64_t word = set ? words[from / 64] : ~words[from / 64];
            const std::uint64_t rest = word >> (from % 64);
            if (rest != 0) return std::min(from + std::countr_zero(rest), bits);
            from = (from / 64 + 1) * 64;
        }
        return bits;
    };
    for (int first = nextBit(0, true); first < bits;) {
        const int last = nextBit(first, false);
        emit(first, last);
        first = nextBit(last, true);
    }
}

// Composites the runs of occupied tiles of one sheet row group.
class SheetCompositor {
  public:
    SheetCompositor(const Sheet& sheet, const SheetShift& shift, const OverWeights& weights,
                    Layer& layer)
        : sheet_(sheet), shift_(shift), weights_(weights), layer_(layer) {}

    void run() {
        const int tileRows = sheet_.layout().tiles().y;
        std::vector<std::uint64_t> both;
        for (int row = 0; row < tileRows; ++row) {
            const auto here = sheet_.occupiedTiles(row);
            // The last pixel row before a tile row reads into it as well.
            both.assign(here.begin(), here.end());
            if (row > 0) {
                const auto above = sheet_.occupiedTiles(row - 1);
                for (std::size_t i = 0; i < both.size(); ++i) both[i] |= above[i];
                addRows(both, kTilePixels * row - 1, kTilePixels * row);
            }
            both.assign(here.begin(), here.end());
            addRows(both, kTilePixels * row, kTilePixels * (row + 1) - 1);
        }
        overSpans(spans_, weights_);
    }

  private:
    void addRows(const std::vector<std::uint64_t>& tiles, int firstRow, int lastRow) {
        forEachRun(tiles, [&](int firstTile, int lastTile) {
            // The pixel before the first one reads into it as well.
            const int first = kTilePixels * firstTile - 1;
            const int last = kTilePixels * lastTile;
            for (int y = firstRow; y < lastRow; ++y) {
                spans_.push_back({sheet_.row(y) + 4 * first, sheet_.row(y + 1) + 4 * first,
                                  layer_.pixel(glm::ivec2(first, y) - shift_.offset),
                                  std::size_t(last - first)});
            }
        });
    }

    const Sheet& sheet_;
    const SheetShift& shift_;
    const OverWeights& weights_;
    Layer& layer_;
    std::vector<OverSpan> spans_;
};

}  // namespace

SheetShift shiftOf(const SheetLayout& layout, glm::dvec2 shiftPerSlice, int slice) {
    const double slices = double(slice) - double(layout.firstSlice);
    const glm::dvec2 sheetOrigin =
        shiftPerSlice * slices * double(layout.resolution) - double(layout.marginPixels);
    const glm::dvec2 whole = glm::floor(-sheetOrigin);
    return {glm::ivec2(whole), -sheetOrigin - whole};
}

PlaneBox reachOf(const SheetLayout& layout, glm::dvec2 shiftPerSlice, int firstSlice,
                 int sliceCount) {
    const glm::ivec2 first = -shiftOf(layout, shiftPerSlice, firstSlice).offset;
    const glm::ivec2 last = -shiftOf(layout, shiftPerSlice, firstSlice + sliceCount - 1).offset;
    return {glm::min(first, last), glm::max(first, last) + layout.sizePixels};
}

void compositeSheet(const Sheet& sheet, const SheetShift& shift, const glm::vec4& scale,
                    bool frontToBack, Layer& layer) {
    const OverWeights weights(glm::vec2(shift.fraction), scale, frontToBack);
    SheetCompositor(sheet, shift, weights, layer).run();
}

Layer mergeLayers(const std::vector<Layer>& frontToBack) {
    PlaneBox all;
    for (const Layer& layer : frontToBack) {
        all = all.empty()
                  ? layer.box
                  : PlaneBox{glm::min(all.min, layer.box.min), glm::max(all.max, layer.box.max)};
    }
    Layer merged(all);
    parallelFor(std::size_t(all.size().y), [&](std::size_t row) {
        const int y = all.min.y + int(row);
        for (const Layer& layer : frontToBack) {
            if (y < layer.box.min.y || y >= layer.box.max.y) continue;
            const glm::ivec2 start{layer.box.min.x, y};
            mergeBehind(merged.pixel(start), layer.pixel(start), std::size_t(layer.box.size().x));
        }
    });
    return merged;
}

}  // namespace deltasplat
