// SPDX-License-Identifier: Apache-2.0
#include "deep_view.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>

#include "listener_part.h"
#include "memory.h"
#include "parallel.h"
#include "stopwatch.h"

namespace deltasplat {
namespace {

// Which sample a slice belongs to, wherever slabs begin.
class SampleNumbers {
  public:
    SampleNumbers(const Subdivision& parts, int slicesPerSample)
        : origin_(std::int64_t{parts.origin.x} * parts.slices),
          length_(std::max<std::int64_t>(std::int64_t{slicesPerSample} * parts.slices, 1)) {}

    std::int64_t of(int slice) const {
        const std::int64_t place = slice + origin_;
        return place / length_ - (place % length_ < 0);
    }
    // The last slice of the same sample, towards larger or smaller ones.
    std::int64_t last(int slice, bool towardsLarger) const {
        const std::int64_t first = of(slice) * length_ - origin_;
        return towardsLarger ? first + length_ - 1 : first;
    }

  private:
    std::int64_t origin_;
    std::int64_t length_;
};

void addPiece(const SeenSlab& piece, bool continues, std::vector<DeepCut>& cuts) {
    if (!continues) cuts.push_back({piece.firstSlice, piece.lastSlice, {}});
    DeepCut& cut = cuts.back();
    cut.firstSlice = std::min(cut.firstSlice, piece.firstSlice);
    cut.lastSlice = std::max(cut.lastSlice, piece.lastSlice);
    cut.slabs.push_back(piece);
}

void mergeBehind(Layer& front, const Layer& layer) {
    parallelForChunks(std::size_t(layer.box.size().y), [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row)
            mergeRowBehind(front, layer, layer.box.min.y + int(row));
    });
}

// Where a slice begins, in undivided slices: the same number for all parts of a volume.
double faceBefore(int slice, const Subdivision& parts) {
    return parts.origin.x + double(slice) / parts.slices - 0.5;
}

}  // namespace

std::vector<DeepCut> cutInDepth(const std::vector<SeenSlab>& seen, bool frontToBack,
                                const Subdivision& parts, int slicesPerSample) {
    const SampleNumbers numbers(parts, slicesPerSample);
    std::vector<DeepCut> cuts;
    for (const SeenSlab& slab : seen) {
        int slice = frontToBack ? slab.firstSlice : slab.lastSlice;
        while (slice >= slab.firstSlice && slice <= slab.lastSlice) {
            const int last = int(std::clamp<std::int64_t>(numbers.last(slice, frontToBack),
                                                          slab.firstSlice, slab.lastSlice));
            const bool continues =
                !cuts.empty() && numbers.of(cuts.back().firstSlice) == numbers.of(slice);
            addPiece({slab.slab, std::min(slice, last), std::max(slice, last)}, continues, cuts);
            slice = frontToBack ? last + 1 : last - 1;
        }
    }
    return cuts;
}

DeepViewResult renderDeepView(const PictureView& picture, int slicesPerSample, KeptMemory& memory,
                              DeepStages& stages, Image& flat, const Listener& listener) {
    const SlabInput& input = picture.slabs();
    const Subdivision& parts = picture.axis().parts;
    const bool frontToBack = input.plane.frontToBack();
    const std::vector<SeenSlab> seen = seenSlabs(input);
    const std::vector<DeepCut> cuts = cutInDepth(seen, frontToBack, parts, slicesPerSample);
    const PlaneBox reach = reachOfAll(input, seen);
    // What is shown may have to be changed for that.
    const double layers = picture.showChangesLayer() ? 2 : 1;
    requireMemory("layers of a deep picture", layers * layerBytes(reach, input.layout.channels));
    Layer merged(reach, input.layout.channels, memory);
    stages.begin(std::make_shared<const SliceDepths>(picture.camera(), picture.worldFromSlices()));
    DeepViewResult result{1, 0, 0, 0};
    double compositeSeconds = 0;
    for (std::size_t i = 0; i < cuts.size(); ++i) {
        const DeepCut& cut = cuts[i];
        const double share = double(i) / double(cuts.size());
        const double next = double(i + 1) / double(cuts.size());
        const Clock::time_point start = Clock::now();
        const Listener rendering = partOf(listener, share, next);
        SlabRenderer slabs(input, cut.slabs, rendering);
        slabs.run();
        mergeBehind(merged, slabs.merge());
        const double slabSeconds = secondsSince(start);
        result.slabSeconds += slabSeconds;
        compositeSeconds += slabSeconds * slabs.compositeShare();
        const Clock::time_point warpStart = Clock::now();
        if (picture.showChangesLayer()) {
            Layer shown = merged;
            result.gain = std::max(result.gain, picture.show(shown, PicturePart(flat)));
        } else {
            result.gain = std::max(result.gain, picture.show(merged, PicturePart(flat)));
        }
        const double first = faceBefore(cut.firstSlice, parts);
        const double last = faceBefore(cut.lastSlice + 1, parts);
        stages.add(flat, frontToBack ? first : last, frontToBack ? last : first);
        result.warpSeconds += secondsSince(warpStart);
    }
    if (result.slabSeconds > 0) result.compositeShare = compositeSeconds / result.slabSeconds;
    return result;
}

}  // namespace deltasplat
