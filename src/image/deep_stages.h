// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>

#include "deltasplat/image/image.h"
#include "image/put_behind.h"
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

/// Shows stages of a picture behind another one.
class StagesBehind : public DeepStages {
  public:
    StagesBehind(const Image& front, DeepStages& stages)
        : front_(front), shown_(front.size), stages_(stages) {}

    void begin(std::shared_ptr<const SliceDepths> depths) override {
        stages_.begin(std::move(depths));
    }
    void add(const Image& picture, double front, double back) override {
        shown_ = front_;
        putBehind(shown_, {0, 0}, picture);
        stages_.add(shown_, front, back);
    }

  private:
    const Image& front_;
    Image shown_;
    DeepStages& stages_;
};

}  // namespace deltasplat
