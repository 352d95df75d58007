// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "optics/voxel_painter.h"

namespace deltasplat {

/// Returns a volume with room for what is seen besides. What is seen where nothing else is makes it
/// one that is not empty.
Volume withRoom(const Volume& volume, const BlockSet& more);

}  // namespace deltasplat
