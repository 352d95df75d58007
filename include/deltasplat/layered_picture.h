// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <memory>
#include <span>
#include <vector>

#include "deltasplat/image/image.h"
#include "deltasplat/prepared_scene.h"
#include "deltasplat/view/camera.h"

namespace deltasplat {

/// The light of one slab of a picture, on the base plane of its region: plain numbers, which may be
/// sent from one process to another.
struct SlabLayer {
    int slab = 0;       ///< number of the slab, 0..LayeredPicture::slabs() - 1
    glm::ivec2 min{0};  ///< pixels [min, max) of the base plane
    glm::ivec2 max{0};
    int channels = 4;  ///< 4: premultiplied RGBA; 1: opacity, where all that is seen has one colour
    std::vector<float> values;      ///< [row][column][channels]
    std::vector<glm::ivec2> spans;  ///< [row]: columns [x, y) outside of which a row is zero
};

/// A picture that is rendered slab by slab: by whoever has time, here or in another process that
/// has prepared the same scene. Its pixels are those of `renderComposite`, bit for bit.
class LayeredPicture {
  public:
    /// @throw as renderComposite; Error(kUsage) for a mostJoined above 2
    LayeredPicture(const PreparedScene& scene, const Camera& camera, const Listener& listener = {});
    ~LayeredPicture();
    LayeredPicture(LayeredPicture&&) noexcept;
    LayeredPicture& operator=(LayeredPicture&&) noexcept;

    /// How many slabs there are that something may be seen of; from an eye those of one region
    /// after the other. Within a region they are numbered from the front on.
    int slabs() const;
    /// Renders a slab. Thread-safe; multi-threaded itself.
    /// @throw Error(kUsage) if there is no such slab; whatever `listener.progress` throws
    SlabLayer render(int slab, const Listener& listener = {}) const;
    /// Puts layers together, and shows them.
    /// @param layers  of all slabs, in any order
    /// @param image   of the camera's size; cleared first
    /// @throw Error(kUsage) if a layer is missing, is there twice or has another shape than this
    ///        picture's, or if the image has another size
    void fold(std::span<const SlabLayer> layers, Image& image) const;

    struct Impl;
    const Impl& impl() const { return *impl_; }

  private:
    std::unique_ptr<const Impl> impl_;
};

}  // namespace deltasplat
