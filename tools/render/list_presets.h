// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <string>

#include "deltasplat/optics/presets.h"
#include "drawing/drawing.h"

namespace deltasplat {

/// Returns the part of a preset's x that is worth showing.
glm::dvec2 shownPart(const Preset& preset, const TransferFunction& function);

/// Returns a line for each preset: name, what its points are, what it is for.
std::string presetList();

/// Draws, for each preset, its colours and how opaque each is.
Drawing presetSwatches();

}  // namespace deltasplat
