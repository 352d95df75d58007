// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "deltasplat/image/pixel_box.h"
#include "deltasplat/ingest/volume.h"
#include "rays/ray_volume.h"
#include "view/picture_rays.h"

namespace deltasplat {

/// A volume's axes in the order and the directions of a line of sight, (slice, u, v): positions
/// grow along the line. The slice axis is most parallel to the line; ties go to the last axis.
struct RayAxes {
    glm::ivec3 order{0, 1, 2};
    glm::ivec3 sign{1};   ///< 1 or -1: direction along order[i]
    glm::ivec3 first{0};  ///< voxel of position 0
    glm::ivec3 count{0};  ///< positions of the volume's box

    int voxelAt(int i, int position) const { return first[i] + sign[i] * position; }
    bool operator==(const RayAxes&) const = default;
};

/// A line of sight in positions of its axes: it meets (u, v) = start + s * slope at slice s.
struct SightRay {
    RayAxes axes;
    glm::dvec2 start{0.0};
    glm::dvec2 slope{0.0};     ///< 0 to 1
    double nearest = 0;        ///< slice, or place between two, where the line begins
    glm::dvec2 slices{0, -1};  ///< range in which it may meet anything; none if the second is less

    /// @param box      of voxels
    /// @param through  a point of the line, in voxels from the box's first to keep numbers small
    /// @param ray      of any length, in voxels
    SightRay(const IndexBox& box, const glm::dvec3& through, const glm::dvec3& ray);

    /// Moves the line to another point, in the same direction.
    void moveTo(const glm::dvec3& through);
    /// Lets the line begin at a distance, in slices, from the point it was made with.
    void beginAt(double slicesFromPoint);
    double slicesFromPoint(double slice) const { return slice - point_; }

  private:
    void clip();
    double point_;  // slice of that point
};

/// Share of its light that a place keeps by depth, from 1 at the nearest to 1 - `darker`.
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

struct PictureLine {
    SightRay ray;
    double lengthWorld;  ///< from one slice to the next
    double depthWorld;   ///< likewise, growth of the depth
    double firstDepth;   ///< of the point that the ray was made with

    double depthAt(double slice) const {
        return firstDepth + depthWorld * ray.slicesFromPoint(slice);
    }
};

/// The lines of sight of a picture: perSide x perSide per pixel.
class PictureLines {
  public:
    /// @param camera  must outlive this
    PictureLines(const Volume& volume, const Camera& camera, int perSide);

    int perSide() const { return perSide_; }
    /// Counted from the picture's top left corner.
    PictureLine at(int x, int y) const;
    /// Lines that may meet the volume.
    const PixelBox& seen() const { return seen_; }
    /// Lines that may meet voxels of a box.
    PixelBox seenOf(const IndexBox& box) const;

  private:
    PictureLine lineOf(const glm::dvec3& through, const glm::dvec3& direction) const;

    const Camera& camera_;
    int perSide_;
    Camera fine_;  // with a pixel per line
    glm::dmat4 world_;
    IndexBox box_;
    PixelBox seen_;
    glm::dmat3 linear_;
    std::optional<PictureRays> rays_;  // from an eye
    /// The eye, in voxels from the box's first; or the first parallel line's place, and the steps.
    glm::dvec3 origin_{0.0};
    glm::dvec3 alongX_{0.0};
    glm::dvec3 alongY_{0.0};
    std::optional<PictureLine> first_;
};

struct LineCount {
    int perSide = 1;
    double voxelsApart = 1;  ///< spacing of lines where a voxel is narrowest; at least 1
};

/// Counts a pixel's lines of sight along each side: one if pixels are no larger than voxels in the
/// middle of the volume, else the number of voxels. Fewer, but at least kLeastPerSide, if more than
/// kMostLines might meet the volume.
LineCount countLines(const Volume& volume, const Camera& camera);

inline constexpr int kLeastPerSide = 16;
inline constexpr double kMostLines = 0x1p22;

/// Slices of a layer of blocks.
struct BlockLayer {
    int block = 0;  ///< its number along the slice axis
    glm::ivec2 slices{0};
};

/// Region of neighbouring lines with the same axes.
class LineGroup {
  public:
    glm::dvec2 slices() const { return slices_; }
    void addSlices(const glm::dvec2& slices);
    /// Makes room for a line, after all addSlices().
    void addLine(const glm::dvec2& start, const glm::dvec2& slope);

    bool meets(const BlockLayer& layer) const {
        return slices_.y > layer.slices.x - 1 && slices_.x < layer.slices.y + 1;
    }
    /// Returns the largest top that lines may read in a layer; -infinity without blocks.
    float topOf(const TopGrid& tops, const RayAxes& axes, const BlockLayer& layer) const;

  private:
    /// Bounds of lines.
    struct Range {
        glm::dvec2 low{1e300};
        glm::dvec2 high{-1e300};
    };
    Range rangeAt(double slice) const;

    glm::dvec2 slices_{1e300, -1e300};
    Range first_, last_;  // one slice before the first, and one behind the last
};

/// Which blocks squares of lines may meet: in large, nearly empty boxes most squares meet none.
class LineCells {
  public:
    /// @param side  of a square, in lines
    LineCells(const PictureLines& lines, const RayVolume& volume, int side);

    /// Whether there are too many blocks to list.
    bool areUnknown() const { return ends_.empty(); }
    /// Numbers of the blocks that any of these lines may meet, in order.
    std::vector<std::uint32_t> blocksBehind(const PixelBox& lines) const;

  private:
    PixelBox cellsOf(const PixelBox& lines) const;
    std::size_t indexOf(glm::ivec2 cell) const;

    int side_;
    PixelBox box_;  // in squares
    std::vector<std::size_t>
        ends_;  // [square]: end of its blocks, row by row; they begin at the previous end
    std::vector<std::uint32_t> blocks_;  // of all squares
};

}  // namespace deltasplat
