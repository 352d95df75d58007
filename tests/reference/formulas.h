// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "reference/reference_renderer.h"

namespace reference {

inline double dot(const Vector& a, const Vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// The index components of a world vector, by Cramer's rule.
inline Vector indexComponents(const std::array<Vector, 3>& axes, const Vector& world) {
    const double determinant = dot(axes[0], cross(axes[1], axes[2]));
    return {dot(world, cross(axes[1], axes[2])) / determinant,
            dot(world, cross(axes[2], axes[0])) / determinant,
            dot(world, cross(axes[0], axes[1])) / determinant};
}

// The index position of a pixel's centre on the plane through the camera's target.
inline Vector indexOfPixel(const View& view, const std::array<Vector, 3>& axes,
                           const Vector& origin, int x, int y) {
    const double toRight = (x + 0.5 - 0.5 * view.width) * view.pixelWorld;
    const double toTop = (0.5 * view.height - (y + 0.5)) * view.pixelWorld;
    Vector world{};
    for (int i = 0; i < 3; ++i) {
        world[i] = view.target[i] - origin[i] + toRight * view.right[i] + toTop * view.up[i];
    }
    return indexComponents(axes, world);
}

inline double tent(double x) {
    return std::abs(x) < 1 ? 1 - std::abs(x) : 0;
}

// E. Catmull and R. Rom, A Class of Local Interpolating Splines, 1974.
inline double catmullRom(double x) {
    const double t = std::abs(x);
    if (t < 1) return (3 * t * t * t - 5 * t * t + 2) / 2;
    if (t < 2) return (-t * t * t + 5 * t * t - 8 * t + 4) / 2;
    return 0;
}

// The quintic B-spline, piece by piece (I. Schoenberg 1946).
inline double quinticSpline(double x) {
    const double t = std::abs(x);
    const double t2 = t * t, t3 = t2 * t, t4 = t3 * t, t5 = t4 * t;
    if (t < 1) return 11 / 20.0 - t2 / 2 + t4 / 4 - t5 / 12;
    if (t < 2) return 17 / 40.0 + 5 * t / 8 - 7 * t2 / 4 + 5 * t3 / 4 - 3 * t4 / 8 + t5 / 24;
    if (t < 3) return 81 / 40.0 - 27 * t / 8 + 9 * t2 / 4 - 3 * t3 / 4 + t4 / 8 - t5 / 120;
    return 0;
}

inline double linear(double x) {
    return std::max(0.0, 1 - std::abs(x));
}

}  // namespace reference
