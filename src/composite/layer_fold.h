// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "composite/layer.h"
#include "splat/covered_cells.h"

namespace deltasplat {

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

}  // namespace deltasplat
