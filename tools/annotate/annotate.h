// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "annotate/annotation.h"
#include "annotate/annotation_choice.h"
#include "annotate/legend.h"
#include "deltasplat/image/image.h"
#include "deltasplat/progress.h"
#include "deltasplat/view/camera.h"

namespace deltasplat {

/// Places annotations in the corners of a picture: the legend upper right, lines of text upper
/// left, axes lower left, the scale bar lower right. What has no room is left out, with a warning.
/// @param space   as Volume::space
/// @param unit    as Volume::lengthUnit
/// @param colors  that are seen best on the picture
/// @param legend  if `choice.legend`
std::vector<Annotation> layOut(const AnnotationChoice& choice, const Camera& camera,
                               const std::string& space, const std::string& unit,
                               const std::optional<Legend>& legend, const InkColors& colors,
                               const Listener& listener = {});

/// Returns dark ink for a picture that is light along its border, where annotations are, and light
/// ink for others; what is clear counts as dark.
const InkColors& inkFor(const Image& image);

/// Draws annotations over a picture, whose pixels stay as they are outside of their boxes.
void annotate(const std::vector<Annotation>& annotations, Image& image);

}  // namespace deltasplat
