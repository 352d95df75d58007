// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>
#include <optional>

#include "deltasplat/image/image.h"
#include "deltasplat/ingest/volume.h"
#include "deltasplat/optics/shading.h"
#include "deltasplat/view/camera.h"

namespace deltasplat {

/// A volume as lights see it: a ball around all of its voxels.
struct SeenBall {
    explicit SeenBall(const Volume& volume);

    glm::dvec3 middle;
    double radius;
    glm::dvec3 halfEdges[3];  ///< of the box around all voxels, footprints included
    double voxel;             ///< smallest size
};

/// A camera that stands where a light does and sees all of a volume: parallel lines of sight of
/// light from far away; of a point near or within the volume to all sides.
/// @param axes  right, up and direction of a camera: the picture is upright as that is, so that
///              a mirrored scene has a mirrored picture
class LightCamera {
  public:
    LightCamera(const Light& light, const SeenBall& ball, const Camera& axes);

    /// How much larger than at the middle of the volume a pixel is at a place.
    double growthAt(const glm::dvec3& world) const;
    /// Returns the camera.
    /// @param pixelWorld  of a pixel, at the middle of the volume; it may become larger, lest the
    ///                    picture has too many
    Camera of(double pixelWorld) const;

  private:
    std::optional<glm::dvec3> eye_;
    Camera camera_;
    const SeenBall& ball_;
    double distance_ = 0;  // at which pixels are as large as that
};

/// Reads the alpha of a picture where a place in the world is seen, between pixels bilinearly; what
/// is beyond the picture is clear.
double alphaAt(const Image& image, const Camera& camera, const glm::dvec3& world);

}  // namespace deltasplat
