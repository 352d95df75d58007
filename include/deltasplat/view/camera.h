// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>

#include "deltasplat/ingest/volume.h"

namespace deltasplat {

enum class Projection {
    kOrtho,        ///< parallel to each other
    kPerspective,  ///< from an eye through a flat picture
    kLatlong       ///< from an eye to all sides: columns are longitudes, rows latitudes
};

/// Returns "ortho", "perspective" or "latlong".
std::string projectionName(Projection projection);

/// A person's description of the camera. World space is right-handed with y up. Angles turn like
/// VTK's camera; quarter turns are exact.
struct CameraOptions {
    Projection projection = Projection::kOrtho;
    /// front (looks along -z), back (+z), left (from -x along +x), right (-x), top (down -y, up is
    /// -z), bottom (up +y, up is +z) or iso (along (-1,-1,-1)). In a patient's space the head is
    /// up: front looks at the face, left and right at the patient's left and right, top down on the
    /// head, iso at face, left and head. The back is up in top, the face in bottom.
    std::string view = "front";
    /// Turns the camera about the up axis through the target, to its right.
    double azimuthDegrees = 0;
    /// Then raises the camera over the target; beyond 90 degrees it hangs upside down.
    double elevationDegrees = 0;
    double rollDegrees = 0;  ///< then turns it clockwise (seen from behind) about the line of sight
    std::optional<glm::dvec3> direction;  ///< of the line of sight; replaces `view`
    /// Up direction: views turn with it, the shortest way. Default: +y, or a patient's head; as in
    /// top or bottom for a `direction` or `eyeWorld` straight down or up. Not parallel to these.
    std::optional<glm::dvec3> up;
    /// Shown in the middle of the picture; default: middle of the box.
    std::optional<glm::dvec3> targetWorld;
    /// kOrtho: world width of the picture; default: the box of voxel centres just fits both ways.
    std::optional<double> frameWidthWorld;
    /// Start of all lines of sight that are not parallel. The camera looks in `direction`, or else
    /// at the target, whatever the view (kLatlong at the target: by the view); angles turn the line
    /// of sight about the eye. Default: `distanceWorld` before the target; kLatlong: the target.
    std::optional<glm::dvec3> eyeWorld;
    /// kPerspective: full vertical angle of view, > 0 and < 180 degrees; default: by `focalMm` and
    /// `apertureMm` if one is given, else kDefaultFov.
    std::optional<double> fovDegrees;
    std::optional<double> focalMm;     ///< default: kDefaultFocalMm
    std::optional<double> apertureMm;  ///< width of the film back; default: kDefaultApertureMm
    /// kPerspective without an eye: from eye to target, > 0; default: the box of voxel centres just
    /// fits. kOrtho: from camera to the plane through the target, where depths begin; moves no
    /// pixel; default: all of the volume lies beyond the camera.
    std::optional<double> distanceWorld;
    /// kPerspective of a C-arm, all three or none; they replace the lens, the eye and the distance.
    /// From the x-ray source (the eye) to the isocenter (the target), > 0; from the source to the
    /// middle of the detector, at least that; width and height of the detector, whose pixels are
    /// square (within a thousandth). Voxels beyond the detector count too.
    std::optional<double> sourceToIsocenterWorld;
    std::optional<double> sourceToDetectorWorld;
    std::optional<glm::dvec2> detectorWorld;
    /// The camera's position and rotation, replacing members above: x goes right, y up, z away from
    /// the scene, as in most programs. A rotation, a uniform scale (ignored) and a translation.
    /// `up` then turns nothing; kOrtho without `frameWidthWorld` is as wide as the box.
    std::optional<glm::dmat4> worldFromCamera;
    /// Shift of the picture's middle to the right of and above the line of sight, as shares of the
    /// picture's width and height: a shifted lens. Not kLatlong.
    glm::dvec2 frameOffset{0.0};
    /// Width of a pixel over its height, kLeastPixelAspect..kMostPixelAspect. Not kLatlong.
    double pixelAspect = 1;
    /// Nearest visible distance along the middle line of sight, in kLatlong along each; >= 0.
    double nearWorld = 0;
    glm::ivec2 sizePixels{512, 512};
    /// Additional pixels at left and right, and above and below, 0..kMostOverscan; not kLatlong.
    glm::ivec2 overscanPixels{0};
};

inline constexpr int kMostOverscan = 1'000'000;

inline constexpr double kDefaultFov = 30;
inline constexpr double kDefaultFocalMm = 50;
inline constexpr double kDefaultApertureMm = 36;
inline constexpr double kMostFrameOffset = 100;
inline constexpr double kLeastPixelAspect = 0.01;
inline constexpr double kMostPixelAspect = 100;

/// A camera. `right`, `up` and `-direction` are a right-handed orthonormal basis. Pixel (0,0) is
/// top left, pixel centres are at half-integers, `targetWorld` falls on `targetPixel()`.
struct Camera {
    Projection projection = Projection::kOrtho;
    glm::dvec3 direction{0, 0, -1};
    glm::dvec3 right{1, 0, 0};
    glm::dvec3 up{0, 1, 0};
    glm::dvec3 targetWorld{0.0};
    /// Width of the picture on the plane through the target; kLatlong: on a cylinder around the eye
    /// through the target, 2 pi times the target's distance.
    double frameWidthWorld = 1;
    /// The target's place in the picture: (0, 0) is the upper left, (1, 1) the lower right corner.
    glm::dvec2 targetInFrame{0.5};
    double pixelAspect = 1;  ///< as CameraOptions::pixelAspect
    /// From the camera to the plane through the target. kOrtho: moves no pixel.
    double targetDistanceWorld = 0;
    double nearWorld = 0;             ///< as CameraOptions::nearWorld
    glm::ivec2 sizePixels{512, 512};  ///< overscan included, as in the frame's width
    glm::ivec2 overscanPixels{0};     ///< as CameraOptions::overscanPixels

    /// Start of the lines of sight (kOrtho: of the middle one).
    glm::dvec3 eyeWorld() const { return targetWorld - targetDistanceWorld * direction; }
    /// kPerspective: full vertical angle of view, as if the target were in the middle.
    double fovDegrees() const;
    /// As CameraOptions::frameOffset.
    glm::dvec2 frameOffset() const { return {0.5 - targetInFrame.x, targetInFrame.y - 0.5}; }
    glm::dvec2 targetPixel() const { return targetInFrame * glm::dvec2(sizePixels); }
    /// Direction, of any length, from the eye through continuous pixel coordinates.
    glm::dvec3 rayThrough(glm::dvec2 pixel) const;

    double pixelWorld() const { return frameWidthWorld / sizePixels.x; }
    /// World distance of a pixel and the one below.
    double pixelHeightWorld() const { return pixelWorld() / pixelAspect; }
    double frameHeightWorld() const {
        return frameWidthWorld * sizePixels.y / sizePixels.x / pixelAspect;
    }
    /// Position of continuous pixel coordinates in the target's plane (kLatlong: at its distance).
    glm::dvec3 worldFromPixel(glm::dvec2 pixel) const;
    /// Continuous pixel coordinates: infinite level with a perspective eye, mirrored behind it.
    glm::dvec2 pixelFromWorld(const glm::dvec3& world) const;
    /// OpenEXR's worldToCamera in world units: left-handed, x right, y up, z along the line of
    /// sight; the target lies at (0, 0, targetDistanceWorld).
    glm::dmat4 cameraFromWorld() const;
    /// OpenEXR's worldToNDC: (0, 0) is the upper left corner of the picture without overscan, (1,
    /// 1) the lower right; z, unused there, is cameraFromWorld's. No matrix describes kLatlong,
    /// which has that of a parallel picture of its frame.
    glm::dmat4 ndcFromWorld() const;

    /// The same camera with additional pixels at each side, or without overscan.
    /// @throw Error(kUsage) for too many pixels, or for a panorama
    Camera withOverscan(glm::ivec2 pixels) const;
    Camera withoutOverscan() const;
};

/// Places the camera on a volume. A volume that projects to one point or line (one voxel, an empty
/// box, a line seen end-on) is framed as one voxel of the smallest size.
/// @param space  as Volume::space: "RAS", "LPS", or anything else for no patient
/// @throw Error(kUsage) naming the option for an unknown view, a number that is not finite, a
///        direction that is zero or parallel to a given up, an eye at its target, a frame width,
///        distance, angle of view, frame offset, pixel aspect or size out of range, a panorama not
///        twice as wide as high, or a `worldFromCamera` that does more than turn, move and scale;
///        Error(kInput) if worldFromIndex is not finite or cannot be inverted
Camera makeCamera(const CameraOptions& options, const IndexBox& box,
                  const glm::dmat4& worldFromIndex, const std::string& space = "");
inline Camera makeCamera(const CameraOptions& options, const Volume& volume) {
    return makeCamera(options, volume.box(), volume.worldFromIndex(), volume.space());
}

}  // namespace deltasplat
