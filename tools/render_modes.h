// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "render_options.h"

namespace deltasplat {

/// Whether the picture is to hold values instead of light: xray and mip in a format of floats.
bool storesValues(const RenderCommand& command);

/// Sets what follows from mode and file format: values are stored as 32-bit floats, and formats of
/// 8 or 16 bits show the colours of largest values.
void applyMode(RenderCommand& command);

/// Scales an x-ray for formats of 8 or 16 bits, so that its largest value is 1.
/// @return the line integral that 1 stands for
double scaleXray(Image& image);

/// Warns of options that were given and that have no effect in the mode that was.
void warnOfUnusedModeOptions(const CLI::App& app, const RenderCommand& command,
                             ProgressDisplay& display);

}  // namespace deltasplat
