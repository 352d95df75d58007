// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "delta/slab_facts.h"
#include "layered_views.h"

namespace deltasplat {

/// Returns the facts that a picture's volume was read with, if it is some slices only.
const SlabFacts* knownFacts(const LayeredPicture::Impl& picture);

/// Returns what there is to know of a picture's slabs: as it was known before, or anew, but for
/// `blocksSeen`. Of a picture of several views, words and slabs are those of the first.
/// @throw Error(kInput) if what was known is of a picture of other colours
SlabFacts factsOf(const LayeredPicture::Impl& picture);

/// Whether parts of a picture may be made of some slices of its volume: one of a delta grid that is
/// seen along its slices, by parallel rays, without looks of voxels' own, and with nothing held
/// from one slab to the next.
bool isReadByParts(const LayeredPicture::Impl& picture);

}  // namespace deltasplat
