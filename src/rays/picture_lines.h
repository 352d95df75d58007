// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <glm/mat3x3.hpp>
#include <optional>

#include "deltasplat/image/pixel_box.h"
#include "rays/sight_ray.h"
#include "view/picture_rays.h"

namespace deltasplat {

/// How much of its light a place keeps by its depth: all of it at the nearest place, and `darker`
/// less at the farthest.
struct DepthShade {
    double darker = 0;  ///< 0..1
    double nearest = 0;
    double farthest = 0;

    float at(double depth) const {
        if (!(farthest > nearest)) return 1;
        const double way = (depth - nearest) / (farthest - nearest);
        return float(1 - darker * std::clamp(way, 0.0, 1.0));
    }
};

/// A line of sight of a picture.
struct PictureLine {
    SightRay ray;
    double lengthWorld;  ///< of the way from one slice to the next
    double depthWorld;   ///< likewise, how much deeper it gets
    double firstDepth;   ///< of the point that the ray was made with

    double depthAt(double slice) const {
        return firstDepth + depthWorld * ray.slicesFromPoint(slice);
    }
};

/// The lines of sight of a picture, of which each pixel has a square of so many.
class PictureLines {
  public:
    /// @param camera  must outlive this
    PictureLines(const Volume& volume, const Camera& camera, int perSide);

    int perSide() const { return perSide_; }
    /// Counted from the picture's top left corner, perSide() to a pixel each way.
    PictureLine at(int x, int y) const;
    /// Lines that may meet the volume, counted likewise.
    const PixelBox& seen() const { return seen_; }
    /// Lines that may meet voxels of a box.
    PixelBox seenOf(const IndexBox& box) const;

  private:
    PictureLine lineOf(const glm::dvec3& through, const glm::dvec3& direction) const;

    const Camera& camera_;
    int perSide_;
    Camera fine_;  // which has a pixel for each line
    glm::dmat4 world_;
    IndexBox box_;
    PixelBox seen_;
    glm::dmat3 linear_;
    std::optional<PictureRays> rays_;  // from an eye
    /// From an eye: that, in voxels from the box's first. Parallel: the first line's place, and
    /// from one to the next.
    glm::dvec3 origin_{0.0};
    glm::dvec3 alongX_{0.0};
    glm::dvec3 alongY_{0.0};
    std::optional<PictureLine> first_;
};

struct LineCount {
    int perSide = 1;
    double voxelsApart = 1;  ///< how far lines are apart where a voxel is narrowest; at least 1
};

/// Counts the lines of sight that a pixel needs along each side: one where pixels are no larger
/// than voxels in the middle of the volume, else as many as there are voxels. Fewer, but at least
/// kLeastPerSide, where a picture would have more than kMostLines that may meet the volume.
LineCount countLines(const Volume& volume, const Camera& camera);

inline constexpr int kLeastPerSide = 16;
inline constexpr double kMostLines = 0x1p22;

}  // namespace deltasplat
