// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>

#include "deltasplat/render.h"

namespace deltasplat {

/// Frames of a sequence that one camera sees, which does not move. Rows of a picture in which
/// nothing differs from the frame before are taken from there instead of being rendered: where all
/// voxels that they see look as they did, and neither the box of the voxels, the slabs it is cut
/// into, the light nor the brightest colour, which all others are stated by, has changed. What
/// scatters light, and what belongs to several grids, is rendered anew.
///
/// Keeps the words of a frame until the next has compared its own with them, and its layer until
/// that has taken its rows, unless they take more than an eighth of the memory that is left.
/// Thread-safe.
class FrameChain {
  public:
    /// @param frames  how many there will be
    explicit FrameChain(std::size_t frames);
    ~FrameChain();
    FrameChain(const FrameChain&) = delete;
    FrameChain& operator=(const FrameChain&) = delete;

    /// A frame in hand, for one thread. Frames behind it wait for it until it has been rendered, or
    /// is gone.
    class Frame {
      public:
        ~Frame();
        Frame(Frame&&) noexcept;
        Frame& operator=(Frame&&) = delete;

        /// Renders it under kComposite: the same pixels as `render`, bit for bit. Waits until the
        /// frame before is as far. At most once.
        /// @param volume  may be gone when it has returned
        /// @return `stats.changed` and `stats.kept`, of what there was to compare
        /// @throw as `render`; Error(kUsage) for another mode
        RenderResult render(const Volume& volume, const RenderOptions& options,
                            const Listener& listener = {});

      private:
        friend class FrameChain;
        struct Impl;
        explicit Frame(std::unique_ptr<Impl> impl);
        std::unique_ptr<Impl> impl_;
    };

    /// Begins a frame. Call it once for each, in whatever order, but wait for none (render) before
    /// all before it have been begun.
    /// @param number  of the frame, from 0 on
    Frame begin(std::size_t number);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace deltasplat
