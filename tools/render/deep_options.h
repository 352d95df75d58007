// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/render_options.h"

namespace deltasplat {

/// Declares the options of deep pictures.
void addDeepOptions(CLI::App& app, RenderCommand& command);

/// Checks what is asked for besides a deep picture.
/// @throw Error(kUsage) naming --deep
void checkDeep(const RenderCommand& command);

/// Warns of options that were given and that have no effect without a deep picture.
void warnOfUnusedDeepOptions(const CLI::App& app, const RenderCommand& command,
                             ProgressDisplay& display);

}  // namespace deltasplat
