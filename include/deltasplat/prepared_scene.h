// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "deltasplat/image/image.h"
#include "deltasplat/ingest/volume.h"
#include "deltasplat/progress.h"
#include "deltasplat/render_options.h"

namespace deltasplat {

/// A volume and its look, without a camera.
struct Scene {
    std::shared_ptr<const Volume> volume;
    Optics optics;
};

/// A scene ready to be rendered from anywhere. The words that slabs are rendered from are made when
/// first needed, and kept: per slice axis; for method `delta`, and for `auto` where it takes
/// changes, per direction along the axis; for joined slices, only for the last two directions of
/// the lines of sight, or for the part that the last eye saw. Copies share the words. Thread-safe:
/// any number of threads may render one scene.
class PreparedScene {
  public:
    /// @throw Error(kUsage) without a volume, or for optics out of range
    PreparedScene(Scene scene, SplatOptions options);

    /// Returns the same volume with other optics, as if prepared anew. The two scenes share words
    /// if they differ in colours or opacities only, tell the same voxels apart and have the same
    /// clear ones, and if no voxel is held or has a look of its own.
    /// @throw Error(kUsage) for optics out of range
    PreparedScene withOptics(Optics optics) const;

    /// Renders emission and absorption as a camera sees them (Mode::kComposite). The pixels are
    /// those of the function `render`, bit for bit, on any number of threads. The memory of a
    /// picture is kept for the next one: at most as much as was in use at one time.
    /// @throw Error(kUsage) for an option or a camera out of range; Error(kFailed) for a picture
    ///        that does not fit this machine's memory; whatever `listener.progress` throws
    Image render(const Camera& camera, const Listener& listener = {}) const;
    /// @param image  of the camera's size; all of it is written, unless something is thrown
    /// @return what was done; words prepared before took no time
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
