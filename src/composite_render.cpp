// SPDX-License-Identifier: Apache-2.0
#include "composite_render.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "composite/compositor.h"
#include "composite/layer_fold.h"
#include "composite/plane_view.h"
#include "delta/code_blocks.h"
#include "deltasplat/error.h"
#include "deltasplat/threads.h"
#include "image/warp.h"
#include "memory.h"
#include "number_text.h"
#include "optics/hold_rule.h"
#include "optics/largest_alpha.h"
#include "parallel.h"
#include "shared_progress.h"
#include "splat/splatter.h"
#include "stopwatch.h"

namespace deltasplat {
namespace {

Encoding encodingOf(Method method) {
    switch (method) {
        case Method::kAuto:
            return Encoding::kSmaller;
        case Method::kDelta:
            return Encoding::kChanges;
        default:
            return Encoding::kWhole;
    }
}

// Whether what is shown is thin. Of thin voxels, two sheet pixels show little that one does not,
// and values mixed little more (docs/decisions.md). Not what is seen decides, lest a voxel or an
// angle change the picture of all others.
bool isThin(const Volume& volume, const Optics& optics) {
    constexpr double kMost = 0.25;
    return largestAlpha(volume, optics) <= kMost;
}

// Where the screen asks for two sheet pixels a voxel, but not for more, what is thin gets one.
int sheetResolution(const Volume& volume, const Factorization& view, const RenderOptions& options) {
    const bool few = view.pixelsPerVoxel < 2.5;
    return !options.resolution && few && isThin(volume, options.optics) ? 1 : view.resolution;
}

// What whole blocks are divided into is counted with 32 bits, and some more voxels around it.
bool canBeDivided(const IndexBox& box, int between) {
    constexpr std::int64_t kMost = std::int64_t{1} << 30;
    const glm::i64vec3 wide = glm::i64vec3(box.max) - glm::i64vec3(box.min) + std::int64_t{16};
    return std::max({wide.x, wide.y, wide.z}) * (between + 1) <= kMost;
}

// Into how many strips rows of the base plane are cut: enough pieces for every thread to take some,
// and enough for a strip's part of sheet and layer to stay in a second-level cache; but not so many
// that strips get much smaller than the rows at their edges, which belong to two. If all of sheet
// and layer hardly overflow that cache, such rows cost more than they help.
int stripCount(const SheetLayout& layout, int rows, std::size_t slabs) {
    constexpr std::size_t kPiecesPerThread = 4;
    constexpr int kLeastRows = 48;
    constexpr double kStripBytes = 1.5e6;
    constexpr double kMostWholeBytes = 6e6;
    const auto threads = std::size_t(threadCount());
    const std::size_t forThreads =
        threads == 1 ? 1 : (kPiecesPerThread * threads + slabs / 2) / slabs;
    const double bytes = 2.0 * sizeof(float) * layout.channels * layout.sizePixels.x * rows;
    const double forCache = bytes > kMostWholeBytes ? bytes / kStripBytes : 1;
    const double wanted = std::min(std::max(double(forThreads), forCache), 1024.0);
    return std::clamp(int(std::lround(wanted)), 1, std::max(1, rows / kLeastRows));
}

// Rows of the base plane that are worked on by themselves.
struct Strip {
    int first;
    int last;
    std::unique_ptr<LayerFold> layers;
};

// What the slabs share, and where their results go. Work is cut into pieces of a slab and a strip
// of base plane rows; how many strips there are changes nothing but who does what.
class SlabRenderer {
  public:
    SlabRenderer(const SplatInput& input, const SheetLayout& layout, const PlaneView& view,
                 const Listener& listener)
        : input_(input),
          view_(view),
          layout_(layout),
          progress_(listener),
          merged_({}, layout_.channels) {
        for (int plane = 0; plane < int(input.classes.planes.size()); ++plane)
            scales_.emplace_back(input.classes.scaleOf(plane) / double(Footprint::kOne));
        cutIntoStrips();
        largest_ = largestLayout();
    }

    // Renders all slabs, from the front on.
    void run() {
        const std::size_t pieces = strips_.size() * slabs().size();
        const auto workers = std::min<std::size_t>(std::size_t(threadCount()), pieces);
        parallelFor(workers, [&](std::size_t) {
            // Whoever comes too late needs none.
            std::optional<Splatter> splatter;
            for (std::size_t i = next_++; i < pieces; i = next_++) {
                if (!splatter) splatter.emplace(input_, largest_);
                renderPiece(i, *splatter);
            }
        });
    }

    // Returns what the slabs look like together.
    Layer merge() {
        parallelForChunks(std::size_t(merged_.box.size().y),
                          [&](std::size_t begin, std::size_t end) {
                              for (std::size_t row = begin; row < end; ++row) {
                                  const int y = merged_.box.min.y + int(row);
                                  for (Strip& strip : strips_) {
                                      if (y >= strip.first && y < strip.last)
                                          strip.layers->finishRow(y);
                                  }
                              }
                          });
        return std::move(merged_);
    }

    // The share of the pieces' time that went into compositing, 0..1.
    double compositeShare() const {
        return pieceSeconds_ > 0 ? compositeSeconds_ / pieceSeconds_ : 0;
    }

  private:
    const std::vector<PlannedSlab>& slabs() const { return input_.deltas.slabs; }

    PlaneBox reachOfAll() const {
        const IndexBox& box = input_.deltas.box;
        return reachOf(layout_, view_.shiftPerSlice, box.min.x, box.dims().x);
    }

    void cutIntoStrips() {
        const PlaneBox box = reachOfAll();
        const int rows = box.size().y;
        const int count = stripCount(layout_, rows, slabs().size());
        for (int i = 0; i < count; ++i) {
            const auto edge = [&](int n) {
                return box.min.y + int(std::int64_t{rows} * n / count);
            };
            strips_.push_back(
                {edge(i), edge(i + 1), std::make_unique<LayerFold>(slabs().size() - 1, merged_)});
        }
    }

    // The part of the sheet that a slab needs for a strip.
    SheetLayout layoutOf(const Strip& strip, const Slab& slab) const {
        if (strips_.size() == 1) return layout_;
        const int lastSlice = slab.firstSlice + slab.sliceCount - 1;
        const int a = shiftOf(layout_, view_.shiftPerSlice, slab.firstSlice).offset.y;
        const int b = shiftOf(layout_, view_.shiftPerSlice, lastSlice).offset.y;
        // Reading takes in the row behind the last as well.
        return layoutRows(layout_, strip.first + std::min(a, b), strip.last + std::max(a, b) + 1);
    }

    SheetLayout largestLayout() const {
        SheetLayout largest = layoutRows(layout_, 0, 0);
        for (const Strip& strip : strips_) {
            for (const Slab& slab : slabs()) {
                const SheetLayout layout = layoutOf(strip, slab);
                if (layout.sizePixels.y > largest.sizePixels.y) largest = layout;
            }
        }
        return largest;
    }

    // The front slab goes straight into the merged layer, the others into layers of their own.
    void renderPiece(std::size_t piece, Splatter& splatter) {
        const Clock::time_point start = Clock::now();
        const std::size_t number = piece / strips_.size();
        const PlannedSlab& slab = slabs()[view_.frontToBack ? number : slabs().size() - 1 - number];
        const Strip& strip = strips_[piece % strips_.size()];
        PlaneBox box = reachOf(layout_, view_.shiftPerSlice, slab.firstSlice, slab.sliceCount);
        box.min.y = std::clamp(strip.first, box.min.y, box.max.y);
        box.max.y = std::clamp(strip.last, box.min.y, box.max.y);
        double compositeSeconds = 0;
        const auto timed = [&](const auto& use) {
            const Clock::time_point before = Clock::now();
            use();
            compositeSeconds += secondsSince(before);
        };
        if (number == 0) {
            // Not made before there are threads, so that others may begin meanwhile.
            timed([&] { std::call_once(mergedOnce_, [&] { merged_.reset(reachOfAll()); }); });
            compositeSeconds += renderSlab(slab, strip, box, splatter, merged_);
            timed([&] { strip.layers->addFront(); });
        } else {
            Layer layer = strip.layers->take(box);
            compositeSeconds += renderSlab(slab, strip, box, splatter, layer);
            timed([&] { strip.layers->add(number - 1, std::move(layer)); });
        }
        count(slab, compositeSeconds, secondsSince(start));
    }

    // Returns the seconds that compositing took.
    double renderSlab(const PlannedSlab& slab, const Strip& strip, const PlaneBox& box,
                      Splatter& splatter, Layer& layer) {
        double compositeSeconds = 0;
        const SheetLayout layout = layoutOf(strip, slab);
        if (box.empty() || layout.blocks.y == 0) return compositeSeconds;
        Compositor compositor(scales_, view_.frontToBack);
        splatter.begin(slab, layout);
        for (int i = 0; i < slab.sliceCount; ++i) {
            const int slice = slab.firstSlice + i;
            const SheetShift shift = shiftOf(layout, view_.shiftPerSlice, slice);
            // Reading takes in the row behind the last as well.
            const Compositor::Sheets sheets =
                splatter.splat(slice, box.min.y + shift.offset.y, box.max.y + shift.offset.y + 1);
            const Clock::time_point before = Clock::now();
            compositor.composite(sheets, shift, box.min.y, box.max.y, layer);
            compositeSeconds += secondsSince(before);
        }
        splatter.end();
        return compositeSeconds;
    }

    void count(const Slab& slab, double compositeSeconds, double pieceSeconds) {
        double slicesDone = 0;
        {
            const std::lock_guard lock(mutex_);
            compositeSeconds_ += compositeSeconds;
            pieceSeconds_ += pieceSeconds;
            slicesDone_ += double(slab.sliceCount) / double(strips_.size());
            slicesDone = slicesDone_;
        }
        progress_.report(0.2 + 0.7 * slicesDone / input_.deltas.box.dims().x);
    }

    const SplatInput& input_;
    const PlaneView& view_;
    const SheetLayout& layout_;
    SharedProgress progress_;
    std::vector<glm::vec4> scales_;  // of the planes of colours
    Layer merged_;
    std::once_flag mergedOnce_;
    std::vector<Strip> strips_;
    SheetLayout largest_;
    std::atomic<std::size_t> next_ = 0;
    std::mutex mutex_;  // guards all below
    double compositeSeconds_ = 0;
    double pieceSeconds_ = 0;
    double slicesDone_ = 0;
};

// Footprints that a method adds.
std::uint64_t stampsOf(const PackedDeltas& deltas, const RenderStats& stats) {
    if (stats.method == Method::kTraditional) return stats.voxels;
    std::uint64_t stamps = 0;
    for (const PlannedSlab& slab : deltas.slabs) stamps += slab.stamps();
    return stamps;
}

Raster rasterOf(const Layer& layer, const ClassTable& classes) {
    Raster raster{layer.box.min, layer.box.size(), layer.values.data(), layer.channels};
    raster.spans = layer.spans;
    // Of one colour, every channel is a fixed share of the opacity.
    if (classes.oneColor) raster.color = glm::dvec3(classes.scale) / classes.scale.a;
    return raster;
}

// What all slabs together take: splatters for each thread, layers, and the merged one.
void requireSlabMemory(const SplatInput& input, const PlaneView& view, const SheetLayout& layout) {
    const PackedDeltas& deltas = input.deltas;
    const IndexBox& box = deltas.box;
    const int rows = reachOf(layout, view.shiftPerSlice, box.min.x, box.dims().x).size().y;
    const int strips = stripCount(layout, rows, deltas.slabs.size());
    int longest = 0;
    for (const Slab& slab : deltas.slabs) longest = std::max(longest, slab.sliceCount);
    // A strip's rows, those that its slabs are shifted by, and whole blocks and margins around.
    const double partRows = double(rows) / strips + 1.0 * (longest + 16) * layout.resolution +
                            2.0 * layout.marginPixels;
    const double share = std::min(1.0, partRows / layout.sizePixels.y);
    double bytes = share * Splatter::bytes(input, layout) *
                   std::min<double>(threadCount(), double(strips) * double(deltas.slabs.size()));
    const auto layerBytes = [&](int firstSlice, int sliceCount) {
        const glm::dvec2 size = reachOf(layout, view.shiftPerSlice, firstSlice, sliceCount).size();
        return sizeof(float) * layout.channels * size.x * size.y;
    };
    for (const Slab& slab : deltas.slabs) bytes += layerBytes(slab.firstSlice, slab.sliceCount);
    // The front slab's is the merged one.
    const Slab& front = view.frontToBack ? deltas.slabs.front() : deltas.slabs.back();
    bytes -= layerBytes(front.firstSlice, front.sliceCount);
    bytes += layerBytes(deltas.box.min.x, deltas.box.dims().x);
    requireMemory("sheets and layers at " + std::to_string(layout.resolution) + " pixels a voxel",
                  bytes);
}

// What voxels become, and sheet pixels for each of them then.
struct SheetPlan {
    Subdivision parts;
    int resolution;
};

// @param view  of the volume's own voxels
void renderDeltas(const PackedDeltas& deltas, const ClassTable& classes, const Factorization& view,
                  const SheetPlan& plan, const RenderOptions& options, const Listener& listener,
                  RenderResult& result) {
    const Clock::time_point start = Clock::now();
    const Factorization thinView = subdivided(view, plan.parts);
    const PlaneView planeView(thinView);
    const int within = plan.parts.within;
    const double sigma = options.sigma.value_or(defaultSigma(thinView.pixelsPerVoxel) / within);
    // The kernel is round in voxels, however many slices there are.
    const Footprint footprint = makeFootprint(sigma, PlaneView(view).shiftPerSlice, plan.resolution,
                                              options.footprintWidth, within);
    const SheetLayout layout = layoutSheet(deltas.box, footprint, classes.oneColor ? 1 : 4);
    std::optional<DigitVoxels> digitVoxels;
    if (!classes.oneDigit()) digitVoxels.emplace(deltas, classes);
    const SplatInput input{deltas, classes, footprint, options.method == Method::kTraditional,
                           digitVoxels ? &*digitVoxels : nullptr};
    requireSlabMemory(input, planeView, layout);
    SlabRenderer slabs(input, layout, planeView, listener);
    slabs.run();
    const double slabSeconds = secondsSince(start);

    const Layer merged = slabs.merge();
    const double mergedSeconds = secondsSince(start);
    listener.report(0.95);

    const glm::dmat3 map = planeFromPixel(planeView, layout);
    warp(rasterOf(merged, classes), map, WarpFilter::kSharp, result.image);

    RenderStats& stats = result.stats;
    stats.stamps = stampsOf(deltas, stats);
    if (!options.tolerance.isExact()) {
        const ErrorBound bound = errorBound(classes, options.tolerance);
        const double gain = warpGain(map);
        stats.errorBoundColor = bound.color * gain;
        stats.errorBoundAlpha = bound.alpha * gain;
    }
    stats.resolution = plan.resolution * within;
    stats.footprint = footprint.width;
    stats.renderSeconds = secondsSince(start);
    stats.splatSeconds = slabSeconds * (1 - slabs.compositeShare());
    stats.compositeSeconds = mergedSeconds - stats.splatSeconds;
    stats.warpSeconds = stats.renderSeconds - mergedSeconds;
}

void checkBetween(int between) {
    if (between >= 0 && between <= kMostBetween) return;
    throw Error(ErrorCode::kUsage,
                gotExpected("--between", std::to_string(between),
                            "a whole number within 0.." + std::to_string(kMostBetween)));
}

[[noreturn]] void throwTooWide(const IndexBox& box, int between) {
    const glm::ivec3 dims = box.dims();
    throw Error(ErrorCode::kFailed,
                gotExpected("--between " + std::to_string(between),
                            std::to_string(dims.x) + "x" + std::to_string(dims.y) + "x" +
                                std::to_string(dims.z) + " voxels",
                            "at most 2^30 parts of them along each axis (--between 0: undivided)"));
}

// Whether voxels are divided where the screen asks for it and nobody says otherwise.
bool dividesUnasked(const Volume& volume, const Factorization& view, const ClassTable& classes,
                    const RenderOptions& options, const Listener& listener) {
    if (view.resolution < 2 || options.resolution || options.footprintWidth) return false;
    if (options.optics.transferFunction.colorsJump()) return false;
    if (volume.empty() || isThin(volume, options.optics)) return false;
    if (!canBeDivided(volume.box, 1)) {
        listener.warn("the volume is too wide for voxels to be divided: drawn as they are");
        return false;
    }
    const BlockReader seen(*volume.codes, nullptr, view.sliceAxis, classes.classOfSlot);
    if (seen.blocks().size() <= kMostDivided) return true;
    listener.warn("voxels are too many to be divided (" + std::to_string(seen.blocks().size()) +
                  " blocks of 8x8x8 can be seen, at most " + std::to_string(kMostDivided) +
                  " are): drawn as they are; --between 1 divides them");
    return false;
}

// @param classes  of the volume's own voxels
SheetPlan planSheet(const Volume& volume, const Factorization& view, const ClassTable& classes,
                    const RenderOptions& options, const Listener& listener) {
    int between = 0;
    int resolution = sheetResolution(volume, view, options);
    if (options.between) {
        between = *options.between;
        checkBetween(between);
        if (between > 0 && !canBeDivided(volume.box, between)) throwTooWide(volume.box, between);
    } else if (dividesUnasked(volume, view, classes, options, listener)) {
        between = 1;
    }
    if (between > 0 && !options.resolution) resolution = 2;
    Subdivision parts{between + 1, between > 0 && resolution % 2 == 0 ? 2 : 1, {}};
    // Whole blocks are divided.
    if (parts.divides()) parts.origin = toSliceOrder(volume.box.min, view.sliceAxis) & ~7;
    return {parts, resolution / parts.within};
}

// Optics as the volume has them, for levels to be seen by.
Optics withRange(const Volume& volume, Optics optics) {
    if (!optics.range) optics.range = defaultRange(volume);
    return optics;
}

}  // namespace

void renderComposite(const Volume& volume, const Factorization& view, const RenderOptions& options,
                     const Listener& listener, RenderResult& result) {
    const Clock::time_point start = Clock::now();
    RenderStats& stats = result.stats;
    const Optics optics = withRange(volume, options.optics);
    ClassTable classes = classify(volume, optics, view.sliceStepWorld);
    const SheetPlan plan = planSheet(volume, view, classes, options, listener);
    const Subdivision& parts = plan.parts;
    stats.between = parts.slices - 1;
    stats.parts = parts.voxels();
    stats.slices *= parts.slices;
    stats.voxels *= std::uint64_t(stats.parts);
    std::optional<ValueMixer> mixer;
    if (parts.divides()) {
        mixer.emplace(volume, parts);
        classes = classify(mixer->levels(), optics, view.sliceStepWorld / parts.slices);
    }
    const Volume& seen = mixer ? mixer->levels() : volume;
    listener.report(0.05);
    const PackedDeltas deltas =
        packDeltas(volume, {view.sliceAxis, encodingOf(options.method), classes.classOfSlot,
                            holdRule(seen, classes, options.tolerance), mixer ? &*mixer : nullptr});
    listener.report(0.2);

    stats.tolerance = options.tolerance;
    stats.visible = deltas.visible();
    stats.deltas = deltas.deltas();
    stats.slabs = int(deltas.slabs.size());
    stats.prepareSeconds = secondsSince(start);
    if (!volume.empty()) renderDeltas(deltas, classes, view, plan, options, listener, result);
}

}  // namespace deltasplat
