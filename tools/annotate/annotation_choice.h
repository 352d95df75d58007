// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace deltasplat {

/// What is to be drawn over a picture.
struct AnnotationChoice {
    bool legend = false;
    bool scaleBar = false;
    bool axes = false;
    std::vector<std::string> lines;  ///< of text

    bool any() const { return legend || scaleBar || axes || !lines.empty(); }
};

}  // namespace deltasplat
