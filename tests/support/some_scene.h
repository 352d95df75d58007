// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "deltasplat/prepared_scene.h"
#include "support/make_volume.h"

namespace deltasplat::test {

inline std::shared_ptr<const Volume> someVolume() {
    return std::make_shared<const Volume>(
        randomVolume({{0, 0, 0}, {33, 26, 28}}, 11, 0.5, {1, 1.2, 0.8}));
}

/// Of one colour, of several, of voxels' own, lit as surfaces, as fog, or fog that burns beside
/// itself.
enum class Colors { kOne, kSeveral, kOwn, kLit, kFog, kFire };

inline Optics someOptics(Colors colors) {
    Optics optics;
    optics.transferFunction.colors = {{0, {1, 0, 0.5}}};
    if (colors != Colors::kOne) optics.transferFunction.colors.push_back({255, {0.2, 1, 0}});
    if (colors == Colors::kOwn) optics.colorBy = ColorBy::kIndex;
    if (colors == Colors::kLit)
        optics.shading = Shading{
            0.1, 0.6, 0.3, 7, {Light{}, {LightFrame::kWorld, {1, -2, 0.5}, {1, 0.8, 0.3}, 0.7}}};
    if (colors == Colors::kFog || colors == Colors::kFire) {
        optics.scattering.emplace();
        optics.scattering->anisotropy = 0.4;
        optics.scattering->octaves = 1;
        optics.scattering->lights = {{LightFrame::kWorld, {1, -2, 0.5}, {1, 0.8, 0.3}, 3}};
    }
    if (colors == Colors::kFire) {
        MediumPart fire;
        Volume heat = randomVolume({{-5, 4, 7}, {20, 33, 22}}, 3, 0.6, {1.1, 1.2, 0.8});
        test::changed(heat)->worldFromIndex[3] = {0.3, 0, 0, 1};
        fire.volume = std::make_shared<const Volume>(std::move(heat));
        fire.kelvinScale = 8;
        optics.parts = {fire};
    }
    optics.transferFunction.opacities = {{60, 0, 0.5, 0}, {200, 0.3, 0.5, 0}, {255, 1, 0.5, 0}};
    return optics;
}

/// Parallel and from an eye, straight and oblique, from near and from afar.
inline std::vector<CameraOptions> someCameras() {
    std::vector<CameraOptions> cameras;
    for (int i = 0; i < 8; ++i) {
        CameraOptions camera;
        camera.sizePixels = {90, 70};
        camera.view = i % 2 == 0 ? "front" : "left";
        camera.azimuthDegrees = 17.0 * i;
        camera.elevationDegrees = 9.0 * i;
        if (i >= 4) {
            camera.projection = Projection::kPerspective;
            camera.fovDegrees = 20.0 * (i - 3);
        }
        cameras.push_back(camera);
    }
    cameras.emplace_back();
    cameras.back().projection = Projection::kLatlong;
    cameras.back().sizePixels = {96, 48};
    return cameras;
}

/// Those, and some of pictures so small that slices are joined.
inline std::vector<CameraOptions> smallCamerasToo() {
    std::vector<CameraOptions> cameras = someCameras();
    for (int i = 0; i < 8; ++i) {
        CameraOptions camera;
        camera.sizePixels = i % 2 == 0 ? glm::ivec2(13, 11) : glm::ivec2(5, 4);
        camera.azimuthDegrees = 170.0 * i - 15 * (i % 2);
        camera.elevationDegrees = 14 + 10 * (i % 4);
        if (i >= 4) {
            camera.projection = Projection::kPerspective;
            camera.fovDegrees = 15.0 * (i - 3);
        }
        cameras.push_back(camera);
    }
    return cameras;
}

inline Camera cameraOf(const Volume& volume, const CameraOptions& options) {
    return makeCamera(options, volume);
}

inline Image pictureOf(const PreparedScene& scene, const CameraOptions& options) {
    const Camera camera = cameraOf(*scene.scene().volume, options);
    Image image(camera.sizePixels);
    scene.render(camera, image);
    return image;
}

}  // namespace deltasplat::test
