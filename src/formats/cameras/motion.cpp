// SPDX-License-Identifier: Apache-2.0
#include "formats/cameras/motion.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "base/portable_math.h"
#include "view/camera_axes.h"

namespace deltasplat {
namespace {

// Returns a rotation's unit quaternion (x, y, z, w). Starts from its largest component, to avoid
// division by small numbers (S. Shepperd, "Quaternion from Rotation Matrix", 1978).
glm::dvec4 quaternionOf(const glm::dmat3& m) {
    const double trace = m[0][0] + m[1][1] + m[2][2];
    const glm::dvec4 four(m[0][0], m[1][1], m[2][2], trace);
    int largest = 0;
    for (int i = 1; i < 4; ++i)
        if (four[i] > four[largest]) largest = i;
    glm::dvec4 q;
    q[largest] = 0.5 * std::sqrt(std::max(1 + 2 * four[largest] - trace, 0.0));
    const double per = 0.25 / q[largest];
    if (largest == 3) {
        q.x = (m[1][2] - m[2][1]) * per;
        q.y = (m[2][0] - m[0][2]) * per;
        q.z = (m[0][1] - m[1][0]) * per;
        return glm::normalize(q);
    }
    const int next = (largest + 1) % 3;
    const int last = (largest + 2) % 3;
    q[next] = (m[largest][next] + m[next][largest]) * per;
    q[last] = (m[largest][last] + m[last][largest]) * per;
    q.w = (m[next][last] - m[last][next]) * per;
    return glm::normalize(q);
}

glm::dmat3 matrixOf(const glm::dvec4& q) {
    const auto [x, y, z, w] = std::array{q.x, q.y, q.z, q.w};
    return {{1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)},
            {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)},
            {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)}};
}

glm::dvec4 slerped(const glm::dvec4& a, glm::dvec4 b, double share) {
    if (glm::dot(a, b) < 0) b = -b;
    const glm::dvec4 apart = a - b;
    const glm::dvec4 along = a + b;
    const double angle = 2 * portable::atan2(glm::length(apart), glm::length(along));
    const double sine = portable::sin(angle);
    if (sine < 1e-9) return glm::normalize(glm::mix(a, b, share));
    return (portable::sin((1 - share) * angle) * a + portable::sin(share * angle) * b) / sine;
}

CameraAxes axesOf(const glm::dmat4& matrix) {
    return cameraAxes(matrix, "matrix", ErrorCode::kInput);
}

glm::dmat3 turnOf(const CameraAxes& axes) {
    return {axes.right, axes.up, -axes.direction};
}

double between(double a, double b, double share) {
    return a + share * (b - a);
}

}  // namespace

KeyPlace keyPlace(const std::vector<double>& keys, double at) {
    const auto next = std::upper_bound(keys.begin(), keys.end(), at);
    if (next == keys.begin()) return {};
    const std::size_t first = std::size_t(next - keys.begin()) - 1;
    if (next == keys.end()) return {first, 0};
    return {first, (at - keys[first]) / (*next - keys[first])};
}

glm::dmat4 mixed(const glm::dmat4& a, const glm::dmat4& b, double share) {
    if (share == 0 || a == b) return a;
    const CameraAxes first = axesOf(a);
    const CameraAxes second = axesOf(b);
    const glm::dmat3 turn =
        matrixOf(slerped(quaternionOf(turnOf(first)), quaternionOf(turnOf(second)), share));
    glm::dmat4 matrix(between(first.scale, second.scale, share) * turn);
    matrix[3] = glm::dvec4(glm::mix(first.positionWorld, second.positionWorld, share), 1);
    return matrix;
}

FilmCamera mixed(const FilmCamera& a, const FilmCamera& b, double share) {
    if (share == 0) return a;
    FilmCamera camera = a;
    camera.worldFromCamera = mixed(a.worldFromCamera, b.worldFromCamera, share);
    camera.focalMm = between(a.focalMm, b.focalMm, share);
    camera.apertureMm = glm::mix(a.apertureMm, b.apertureMm, share);
    camera.offsetMm = glm::mix(a.offsetMm, b.offsetMm, share);
    camera.frameWidthWorld = between(a.frameWidthWorld, b.frameWidthWorld, share);
    camera.nearWorld = between(a.nearWorld, b.nearWorld, share);
    if (a.farWorld && b.farWorld) camera.farWorld = between(*a.farWorld, *b.farWorld, share);
    return camera;
}

bool isRotationOrder(const std::string& order) {
    std::string sorted = order;
    std::sort(sorted.begin(), sorted.end());
    return sorted == "xyz";
}

glm::dmat4 rotation(const glm::dvec3& degrees, const std::string& order) {
    glm::dmat4 turned(1);
    for (const char name : order) {
        const int axis = name - 'x';
        int quarters = 0;
        const double rest = std::remquo(degrees[axis], 90.0, &quarters) * std::numbers::pi / 180;
        const double cosines[] = {portable::cos(rest), -portable::sin(rest), -portable::cos(rest),
                                  portable::sin(rest)};
        const double cosine = cosines[quarters & 3];
        const double sine = cosines[(quarters + 3) & 3];
        const int next = (axis + 1) % 3;
        const int last = (axis + 2) % 3;
        glm::dmat4 one(1);
        one[next][next] = cosine;
        one[next][last] = sine;
        one[last][next] = -sine;
        one[last][last] = cosine;
        // The first rotation is applied to the point first.
        turned = one * turned;
    }
    return turned;
}

}  // namespace deltasplat
