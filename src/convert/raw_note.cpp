// SPDX-License-Identifier: Apache-2.0
#include <glm/gtc/matrix_transform.hpp>

#include "convert/dense_layout.h"
#include "number_text.h"

namespace deltasplat {
// A file without a header: what its name does not say, the options have to when it is read.
void settleRaw(DenseLayout& layout, const std::string& file, Notes& notes) {
    const glm::dvec3 spacing = layout.spacing(), origin = layout.origin();
    std::string options;
    if (!saysLayout(file, {layout.dims, layout.type, false, 0})) {
        options += " --dims " + layout.dimsText() + " --type " + rawTypeName(layout.type);
        if (rawTypeBytes(layout.type) > 1) options += " --endian little";
    }
    if (spacing != glm::dvec3(1)) options += " --spacing " + numberText(spacing);
    if (origin != glm::dvec3(0)) options += " --origin " + numberText(origin);

    const glm::dmat4 readBack = glm::scale(glm::translate(glm::dmat4(1), origin), spacing);
    std::string dropped;
    if (readBack != layout.worldFromIndex) dropped += " axis directions";
    if (!layout.space.empty())
        dropped += (dropped.empty() ? " " : " and ") + layout.space + " space";
    if (!options.empty()) notes.remark("no header; read it with" + options);
    if (!dropped.empty()) notes.loss("no header, which drops" + dropped);
}

}  // namespace deltasplat
