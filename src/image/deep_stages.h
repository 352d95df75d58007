// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "deltasplat/image/image.h"
#include "view/slice_depths.h"

namespace deltasplat {

/// Who is shown a picture stage by stage, as more and more is put behind what is there.
class DeepStages {
  public:
    virtual ~DeepStages() = default;
    /// Says where the slices of stages that follow lie.
    virtual void begin(std::shared_ptr<const SliceDepths> depths) = 0;
    /// Takes the picture as it is now that what lies between two positions of slices has been put
    /// behind the rest.
    /// @param front,back  positions; lines of sight meet `front` first
    /// @throw Error(kFailed) if what is kept of it does not fit into memory
    virtual void add(const Image& picture, double front, double back) = 0;
};

}  // namespace deltasplat
