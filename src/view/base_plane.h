// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory_resource>
#include <optional>
#include <span>
#include <vector>

#include "deltasplat/ingest/volume.h"
#include "deltasplat/view/camera.h"
#include "deltasplat/view/factorization.h"
#include "view/picture_rays.h"

namespace deltasplat {

/// Pixels [min, max) of the base plane.
struct PlaneBox {
    glm::ivec2 min{0};
    glm::ivec2 max{0};

    glm::ivec2 size() const { return max - min; }
    bool empty() const { return max.x <= min.x || max.y <= min.y; }

    bool operator==(const PlaneBox&) const = default;
};

/// Where a slice lies on the base plane: base position b shows voxel position scale * b + offset,
/// counted from the plane's first voxel.
struct SlicePlace {
    double scale = 1;
    glm::dvec2 offset{0.0};
};

/// From an eye, pixels around what the picture shows of a region, for the warp's filters to read,
/// which reach two pixels of the picture.
/// @param view     as BasePlane has it
/// @param spacing  from one pixel to the next, in slopes
int planeBorder(const Factorization& view, double spacing);

/// Where base plane pixels lie: what slices have in common. Runs along v, as sheets do.
///
/// Numbers stay small however far from the index origin a volume is: voxels and slices are counted
/// from the first ones, `firstVoxel` and `firstSlice`.
class BasePlane {
  public:
    /// Of parallel lines of sight: pixels as fine as those of sheets.
    /// @param firstVoxel    (v, u)
    /// @param resolution    pixels a voxel
    /// @param offsetPixels  how far pixels lie behind voxels
    BasePlane(const Factorization& view, int firstSlice, glm::ivec2 firstVoxel, double resolution,
              double offsetPixels);
    /// Of lines of sight from an eye: pixels of what the picture shows and a few around it.
    /// @param spacing    from one pixel to the next, in slopes
    /// @param nearWorld  as Camera::nearWorld
    BasePlane(const Factorization& view, const Camera& camera, int firstSlice,
              glm::ivec2 firstVoxel, double spacing);

    bool frontToBack() const { return frontToBack_; }
    bool isParallel() const { return !eye_; }
    /// Base position of a pixel, and from one pixel to the next.
    double spacing() const { return spacing_; }
    glm::dvec2 positionOf(glm::dvec2 pixel) const { return origin_ + spacing_ * pixel; }
    glm::dvec2 pixelOf(glm::dvec2 position) const { return (position - origin_) / spacing_; }
    SlicePlace placeOf(int slice) const;

    /// Parallel: picture position to base plane pixel.
    const glm::dmat3& pixelFromPicture() const { return pixelFromPicture_; }

    /// From an eye: all pixels.
    const PlaneBox& limits() const { return limits_; }
    /// From an eye: narrows a range of slices to those of which something is seen; y < x if none.
    glm::ivec2 seen(glm::ivec2 slices) const;
    /// How many slices away a slice is.
    double distanceOf(int slice) const;
    /// Whether the eye, or the near plane, cuts the slice, so that only a share of it is seen.
    bool isCut(int slice) const;
    /// Whether that is so of any of a range of slices of which something is seen.
    bool cutsAny(glm::ivec2 slices) const;
    /// Which share of the way through a slice lies beyond the eye and the near plane.
    double shareOf(int slice, glm::ivec2 pixel) const;
    /// World length of the way through a slice, as a multiple of what colours are classified for.
    double stepsAt(glm::ivec2 pixel) const;

    bool operator==(const BasePlane&) const = default;

  private:
    // Of a slope: slices from the eye to the near plane, infinite where that is never crossed.
    double nearestOf(glm::dvec2 slope) const;
    glm::dvec3 rayOf(glm::dvec2 slope) const { return worldFromStep_ * glm::dvec3(1, slope); }

    bool frontToBack_;
    int firstSlice_;
    double spacing_;
    glm::dvec2 origin_;
    glm::dvec2 shiftPerSlice_{0.0};
    glm::dmat3 pixelFromPicture_{1.0};

    std::optional<glm::dvec3> eye_;  // (slice, v, u), from the first slice and voxel
    glm::dmat3 worldFromStep_{1.0};  // away, along v, along u
    double stepWorld_ = 1;           // that colours are classified for
    PlaneBox limits_;
    double nearWorld_ = 0;
    std::optional<glm::dvec3> depthAlong_;  // unit vector; empty: along each line of sight
    glm::dvec2 nearest_{0.0};               // least and most that nearestOf() gives
};

/// How many steps each base plane pixel's line of sight takes through a slice (stepsAt), `[row]
/// [width]`. Multi-threaded.
struct StepLengths {
    PlaneBox box;
    std::pmr::vector<float> values;  ///< and kStepsSpare more

    StepLengths(const BasePlane& plane, const PlaneBox& planeBox,
                std::pmr::memory_resource& memory);
    const float* at(glm::ivec2 pixel) const {
        const glm::ivec2 p = pixel - box.min;
        return &values[std::size_t(p.y) * std::size_t(box.size().x) + std::size_t(p.x)];
    }
};

/// What becomes one.
struct JoinedVoxels {
    int slices = 1;
    int within = 1;  ///< as Subdivision::joinedWithin
};

/// How slices are moved that become one, and by how much that moves them.
struct JoinedSlants {
    std::array<glm::ivec2, kMostJoined> slants{};  ///< as Subdivision has them
    /// How far what is joined lies from where it is drawn, in voxels: at most.
    double farthest = 0;
    /// Whether what is thin, and seen nearly edge-on, stays as dense as it is: along u and along v,
    /// lines of sight go on by what becomes one within these slices, or hardly at all.
    bool keepsDensity = true;
};

/// Returns the slants by which slices stay nearest to their places.
/// @param shiftPerSlice  -1 to 1 each
/// @param count          a power of two, kMostJoined at most
/// @param within         as Subdivision::joinedWithin
JoinedSlants joinedSlants(const glm::dvec2& shiftPerSlice, int count, int within = 1);

/// Returns where joined voxels are drawn, counted from the first of them: in the middle between the
/// outermost places of all.
/// @param slants  as Subdivision::joinedSlants
glm::dvec2 middleOfJoined(const glm::dvec2& shiftPerSlice, std::span<const glm::ivec2> slants);

/// How deep a line of sight, which crosses all slices, lies at a position along the slice axis.
struct DepthLine {
    double first = 0;  ///< at position 0
    double perSlice = 0;

    double at(double slice) const { return first + perSlice * slice; }
};

/// How deep slices lie in a picture, pixel by pixel: along the camera's line of sight as OpenEXR's
/// worldToCamera has it, of kLatlong along each pixel's, in world units.
class SliceDepths {
  public:
    /// @param worldFromSlices  from (slice, u, v), counted from anywhere
    SliceDepths(const Camera& camera, const glm::dmat4& worldFromSlices);

    /// Of the middle of a pixel.
    DepthLine lineAt(int x, int y) const;
    /// What is nearer is not seen.
    double nearest() const { return camera_.nearWorld; }

  private:
    Camera camera_;
    glm::dvec3 origin_;  // in the world, position 0 along the axis
    glm::dvec3 slicesPerWorld_;
    std::optional<PictureRays> rays_;  // from an eye
};

}  // namespace deltasplat
