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

/// What slabs are rendered from, and how they are seen.
struct SlabInput {
    SplatInput splat;
    const SheetLayout& layout;  ///< of whole sheets
    const BasePlane& plane;
    KeptMemory& memory;  ///< for layers, and the one for sheets
};

/// Slices [firstSlice, lastSlice] of a slab, and the blocks that any of them has.
struct SlabRun {
    int firstSlice;
    int lastSlice;
    BlockBox blocks = {};
};

/// A slab of which some slices are seen: those of [firstSlice, lastSlice].
struct SeenSlab {
    const PlannedSlab* slab;
    int firstSlice;
    int lastSlice;
    /// Where only what lies in a part of the base plane is drawn: the runs that have any of it, as
    /// they are walked, and the box that they are drawn into. Else all is.
    std::vector<SlabRun> runs = {};
    PlaneBox box = {};
};

/// Returns the slabs of which something may be seen, from the front on.
std::vector<SeenSlab> seenSlabs(const SlabInput& input);
/// Returns the base plane's part that one of them reaches.
PlaneBox reachOfSeen(const SlabInput& input, const SeenSlab& seen);
/// Returns the part that all of them reach.
PlaneBox reachOfAll(const SlabInput& input, const std::vector<SeenSlab>& seen);

/// Renders slabs into layers, and puts these together. Work is cut into pieces of a slab and a
/// *strip*, some rows of the base plane that are worked on by themselves; how many strips there are
/// changes nothing but who does what.
class SlabRenderer {
  public:
    /// @param seen   which, from the front on
    /// @param front  what lies before them, and reaches all that they do; bits are then those of
    ///               rendering all at once
    /// @throw Error(kFailed) if sheets and layers do not fit into memory
    SlabRenderer(const SlabInput& input, std::vector<SeenSlab> seen, const Listener& listener,
                 std::optional<Layer> front = {});

    /// Renders the slabs, from the front on.
    void run();
    /// Returns what the slabs look like together.
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
        std::size_t next = 0;  // of its slabs, that nobody has begun; guarded by mutex_
    };
    struct Piece {
        Strip& strip;
        std::size_t slab;
    };
    // How the slices of a run are walked.
    struct SliceWalk {
        int begin;  // of the slab
        int first;  // that is seen
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
    std::vector<SeenSlab> seen_;        // from the front on
    bool hasFront_;                     // before them
    PlaneBox reach_;                    // of all of them
    std::optional<StepLengths> steps_;  // from an eye, of colours
    std::vector<Strip> strips_;
    SheetLayout largest_;  // holds the part of any piece
    Layer merged_;
    std::mutex mutex_;           // guards all below
    std::size_t nextStrip_ = 0;  // that nobody has for its own
    double compositeSeconds_ = 0;
    double pieceSeconds_ = 0;
    double slicesDone_ = 0;
    double slices_ = 0;  // of all that is to be rendered
};

}  // namespace deltasplat
