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

struct PlaneBox {
    glm::ivec2 min{0};
    glm::ivec2 max{0};

    glm::ivec2 size() const { return max - min; }
    bool empty() const { return max.x <= min.x || max.y <= min.y; }

    bool operator==(const PlaneBox&) const = default;
};

/// A slice on the base plane: position b shows voxel scale * b + offset, from the first voxel.
struct SlicePlace {
    double scale = 1;
    glm::dvec2 offset{0.0};
};

/// Returns how many pixels surround a region seen from an eye. The warp reaches two picture pixels.
/// @param view     as for BasePlane
/// @param spacing  distance of pixels, in slopes
int planeBorder(const Factorization& view, double spacing);

/// Places of the base plane's pixels, for all slices. Runs along v, as sheets do. Counts voxels and
/// slices from `firstVoxel` and `firstSlice`, so that numbers stay small far from the origin.
class BasePlane {
  public:
    /// For parallel lines of sight: pixels as fine as those of sheets.
    /// @param firstVoxel    (v, u)
    /// @param resolution    pixels per voxel
    /// @param offsetPixels  how far pixels lie behind voxels
    BasePlane(const Factorization& view, int firstSlice, glm::ivec2 firstVoxel, double resolution,
              double offsetPixels);
    /// For lines of sight from an eye: the pixels that the picture shows and a few around them.
    /// @param spacing    distance of pixels, in slopes
    /// @param nearWorld  as Camera::nearWorld
    BasePlane(const Factorization& view, const Camera& camera, int firstSlice,
              glm::ivec2 firstVoxel, double spacing);

    bool frontToBack() const { return frontToBack_; }
    bool isParallel() const { return !eye_; }
    double spacing() const { return spacing_; }
    glm::dvec2 positionOf(glm::dvec2 pixel) const { return origin_ + spacing_ * pixel; }
    glm::dvec2 pixelOf(glm::dvec2 position) const { return (position - origin_) / spacing_; }
    SlicePlace placeOf(int slice) const;

    /// For parallel lines of sight: base plane pixel from picture position.
    const glm::dmat3& pixelFromPicture() const { return pixelFromPicture_; }

    /// For an eye: all pixels.
    const PlaneBox& limits() const { return limits_; }
    /// For an eye: narrows a range to the visible slices; y < x if there are none.
    glm::ivec2 seen(glm::ivec2 slices) const;
    /// Distance from the eye to a slice, in slices.
    double distanceOf(int slice) const;
    /// Whether the eye or the near plane cuts the slice, so that only a part is visible.
    bool isCut(int slice) const;
    /// Whether any visible slice of a range is cut.
    bool cutsAny(glm::ivec2 slices) const;
    /// Share of the way through a slice that lies beyond the eye and the near plane.
    double shareOf(int slice, glm::ivec2 pixel) const;
    /// World length of the way through a slice, relative to that which colours are classified for.
    double stepsAt(glm::ivec2 pixel) const;

    bool operator==(const BasePlane&) const = default;

  private:
    // Distance from the eye to the near plane in slices, for a slope; infinite if never crossed.
    double nearestOf(glm::dvec2 slope) const;
    glm::dvec3 rayOf(glm::dvec2 slope) const { return worldFromStep_ * glm::dvec3(1, slope); }

    bool frontToBack_;
    int firstSlice_;
    double spacing_;
    glm::dvec2 origin_;
    glm::dvec2 shiftPerSlice_{0.0};
    glm::dmat3 pixelFromPicture_{1.0};

    std::optional<glm::dvec3> eye_;  // (slice, v, u), relative to the first slice and voxel
    glm::dmat3 worldFromStep_{1.0};  // columns: away, along v, along u
    double stepWorld_ = 1;           // length that colours are classified for
    PlaneBox limits_;
    double nearWorld_ = 0;
    std::optional<glm::dvec3> depthAlong_;  // unit vector; empty: depth along each line of sight
    glm::dvec2 nearest_{0.0};               // least and most of nearestOf()
};

/// Steps of each base plane pixel through a slice (stepsAt), `[row][width]`. Multi-threaded.
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

/// Numbers of slices and voxels that are joined to one.
struct JoinedVoxels {
    int slices = 1;
    int within = 1;  ///< as Subdivision::joinedWithin
};

struct JoinedSlants {
    std::array<glm::ivec2, kMostJoined> slants{};  ///< as in Subdivision
    /// Largest distance between a joined voxel's place and where it is drawn, in voxels.
    double farthest = 0;
    /// Whether thin structures seen nearly edge-on keep their density: along u and along v, lines
    /// of sight move on by a joined voxel within these slices, or hardly at all.
    bool keepsDensity = true;
};

/// Returns the slants that keep slices nearest to their places.
/// @param shiftPerSlice  -1 to 1 each
/// @param count          a power of two, at most kMostJoined
/// @param within         as Subdivision::joinedWithin
JoinedSlants joinedSlants(const glm::dvec2& shiftPerSlice, int count, int within = 1);

/// Returns where joined voxels are drawn, relative to the first: midway between the outermost.
/// @param slants  as Subdivision::joinedSlants
glm::dvec2 middleOfJoined(const glm::dvec2& shiftPerSlice, std::span<const glm::ivec2> slants);

/// Depth of a line of sight, which crosses all slices, at a position along the slice axis.
struct DepthLine {
    double first = 0;  ///< at position 0
    double perSlice = 0;

    double at(double slice) const { return first + perSlice * slice; }
};

/// Depths of slices per picture pixel in world units, along the camera's line of sight as in
/// OpenEXR's worldToCamera, or along each pixel's for kLatlong.
class SliceDepths {
  public:
    /// @param worldFromSlices  from (slice, u, v), with any origin
    SliceDepths(const Camera& camera, const glm::dmat4& worldFromSlices);

    /// For the middle of a pixel.
    DepthLine lineAt(int x, int y) const;
    /// Smaller depths are not visible.
    double nearest() const { return camera_.nearWorld; }

  private:
    Camera camera_;
    glm::dvec3 origin_;  // in the world, at position 0 along the axis
    glm::dvec3 slicesPerWorld_;
    std::optional<PictureRays> rays_;  // for an eye
};

}  // namespace deltasplat
