// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Imath/ImathVec.h>
#include <Imath/half.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>

#include <vector>

#include "deltasplat/image/image.h"
#include "deltasplat/image/pixel_box.h"

namespace deltasplat {

/// Adds channels R, G, B and A.
void addRgba(bool asFloat, Imf::Header& header);

/// Pixels of a picture as an .exr has them: halves or floats, all of them finite.
class ExrRgba {
  public:
    /// Multi-threaded.
    /// @param box  of the picture
    ExrRgba(const Image& image, const PixelBox& box, bool asFloat);

    /// Says where OpenEXR finds them, for as long as this lives.
    /// @param first  where the first one lies in the file's data window
    Imf::FrameBuffer at(const Imath::V2i& first) const;

  private:
    glm::ivec2 size_;
    std::vector<half> halves_;   // [height][width][4], or none
    std::vector<float> floats_;  // the same
};

/// Returns a box of a channel's values, all of them finite.
/// @param width  of the channel
std::vector<float> exrPlane(const std::vector<float>& values, const PixelBox& box, int width);

}  // namespace deltasplat
