// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/color.h>

#include <functional>
#include <string>

#include "deltasplat/image/color_management.h"

namespace deltasplat {

/// What OpenColorIO makes of ColorOptions. Empty is what these do not ask for.
struct ColorTransforms {
    OIIO::ColorProcessorHandle stored;
    OIIO::ColorProcessorHandle shown;
    OIIO::ColorProcessorHandle look;
};

/// Called before a transform is made of `name`, which `option` is.
using BeforeTransform = std::function<void(const char* option, const std::string& name)>;

/// Makes the transforms. OpenImageIO takes what OpenColorIO complains of, with names and lines of
/// files in it, for the format of its own message, and ends the process where braces make it none.
/// @throw Error(kUsage) or Error(kInput) as ColorTransform's constructor
ColorTransforms makeColorTransforms(ColorOptions options, const BeforeTransform& before);

/// Throws what makeColorTransforms throws where no transform can be made.
[[noreturn]] void refuseTransform(const char* option, const std::string& name,
                                  const std::string& complaint);

/// Returns what a library complains of on one line.
std::string lineOf(const std::string& complaint);

}  // namespace deltasplat
