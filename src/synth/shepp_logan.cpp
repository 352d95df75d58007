// SPDX-License-Identifier: Apache-2.0
// Based on: L. Shepp, B. Logan, "The Fourier Reconstruction of a Head Section", 1974 (ellipses);
// P. Toft, "The Radon Transform", 1996, table B.3 (contrasts that can be seen); the third axes and
// positions along z are those of M. Schabel's 3D version, 2005. The ventricles are turned about z
// only.
#include <cmath>
#include <numbers>

#include "portable_math.h"
#include "synth/volumes.h"

namespace deltasplat {
namespace {

struct Ellipsoid {
    int tenths;           // added where the point is inside, in tenths of the value range
    glm::dvec3 halfAxes;  // before turning
    glm::dvec3 centre;
    double turnDegrees;  // about z, counter-clockwise
};

const Ellipsoid kHead[] = {{10, {0.69, 0.92, 0.81}, {0, 0, 0}, 0},           // skull
                           {-8, {0.6624, 0.874, 0.78}, {0, -0.0184, 0}, 0},  // brain
                           {-2, {0.11, 0.31, 0.22}, {0.22, 0, 0}, -18},      // right ventricle
                           {-2, {0.16, 0.41, 0.28}, {-0.22, 0, 0}, 18},      // left ventricle
                           {1, {0.21, 0.25, 0.41}, {0, 0.35, -0.15}, 0},     // the rest are tumours
                           {1, {0.046, 0.046, 0.05}, {0, 0.1, 0.25}, 0},     //
                           {1, {0.046, 0.046, 0.05}, {0, -0.1, 0.25}, 0},    //
                           {1, {0.046, 0.023, 0.05}, {-0.08, -0.605, 0}, 0},  //
                           {1, {0.023, 0.023, 0.02}, {0, -0.606, 0}, 0},      //
                           {1, {0.023, 0.046, 0.02}, {0.06, -0.605, 0}, 0}};

bool isInside(const Ellipsoid& ellipsoid, const glm::dvec3& p) {
    const double turn = ellipsoid.turnDegrees * std::numbers::pi / 180;
    const glm::dvec3 d = p - ellipsoid.centre;
    const double x = (d.x * portable::cos(turn) + d.y * portable::sin(turn)) / ellipsoid.halfAxes.x;
    const double y = (d.y * portable::cos(turn) - d.x * portable::sin(turn)) / ellipsoid.halfAxes.y;
    const double z = d.z / ellipsoid.halfAxes.z;
    return x * x + y * y + z * z <= 1;
}

}  // namespace

ValueAt makeSheppLogan() {
    return [](const glm::dvec3& p) {
        // Whole tenths add up without rounding, so that empty places are exactly 0.
        int tenths = 0;
        for (const Ellipsoid& ellipsoid : kHead) {
            if (isInside(ellipsoid, p)) tenths += ellipsoid.tenths;
        }
        return tenths > 0 ? tenths / 10.0 : 0.0;
    };
}

}  // namespace deltasplat
