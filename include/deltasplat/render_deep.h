// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deltasplat/image/deep_image.h"
#include "deltasplat/prepared_scene.h"
#include "deltasplat/render.h"

namespace deltasplat {

/// How finely a picture is cut in depth.
struct DeepOptions {
    /// Slices of the volume that a sample holds at most, 1..kMostSlicesPerSample: those of the
    /// volume's own voxels, whatever they are divided into. Cut at multiples of it, so that samples
    /// of parts of a volume end where the whole's do.
    int slicesPerSample = 8;
};

inline constexpr int kMostSlicesPerSample = 1 << 20;

/// Renders one picture in depth: what lines of sight meet of Mode::kComposite, cut into samples
/// between slices of the volume. Depths are those of Camera::cameraFromWorld, along the camera's
/// line of sight; kLatlong, which sees all sides, has distances from the eye. What lies behind
/// where less than 2^-10 gets through belongs to the last sample before.
/// @param deep  is replaced
/// @return the flat picture, which samples put over each other give (as `render`, where slices are
///         not joined, to a few units of the last place of floats); stats as those of `render`
/// @throw Error(kUsage) for options out of range, another mode, or a camera that is not before all
///        of the volume; Error(kFailed) for a picture that does not fit this machine's memory;
///        whatever `listener.progress` throws
RenderResult renderDeep(const Volume& volume, const RenderOptions& options,
                        const DeepOptions& deepOptions, DeepImage& deep,
                        const Listener& listener = {});

/// The same of a prepared scene.
/// @param flat  of the camera's size; becomes the flat picture
RenderStats renderDeep(const PreparedScene& scene, const Camera& camera,
                       const DeepOptions& deepOptions, DeepImage& deep, Image& flat,
                       const Listener& listener = {});

}  // namespace deltasplat
