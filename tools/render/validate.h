// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/render_options.h"

namespace deltasplat {

/// Checks what has no need of files: of a sequence, all that its frames have in common.
/// @throw Error(kUsage)
void validateOptions(const RenderCommand& command);

/// Checks all that can be checked before anything is read.
/// @throw Error(kUsage) or, for a folder that cannot be written to, Error(kOutput)
void validate(const RenderCommand& command);

}  // namespace deltasplat
