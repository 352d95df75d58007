// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "deltasplat/view/camera.h"

namespace deltasplat {

/// A parallel projection split into a shift for each slice and one affine warp (Lacroute and Levoy
/// 1994). (slice, u, v) are the volume's axes in `sliceOrder(sliceAxis)`; base plane positions are
/// (u, v) voxel indices on slice 0.
struct Factorization {
    int sliceAxis = 2;        ///< the volume axis most parallel to the line of sight
    bool frontToBack = true;  ///< increasing slice index goes away from the camera
    glm::dvec2 shiftPerSlice{
        0.0};  ///< d: voxel (s, u, v) falls on base plane (u, v) + s * d; |d| <= 1 each
    double sliceStepWorld =
        1;               ///< world distance between consecutive slices along the line of sight
    int resolution = 1;  ///< r: sheet pixels a voxel, the same along u and v
    double pixelsPerVoxel = 1;  ///< of the screen, along the base plane's longest stretch
    glm::dmat3 baseFromPixel{
        1.0};  ///< (pixel x, pixel y, 1) -> (u, v, 1) on the base plane, in voxels
};

inline constexpr int kMaxResolution = 16;

/// Factors the camera's projection of a volume.
/// Ties between axes go to the later one (z before y before x), so that a diagonal view is well
/// defined; what is within 1e-9 of a tie is one, and shifts within 1e-9 of 0 or 1 are 0 or 1, so
/// that rounding neither chooses an axis nor tilts a straight view.
/// @param resolution  1..kMaxResolution, or empty: 1 where the screen has fewer than one and a half
/// pixels a voxel, else 2
/// @throw Error(kUsage) if the resolution is out of range;
///        Error(kInput) if worldFromIndex is not finite or cannot be inverted
Factorization factorize(const Camera& camera, const glm::dmat4& worldFromIndex,
                        std::optional<int> resolution = {});

/// Into how many thin voxels a voxel is divided, evenly spaced and as far from its faces as from
/// each other by half.
struct Subdivision {
    int slices = 1;  ///< along the slice axis
    int within = 1;  ///< along u and along v: 1 or 2
    /// (slice, u, v) of the voxel that thin voxels are counted from: numbers stay small wherever in
    /// index space a volume lies.
    glm::ivec3 origin{0};

    /// Whether there is more than one.
    bool divides() const { return slices > 1 || within > 1; }
    /// What a voxel becomes.
    int voxels() const { return slices * within * within; }
    /// The smallest share of a voxel in a value mixed from several, as 1 / n.
    int smallestShare() const { return 2 * slices * (within == 2 ? 16 : 1); }
};

/// Returns the factorization for thin voxels, which are what is counted then: voxel i becomes
/// (i - origin) * n and those that follow, along each axis. The resolution stays what it is.
Factorization subdivided(const Factorization& view, const Subdivision& parts);

}  // namespace deltasplat
