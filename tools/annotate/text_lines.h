// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "annotate/annotation.h"

namespace deltasplat {

/// Puts lines of text into the upper left corner, shortened where they are wider than `width`
/// pixels, and after the first one as many as there is room for.
/// @param cut  receives whether anything was shortened or left out
Annotation drawTextLines(const std::vector<std::string>& lines, const AnnotationStyle& style,
                         double width, bool& cut);

}  // namespace deltasplat
