// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "deltasplat/image/image.h"

namespace deltasplat {

/// Takes the pictures of a sequence, each once, in any order. Thread-safe but for finish().
class FrameSink {
  public:
    virtual ~FrameSink() = default;
    /// @param i  number of the frame in its list
    /// @param image  as it is shown, linear
    virtual void put(std::size_t i, const Image& image) = 0;
    /// Says that frame i has no picture.
    virtual void skip(std::size_t i) = 0;
    /// Makes the file of what has been put.
    /// @throw Error(kOutput)
    virtual void finish() = 0;
};

}  // namespace deltasplat
