// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "base/kept_memory.h"
#include "base/progress.h"
#include "composite/layer.h"
#include "splat/splatter.h"
#include "view/base_plane.h"

namespace deltasplat {

/// The data of slabs, and how they are seen.
struct SlabInput {
    SplatInput splat;
    const SheetLayout& layout;  ///< of whole sheets
    const BasePlane& plane;
    KeptMemory& memory;  ///< for layers; the same as for sheets (SplatInput::memory)
};

/// Slices [firstSlice, lastSlice] of a slab, and the blocks in them.
struct SlabRun {
    int firstSlice;
    int lastSlice;
    BlockBox blocks = {};
};

/// A slab whose slices [firstSlice, lastSlice] are seen.
struct SeenSlab {
    const PlannedSlab* slab;
    int firstSlice;
    int lastSlice;
    /// If set, draws only a part of the base plane: the runs with any of it, in walking order, and
    /// the box to draw into. Else draws everything.
    std::vector<SlabRun> runs = {};
    PlaneBox box = {};
};

/// Returns the slabs that may be visible, from the front on.
std::vector<SeenSlab> seenSlabs(const SlabInput& input);
/// Returns the base plane's part that a slab reaches.
PlaneBox reachOfSeen(const SlabInput& input, const SeenSlab& seen);
/// Returns the part that all slabs reach.
PlaneBox reachOfAll(const SlabInput& input, const std::vector<SeenSlab>& seen);

/// Renders slabs into layers and puts these together. A piece of work is a slab in a *strip*, some
/// rows of the base plane of their own; the number of strips only decides who does what.
class SlabRenderer {
  public:
    /// @param seen   from the front on
    /// @param front  layer before all slabs, as large; bits equal those of rendering all at once
    /// @throw Error(kFailed) if sheets and layers do not fit into memory
    SlabRenderer(const SlabInput& input, std::vector<SeenSlab> seen, const Listener& listener,
                 std::optional<Layer> front = {});

    void run();
    Layer merge();
    /// The share of the pieces' time that went into compositing, 0..1.
    double compositeShare() const {
        return pieceSeconds_ > 0 ? compositeSeconds_ / pieceSeconds_ : 0;
    }

  private:
    struct Strip {
        int first;
        int last;
        std::unique_ptr<LayerFold> layers;
        std::size_t next = 0;  // first slab of the strip that nobody has begun; guarded by mutex_
    };
    struct Piece {
        Strip& strip;
        std::size_t slab;
    };
    // How slices of a run are walked.
    struct SliceWalk {
        int begin;  // of the slab
        int first;  // first visible slice
        int last;
        int step;
    };
    SliceWalk walkOf(const PlannedSlab& slab, const SlabRun& run) const;
    bool drawsRuns() const { return !seen_.empty() && !seen_.front().runs.empty(); }
    void cutIntoStrips();
    int stripCount() const;
    std::vector<int> edgesOfStrips() const;
    std::vector<double> workOfRows() const;
    double pixelsOfSlice() const;
    int travel() const;
    SheetLayout layoutOf(const Strip& strip, const SeenSlab& seen, const SlabRun& run) const;
    PlaneBox boxOf(const Strip& strip, const SeenSlab& seen) const;
    void findLargest();
    void requireSlabMemory() const;
    std::optional<Piece> takePiece(Strip*& own);
    void renderPiece(const Piece& piece, Splatter& splatter);
    double renderSlab(const SeenSlab& seen, const Strip& strip, const PlaneBox& box,
                      Splatter& splatter, Layer& layer);
    double renderRun(const PlannedSlab& slab, const SlabRun& run, const Strip& strip,
                     const SheetLayout& layout, const PlaneBox& box, Splatter& splatter,
                     Layer& layer);
    template <typename Composite>
    double walkSlices(const PlannedSlab& slab, const SlabRun& run, const SheetLayout& layout,
                      const PlaneBox& box, SlabCover& cover, Splatter& splatter,
                      const Composite& composite);
    void count(const SeenSlab& seen, double compositeSeconds, double pieceSeconds);

    const SlabInput& input_;
    SharedProgress progress_;
    std::vector<glm::vec4> scales_;  // of the planes of colours
    int channels_;
    std::vector<SeenSlab> seen_;        // front to back
    bool hasFront_;                     // before the slabs
    PlaneBox reach_;                    // of all slabs
    std::optional<StepLengths> steps_;  // from an eye, of colours
    std::vector<Strip> strips_;
    SheetLayout largest_;  // holds the part of any piece
    Layer merged_;
    std::mutex mutex_;           // guards all below
    std::size_t nextStrip_ = 0;  // first strip without an owner
    double compositeSeconds_ = 0;
    double pieceSeconds_ = 0;
    double slicesDone_ = 0;
    double slices_ = 0;  // of all work
};

}  // namespace deltasplat
