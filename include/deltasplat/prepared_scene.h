// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "deltasplat/image/image.h"
#include "deltasplat/ingest/volume.h"
#include "deltasplat/progress.h"
#include "deltasplat/render_options.h"

namespace deltasplat {

/// What is to be seen, without a camera.
struct Scene {
    std::shared_ptr<const Volume> volume;
    Optics optics;
};

/// A scene made ready to be rendered from anywhere: for each slice axis that a camera needs (and,
/// of method `delta` and where `auto` takes changes, for each way along it; where slices are
/// joined, for the two ways that lines of sight last went through them, or of what the eye sees
/// that they were last seen from), the words that slabs are rendered from, made when they are first
/// needed and kept. Copies share them. Thread-safe: any number of threads may render one.
class PreparedScene {
  public:
    /// @throw Error(kUsage) without a volume, or for optics out of range
    PreparedScene(Scene scene, SplatOptions options);

    /// Returns the same volume with other optics, as if prepared anew. Words are shared with this
    /// scene where both tell the same voxels apart and nothing is held or has a look of its own:
    /// where colours or opacities are others, but what is clear, and what looks alike, is the same.
    /// @throw Error(kUsage) for optics out of range
    PreparedScene withOptics(Optics optics) const;

    /// Renders emission and absorption as a camera sees them (Mode::kComposite). Same scene, same
    /// camera: the same pixels as the function `render`, bit for bit, and on any number of threads.
    /// Memory that a picture takes is kept for the next: at most what was in use at one time.
    /// @throw Error(kUsage) for an option or a camera out of range; Error(kFailed) for a picture
    ///        that does not fit this machine's memory; whatever `listener.progress` throws
    Image render(const Camera& camera, const Listener& listener = {}) const;
    /// Renders into a picture of the caller's.
    /// @param image  of the camera's size; all of it is written, unless something is thrown
    /// @return what was done; what was prepared before took no time
    /// @throw Error(kUsage) if the image has another size; as above
    RenderStats render(const Camera& camera, Image& image, const Listener& listener = {}) const;

    const Scene& scene() const;
    const SplatOptions& options() const;

    struct Impl;
    const Impl& impl() const { return *impl_; }

  private:
    std::shared_ptr<const Impl> impl_;
};

}  // namespace deltasplat
