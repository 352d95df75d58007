// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "deltasplat/image/pixel_box.h"
#include "deltasplat/prepared_scene.h"

namespace deltasplat {

/// A picture before its pixels: all that there is to see, as large as the volume's slices ask for.
/// It shows itself part by part, so a picture of any size takes no more memory than a part of it.
/// Each pixel has the bits that PreparedScene::render gives it, whatever the parts.
class Picture {
  public:
    /// Renders all but the pixels.
    /// @throw as PreparedScene::render
    Picture(const PreparedScene& scene, const Camera& camera, const Listener& listener = {});
    ~Picture();
    Picture(Picture&&) noexcept;
    Picture& operator=(Picture&&) noexcept;

    const Camera& camera() const;
    /// Writes pixels of the picture.
    /// @param part   within the camera's size
    /// @param image  of the part's size
    /// @throw Error(kUsage) if either is not so
    void show(const PixelBox& part, Image& image);
    /// What was done; error bounds and the warp's time are those of the parts shown so far. Of a
    /// picture that slabs were put together to: method, tolerance and number of slabs.
    const RenderStats& stats() const;

    struct Impl;
    explicit Picture(std::unique_ptr<Impl> impl);

  private:
    std::unique_ptr<Impl> impl_;
};

}  // namespace deltasplat
