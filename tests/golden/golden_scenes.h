// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "deltasplat/render.h"

namespace deltasplat::test {

/// A picture to make: of which of the goldenVolumes, and how.
struct GoldenScene {
    std::string name;
    std::string volume;
    RenderOptions options;
    std::string part;      ///< the volume of what else there is (Optics::parts)
    int joined = 1;        ///< slices, though there are few voxels
    int joinedWithin = 1;  ///< and of these voxels along u and v
};

/// Returns all scenes: every mode, slice axis and kind of transfer function, and the options that
/// change pixels.
std::vector<GoldenScene> goldenScenes();

}  // namespace deltasplat::test
