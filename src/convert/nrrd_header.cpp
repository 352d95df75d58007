// SPDX-License-Identifier: Apache-2.0
// Based on: Definition of NRRD File Format (teem.sourceforge.net/nrrd/format.html), version 4.
#include "convert/dense_layout.h"
#include "number_text.h"

namespace deltasplat {
namespace {

std::string vectorText(const glm::dvec3& v) {
    return "(" + numberText(v) + ")";
}

std::string spaceLine(const std::string& space) {
    if (space == "RAS") return "space: right-anterior-superior\n";
    if (space == "LPS") return "space: left-posterior-superior\n";
    return "space dimension: 3\n";
}

std::string typeText(RawType type) {
    if (type == RawType::kFloat32) return "float";
    return type == RawType::kFloat64 ? "double" : rawTypeName(type);
}

}  // namespace

// NRRD holds everything that a layout has.
void settleNrrd(DenseLayout&, const std::string&, Notes&) {}

std::string nrrdHeader(const DenseLayout& layout, const std::string& dataFile) {
    const glm::dmat4& matrix = layout.worldFromIndex;
    std::string text = "NRRD0004\n";
    text += "type: " + typeText(layout.type) + "\n";
    text += "dimension: 3\n";
    text += spaceLine(layout.space);
    text += "sizes: " + std::to_string(layout.dims.x) + " " + std::to_string(layout.dims.y) + " " +
            std::to_string(layout.dims.z) + "\n";
    text += "space directions: " + vectorText(matrix[0]) + " " + vectorText(matrix[1]) + " " +
            vectorText(matrix[2]) + "\n";
    text += "kinds: domain domain domain\n";
    text += "endian: little\n";
    text += "encoding: gzip\n";
    text += "space origin: " + vectorText(layout.origin()) + "\n";
    // An empty line ends the header of a file that goes on with the values.
    return text + (dataFile.empty() ? "\n" : "data file: " + dataFile + "\n");
}

}  // namespace deltasplat
