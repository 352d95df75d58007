// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>

#include "deltasplat/ingest/volume.h"

namespace deltasplat {

/// How lines of sight run.
enum class Projection {
    kOrtho,        ///< parallel to each other
    kPerspective,  ///< from an eye through a flat picture
    kLatlong       ///< from an eye to all sides: columns are longitudes, rows latitudes
};

/// Returns "ortho", "perspective" or "latlong".
std::string projectionName(Projection projection);

/// What a person says about the camera. World space is right-handed with y up. Angles turn the way
/// VTK's camera turns; quarter turns are exact.
struct CameraOptions {
    Projection projection = Projection::kOrtho;
    /// front (looks along -z), back (+z), left (from -x along +x), right (-x), top (down -y, up is
    /// -z), bottom (up +y, up is +z) or iso (along (-1,-1,-1)). In a patient's space up is the
    /// head's direction, front looks at the face, left and right at the patient's left and right,
    /// top down on the head, iso at face, left and head; top and bottom have the back and the face
    /// at the top of the picture.
    std::string view = "front";
    double azimuthDegrees =
        0;  ///< turns the camera about the up axis through the target, towards its right
    /// Then raises the camera over the target; its up turns along, so that past 90 degrees it hangs
    /// upside down.
    double elevationDegrees = 0;
    double rollDegrees = 0;  ///< then turns it clockwise (seen from behind) about the line of sight
    std::optional<glm::dvec3> direction;  ///< the way the line of sight travels; replaces `view`
    /// What is up: views turn with it, the shortest way. Default: +y, or in a patient's space the
    /// head's direction; of a `direction` or `eyeWorld` straight down or up as in top or bottom.
    /// Not parallel to those.
    std::optional<glm::dvec3> up;
    std::optional<glm::dvec3>
        targetWorld;  ///< falls on the middle of the picture; default: middle of the box
    /// kOrtho: world width of the picture; default: the box of voxel centres just fits both ways.
    std::optional<double> frameWidthWorld;
    /// Where lines of sight begin, unless they are parallel. From there it looks in `direction`, or
    /// else at the target, whatever the view (kLatlong, at the target: as the view says); angles
    /// turn the line of sight about the eye. Default: `distanceWorld` before the target; kLatlong:
    /// the target.
    std::optional<glm::dvec3> eyeWorld;
    /// kPerspective: full vertical angle of view, more than 0 and less than 180 degrees; default:
    /// by `focalMm` and `apertureMm` if one is given, else kDefaultFov.
    std::optional<double> fovDegrees;
    std::optional<double> focalMm;     ///< default: kDefaultFocalMm
    std::optional<double> apertureMm;  ///< width of the film back; default: kDefaultApertureMm
    /// kPerspective without an eye: from the eye to the target, > 0; default: the box of voxel
    /// centres just fits. kOrtho: from the camera to the plane through the target, where depths
    /// begin; moves no pixel; default: all of the volume lies beyond the camera.
    std::optional<double> distanceWorld;
    /// kPerspective of a C-arm, all three or none, in place of the lens, the eye and the distance:
    /// from the source of x-rays, which is the eye, to the isocenter, which is the target, > 0; to
    /// the middle of the detector, at least that; and the detector's width and height, whose pixels
    /// are square (within a thousandth). What lies beyond the detector counts as well.
    std::optional<double> sourceToIsocenterWorld;
    std::optional<double> sourceToDetectorWorld;
    std::optional<glm::dvec2> detectorWorld;
    /// Where the camera stands and how it is turned, in place of all of the above that says so:
    /// its x axis goes to the right, y up, z away from what it sees, which is how most programs
    /// have it. A rotation, a uniform scale (left out) and a translation. With it, `up` turns
    /// nothing; kOrtho without `frameWidthWorld`: as wide as the box.
    std::optional<glm::dmat4> worldFromCamera;
    /// How far the middle of the picture lies to the right of and above the line of sight, as
    /// shares of the picture's width and height: a shifted lens, whose picture is a part of a wider
    /// one. Not kLatlong.
    glm::dvec2 frameOffset{0.0};
    /// Width of a pixel over its height, kLeastPixelAspect..kMostPixelAspect. Not kLatlong.
    double pixelAspect = 1;
    /// What is nearer than this is not seen: along the middle line of sight, or, kLatlong, along
    /// each; >= 0.
    double nearWorld = 0;
    glm::ivec2 sizePixels{512, 512};
    /// Pixels that the picture has more at its left and right, and above and below, each
    /// 0..kMostOverscan; not kLatlong.
    glm::ivec2 overscanPixels{0};
};

inline constexpr int kMostOverscan = 1'000'000;

inline constexpr double kDefaultFov = 30;
inline constexpr double kDefaultFocalMm = 50;
inline constexpr double kDefaultApertureMm = 36;
inline constexpr double kMostFrameOffset = 100;
inline constexpr double kLeastPixelAspect = 0.01;
inline constexpr double kMostPixelAspect = 100;

/// A camera. `right`, `up` and `-direction` are a right-handed orthonormal basis.
/// Pixel (0,0) is top left, pixel centres are at half-integers, `targetWorld` falls on
/// `targetPixel()`.
struct Camera {
    Projection projection = Projection::kOrtho;
    glm::dvec3 direction{0, 0, -1};
    glm::dvec3 right{1, 0, 0};
    glm::dvec3 up{0, 1, 0};
    glm::dvec3 targetWorld{0.0};
    /// Width of what the picture shows of the plane through the target; of kLatlong, 2 pi times
    /// the target's distance: the picture's width on a cylinder around the eye.
    double frameWidthWorld = 1;
    /// Where in the picture the target falls: (0, 0) is the upper left corner, (1, 1) the lower
    /// right one.
    glm::dvec2 targetInFrame{0.5};
    double pixelAspect = 1;  ///< as CameraOptions::pixelAspect
    /// From the camera to the plane through the target. kOrtho: it moves no pixel.
    double targetDistanceWorld = 0;
    double nearWorld = 0;             ///< as CameraOptions::nearWorld
    glm::ivec2 sizePixels{512, 512};  ///< overscan included, as in the frame's width
    glm::ivec2 overscanPixels{0};     ///< as CameraOptions::overscanPixels

    /// Where lines of sight begin (kOrtho: the middle one).
    glm::dvec3 eyeWorld() const { return targetWorld - targetDistanceWorld * direction; }
    /// kPerspective: full vertical angle of view, were the target in the middle.
    double fovDegrees() const;
    /// As CameraOptions::frameOffset.
    glm::dvec2 frameOffset() const { return {0.5 - targetInFrame.x, targetInFrame.y - 0.5}; }
    /// Continuous pixel coordinates of the target.
    glm::dvec2 targetPixel() const { return targetInFrame * glm::dvec2(sizePixels); }
    /// Direction, not of length 1, in which continuous pixel coordinates are seen from the eye.
    glm::dvec3 rayThrough(glm::dvec2 pixel) const;

    /// World units across a pixel.
    double pixelWorld() const { return frameWidthWorld / sizePixels.x; }
    /// World units from one pixel to the one below.
    double pixelHeightWorld() const { return pixelWorld() / pixelAspect; }
    double frameHeightWorld() const {
        return frameWidthWorld * sizePixels.y / sizePixels.x / pixelAspect;
    }
    /// World position, on the plane through the target (kLatlong: as far away as the target), of
    /// continuous pixel coordinates.
    glm::dvec3 worldFromPixel(glm::dvec2 pixel) const;
    /// Continuous pixel coordinates of a world position; infinite for what lies level with the eye
    /// of a perspective camera, and mirrored for what lies behind it.
    glm::dvec2 pixelFromWorld(const glm::dvec3& world) const;
    /// OpenEXR's worldToCamera: left-handed, x right, y up, z along the line of sight, in world
    /// units; the target lies at (0, 0, targetDistanceWorld).
    glm::dmat4 cameraFromWorld() const;
    /// OpenEXR's worldToNDC: (0, 0) is the upper left corner of the picture without its overscan,
    /// (1, 1) the lower right one; z, which has no meaning there, is that of cameraFromWorld.
    /// kLatlong, which no matrix describes, has that of a parallel picture of its frame.
    glm::dmat4 ndcFromWorld() const;

    /// The same camera with so many pixels more at each side, and without those that it has.
    /// @throw Error(kUsage) for pixels that are too many, or a panorama's
    Camera withOverscan(glm::ivec2 pixels) const;
    Camera withoutOverscan() const;
};

/// Places the camera on a volume. What projects to one point (one voxel, an empty box, a line seen
/// end-on) is framed as one voxel of the smallest size.
/// @param space  as Volume::space: "RAS", "LPS", or anything else for no patient
/// @throw Error(kUsage) naming the option if the view's name is unknown, a number is not finite,
///        the direction is zero or parallel to a given up, the eye is the target that it looks
///        at, the
///        frame width, the distance, the angle of view, the frame's offset, the pixels' aspect or
///        the size is out of range, a panorama is not twice as wide as high, or `worldFromCamera`
///        is more than turned, moved and scaled; Error(kInput) if worldFromIndex is not finite or
///        cannot be inverted
Camera makeCamera(const CameraOptions& options, const IndexBox& box,
                  const glm::dmat4& worldFromIndex, const std::string& space = "");
inline Camera makeCamera(const CameraOptions& options, const Volume& volume) {
    return makeCamera(options, volume.box, volume.worldFromIndex, volume.space);
}

}  // namespace deltasplat
