// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <limits>
#include <memory>
#include <memory_resource>
#include <mutex>
#include <optional>
#include <vector>

#include "base/uncleared.h"
#include "composite/over_kernels.h"
#include "splat/sheet_cover.h"
#include "view/base_plane.h"

namespace deltasplat {

/// The composited light of one slab on the base plane: float `[row][width][channels]`, rows along
/// u as those of sheets; premultiplied RGBA, or opacity alone where all that is seen has one
/// colour. While it is made, a row has values in its span alone.
struct Layer {
    PlaneBox box;
    int channels;
    pmr::UnclearedVector<float> values;

    /// [rows]: columns [x, y) of the box, outside of which a finished row is zero.
    std::vector<glm::ivec2> spans;

    /// A finished layer, all zero.
    /// @param memory  for the values
    explicit Layer(const PlaneBox& planeBox, int channelCount = 4,
                   std::pmr::memory_resource& memory = *std::pmr::get_default_resource())
        : box(planeBox), channels(channelCount), values(&memory) {
        setBox(planeBox);
        for (int y = box.min.y; y < box.max.y; ++y) clearRest(y);
    }

    /// Becomes a layer of a box, with empty spans, in the memory that it has.
    void setBox(const PlaneBox& planeBox);
    /// Says that columns [first, last) of a row of the base plane may not be zero, and makes zero
    /// what comes to its span by that.
    void extend(int y, int first, int last) {
        first -= box.min.x;
        last -= box.min.x;
        const glm::ivec2 span = spans[std::size_t(y - box.min.y)];
        if (first < span.x || last > span.y) widen(y, {first, last});
    }
    /// Makes zero what lies outside of a row's span.
    void clearRest(int y);
    /// The same of all rows, on all threads.
    void clearRest();
    float* pixel(glm::ivec2 b) {
        const glm::ivec2 p = b - box.min;
        return &values[channels * (std::size_t(p.y) * box.size().x + p.x)];
    }
    const float* pixel(glm::ivec2 b) const { return const_cast<Layer*>(this)->pixel(b); }

  private:
    static constexpr glm::ivec2 kNothing{std::numeric_limits<int>::max(), 0};
    void widen(int y, glm::ivec2 columns);
    void fillZero(int y, int first, int last);
};

/// Bytes that the values of a layer take.
inline double layerBytes(const PlaneBox& box, int channels) {
    const glm::dvec2 size = box.size();
    return sizeof(float) * channels * size.x * size.y;
}

/// A row of a layer.
struct LayerRow {
    const float* values;  ///< [width][channels]
    int firstColumn;      ///< of the base plane
    glm::ivec2 span;      ///< columns [x, y) outside of which it is zero
};

/// Puts row `y` behind a layer that covers it.
void mergeRowBehind(Layer& front, const LayerRow& row, int y);
/// Puts row `y` of a layer, if it has it, behind another layer that covers it.
void mergeRowBehind(Layer& front, const Layer& layer, int y);

/// Puts layers behind a front one, in whatever order they are done: the order of the arithmetic is
/// fixed by their numbers alone. As long as more are to come, layers are merged as soon as those in
/// front of them are, so that few are in memory. Thread-safe but for finishRow().
class LayerFold {
  public:
    /// @param count  layers to come, numbered from the front
    /// @param front  what they are put behind, once addFront() is called; folds may share it if
    /// their layers share no row
    /// @param part   of the base plane, in which its layers lie
    LayerFold(std::size_t count, Layer& front, const PlaneBox& part)
        : front_(front),
          channels_(front.channels),
          covered_(std::make_shared<const CoveredCells>(part)),
          done_(count) {}

    /// Returns an empty layer. Call it once for each number.
    Layer take(const PlaneBox& box);
    /// Returns what is covered by the layers that are merged by now: whatever a later one has there
    /// changes nothing.
    std::shared_ptr<const CoveredCells> covered();
    /// Says that the front layer is finished, and may be written to from now on by others than who
    /// made it. Call it once.
    void addFront();
    /// Takes a finished layer back.
    void add(std::size_t number, Layer layer);
    /// Merges row y of the layers that are left, when all have been added, the front one included.
    void finishRow(int y);

  private:
    void mergeReady(std::unique_lock<std::mutex>& lock);
    void findCovered(std::unique_lock<std::mutex>& lock);

    Layer& front_;
    int channels_;
    std::mutex mutex_;  // guards all below
    std::shared_ptr<const CoveredCells> covered_;
    std::vector<std::optional<Layer>> done_;  // [count]: not yet merged
    std::vector<Layer> idle_;
    std::size_t taken_ = 0;
    std::size_t next_ = 0;  // the first that is not merged
    bool hasFront_ = false;
    bool merging_ = false;
};

/// Adds the cells in which a layer is opaque everywhere, its opacity 1 to the last bit: whatever is
/// put behind it there changes no bit, for it is multiplied by 0.
/// @return whether there are any that were not covered
bool addCovered(const Layer& layer, CoveredCells& cells);

/// What of the slices of a slab is covered and need not be made: by the slabs before it, and by the
/// slab's own slices, from the front on. What is covered changes no bit of the picture
/// (addCovered). To be asked for one slice after the other.
class SlabCover {
  public:
    /// @param before  what the slabs before cover
    /// @param layer   the slab's own, whose rows of `before` nobody else changes; it must outlive
    ///                this
    SlabCover(const BasePlane& plane, int lastSlice, std::shared_ptr<const CoveredCells> before,
              const Layer& layer)
        : plane_(plane), lastSlice_(lastSlice), layer_(layer), cells_(std::move(before)) {}

    /// Whether nothing has to be made.
    bool all() const { return cells_->all(); }
    /// Returns what of the next slice has to be made; valid until the one behind it.
    /// @param read  what the plane reads of it
    NeededPixels next(const SheetReading& reading, const SheetBox& read, const SheetLayout& layout);
    /// Says over how many pixels of the layer compositing that slice went.
    void add(std::size_t pixels) { pixels_ += pixels; }

  private:
    void look();

    const BasePlane& plane_;
    int lastSlice_;
    const Layer& layer_;
    std::shared_ptr<const CoveredCells> cells_;
    std::size_t pixels_ = 0;     // composited since the last look
    std::size_t between_ = 128;  // pixels a cell, from a look to the next
    int slices_ = 0;             // since fromNowOn_ was found
    SheetCover ofSlice_;
    SheetCover fromNowOn_;
};

}  // namespace deltasplat
