// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "deltasplat/image/pixel_box.h"
#include "deltasplat/prepared_scene.h"

namespace deltasplat {

/// A picture that is shown part by part. What there is to see is rendered once, as large as the
/// volume's slices ask for, and resampled to the pixels that are wanted: a picture of any size
/// takes no more memory than a part of it. Each pixel has the bits that renderComposite gives it,
/// whatever the parts.
class PartedPicture {
  public:
    /// Renders all but the pixels.
    /// @throw as renderComposite
    PartedPicture(const PreparedScene& scene, const Camera& camera, const Listener& listener = {});
    ~PartedPicture();
    PartedPicture(PartedPicture&&) noexcept;
    PartedPicture& operator=(PartedPicture&&) noexcept;

    const Camera& camera() const;
    /// Writes pixels of the picture.
    /// @param part   within the camera's size
    /// @param image  of the part's size
    /// @throw Error(kUsage) if either is not so
    void show(const PixelBox& part, Image& image);
    /// What was done; error bounds and the warp's time are those of the parts shown so far.
    const RenderStats& stats() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace deltasplat
