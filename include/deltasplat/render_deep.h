// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deltasplat/image/deep_image.h"
#include "deltasplat/prepared_scene.h"
#include "deltasplat/render.h"

namespace deltasplat {

struct DeepOptions {
    /// Most slices per sample, 1..kMostSlicesPerSample, counted in undivided voxels. Cuts lie at
    /// multiples of this number, so that samples of parts of a volume end where the whole's do.
    int slicesPerSample = 8;
};

inline constexpr int kMostSlicesPerSample = 1 << 20;

/// Renders one picture of Mode::kComposite in depth, cut into samples between slices of the volume.
/// Depths are those of Camera::cameraFromWorld, along the camera's line of sight; kLatlong, which
/// sees all sides, has distances from the eye. Everything behind the depth where less than 2^-10
/// gets through belongs to the last sample before it.
/// @param deep  is replaced
/// @return the flat picture, which equals the samples put over each other (and `render`, where
///        slices are not joined, to a few units of the last place of floats); stats as `render`
/// @throw Error(kUsage) for options out of range, another mode, or a camera that is not before all
///        of the volume; Error(kFailed) for a picture that does not fit this machine's memory;
///        whatever `listener.progress` throws
RenderResult renderDeep(const Volume& volume, const RenderOptions& options,
                        const DeepOptions& deepOptions, DeepImage& deep,
                        const Listener& listener = {});

/// Renders a prepared scene in depth.
/// @param flat  of the camera's size; becomes the flat picture
RenderStats renderDeep(const PreparedScene& scene, const Camera& camera,
                       const DeepOptions& deepOptions, DeepImage& deep, Image& flat,
                       const Listener& listener = {});

}  // namespace deltasplat
