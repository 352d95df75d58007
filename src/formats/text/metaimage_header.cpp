// SPDX-License-Identifier: Apache-2.0
// Based on: MetaIO's "MetaImage" tag reference (itk.org/Wiki/ITK/MetaIO/Documentation). World space
// is LPS, as in ITK and in what is built on it; AnatomicalOrientation, which ITK always writes,
// tells that it is a patient's.
#include <cmath>

#include "base/text.h"
#include "formats/dense/dense_layout.h"
#include "formats/text/text_header.h"

namespace deltasplat {
namespace {

std::string typeText(RawType type) {
    switch (type) {
        case RawType::kUint8:
            return "MET_UCHAR";
        case RawType::kInt8:
            return "MET_CHAR";
        case RawType::kUint16:
            return "MET_USHORT";
        case RawType::kInt16:
            return "MET_SHORT";
        case RawType::kUint32:
            return "MET_UINT";
        case RawType::kInt32:
            return "MET_INT";
        case RawType::kUint64:
            return "MET_ULONG_LONG";
        case RawType::kInt64:
            return "MET_LONG_LONG";
        case RawType::kFloat32:
            return "MET_FLOAT";
        case RawType::kFloat64:
            break;
    }
    return "MET_DOUBLE";
}

// Returns the sides from which the axes come, as ITK writes them: "RAI" where they run along world
// x, y and z of LPS space.
std::string orientationText(const glm::dmat3& directions) {
    constexpr const char* kFrom[3] = {"RL", "AP", "IS"};
    std::string text = "???";
    glm::dmat3 left = directions;
    for (int step = 0; step < 3; ++step) {
        // The axis that is nearest to a world axis, of those that are left, is told first.
        int axis = 0, world = 0;
        for (int i = 0; i < 9; ++i) {
            if (std::abs(left[i / 3][i % 3]) > std::abs(left[axis][world])) {
                axis = i / 3, world = i % 3;
            }
        }
        text[std::size_t(axis)] = kFrom[world][directions[axis][world] < 0 ? 1 : 0];
        left[axis] = glm::dvec3(0);
        for (int other = 0; other < 3; ++other) left[other][world] = 0;
    }
    return text;
}

std::string vectorText(const glm::dvec3& v) {
    return " " + numberText(v.x) + " " + numberText(v.y) + " " + numberText(v.z);
}

}  // namespace

void settleMetaImage(DenseLayout& layout, const std::string&, WriteNotes& notes) {
    layout.turnTo("LPS");
    // ITK takes places for millimetres, and scales sizes alone where the header has another unit.
    layout.turnToMillimetres();
    layout.noteLabels("MetaImage", false, notes);
    if (!layout.isOrthogonal()) {
        notes.loss(
            "axes that are not at right angles: MetaImage has only rotations, and programs "
            "that rely on it misplace the voxels");
    }
}

std::string metaImageHeader(const DenseLayout& layout, const std::string& dataFile) {
    const glm::dmat3 directions = layout.directions();
    std::string text = "ObjectType = Image\nNDims = 3\nBinaryData = True\n";
    text += "BinaryDataByteOrderMSB = False\nCompressedData = False\n";
    text += "TransformMatrix =" + vectorText(directions[0]) + vectorText(directions[1]) +
            vectorText(directions[2]) + "\n";
    text += "Offset =" + vectorText(layout.origin()) + "\n";
    text += "CenterOfRotation = 0 0 0\n";
    if (!layout.space.empty()) {
        text += "AnatomicalOrientation = " + orientationText(directions) + "\n";
    }
    if (!layout.lengthUnit.empty()) text += "DistanceUnits = mm\n";
    text += "ElementSpacing =" + vectorText(layout.spacing()) + "\n";
    text += "DimSize = " + std::to_string(layout.dims.x) + " " + std::to_string(layout.dims.y) +
            " " + std::to_string(layout.dims.z) + "\n";
    text += "ElementType = " + typeText(layout.type) + "\n";
    // As ITK keeps the intent of a NIfTI file.
    if (layout.labels) text += "intent_code = 1002\n";
    return text + "ElementDataFile = " + (dataFile.empty() ? "LOCAL" : dataFile) + "\n";
}

}  // namespace deltasplat
