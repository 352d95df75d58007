// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>
#include <optional>

#include "deltasplat/image/image.h"
#include "deltasplat/ingest/volume.h"
#include "deltasplat/optics/shading.h"
#include "deltasplat/view/camera.h"

namespace deltasplat {

/// A volume as lights see it: a ball around all voxels.
struct SeenBall {
    explicit SeenBall(const Volume& volume);

    glm::dvec3 middle;
    double radius;
    glm::dvec3 halfEdges[3];  ///< of the box around all voxels and their footprints
    double voxel;             ///< smallest size
};

/// A camera in place of a light that sees all of a volume: parallel for distant light; in all
/// directions for a point near or within the volume.
/// @param axes  a camera's right, up and direction, so that mirrored scenes have mirrored pictures
class LightCamera {
  public:
    LightCamera(const Light& light, const SeenBall& ball, const Camera& axes);

    /// Size of a pixel at a place, relative to one at the volume's middle.
    double growthAt(const glm::dvec3& world) const;
    /// @param pixelWorld  pixel size at the volume's middle; enlarged if pixels are too many
    Camera of(double pixelWorld) const;

  private:
    std::optional<glm::dvec3> eye_;
    Camera camera_;
    const SeenBall& ball_;
    double distance_ = 0;  // where pixels have that size
};

/// Reads the alpha of the picture at a place in the world, bilinearly; outside the picture 0.
double alphaAt(const Image& image, const Camera& camera, const glm::dvec3& world);

}  // namespace deltasplat
