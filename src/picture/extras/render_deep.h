// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "deltasplat/progress.h"
#include "picture/picture_view.h"
#include "screen/deep_builder.h"

namespace deltasplat {

/// Slices of a view that make one sample, and which slabs they belong to.
struct DeepCut {
    int firstSlice;               ///< the smallest
    int lastSlice;                ///< the largest
    std::vector<SeenSlab> slabs;  ///< from the front on
};

/// Cuts what is seen of slabs at multiples of `slicesPerSample` undivided slices, or, if that is 0,
/// at every slice, from the front on.
/// @param seen  from the front on
std::vector<DeepCut> cutInDepth(const std::vector<SeenSlab>& seen, bool frontToBack,
                                const Subdivision& parts, int slicesPerSample);

/// What a view of a deep picture took.
struct DeepViewResult {
    double gain;            ///< as PictureView::show
    double slabSeconds;     ///< of slabs
    double compositeShare;  ///< of those: compositing
    double warpSeconds;     ///< of the rest
};

/// Renders a view cut by cut, and shows each time what there is so far.
/// @param flat  becomes the flat picture
DeepViewResult renderDeepView(const PictureView& picture, int slicesPerSample, KeptMemory& memory,
                              DeepStages& stages, Image& flat, const Listener& listener);

}  // namespace deltasplat
