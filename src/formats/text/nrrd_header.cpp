// SPDX-License-Identifier: Apache-2.0
// Based on: Definition of NRRD File Format (teem.sourceforge.net/nrrd/format.html), version 4.
#include <vector>

#include "base/text.h"
#include "deltasplat/ingest/label_list.h"
#include "formats/dense/dense_layout.h"
#include "formats/text/text_header.h"

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

std::string unitsLine(const std::string& unit) {
    if (unit.empty()) return "";
    const std::string quoted = " \"" + unit + "\"";
    return "space units:" + quoted + quoted + quoted + "\n";
}

std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) result += c == '\n' ? "\\n" : c == '\\' ? "\\\\" : std::string(1, c);
    return result;
}

std::string extentText(const glm::ivec3& dims) {
    std::string text;
    for (int axis = 0; axis < 3; ++axis)
        text += (axis == 0 ? "0 " : " 0 ") + std::to_string(dims[axis] - 1);
    return text;
}

// Segments as 3D Slicer has them in a .seg.nrrd; labels without names as ITK keeps NIfTI's intent.
std::string labelLines(const DenseLayout& layout) {
    const std::vector<LabelEntry>& entries = layout.labels->entries;
    if (entries.empty()) return "intent_code:=1002\n";
    std::string text;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const LabelEntry& label = entries[i];
        const std::string segment = "Segment" + std::to_string(i) + "_";
        if (label.rgb) {
            text += segment + "Color:=" + numberText(label.rgb->r) + " " +
                    numberText(label.rgb->g) + " " + numberText(label.rgb->b) + "\n";
        }
        text += segment + "Extent:=" + extentText(layout.dims) + "\n";
        text += segment + "ID:=Segment_" + std::to_string(i + 1) + "\n";
        text += segment + "LabelValue:=" + std::to_string(label.value) + "\n";
        text += segment + "Layer:=0\n";
        text += segment + "Name:=" + escaped(label.name) + "\n";
    }
    for (const char* const key : {"Segmentation_MasterRepresentation:=Binary labelmap\n",
                                  "Segmentation_SourceRepresentation:=Binary labelmap\n",
                                  "Segmentation_ContainedRepresentationNames:=Binary labelmap|\n"})
        text += key;
    return text + "Segmentation_ReferenceImageExtentOffset:=0 0 0\n";
}

std::string typeText(RawType type) {
    if (type == RawType::kFloat32) return "float";
    return type == RawType::kFloat64 ? "double" : rawTypeName(type);
}

}  // namespace

// NRRD holds everything that a layout has.
void settleNrrd(DenseLayout&, const std::string&, WriteNotes&) {}

std::string nrrdHeader(const DenseLayout& layout, const std::string& dataFile) {
    const glm::dmat4& matrix = layout.worldFromIndex;
    std::string text = "NRRD0004\n";
    text += "type: " + typeText(layout.type) + "\n";
    text += "dimension: 3\n";
    text += spaceLine(layout.space);
    text += unitsLine(layout.lengthUnit);
    text += "sizes: " + std::to_string(layout.dims.x) + " " + std::to_string(layout.dims.y) + " " +
            std::to_string(layout.dims.z) + "\n";
    text += "space directions: " + vectorText(matrix[0]) + " " + vectorText(matrix[1]) + " " +
            vectorText(matrix[2]) + "\n";
    text += "kinds: domain domain domain\n";
    text += "endian: little\n";
    text += "encoding: gzip\n";
    text += "space origin: " + vectorText(layout.origin()) + "\n";
    if (layout.labels) text += labelLines(layout);
    // An empty line ends the header of a file that goes on with the values.
    return text + (dataFile.empty() ? "\n" : "data file: " + dataFile + "\n");
}

}  // namespace deltasplat
