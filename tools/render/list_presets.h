// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "drawing/drawing.h"

namespace deltasplat {

/// Returns a line for each preset: name, what its points are, what it is for.
std::string presetList();

/// Draws, for each preset, its colours and how opaque each is.
Drawing presetSwatches();

}  // namespace deltasplat
