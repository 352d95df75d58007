// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "deltasplat/view/camera.h"

namespace deltasplat {

/// A projection split into a place per slice and a warp (Lacroute and Levoy 1994). (slice, u, v)
/// are the axes `sliceOrder(sliceAxis)`. On the *base plane*, a line of sight has one place:
/// - parallel: (u, v) where it crosses slice 0, in voxels;
/// - from an eye: its slope, in voxels along u and v per slice.
struct Factorization {
    int sliceAxis = 2;        ///< volume axis most parallel to the lines of sight
    bool frontToBack = true;  ///< increasing slice index goes away from the camera
    /// World distance of consecutive slices along the line of sight; from an eye, where this
    /// differs per pixel, of their planes.
    double sliceStepWorld = 1;
    double resolution = 1;      ///< r: sheet pixels per voxel, along u and v
    double pixelsPerVoxel = 1;  ///< of the screen, along the base plane's longest stretch; from an
                                ///< eye, for a voxel in the middle of the volume

    /// Parallel: d: voxel (s, u, v) falls on base plane (u, v) + s * d; |d| <= 1 each.
    glm::dvec2 shiftPerSlice{0.0};
    /// Parallel: (pixel x, pixel y, 1) -> (u, v, 1) on the base plane, in voxels.
    glm::dmat3 baseFromPixel{1.0};

    /// Index position (slice, u, v) where lines of sight begin; empty: parallel.
    std::optional<glm::dvec3> eye;
    /// World vectors of one step away from the eye along the slice axis, along u and along v.
    glm::dmat3 worldFromStep{1.0};
    /// Only slopes nearest to these whole numbers, -1 to 1, in voxels per slice; empty: all.
    std::optional<glm::ivec2> slopeStep;
    /// Largest slope of this slice axis, along u and v; then the box of slopes in the picture.
    double slopeLimit = 1;
    glm::dvec2 slopeMin{0.0};
    glm::dvec2 slopeMax{0.0};
    double pixelsPerSlope = 1;  ///< of the screen, mean over this box
    /// World length of the way through a slice that colours are for, relative to `sliceStepWorld`:
    /// with a `slopeStep`, the middle of the lengths in the picture's frame.
    double steps = 1;
    double stepRange = 1;  ///< largest factor between other lengths and this one
};

inline constexpr int kMaxResolution = 16;

/// Whether a sheet may have this many pixels per voxel: 1, 2 and so on up to kMaxResolution.
bool isResolution(double resolution);

/// Factors the camera's projection of a volume. Ties between axes go to the later one (z before y
/// before x), which defines diagonal views. Ties within 1e-9 count, and shifts within 1e-9 of 0 or
/// 1 are 0 or 1, so that rounding neither chooses an axis nor tilts a straight view.
/// @param camera      a parallel one
/// @param resolution  as isResolution; empty: 1 below 1.5 screen pixels per voxel, else 2
/// @throw Error(kUsage) if the resolution is out of range; Error(kInput) if worldFromIndex is not
///        finite or cannot be inverted
Factorization factorize(const Camera& camera, const glm::dmat4& worldFromIndex,
                        std::optional<double> resolution = {});

/// Factors the projection of a camera with an eye, once for each of the six directions along an
/// axis, in index space, that lines of sight in the picture are most parallel to.
/// @param box           of the visible volume
/// @param atSlopeSteps  cuts each further, into up to nine, by the whole voxels nearest to slopes
/// @throw as `factorize`
std::vector<Factorization> factorizeRegions(const Camera& camera, const IndexBox& box,
                                            const glm::dmat4& worldFromIndex,
                                            std::optional<double> resolution = {},
                                            bool atSlopeSteps = false);

/// Returns the most screen pixels of a world length, in any direction, at the box's voxel nearest
/// to the eye; infinite if eye or near plane lie beyond any voxel. (Panorama: at the equator.)
double mostPixelsOf(double lengthWorld, const Camera& camera, const IndexBox& box,
                    const glm::dmat4& worldFromIndex);

/// Returns the world distance between planes of slices, the shortest way between them.
double planeDistance(const glm::dmat4& worldFromIndex, int sliceAxis);

/// Whether lines of sight of this direction, in steps along `order` (sliceOrder) of a slice axis,
/// belong to the axis: no step is longer, and no later axis' step as long.
inline bool belongs(const glm::dvec3& steps, const glm::ivec3& order) {
    const double u = steps.y < 0 ? -steps.y : steps.y;
    const double v = steps.z < 0 ? -steps.z : steps.z;
    return (order[1] > order[0] ? steps.x > u : steps.x >= u) &&
           (order[2] > order[0] ? steps.x > v : steps.x >= v);
}

/// Whether a slope is nearest to a whole number of voxels, -1 to 1; ties go to 0.
/// @param along  of a line of sight, along u or v over `slices`
inline bool isNearSlope(int slopeStep, double along, double slices) {
    if (slopeStep == 0) return 2 * (along < 0 ? -along : along) <= slices;
    return 2.0 * slopeStep * along > slices;
}

/// Most slices drawn as one: a power of two.
inline constexpr int kMostJoined = 32;
/// Most voxels of joined slices drawn as one along u, and along v: a power of two.
inline constexpr int kMostJoinedWithin = 4;

/// How voxels are drawn: divided, evenly spaced and half a space from the faces, or joined.
struct Subdivision {
    int slices = 1;  ///< along the slice axis
    int within = 1;  ///< along u and along v: 1 or 2
    /// Undivided slices drawn as one, from a multiple on: a power of two, at most kMostJoined.
    int joined = 1;
    /// Voxels of joined slices drawn as one along u and v, from a multiple on: a power of two.
    int joinedWithin = 1;
    /// [joined]: voxel (u, v) is drawn with the first slice's (u, v) + slant, nearly on the same
    /// line. All have one sign along u, and along v, and are shorter than there are slices.
    std::array<glm::ivec2, kMostJoined> slants{};
    /// (slice, u, v) of the voxel where thin ones begin to count, to keep numbers small.
    glm::ivec3 origin{0};

    std::span<const glm::ivec2> joinedSlants() const {
        return std::span(slants).first(std::size_t(joined));
    }
    bool divides() const { return slices > 1 || within > 1; }
    /// Drawn slices and voxels per voxel along each axis.
    glm::dvec3 per() const {
        const double beside = double(within) / joinedWithin;
        return {double(slices) / joined, beside, beside};
    }
    /// Thin voxels per voxel.
    int voxels() const { return slices * within * within; }
    /// Smallest share of a voxel in a value mixed from several, as 1 / n.
    int smallestShare() const { return 2 * slices * (within == 2 ? 16 : 1); }
    bool operator==(const Subdivision&) const = default;
};

/// Returns the factorization for thin voxels: voxel i becomes (i - origin) * n and the following
/// ones, along each axis. The resolution stays.
Factorization subdivided(const Factorization& view, const Subdivision& parts);

}  // namespace deltasplat
