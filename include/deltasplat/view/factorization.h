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

/// A projection split into a place for each slice and one warp (Lacroute and Levoy 1994).
/// (slice, u, v) are the volume's axes in `sliceOrder(sliceAxis)`. What a line of sight meets of
/// any slice has one place on the *base plane*:
/// - parallel: (u, v) where it crosses slice 0, in voxels;
/// - from an eye: its slope, the voxels along u and v that it goes for each slice.
struct Factorization {
    int sliceAxis = 2;        ///< the volume axis most parallel to the lines of sight
    bool frontToBack = true;  ///< increasing slice index goes away from the camera
    /// World distance between consecutive slices along the line of sight; from an eye, where it
    /// differs from pixel to pixel, between their planes.
    double sliceStepWorld = 1;
    double resolution = 1;      ///< r: sheet pixels a voxel, the same along u and v
    double pixelsPerVoxel = 1;  ///< of the screen, along the base plane's longest stretch; from an
                                ///< eye, of a voxel in the middle of the volume

    /// Parallel: d: voxel (s, u, v) falls on base plane (u, v) + s * d; |d| <= 1 each.
    glm::dvec2 shiftPerSlice{0.0};
    /// Parallel: (pixel x, pixel y, 1) -> (u, v, 1) on the base plane, in voxels.
    glm::dmat3 baseFromPixel{1.0};

    /// Index position (slice, u, v) that lines of sight begin at; empty: parallel.
    std::optional<glm::dvec3> eye;
    /// World vectors of one step away from the eye along the slice axis, and along u and v.
    glm::dmat3 worldFromStep{1.0};
    /// Of slopes that belong to this slice axis, in voxels a slice, only those that are nearest to
    /// whole numbers, -1 to 1 each, along u and v; empty: all.
    std::optional<glm::ivec2> slopeStep;
    /// Slopes that belong to this slice axis, along u and v, and of these the box that the picture
    /// shows.
    double slopeLimit = 1;
    glm::dvec2 slopeMin{0.0};
    glm::dvec2 slopeMax{0.0};
    double pixelsPerSlope = 1;  ///< of the screen, on average over this box
    /// World length of the way through a slice that colours are for, as a multiple of
    /// `sliceStepWorld`: with a `slopeStep`, in the middle of those in the picture's frame.
    double steps = 1;
    double stepRange = 1;  ///< how many times as long, or as short, others are there at most
};

inline constexpr int kMaxResolution = 16;

/// Whether a sheet may have so many pixels per voxel: 1, 2 and so on up to kMaxResolution.
bool isResolution(double resolution);

/// Factors the camera's projection of a volume.
/// Ties between axes go to the later one (z before y before x), so that a diagonal view is well
/// defined; what is within 1e-9 of a tie is one, and shifts within 1e-9 of 0 or 1 are 0 or 1, so
/// that rounding neither chooses an axis nor tilts a straight view.
/// @param camera      a parallel one
/// @param resolution  as isResolution says, or empty: 1 where the screen has fewer than one and a
/// half pixels a voxel, else 2
/// @throw Error(kUsage) if the resolution is out of range;
///        Error(kInput) if worldFromIndex is not finite or cannot be inverted
Factorization factorize(const Camera& camera, const glm::dmat4& worldFromIndex,
                        std::optional<double> resolution = {});

/// Factors the projection of a camera that looks from an eye: for each of the up to six ways along
/// an axis that lines of sight may be most parallel to, in index space, if the picture shows such
/// lines.
/// @param box           of the volume: what is to be seen
/// @param atSlopeSteps  cuts these further, up to nine for each: by the whole numbers of voxels
///                      that slopes are nearest to
/// @throw as `factorize`
std::vector<Factorization> factorizeRegions(const Camera& camera, const IndexBox& box,
                                            const glm::dmat4& worldFromIndex,
                                            std::optional<double> resolution = {},
                                            bool atSlopeSteps = false);

/// Returns how many pixels of the screen a length in the world covers at most, as near to the eye
/// of a camera as any voxel of a box is and whichever way it lies; infinite if the eye or the near
/// plane lies beyond any. (Of a panorama, at the equator.)
double mostPixelsOf(double lengthWorld, const Camera& camera, const IndexBox& box,
                    const glm::dmat4& worldFromIndex);

/// Returns the world distance between the planes of slices, the least that a line of sight goes
/// from one to the next.
double planeDistance(const glm::dmat4& worldFromIndex, int sliceAxis);

/// Whether lines of sight of this direction, in steps along `order` (sliceOrder) of a slice axis,
/// belong to it: none is longer, and none of a later axis as long.
inline bool belongs(const glm::dvec3& steps, const glm::ivec3& order) {
    const double u = steps.y < 0 ? -steps.y : steps.y;
    const double v = steps.z < 0 ? -steps.z : steps.z;
    return (order[1] > order[0] ? steps.x > u : steps.x >= u) &&
           (order[2] > order[0] ? steps.x > v : steps.x >= v);
}

/// Whether a slope is nearest to a whole number of voxels, -1 to 1; ties go to 0.
/// @param along  of a line of sight, along u or v for so many slices
inline bool isNearSlope(int slopeStep, double along, double slices) {
    if (slopeStep == 0) return 2 * (along < 0 ? -along : along) <= slices;
    return 2.0 * slopeStep * along > slices;
}

/// Most slices that are drawn as one: a power of two.
inline constexpr int kMostJoined = 32;
/// Most voxels along u, and along v, of joined slices that are drawn as one: a power of two.
inline constexpr int kMostJoinedWithin = 4;

/// What voxels are drawn as: into how many thin ones each is divided, evenly spaced and as far from
/// its faces as from each other by half; or how many slices are joined.
struct Subdivision {
    int slices = 1;  ///< along the slice axis
    int within = 1;  ///< along u and along v: 1 or 2
    /// Undivided slices that are drawn as one, of an index that is a multiple and those behind it:
    /// a power of two, kMostJoined at most.
    int joined = 1;
    /// Of joined slices, voxels along u and along v that are drawn as one once each stands for all
    /// slices, from a multiple on: a power of two, kMostJoinedWithin at most.
    int joinedWithin = 1;
    /// [joined]: voxel (u, v) of each of them is drawn with (u, v) + slant of the first, which
    /// nearly the same line of sight meets. Along u all have one sign, and along v, and none is as
    /// long as there are slices.
    std::array<glm::ivec2, kMostJoined> slants{};
    /// (slice, u, v) of the voxel that thin voxels are counted from: numbers stay small wherever in
    /// index space a volume lies.
    glm::ivec3 origin{0};

    std::span<const glm::ivec2> joinedSlants() const {
        return std::span(slants).first(std::size_t(joined));
    }
    /// Whether there is more than one.
    bool divides() const { return slices > 1 || within > 1; }
    /// Slices and voxels that are drawn for one along each axis.
    glm::dvec3 per() const {
        const double beside = double(within) / joinedWithin;
        return {double(slices) / joined, beside, beside};
    }
    /// What a voxel becomes.
    int voxels() const { return slices * within * within; }
    /// The smallest share of a voxel in a value mixed from several, as 1 / n.
    int smallestShare() const { return 2 * slices * (within == 2 ? 16 : 1); }
    bool operator==(const Subdivision&) const = default;
};

/// Returns the factorization for thin voxels, which are what is counted then: voxel i becomes
/// (i - origin) * n and those that follow, along each axis. The resolution stays what it is.
Factorization subdivided(const Factorization& view, const Subdivision& parts);

}  // namespace deltasplat
