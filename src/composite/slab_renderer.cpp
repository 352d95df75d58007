// SPDX-License-Identifier: Apache-2.0
#include "composite/slab_renderer.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/text.h"
#include "composite/compositor.h"
#include "deltasplat/threads.h"

namespace deltasplat {

std::vector<SeenSlab> seenSlabs(const SlabInput& input) {
    std::vector<SeenSlab> seen;
    for (const PlannedSlab& slab : input.splat.deltas.slabs) {
        glm::ivec2 slices(slab.firstSlice, slab.firstSlice + slab.sliceCount - 1);
        if (!input.plane.isParallel()) slices = input.plane.seen(slices);
        if (slices.y >= slices.x) seen.push_back({&slab, slices.x, slices.y});
    }
    if (!input.plane.frontToBack()) std::reverse(seen.begin(), seen.end());
    return seen;
}

namespace {

SlabRun wholeRun(const SeenSlab& seen) {
    return {seen.firstSlice, seen.lastSlice};
}

std::span<const SlabRun> runsOf(const SeenSlab& seen, const SlabRun& whole) {
    return seen.runs.empty() ? std::span(&whole, 1) : std::span(seen.runs);
}

}  // namespace

PlaneBox reachOfSeen(const SlabInput& input, const SeenSlab& seen) {
    if (!seen.runs.empty()) return seen.box;
    return reachOf(input.plane, input.layout, seen.firstSlice,
                   seen.lastSlice - seen.firstSlice + 1);
}

PlaneBox reachOfAll(const SlabInput& input, const std::vector<SeenSlab>& seen) {
    PlaneBox all;
    for (const SeenSlab& one : seen) {
        const PlaneBox reach = reachOfSeen(input, one);
        const bool isFirst = &one == &seen.front();
        all.min = isFirst ? reach.min : glm::min(all.min, reach.min);
        all.max = isFirst ? reach.max : glm::max(all.max, reach.max);
    }
    return all;
}

SlabRenderer::SlabRenderer(const SlabInput& input, std::vector<SeenSlab> seen,
                           const Listener& listener, std::optional<Layer> front)
    : input_(input),
      progress_(listener),
      channels_(input.layout.channels),
      seen_(std::move(seen)),
      hasFront_(front.has_value()),
      reach_(front ? front->box : reachOfAll(input, seen_)),
      merged_(front ? std::move(*front) : Layer({}, channels_, input.memory)) {
    const ClassTable& table = input.splat.colors.table();
    for (int plane = 0; plane < int(table.planes.size()); ++plane)
        scales_.emplace_back(table.scaleOf(plane) / double(Footprint::kOne));
    for (const SeenSlab& one : seen_) slices_ += one.slab->sliceCount;
    if (seen_.empty() || reach_.empty()) return;
    cutIntoStrips();
    findLargest();
    requireSlabMemory();
    requireCountable(largest_);
    if (!hasFront_) merged_.setBox(reach_);
    if (!input.plane.isParallel() && channels_ == 4)
        steps_.emplace(input.plane, reach_, input.memory);
}

void SlabRenderer::run() {
    const std::size_t pieces = strips_.size() * seen_.size();
    const auto workers = std::min<std::size_t>(std::size_t(threadCount()), pieces);
    parallelFor(workers, [&](std::size_t) {
        // Latecomers need none.
        std::optional<Splatter> splatter;
        Strip* own = nullptr;
        while (const std::optional<Piece> piece = takePiece(own)) {
            if (!splatter) splatter.emplace(input_.splat, largest_);
            renderPiece(*piece, *splatter);
        }
    });
}

// A strip's own thread knows at each slab what slabs before cover. Others share strips.
std::optional<SlabRenderer::Piece> SlabRenderer::takePiece(Strip*& own) {
    const std::lock_guard lock(mutex_);
    const auto isLeft = [&](const Strip& strip) { return strip.next < seen_.size(); };
    if (!own || !isLeft(*own)) own = nextStrip_ < strips_.size() ? &strips_[nextStrip_++] : nullptr;
    if (!own) {
        const auto most =
            std::min_element(strips_.begin(), strips_.end(),
                             [](const Strip& a, const Strip& b) { return a.next < b.next; });
        if (most == strips_.end() || !isLeft(*most)) return {};
        own = &*most;
    }
    return Piece{*own, own->next++};
}

Layer SlabRenderer::merge() {
    parallelForChunks(std::size_t(merged_.box.size().y), [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row) {
            const int y = merged_.box.min.y + int(row);
            for (Strip& strip : strips_) {
                if (y >= strip.first && y < strip.last) strip.layers->finishRow(y);
            }
            if (!hasFront_) merged_.clearRest(y);
        }
    });
    return std::move(merged_);
}

// Number of strips of base plane rows. Every thread gets several pieces, and a strip's slice of
// sheet and layer fits into a second-level cache; but strips are not much smaller than the rows at
// their edges, which two strips work on. If sheet and layer hardly overflow that cache, such rows
// cost too much. No strip has more of both, as each thread clears its part of the sheet.
int SlabRenderer::stripCount() const {
    constexpr std::size_t kPiecesPerThread = 4;
    constexpr int kLeastRows = 48;
    constexpr double kTouchedBytes = 0.75e6;
    constexpr double kMostBytes = 6e6;
    const auto threads = std::size_t(threadCount());
    const std::size_t slabs = seen_.size();
    const std::size_t forThreads =
        threads == 1 ? 1 : (kPiecesPerThread * threads + slabs / 2) / slabs;
    const int rows = reach_.size().y;
    const int columns = drawsRuns() ? reach_.size().x : input_.layout.sizePixels.x;
    const double pixels = double(columns) * rows;
    const double pixelBytes = 2.0 * sizeof(float) * channels_;
    const double parts = pixelBytes * pixels / kMostBytes;
    const double touched = pixelBytes * std::min(pixels, pixelsOfSlice());
    const double forCache = parts > 1 ? std::max(touched / kTouchedBytes, parts) : 1;
    const double wanted = std::min(std::max(double(forThreads), forCache), 1024.0);
    return std::clamp(int(std::lround(wanted)), 1,
                      std::max(1, rows / std::max(kLeastRows, travel())));
}

// Sheet pixels that a slice touches, on average over all visible words.
double SlabRenderer::pixelsOfSlice() const {
    if (input_.splat.stampEmptyVoxels) return std::numeric_limits<double>::infinity();
    double words = 0;
    double weighted = 0;
    for (const SeenSlab& seen : seen_) {
        const auto ofSlab = double(seen.slab->seenWords);
        words += ofSlab;
        weighted += ofSlab * ofSlab / seen.slab->sliceCount;
    }
    if (words == 0) return 0;
    const double edge = input_.layout.blockPixels();
    return edge * edge * weighted / words;
}

// Rows of the sheet passed by a strip in a slab of changes: each strip looks at all of them.
int SlabRenderer::travel() const {
    if (!input_.plane.isParallel()) return 0;
    int rows = 0;
    for (const SeenSlab& seen : seen_) {
        if (seen.slab->whole) continue;
        const auto rowOf = [&](int slice) {
            return readingOf(input_.plane, input_.layout, slice).offset.y;
        };
        rows = std::max(rows, std::abs(rowOf(seen.lastSlice) - rowOf(seen.firstSlice)));
    }
    return rows;
}

// Work per row, from evenly sampled words of visible slices, where the base plane reads them.
std::vector<double> SlabRenderer::workOfRows() const {
    constexpr std::size_t kSamples = 1024;
    // Work of a row without words, relative to one with a fair share.
    constexpr double kEmptyRow = 0.1;
    const std::size_t step = std::max<std::size_t>(1, input_.splat.deltas.words.size() / kSamples);
    const int first = reach_.min.y;
    std::vector<double> work(std::size_t(reach_.size().y) + 1);  // growth from row to row
    double all = 0;
    std::size_t next = 0;
    for (const SeenSlab& seen : seen_) {
        for (int slice = seen.firstSlice; slice <= seen.lastSlice; ++slice) {
            const std::span<const DeltaWord> words = input_.splat.deltas.slice(slice);
            if (next < words.size()) {
                const SheetReading reading = readingOf(input_.plane, input_.layout, slice);
                for (; next < words.size(); next += step) {
                    const glm::ivec2 reached = pixelsReached(
                        input_.layout, words[next].block.x - (input_.layout.firstVoxel.y >> 3));
                    const glm::ivec2 rows = readersOf(reading, 1, reached.x, reached.y, reach_);
                    if (rows.x >= rows.y) continue;
                    work[std::size_t(rows.x - first)] += 1;
                    work[std::size_t(rows.y - first)] -= 1;
                    all += rows.y - rows.x;
                }
            }
            next -= words.size();
        }
    }
    std::partial_sum(work.begin(), work.end(), work.begin());
    work.pop_back();
    for (double& ofRow : work) ofRow += kEmptyRow * std::max(all, 1.0) / double(work.size());
    return work;
}

// Returns the first rows of strips, and the last one's end. Several threads get strips of equal
// work, unless most rows would lie at edges. With many strips per thread, work evens out, and
// strips are equally high: busy strips of equal work would be low, most of their rows at edges.
std::vector<int> SlabRenderer::edgesOfStrips() const {
    constexpr int kManyForThread = 8;
    const int leastRows = std::max(32, travel());
    const int count = stripCount();
    const int first = reach_.min.y;
    const int end = reach_.max.y;
    std::vector<int> edges(std::size_t(count) + 1, end);
    for (int i = 0; i < count; ++i)
        edges[std::size_t(i)] = first + int(std::int64_t{end - first} * i / count);
    const int threads = threadCount();
    if (count == 1 || threads == 1 || count >= kManyForThread * threads) return edges;
    const std::vector<double> work = workOfRows();
    double left = std::accumulate(work.begin(), work.end(), 0.0);
    int row = first;
    for (int i = 0; i + 1 < count; ++i) {
        // Leaves the strips behind their rows.
        const int last = end - leastRows * (count - 1 - i);
        const int least = std::min(row + leastRows, last);
        const double wanted = left / (count - i);
        double ofStrip = 0;
        while (row < least || (row < last && ofStrip < wanted))
            ofStrip += work[std::size_t(row++ - first)];
        left -= ofStrip;
        edges[std::size_t(i) + 1] = row;
    }
    return edges;
}

void SlabRenderer::cutIntoStrips() {
    const std::vector<int> edges = edgesOfStrips();
    for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
        const PlaneBox part{{reach_.min.x, edges[i]}, {reach_.max.x, edges[i + 1]}};
        // The front slab renders into the merged layer, unless something lies before it.
        const std::size_t layers = seen_.size() - (hasFront_ ? 0 : 1);
        strips_.push_back(
            {part.min.y, part.max.y, std::make_unique<LayerFold>(layers, merged_, part)});
        if (hasFront_) strips_.back().layers->addFront();
    }
}

// The base plane's part that a slab reaches in a strip.
PlaneBox SlabRenderer::boxOf(const Strip& strip, const SeenSlab& seen) const {
    PlaneBox box = reachOfSeen(input_, seen);
    box.min.y = std::clamp(strip.first, box.min.y, box.max.y);
    box.max.y = std::clamp(strip.last, box.min.y, box.max.y);
    return box;
}

// The sheet's part that a run needs for a strip.
SheetLayout SlabRenderer::layoutOf(const Strip& strip, const SeenSlab& seen,
                                   const SlabRun& run) const {
    const SheetLayout& whole = input_.layout;
    if (input_.plane.isParallel() && strips_.size() == 1 && !drawsRuns()) return whole;
    const PlaneBox box = boxOf(strip, seen);
    SheetBox part{whole.sizePixels, {0, 0}};
    for (const int slice : {run.firstSlice, run.lastSlice}) {
        const SheetBox read = readBox(readingOf(input_.plane, whole, slice), box, whole);
        part.min = glm::min(part.min, read.min);
        part.max = glm::max(part.max, read.max);
    }
    return layoutPart(whole, part, run.blocks);
}

void SlabRenderer::findLargest() {
    largest_ = layoutPart(input_.layout, {});
    for (const Strip& strip : strips_) {
        for (const SeenSlab& seen : seen_) {
            const SlabRun whole = wholeRun(seen);
            for (const SlabRun& run : runsOf(seen, whole)) {
                const SheetLayout layout = layoutOf(strip, seen, run);
                largest_.blocks = glm::max(largest_.blocks, layout.blocks);
                largest_.sizePixels = glm::max(largest_.sizePixels, layout.sizePixels);
            }
        }
    }
}

// Memory of all slabs: splatters per thread, layers, and the merged layer.
void SlabRenderer::requireSlabMemory() const {
    const double pieces = double(strips_.size()) * double(seen_.size());
    double bytes =
        Splatter::bytes(input_.splat, largest_) * std::min<double>(threadCount(), pieces);
    for (std::size_t i = hasFront_ ? 0 : 1; i < seen_.size(); ++i)
        bytes += layerBytes(reachOfSeen(input_, seen_[i]), channels_);
    if (!hasFront_) bytes += layerBytes(reach_, channels_);
    if (!input_.plane.isParallel()) bytes += layerBytes(reach_, 1);
    // Kept memory is there already.
    bytes = std::max(0.0, bytes - double(input_.memory.idleBytes()));
    requireMemory("sheets and layers at " + std::to_string(largest_.resolution) + " pixels a voxel",
                  bytes);
}

// Without a layer before it, the front slab renders into the merged layer; others into their own.
void SlabRenderer::renderPiece(const Piece& piece, Splatter& splatter) {
    const Clock::time_point start = Clock::now();
    const std::size_t number = piece.slab;
    const SeenSlab& seen = seen_[number];
    const Strip& strip = piece.strip;
    const PlaneBox box = boxOf(strip, seen);
    double compositeSeconds = 0;
    const auto timed = [&](const auto& use) {
        const Clock::time_point before = Clock::now();
        use();
        compositeSeconds += secondsSince(before);
    };
    if (number == 0 && !hasFront_) {
        compositeSeconds += renderSlab(seen, strip, box, splatter, merged_);
        timed([&] { strip.layers->addFront(); });
    } else {
        Layer layer = strip.layers->take(box);
        compositeSeconds += renderSlab(seen, strip, box, splatter, layer);
        timed([&] { strip.layers->add(number - (hasFront_ ? 0 : 1), std::move(layer)); });
    }
    count(seen, compositeSeconds, secondsSince(start));
}

// Returns the seconds that compositing took.
double SlabRenderer::renderSlab(const SeenSlab& seen, const Strip& strip, const PlaneBox& box,
                                Splatter& splatter, Layer& layer) {
    // Whatever its number of slices.
    if (seen.slab->seenWords == 0 || box.empty()) return 0;
    const SlabRun whole = wholeRun(seen);
    double compositeSeconds = 0;
    for (const SlabRun& run : runsOf(seen, whole)) {
        const SheetLayout layout = layoutOf(strip, seen, run);
        if (layout.blocks.x == 0 || layout.blocks.y == 0) continue;
        compositeSeconds += renderRun(*seen.slab, run, strip, layout, box, splatter, layer);
    }
    return compositeSeconds;
}

double SlabRenderer::renderRun(const PlannedSlab& slab, const SlabRun& run, const Strip& strip,
                               const SheetLayout& layout, const PlaneBox& box, Splatter& splatter,
                               Layer& layer) {
    SlabCover cover(input_.plane, walkOf(slab, run).last, strip.layers->covered(), layer);
    if (cover.all()) return 0;
    if (input_.plane.isParallel()) {
        Compositor compositor(scales_);
        return walkSlices(
            slab, run, layout, box, cover, splatter,
            [&](const auto& sheets, int, const SheetReading& reading, const SheetCover* hidden) {
                return compositor.composite(sheets, reading, box.min.y, box.max.y, hidden, layer);
            });
    }
    PerspectiveCompositor compositor(input_.plane, scales_, steps_ ? &*steps_ : nullptr);
    return walkSlices(
        slab, run, layout, box, cover, splatter,
        [&](const auto& sheets, int slice, const SheetReading& reading, const SheetCover* hidden) {
            return compositor.composite(sheets, slice, reading, box, hidden, layer);
        });
}

SlabRenderer::SliceWalk SlabRenderer::walkOf(const PlannedSlab& slab, const SlabRun& run) const {
    if (input_.plane.frontToBack()) return {slab.firstSlice, run.firstSlice, run.lastSlice, 1};
    return {slab.firstSlice + slab.sliceCount - 1, run.lastSlice, run.firstSlice, -1};
}

// Calls composite(sheets, slice, reading, hidden) -> pixels done, for all visible slices.
template <typename Composite>
double SlabRenderer::walkSlices(const PlannedSlab& slab, const SlabRun& run,
                                const SheetLayout& layout, const PlaneBox& box, SlabCover& cover,
                                Splatter& splatter, const Composite& composite) {
    double compositeSeconds = 0;
    splatter.begin(slab, layout);
    const SliceWalk walk = walkOf(slab, run);
    const SheetBox last = readBox(readingOf(input_.plane, layout, walk.last), box, layout);
    // Changes before the first visible slice are needed, but their pixels are not read.
    if (!slab.whole) {
        for (int slice = walk.begin; slice != walk.first; slice += walk.step)
            splatter.splat(slice, {0, 0});
    }
    for (int slice = walk.first; slice != walk.last + walk.step; slice += walk.step) {
        const SheetReading reading = readingOf(input_.plane, layout, slice);
        const SheetBox read = readBox(reading, box, layout);
        NeededPixels needed = cover.next(reading, read, layout);
        // Readings of slices between lie between the first and the last.
        needed.rowsFromNowOn = {std::min(read.min.y, last.min.y), std::max(read.max.y, last.max.y)};
        const auto sheets = splatter.splat(slice, needed);
        const Clock::time_point before = Clock::now();
        cover.add(composite(sheets, slice, reading, needed.cover));
        compositeSeconds += secondsSince(before);
    }
    splatter.end();
    return compositeSeconds;
}

void SlabRenderer::count(const SeenSlab& seen, double compositeSeconds, double pieceSeconds) {
    double slicesDone = 0;
    {
        const std::lock_guard lock(mutex_);
        compositeSeconds_ += compositeSeconds;
        pieceSeconds_ += pieceSeconds;
        slicesDone_ += double(seen.slab->sliceCount) / double(strips_.size());
        slicesDone = slicesDone_;
    }
    progress_.report(slicesDone / slices_);
}

}  // namespace deltasplat
