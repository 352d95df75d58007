// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volume/code_tree.h"

namespace deltasplat {

/// Cuts the source of a volume whose codes were cut: no voxel stays active that is inactive in the
/// codes. If the code book is not exact, also updates the smallest and largest value.
/// @throw Error(kFailed) if memory is too small
void cutSource(VolumeData& volume);

}  // namespace deltasplat
