// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <functional>
#include <glm/common.hpp>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "base/memory.h"
#include "base/progress.h"
#include "composite/slab_renderer.h"
#include "deltasplat/image/pixel_box.h"
#include "picture/picture_view.h"
#include "picture/render_views.h"
#include "screen/clear_image.h"

namespace deltasplat {

namespace {

/// Pixels of a picture, and the slabs that show in them, from front to back.
struct PlanePart {
    PixelBox pixels;
    std::vector<SeenSlab> slabs;
    PlaneBox whole;  ///< reach of all slabs, if this is a part; else empty
};

/// Cuts a picture into parts if most of its base plane would be empty or outside the picture. A
/// part's base plane and sheets cover only its own voxels, so the cost depends on the visible
/// voxels, not on their box. Bits do not change.
/// @param pixels  the wanted pixels
/// @return the parts that show anything; or a single part with all slabs
std::vector<PlanePart> planeParts(const SlabInput& input, const PlaneView& plane,
                                  const PixelBox& pixels);

/// Calls `show` for each part and its place; other pixels become clear.
/// @param all         the wanted part of the picture
/// @param writesAll   whether `show` writes all pixels of a part; else it adds to those there
void showParts(std::vector<PlanePart>& parts, const PicturePart& all, bool writesAll,
               const std::function<void(PlanePart& part, const PicturePart& to)>& show);

// Limit for the planes and sheets of a part.
constexpr double kMostBytes = 1 << 27;
// Smaller parts read little less: filters reach half as far from an eye, as far for parallel lines.
constexpr int kLeastPixels = 4;
constexpr int kLeastPixelsParallel = 8;
// Slices that share a part of a sheet.
constexpr int kSlicesOfRun = 64;

PlaneBox bothOf(const PlaneBox& a, const PlaneBox& b) {
    PlaneBox both{glm::max(a.min, b.min), glm::min(a.max, b.max)};
    both.max = glm::max(both.min, both.max);
    return both;
}

PlaneBox aroundBoth(const PlaneBox& a, const PlaneBox& b) {
    if (a.empty()) return b;
    return {glm::min(a.min, b.min), glm::max(a.max, b.max)};
}

double pixelsOf(const PlaneBox& box) {
    return double(box.size().x) * box.size().y;
}

class PartFinder {
  public:
    PartFinder(const SlabInput& input, const PlaneView& plane)
        : input_(input), deltas_(input.splat.deltas), plane_(plane), seen_(seenSlabs(input)) {
        reach_ = reachOfAll(input, seen_);
    }

    bool isSparse(const PixelBox& pixels) const {
        if (input_.splat.stampEmptyVoxels) return false;
        const double bytes = layerBytes(reach_, input_.layout.channels) +
                             Splatter::bytes(input_.splat, input_.layout);
        if (bytes <= kMostBytes) return false;
        const double resolution = input_.layout.resolution;
        const double filled = 64 * resolution * resolution * double(deltas_.words.size());
        const PlaneBox read = bothOf(plane_.readBy(pixels), reach_);
        return pixelsOf(reach_) > std::min(filled, 2 * pixelsOf(read));
    }

    std::vector<PlanePart> find(const PixelBox& pixels) {
        if (!isSparse(pixels)) return {{pixels, seen_, {}}};
        // Each half of a picture keeps its own list.
        requireMemory("parts of the picture",
                      2.0 * sizeof(std::uint32_t) * double(deltas_.words.size()));
        std::vector<std::uint32_t> words(deltas_.words.size());
        for (std::size_t i = 0; i < words.size(); ++i) words[i] = std::uint32_t(i);
        divide(pixels, words);
        return std::move(parts_);
    }

  private:
    // Words of a slab that reach a part of the plane, from the first slice on.
    struct SlabWords {
        const SeenSlab* seen;
        std::vector<std::pair<int, std::uint32_t>> words;  // with their slices
    };

    void divide(const PixelBox& pixels, const std::vector<std::uint32_t>& words) {
        const PlaneBox box = bothOf(plane_.readBy(pixels), reach_);
        std::vector<std::uint32_t> reaching;
        PlanePart part = partOf(pixels, box, words, reaching);
        if (part.slabs.empty()) return;
        const glm::ivec2 size = pixels.size();
        // With a small plane, the sheets are not large because of the part.
        const int least = input_.plane.isParallel() ? kLeastPixelsParallel : kLeastPixels;
        const bool isSmall = layerBytes(box, input_.layout.channels) < kMostBytes / 64;
        if (isSmall || std::max(size.x, size.y) <= least || bytesOf(part) <= kMostBytes) {
            parts_.push_back(std::move(part));
            return;
        }
        const int axis = size.x >= size.y ? 0 : 1;
        const int middle = pixels.min[axis] + size[axis] / 2;
        PixelBox first = pixels;
        PixelBox second = pixels;
        first.max[axis] = second.min[axis] = middle;
        divide(first, reaching);
        divide(second, reaching);
    }

    // @param reaching  receives the words that reach the box
    PlanePart partOf(const PixelBox& pixels, const PlaneBox& box,
                     const std::vector<std::uint32_t>& words,
                     std::vector<std::uint32_t>& reaching) const {
        PlanePart part{pixels, {}, reach_};
        if (box.empty()) return part;
        for (const SeenSlab& seen : seen_) {
            SeenSlab cut{seen.slab, seen.firstSlice, seen.lastSlice};
            const int begin = seen.slab->firstSlice;
            const int end = begin + seen.slab->sliceCount;
            auto word = std::lower_bound(words.begin(), words.end(), firstWordOf(begin));
            for (int slice = begin; slice < end && word != words.end(); ++slice) {
                const std::size_t last = firstWordOf(slice + 1);
                if (*word >= last) {
                    if (*word >= firstWordOf(end)) break;
                    slice = sliceOf(*word, slice) - 1;
                    continue;
                }
                // Changes last from their slice on; whole words belong to their slice only.
                const bool isSeen = slice >= seen.firstSlice && slice <= seen.lastSlice;
                const bool isUsed = isSeen || !seen.slab->whole;
                const int lastWalked =
                    input_.plane.frontToBack() ? seen.lastSlice : seen.firstSlice;
                const SheetReading reading = readingOf(input_.plane, input_.layout, slice);
                std::optional<SheetReading> lastReading;
                if (!seen.slab->whole)
                    lastReading = readingOf(input_.plane, input_.layout, lastWalked);
                for (; word != words.end() && *word < last; ++word) {
                    const glm::ivec2 block = blockOf(deltas_.words[*word]);
                    if (!isUsed || !reaches(block, reading, lastReading, box)) continue;
                    reaching.push_back(*word);
                    addTo(cut, seen, slice, block);
                }
            }
            if (cut.runs.empty()) continue;
            if (!input_.plane.frontToBack()) std::reverse(cut.runs.begin(), cut.runs.end());
            placeCut(cut, seen, box);
            part.slabs.push_back(std::move(cut));
        }
        std::sort(reaching.begin(), reaching.end());
        // Showing reads the whole box.
        if (!part.slabs.empty()) part.slabs.front().box = aroundBoth(part.slabs.front().box, box);
        return part;
    }

    std::size_t firstWordOf(int slice) const {
        return deltas_.begins[std::size_t(slice - deltas_.box.min.x)];
    }
    // The slice of a word, at or after `first`.
    int sliceOf(std::size_t word, int first) const {
        const auto from = deltas_.begins.begin() + (first - deltas_.box.min.x);
        const auto behind = std::upper_bound(from, deltas_.begins.end(), word);
        return deltas_.box.min.x + int(behind - deltas_.begins.begin()) - 1;
    }

    glm::ivec2 blockOf(const DeltaWord& word) const {
        return glm::ivec2(word.block.y, word.block.x) - input_.layout.firstVoxel / 8;
    }

    bool reaches(glm::ivec2 block, const SheetReading& reading,
                 const std::optional<SheetReading>& lastReading, const PlaneBox& box) const {
        for (int axis = 0; axis < 2; ++axis) {
            const glm::ivec2 pixels = pixelsReached(input_.layout, block[axis]);
            glm::ivec2 readers = readersOf(reading, axis, pixels.x, pixels.y, box);
            if (lastReading) {
                const glm::ivec2 last = readersOf(*lastReading, axis, pixels.x, pixels.y, box);
                readers = {std::min(readers.x, last.x), std::max(readers.y, last.y)};
            }
            if (readers.x >= readers.y) return false;
        }
        return true;
    }

    // Slabs of changes are walked from their first slice on.
    void addTo(SeenSlab& cut, const SeenSlab& seen, int slice, glm::ivec2 block) const {
        const bool isWhole = seen.slab->whole;
        const auto numberOf = [&](int of) { return (of - seen.slab->firstSlice) / kSlicesOfRun; };
        if (cut.runs.empty() ||
            (isWhole && numberOf(cut.runs.back().lastSlice) != numberOf(slice))) {
            const SlabRun run{slice, slice, {block, block}};
            cut.runs.push_back(isWhole ? run
                                       : SlabRun{seen.firstSlice, seen.lastSlice, run.blocks});
            return;
        }
        SlabRun& run = cut.runs.back();
        if (isWhole) run.lastSlice = slice;
        run.blocks = {glm::min(run.blocks.first, block), glm::max(run.blocks.last, block)};
    }

    // With parallel lines, each run's part of a sheet is drawn at its full width.
    void placeCut(SeenSlab& cut, const SeenSlab& seen, const PlaneBox& box) const {
        if (!input_.plane.isParallel()) {
            cut.box = bothOf(reachOfSeen(input_, seen), box);
            return;
        }
        const SheetLayout& whole = input_.layout;
        for (const SlabRun& run : cut.runs) {
            const SheetLayout layout = layoutPart(whole, {{0, 0}, whole.sizePixels}, run.blocks);
            cut.box = aroundBoth(cut.box, reachOf(input_.plane, layout, run.firstSlice,
                                                  run.lastSlice - run.firstSlice + 1));
        }
        cut.box.min.y = std::clamp(cut.box.min.y, box.min.y, box.max.y);
        cut.box.max.y = std::clamp(cut.box.max.y, box.min.y, box.max.y);
    }

    double bytesOf(const PlanePart& part) const {
        const int channels = input_.layout.channels;
        PlaneBox all;
        double bytes = 0;
        SheetLayout largest = input_.layout;
        largest.blocks = largest.sizePixels = {0, 0};
        for (const SeenSlab& cut : part.slabs) {
            bytes += layerBytes(cut.box, channels);
            all = aroundBoth(all, cut.box);
            for (const SlabRun& run : cut.runs) {
                const SheetLayout layout =
                    layoutPart(input_.layout, {{0, 0}, input_.layout.sizePixels}, run.blocks);
                largest.blocks = glm::max(largest.blocks, layout.blocks);
                largest.sizePixels = glm::max(largest.sizePixels, layout.sizePixels);
            }
        }
        return bytes + layerBytes(all, channels) + Splatter::bytes(input_.splat, largest);
    }

    const SlabInput& input_;
    const PackedDeltas& deltas_;
    const PlaneView& plane_;
    std::vector<SeenSlab> seen_;
    PlaneBox reach_;
    std::vector<PlanePart> parts_;
};

std::vector<PlanePart> planeParts(const SlabInput& input, const PlaneView& plane,
                                  const PixelBox& pixels) {
    return PartFinder(input, plane).find(pixels);
}

void showParts(std::vector<PlanePart>& parts, const PicturePart& all, bool writesAll,
               const std::function<void(PlanePart& part, const PicturePart& to)>& show) {
    const auto isAll = [&](const PixelBox& box) {
        return box.min == all.first && box.max == all.last();
    };
    if (parts.size() == 1 && isAll(parts.front().pixels)) return show(parts.front(), all);
    if (writesAll) clearImage(all.image);
    for (PlanePart& part : parts) {
        const glm::ivec2 size = part.pixels.size();
        Image image(size);
        const auto rowOf = [&](int y) {
            return all.pixel(part.pixels.min.x, part.pixels.min.y + y);
        };
        for (int y = 0; y < size.y; ++y) std::copy_n(rowOf(y), 4 * size.x, image.pixel(0, y));
        show(part, PicturePart(image, part.pixels.min, all.size));
        for (int y = 0; y < size.y; ++y) std::copy_n(image.pixel(0, y), 4 * size.x, rowOf(y));
    }
}

// Merges slabs and shows them, view by view.
class ImageSink : public ViewSink {
  public:
    ImageSink(Image& image, KeptMemory& memory)
        : whole_(image), size_(image.size), memory_(memory) {}

    DrawnFor drawnFor() const override { return DrawnFor::kPixels; }
    void beginGroup(std::shared_ptr<const PreparedScene::Impl>, const PixelBox& part) override {
        group_.emplace(clearImage(part.size()));
        first_ = part.min;
    }
    void endGroup() override {
        putBehind(whole_, first_, *group_);
        group_.reset();
    }
    void take(const PlannedView& planned, RenderStats& stats, const Listener& listener) override {
        planned.axis->packer ? showInParts(planned, stats, listener)
                             : show(planned, stats, listener);
    }
    bool isAnyBeyond(float least) const override {
        return deltasplat::isAnyBeyond(whole_.rgba, least);
    }

  private:
    PicturePart part() {
        return group_ ? PicturePart(*group_, first_, size_) : PicturePart(whole_);
    }

    void show(const PlannedView& planned, RenderStats& stats, const Listener& listener) {
        const std::unique_ptr<const PictureView> view = planned.view(planned.axis);
        const SlabInput& slabs = view->slabs();
        const PicturePart all = part();
        std::vector<PlanePart> parts = planeParts(slabs, view->plane(), {all.first, all.last()});
        double gain = 0;
        showParts(parts, all, slabs.plane.isParallel(), [&](PlanePart& one, const PicturePart& to) {
            // Parts differ in size: memory that few can reuse would pile up.
            if (parts.size() > 1) memory_.endPicture();
            const double share = 0.7 * double(&one - parts.data()) / double(parts.size());
            Layer merged =
                renderSlabs(slabs, std::move(one.slabs), stats,
                            partOf(listener, 0.2 + share, 0.2 + share + 0.7 / parts.size()));
            gain =
                std::max(gain, timedWarp(stats, [&] { return view->show(merged, to, one.whole); }));
        });
        listener.report(0.95);
        addBound(view->errorBound(), gain, stats);
    }

    // Makes words of a few slabs at a time, and puts each result behind the layer so far.
    void showInParts(const PlannedView& planned, RenderStats& stats, const Listener& listener) {
        std::vector<SlabRange> parts = planned.axis->packer->parts();
        if (!planned.plan.view.frontToBack) std::reverse(parts.begin(), parts.end());
        std::unique_ptr<const PictureView> view;
        std::optional<Layer> merged;
        for (std::size_t i = 0; i < parts.size(); ++i) {
            const auto share = [&](double part) {
                return 0.2 + 0.7 * (double(i) + part) / double(parts.size());
            };
            // Free the words of one part before making the next.
            view = nullptr;
            const Clock::time_point start = Clock::now();
            std::shared_ptr<const PreparedAxis> axis = planned.axis->withWords(parts[i]);
            stats.prepareSeconds += secondsSince(start);
            view = planned.view(std::move(axis));
            const SlabInput& input = view->slabs();
            std::vector<SeenSlab> seen = seenSlabs(input);
            if (!merged) {
                merged.emplace(PlaneBox{}, input.layout.channels, memory_);
                merged->setBox(reachOfAll(input, seen));
                merged->clearRest();
            }
            std::erase_if(seen, [&](const SeenSlab& one) {
                const auto number = one.slab - input.splat.deltas.slabs.data();
                return number < parts[i].first || number >= parts[i].last;
            });
            merged = renderSlabs(input, std::move(seen), stats,
                                 partOf(listener, share(0), share(1)), std::move(merged));
        }
        listener.report(0.95);
        const double gain = timedWarp(stats, [&] { return view->show(*merged, part()); });
        addBound(view->errorBound(), gain, stats);
    }

    template <typename Show>
    static double timedWarp(RenderStats& stats, const Show& show) {
        const Clock::time_point start = Clock::now();
        const double gain = show();
        stats.warpSeconds += secondsSince(start);
        return gain;
    }

    Image& whole_;
    glm::ivec2 size_;
    KeptMemory& memory_;
    std::optional<Image> group_;  // of the current group
    glm::ivec2 first_{0};         // of the group in the picture
};

}  // namespace

RenderStats renderImage(const PreparedScene::Impl& scene, const Camera& camera, KeptMemory& memory,
                        Image& image, const Listener& listener) {
    ImageSink sink(image, memory);
    return renderViews(scene, camera, memory, sink, listener);
}

RenderStats PreparedScene::render(const Camera& camera, Image& image,
                                  const Listener& listener) const {
    requireSize(camera, image);
    // A parallel view writes every pixel.
    const bool isWritten =
        camera.projection == Projection::kOrtho && !scene().volume->empty() && !impl_->far;
    if (!isWritten) clearImage(image);
    const RenderStats stats = renderImage(*impl_, camera, *impl_->memory, image, listener);
    impl_->memory->endPicture();
    return stats;
}

Image PreparedScene::render(const Camera& camera, const Listener& listener) const {
    Image image = clearImage(camera.sizePixels);
    render(camera, image, listener);
    return image;
}

}  // namespace deltasplat
