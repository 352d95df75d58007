// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <string>

#include "annotate/annotation.h"
#include "deltasplat/view/camera.h"

namespace deltasplat {

/// A world axis of length 1 as the camera sees it in the middle of its picture.
struct SeenAxis {
    std::string letter;     ///< what it points to: of a patient R, L, A, P, S or I, else x, y or z
    glm::dvec2 along{0.0};  ///< in the picture, y down
    double away = 0;        ///< from the camera; less than 0: towards it
};

/// Returns x, y and z.
/// @param space  as Volume::space
std::array<SeenAxis, 3> seenAxes(const Camera& camera, const std::string& space);

/// Draws the axes into the lower left corner. One that is seen end-on is a dot, or a cross where it
/// points away.
Annotation drawAxes(const std::array<SeenAxis, 3>& axes, const AnnotationStyle& style);

}  // namespace deltasplat
