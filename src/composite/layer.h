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

/// The composited light of one slab on the base plane: float `[row][width][channels]`, rows along u
/// as in sheets; premultiplied RGBA, or opacity only where everything seen has one colour. Until a
/// row is finished, only its span has values.
struct Layer {
    PlaneBox box;
    int channels;
    pmr::UnclearedVector<float> values;

    /// [rows]: columns [x, y) of the box; a finished row is zero outside.
    std::vector<glm::ivec2> spans;

    /// A finished layer, all zero.
    /// @param memory  for the values
    explicit Layer(const PlaneBox& planeBox, int channelCount = 4,
                   std::pmr::memory_resource& memory = *std::pmr::get_default_resource())
        : box(planeBox), channels(channelCount), values(&memory) {
        setBox(planeBox);
        for (int y = box.min.y; y < box.max.y; ++y) clearRest(y);
    }

    /// Becomes a layer of a box, with empty spans, in its own memory.
    void setBox(const PlaneBox& planeBox);
    /// Adds columns [first, last) to the span of a base plane row, and fills them with zeros.
    void extend(int y, int first, int last) {
        first -= box.min.x;
        last -= box.min.x;
        const glm::ivec2 span = spans[std::size_t(y - box.min.y)];
        if (first < span.x || last > span.y) widen(y, {first, last});
    }
    /// Fills a row with zeros outside its span.
    void clearRest(int y);
    /// Fills all rows on all threads.
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

inline double layerBytes(const PlaneBox& box, int channels) {
    const glm::dvec2 size = box.size();
    return sizeof(float) * channels * size.x * size.y;
}

/// A row of a layer.
struct LayerRow {
    const float* values;  ///< [width][channels]
    int firstColumn;      ///< of the base plane
    glm::ivec2 span;      ///< columns [x, y); zero outside
};

/// Puts row `y` behind a layer that covers it.
void mergeRowBehind(Layer& front, const LayerRow& row, int y);
/// Puts row `y` of a layer, if it is there, behind another layer that covers it.
void mergeRowBehind(Layer& front, const Layer& layer, int y);

/// Puts layers behind a front one, whatever the order in which they get done: only their numbers
/// fix the order of the arithmetic. While more are to come, a layer is merged as soon as those in
/// front of it are, so that few are in memory. Thread-safe except finishRow().
class LayerFold {
  public:
    /// @param count  layers to come, numbered from the front
    /// @param front  goes in front after addFront(); folds without common rows may share it
    /// @param part   of the base plane, which holds the layers
    LayerFold(std::size_t count, Layer& front, const PlaneBox& part)
        : front_(front),
          channels_(front.channels),
          covered_(std::make_shared<const CoveredCells>(part)),
          done_(count) {}

    /// Returns an empty layer. Call it once per number.
    Layer take(const PlaneBox& box);
    /// Returns the cells covered by merged layers: later layers change nothing there.
    std::shared_ptr<const CoveredCells> covered();
    /// Says that the front layer is finished and may be changed. Call it once.
    void addFront();
    void add(std::size_t number, Layer layer);
    /// Merges row y of all remaining layers, once all are added, the front one included.
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
    std::size_t next_ = 0;  // first layer that is not merged
    bool hasFront_ = false;
    bool merging_ = false;
};

/// Adds the cells where a layer is opaque, its opacity 1 to the last bit: layers behind change no
/// bit there, because they are multiplied by 0.
/// @return whether any cell is newly covered
bool addCovered(const Layer& layer, CoveredCells& cells);

/// Covered parts of a slab's slices, which need not be made: covered by slabs before, and by its
/// own slices, front to back. They change no bit (addCovered). Ask slice after slice.
class SlabCover {
  public:
    /// @param before  cells covered by the slabs before
    /// @param layer   the slab's own; must outlive this, and nobody else changes its rows of
    ///                `before`
    SlabCover(const BasePlane& plane, int lastSlice, std::shared_ptr<const CoveredCells> before,
              const Layer& layer)
        : plane_(plane), lastSlice_(lastSlice), layer_(layer), cells_(std::move(before)) {}

    bool all() const { return cells_->all(); }
    /// Returns the needed part of the next slice; valid until the slice behind it.
    /// @param read  pixels that the plane reads
    NeededPixels next(const SheetReading& reading, const SheetBox& read, const SheetLayout& layout);
    /// Adds the pixels composited for that slice.
    void add(std::size_t pixels) { pixels_ += pixels; }

  private:
    void look();

    const BasePlane& plane_;
    int lastSlice_;
    const Layer& layer_;
    std::shared_ptr<const CoveredCells> cells_;
    std::size_t pixels_ = 0;     // composited since the last look
    std::size_t between_ = 128;  // pixels per cell between two looks
    int slices_ = 0;             // since fromNowOn_ was found
    SheetCover ofSlice_;
    SheetCover fromNowOn_;
};

}  // namespace deltasplat
