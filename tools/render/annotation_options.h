// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "annotate/annotation_choice.h"
#include "options/command_line.h"
#include "render/render_options.h"

namespace deltasplat {

/// Declares --legend, --scale-bar, --axes and --annotate.
void addAnnotationOptions(CLI::App& app, AnnotationChoice& choice);

/// Checks that the picture can have what is to be drawn over it.
/// @throw Error(kUsage) naming the option
void checkAnnotations(const RenderCommand& command);

}  // namespace deltasplat
