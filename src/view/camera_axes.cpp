// SPDX-License-Identifier: Apache-2.0
#include "view/camera_axes.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "number_text.h"

namespace deltasplat {
namespace {

constexpr double kLeastScale = 1e-30;
constexpr double kMostScale = 1e30;

bool isFinite(const glm::dmat4& matrix) {
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j)
            if (!std::isfinite(matrix[i][j])) return false;
    }
    return true;
}

// What is wrong, or nothing.
std::string faultOf(const glm::dmat4& matrix, const glm::dvec3& lengths) {
    if (!isFinite(matrix)) return "a number that is not finite";
    const glm::dvec4 last(matrix[0][3], matrix[1][3], matrix[2][3], matrix[3][3]);
    if (last != glm::dvec4(0, 0, 0, 1)) {
        const bool isTransposed = last.w == 1 && glm::dvec3(matrix[3]) == glm::dvec3(0);
        if (isTransposed) return "the translation in the last column";
        return glm::determinant(matrix) == 0 ? "a singular matrix" : "a projection";
    }
    const double least = std::min({lengths.x, lengths.y, lengths.z});
    const double most = std::max({lengths.x, lengths.y, lengths.z});
    if (!(least >= kLeastScale && most <= kMostScale))
        return "axes of the lengths " + numberText(lengths);
    const glm::dmat3 unit(glm::dvec3(matrix[0]) / lengths.x, glm::dvec3(matrix[1]) / lengths.y,
                          glm::dvec3(matrix[2]) / lengths.z);
    const double volume = glm::determinant(unit);
    if (std::abs(volume) < kAxesRounding) return "a singular matrix";
    if (volume < 0) return "a mirrored one";
    const double cosine =
        std::max({std::abs(glm::dot(unit[0], unit[1])), std::abs(glm::dot(unit[1], unit[2])),
                  std::abs(glm::dot(unit[2], unit[0]))});
    if (cosine > kAxesRounding) return "axes that are not at right angles";
    if (most - least > kAxesRounding * most) return "axes of the lengths " + numberText(lengths);
    return "";
}

}  // namespace

CameraAxes cameraAxes(const glm::dmat4& worldFromCamera, const std::string& what, ErrorCode code) {
    glm::dvec3 lengths;
    for (int i = 0; i < 3; ++i) lengths[i] = glm::length(glm::dvec3(worldFromCamera[i]));
    const std::string fault = faultOf(worldFromCamera, lengths);
    if (!fault.empty()) {
        throw Error(code, gotExpected(what, fault,
                                      "a rotation, perhaps evenly scaled, and a translation in the "
                                      "last row, row by row"));
    }
    CameraAxes axes;
    // Sums with 0 have no -0.
    axes.direction = 0.0 - glm::normalize(glm::dvec3(worldFromCamera[2]));
    const glm::dvec3 up(worldFromCamera[1]);
    axes.right = glm::normalize(glm::cross(axes.direction, up));
    axes.up = glm::cross(axes.right, axes.direction);
    axes.positionWorld = glm::dvec3(worldFromCamera[3]);
    axes.scale = (lengths.x + lengths.y + lengths.z) / 3;
    return axes;
}

}  // namespace deltasplat
