// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <vector>

#include "deltasplat/image/deep_image.h"
#include "deltasplat/image/image.h"
#include "deltasplat/progress.h"

namespace deltasplat {

/// How far away solid things are in every pixel of a picture: what lies behind is not seen.
struct DepthImage {
    glm::ivec2 size{0};
    /// [height][width], from the top: depths as DeepSample has them; infinite where nothing is.
    std::vector<float> depths;
};

/// Reads the channel Z of an .exr, else depth, else the .Z of a layer called depth (as
/// ViewLayer.Depth.Z; all in any case), else the only one there is. Depths of 0 and below, NaN and
/// those from 1e10 on stand for nothing, the first two with a warning.
/// @throw Error(kInput) if the file is none, or has no such channel
DepthImage readDepthImage(const std::filesystem::path& file, const Listener& listener = {});

/// Returns what is seen of a deep picture before solid things: samples behind these are left out,
/// and those that lie in the way are cut.
/// @throw Error(kUsage) if the pictures have different sizes
Image holdOut(const DeepImage& deep, const DepthImage& solid);

}  // namespace deltasplat
