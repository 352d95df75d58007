// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "annotate/annotation.h"

namespace deltasplat {

/// The colours of a range of data values.
struct ValueScale {
    glm::dvec2 range{0.0};  ///< range.x < range.y
    std::function<Rgb(double value)> colorOf;
    std::function<double(double value)> opacityOf;  ///< 0..1; empty: values have none
};

/// The colour of a label.
struct LabelColor {
    std::string name;
    Rgb color;
};

/// What a legend says.
struct Legend {
    std::string title;
    std::variant<ValueScale, std::vector<LabelColor>> key;
};

/// Puts a legend into the upper right corner: a bar of colours with round values beside it and a
/// curve of opacities, or a list of labels, of which as many are shown as there is room for.
Annotation drawLegend(const Legend& legend, const AnnotationStyle& style);

}  // namespace deltasplat
