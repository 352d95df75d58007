// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>

#include "deltasplat/render.h"

namespace deltasplat {

/// Renders the frames of a sequence that one camera sees, which does not move. Rows of a picture in
/// which nothing differs from the frame before are taken from there instead of being rendered:
/// where no voxel that they see has another colour, and neither the box of the voxels, the light
/// nor the brightest colour, which all are stated by, has changed. Light that voxels scatter is
/// made anew. Thread-safe: frames may be rendered at the same time, begun in order.
///
/// Keeps the words and layers of the last frame: about as much memory as rendering it takes.
class FrameChain {
  public:
    FrameChain();
    ~FrameChain();
    FrameChain(const FrameChain&) = delete;
    FrameChain& operator=(const FrameChain&) = delete;

    /// Renders a frame under kComposite: the same pixels as `render`, bit for bit. Waits until the
    /// frame before is as far, which may be rendered by another thread.
    /// @param number  of the frame: 0, or one more than that of a frame that render() or end() was
    ///                or will be called with
    /// @param volume  may be gone when it has returned
    /// @return `stats.changed`: how much of the frame differs from the one before
    /// @throw as `render`; Error(kUsage) for another mode
    RenderResult render(std::size_t number, const Volume& volume, const RenderOptions& options,
                        const Listener& listener = {});
    /// Says that a frame has been rendered, or will not be. To be called once for each, whatever
    /// has become of it, or the next one waits for ever.
    void end(std::size_t number);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace deltasplat
