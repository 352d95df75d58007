// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <vector>

#include "deltasplat/image/deep_image.h"
#include "deltasplat/image/image.h"
#include "deltasplat/progress.h"

namespace deltasplat {

/// Depth per pixel of a picture of the solid objects that hide everything behind them.
struct DepthImage {
    glm::ivec2 size{0};
    /// [height][width], rows top to bottom: depths as in DeepSample; infinite where no object is.
    std::vector<float> depths;
};

/// Reads the channel Z of an .exr, else depth, else .Z of a layer called depth (such as
/// ViewLayer.Depth.Z), names in any case, else the only channel. Depths of 0 and below, NaN and
/// depths from 1e10 on stand for no object, the first two with a warning.
/// @throw Error(kInput) if the file is no .exr, or has no such channel
DepthImage readDepthImage(const std::filesystem::path& file, const Listener& listener = {});

/// Returns the part of a deep picture that is visible before solid objects: samples behind an
/// object are left out, and samples that reach behind it are cut.
/// @throw Error(kUsage) if the pictures have different sizes
Image holdOut(const DeepImage& deep, const DepthImage& solid);

}  // namespace deltasplat
