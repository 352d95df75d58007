// SPDX-License-Identifier: Apache-2.0
// Based on: numpy.lib.format 1.0; Definition of NRRD File Format, version 4; MetaIO's MetaImage
// tags.
#include "image/encode_numbers.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "base/bits.h"
#include "base/text.h"
#include "volume/placement.h"

namespace deltasplat {
namespace {

std::string npyHeader(glm::ivec2 size) {
    constexpr std::size_t kUnit = 64, kStart = 10;
    std::string text = "{'descr': '<f4', 'fortran_order': False, 'shape': (" +
                       std::to_string(size.y) + ", " + std::to_string(size.x) + "), }";
    const std::size_t whole = (kStart + text.size() + 1 + kUnit - 1) / kUnit * kUnit;
    text.resize(whole - kStart - 1, ' ');
    text += '\n';
    return std::string("\x93NUMPY\x01\x00", 8) + char(text.size() & 0xff) + char(text.size() >> 8) +
           text;
}

std::string sizesText(glm::ivec2 size) {
    return std::to_string(size.x) + " " + std::to_string(size.y) + " 1";
}

// One entry per spatial axis, if the unit is known.
std::string unitsLine(const std::string& unit) {
    if (unit.empty()) return "";
    const std::string quoted = " \"" + unit + "\"";
    return "space units:" + quoted + quoted + quoted + "\n";
}

// Voxel (0, 0, 0) is the part's first pixel.
glm::dmat4 placeOf(const ImageFileOptions& options, const PixelBox& part) {
    glm::dmat4 matrix = options.worldFromPixel.value_or(glm::dmat4(1));
    matrix[3] = matrix * glm::dvec4(part.min, 0, 1);
    // Adding 0 turns -0 into 0.
    return matrix + 0.0;
}

std::string nrrdHeader(const ImageFileOptions& options, const PixelBox& part) {
    const glm::dmat4 matrix = placeOf(options, part);
    const auto vector = [&](int i) { return "(" + numberText(glm::dvec3(matrix[i])) + ")"; };
    const std::string& space = options.space;
    return "NRRD0005\ntype: float\ndimension: 3\n" +
           std::string(space == "RAS"   ? "space: right-anterior-superior\n"
                       : space == "LPS" ? "space: left-posterior-superior\n"
                                        : "space dimension: 3\n") +
           "sizes: " + sizesText(part.size()) + "\nspace directions: " + vector(0) + " " +
           vector(1) + " " + vector(2) +
           "\nkinds: domain domain domain\nendian: little\nencoding: raw\nspace origin: " +
           vector(3) + "\n" + unitsLine(options.lengthUnit) + "\n";
}

// MetaImage's world space is LPS, in millimetres.
std::string metaImageHeader(const ImageFileOptions& options, const PixelBox& part) {
    glm::dmat4 matrix = placeOf(options, part);
    const double millimetres = millimetresIn(options.lengthUnit);
    if (millimetres > 0) scaleLengths(matrix, millimetres);
    if (options.space == "RAS") {
        // Subtracting from 0 avoids -0.
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 2; ++row) matrix[column][row] = 0.0 - matrix[column][row];
    }
    std::string directions;
    glm::dvec3 spacing(1);
    const auto text = [](const glm::dvec3& v) {
        return " " + numberText(v.x) + " " + numberText(v.y) + " " + numberText(v.z);
    };
    for (int axis = 0; axis < 3; ++axis) {
        spacing[axis] = glm::length(glm::dvec3(matrix[axis]));
        directions += text(glm::dvec3(matrix[axis]) / spacing[axis]);
    }
    return "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
           "CompressedData = False\nTransformMatrix =" +
           directions + "\nOffset =" + text(glm::dvec3(matrix[3])) +
           "\nCenterOfRotation = 0 0 0\nElementSpacing =" + text(spacing) +
           "\nDimSize = " + sizesText(part.size()) +
           (millimetres > 0 ? "\nDistanceUnits = mm" : "") +
           "\nElementType = MET_FLOAT\nElementDataFile = LOCAL\n";
}

}  // namespace

std::vector<float> numbersOf(const Image& image, const ImageFileOptions& options) {
    constexpr float kMost = std::numeric_limits<float>::max();
    const PixelBox part = options.region.value_or(PixelBox{{0, 0}, image.size});
    std::vector<float> numbers;
    numbers.reserve(std::size_t(part.size().x) * std::size_t(part.size().y));
    for (int y = part.min.y; y < part.max.y; ++y) {
        for (int x = part.min.x; x < part.max.x; ++x) {
            const float* const rgba = image.pixel(x, y);
            const bool isNothing = rgba[3] == 0 && options.nothing != 0;
            const float number = std::isnan(rgba[0]) ? 0 : std::clamp(rgba[0], -kMost, kMost);
            numbers.push_back(isNothing ? options.nothing : number);
        }
    }
    return numbers;
}

std::string encodeNumbers(const std::filesystem::path& file, const Image& image,
                          const ImageFileOptions& options) {
    const PixelBox part = options.region.value_or(PixelBox{{0, 0}, image.size});
    const ImageFormat format = imageFormatOf(file);
    std::string bytes = format == ImageFormat::kNpy    ? npyHeader(part.size())
                        : format == ImageFormat::kNrrd ? nrrdHeader(options, part)
                                                       : metaImageHeader(options, part);
    const std::vector<float> numbers = numbersOf(image, options);
    const std::size_t begin = bytes.size();
    bytes.resize(begin + numbers.size() * sizeof(float));
    for (std::size_t i = 0; i < numbers.size(); ++i)
        storeLittle(numbers[i],
                    reinterpret_cast<std::byte*>(bytes.data() + begin + i * sizeof(float)));
    return bytes;
}

}  // namespace deltasplat
