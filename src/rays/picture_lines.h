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

/// A volume's axes in the order and the directions of a line of sight: (slice, u, v), of which the
/// first is the one that it is most parallel to, of several the last. It goes to larger positions
/// along each.
struct RayAxes {
    glm::ivec3 order{0, 1, 2};
    glm::ivec3 sign{1};   ///< 1 or -1: the way along order[i]
    glm::ivec3 first{0};  ///< voxel of position 0
    glm::ivec3 count{0};  ///< positions of the volume's box

    int voxelAt(int i, int position) const { return first[i] + sign[i] * position; }
    bool operator==(const RayAxes&) const = default;
};

/// A line of sight in positions of its axes: at slice s it meets (u, v) = start + s * slope.
struct SightRay {
    RayAxes axes;
    glm::dvec2 start{0.0};
    glm::dvec2 slope{0.0};     ///< 0 to 1
    double nearest = 0;        ///< the slice, or the place between two, at which it begins
    glm::dvec2 slices{0, -1};  ///< between which it may meet anything; none if the second is less

    /// @param box      of voxels
    /// @param through  a point that it goes through, in voxels from the box's first, so that
    ///                 numbers stay small
    /// @param ray      of any length, in voxels
    SightRay(const IndexBox& box, const glm::dvec3& through, const glm::dvec3& ray);

    /// Moves it to another point, without changing its direction.
    void moveTo(const glm::dvec3& through);
    /// Makes it begin at so many slices from the point that it was made with.
    void beginAt(double slicesFromPoint);
    double slicesFromPoint(double slice) const { return slice - point_; }

  private:
    void clip();
    double point_;  // slice of the point that it goes through
};

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

/// Slices that a layer of blocks has.
struct BlockLayer {
    int block = 0;  ///< its number along the slice axis
    glm::ivec2 slices{0};
};

/// Where lines of the same axes run that lie beside each other.
class LineGroup {
  public:
    glm::dvec2 slices() const { return slices_; }
    /// Makes room for lines that meet something between two slices.
    void addSlices(const glm::dvec2& slices);
    /// Makes room for a line, once all slices are known.
    void addLine(const glm::dvec2& start, const glm::dvec2& slope);

    bool meets(const BlockLayer& layer) const {
        return slices_.y > layer.slices.x - 1 && slices_.x < layer.slices.y + 1;
    }
    /// Returns the largest of what blocks hold that lines may read of a layer, -infinity where
    /// there are none.
    float topOf(const TopGrid& tops, const RayAxes& axes, const BlockLayer& layer) const;

  private:
    /// Where lines are at least and at most.
    struct Range {
        glm::dvec2 low{1e300};
        glm::dvec2 high{-1e300};
    };
    Range rangeAt(double slice) const;

    glm::dvec2 slices_{1e300, -1e300};
    Range first_, last_;  // a slice before the first, and behind the last
};

/// Which blocks squares of lines of sight may meet: where there is little in a large box, most
/// squares meet none.
class LineCells {
  public:
    /// @param side  of a square, in lines
    LineCells(const PictureLines& lines, const RayVolume& volume, int side);

    /// Whether blocks are so many that nobody knows who meets which.
    bool areUnknown() const { return ends_.empty(); }
    /// Numbers of the blocks that any of these lines may meet, in order.
    std::vector<std::uint32_t> blocksBehind(const PixelBox& lines) const;

  private:
    PixelBox cellsOf(const PixelBox& lines) const;
    std::size_t indexOf(glm::ivec2 cell) const;

    int side_;
    PixelBox box_;                       // in squares
    std::vector<std::size_t> ends_;      // of the blocks of each, row by row, which begin at its
                                         // predecessor's
    std::vector<std::uint32_t> blocks_;  // of all
};

}  // namespace deltasplat
