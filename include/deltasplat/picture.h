// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "deltasplat/image/pixel_box.h"
#include "deltasplat/prepared_scene.h"

namespace deltasplat {

/// A picture before its pixels exist, at the resolution of the volume's slices. show() makes pixels
/// part by part, so a picture of any size takes no more memory than one part. Each pixel has the
/// bits that PreparedScene::render gives it, whatever the parts.
class Picture {
  public:
    /// @throw as PreparedScene::render
    Picture(const PreparedScene& scene, const Camera& camera, const Listener& listener = {});
    ~Picture();
    Picture(Picture&&) noexcept;
    Picture& operator=(Picture&&) noexcept;

    const Camera& camera() const;
    /// @param part   within the camera's size
    /// @param image  of the part's size
    /// @throw Error(kUsage) for a part outside the picture or an image of another size
    void show(const PixelBox& part, Image& image);
    /// Returns statistics; error bounds and the warp's time cover the parts shown so far. For a
    /// picture put together from slabs: method, tolerance and number of slabs.
    const RenderStats& stats() const;

    struct Impl;
    explicit Picture(std::unique_ptr<Impl> impl);

  private:
    std::unique_ptr<Impl> impl_;
};

}  // namespace deltasplat
