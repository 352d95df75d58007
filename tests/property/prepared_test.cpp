// SPDX-License-Identifier: Apache-2.0
// A scene prepared once and rendered from anywhere, by any number of threads, gives the pixels that
// `render` gives.
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "deltasplat/error.h"
#include "deltasplat/prepared_scene.h"
#include "deltasplat/render.h"
#include "deltasplat/threads.h"
#include "prepared_axis.h"
#include "support/make_volume.h"

namespace deltasplat {
namespace {

std::shared_ptr<const Volume> someVolume() {
    return std::make_shared<const Volume>(
        test::randomVolume({{0, 0, 0}, {33, 26, 28}}, 11, 0.5, {1, 1.2, 0.8}));
}

Optics someOptics(bool several) {
    Optics optics;
    optics.transferFunction.colors = {{0, {1, 0, 0.5}}};
    if (several) optics.transferFunction.colors.push_back({255, {0.2, 1, 0}});
    optics.transferFunction.opacities = {{60, 0, 0.5, 0}, {200, 0.3, 0.5, 0}, {255, 1, 0.5, 0}};
    return optics;
}

// Parallel and from an eye, straight and oblique, from near and from afar.
std::vector<CameraOptions> someCameras() {
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

Camera cameraOf(const Volume& volume, const CameraOptions& options) {
    return makeCamera(options, volume.box, volume.worldFromIndex, volume.space);
}

Image pictureOf(const PreparedScene& scene, const CameraOptions& options) {
    const Camera camera = cameraOf(*scene.scene().volume, options);
    Image image(camera.sizePixels);
    renderComposite(scene, camera, image);
    return image;
}

TEST(Prepared, givesThePixelsOfRender) {
    for (const bool several : {false, true}) {
        for (const double tolerance : {0.0, 0.1}) {
            RenderOptions options;
            options.optics = someOptics(several);
            options.tolerance.relative = tolerance;
            const PreparedScene scene({someVolume(), options.optics}, options);
            for (int round = 0; round < 2; ++round) {
                for (const CameraOptions& camera : someCameras()) {
                    options.camera = camera;
                    EXPECT_EQ(pictureOf(scene, camera).rgba,
                              render(*scene.scene().volume, options).image.rgba)
                        << several << ' ' << tolerance << ' ' << camera.azimuthDegrees;
                }
            }
        }
    }
}

// A camera that turns needs each axis once, whatever the angle.
TEST(Prepared, preparesEachAxisOnce) {
    const PreparedScene scene({someVolume(), someOptics(true)}, SplatOptions());
    const Subdivision whole;
    std::vector<std::shared_ptr<const PreparedAxis>> axes;
    for (int axis = 0; axis < 3; ++axis) axes.push_back(scene.impl().axis(axis, whole, 1, {}));
    int told = 0;
    Listener listener;
    listener.progress = [&](double) { ++told; };
    for (int i = 0; i < 100; ++i) {
        CameraOptions camera;
        camera.sizePixels = {24, 20};
        camera.azimuthDegrees = 3.6 * i;
        camera.elevationDegrees = i;
        pictureOf(scene, camera);
    }
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_EQ(scene.impl().axis(axis, whole, 1, listener), axes[std::size_t(axis)]);
        EXPECT_EQ(told, 0);
    }
}

// Also while none of the axes is there yet.
TEST(Prepared, anyNumberOfThreadsMayRenderOneScene) {
    for (const bool several : {false, true}) {
        const PreparedScene scene({someVolume(), someOptics(several)}, SplatOptions());
        const std::vector<CameraOptions> cameras = someCameras();
        std::vector<Image> pictures(2 * cameras.size());
        std::vector<std::thread> threads;
        for (std::size_t i = 0; i < pictures.size(); ++i) {
            threads.emplace_back([&, i] {
                const ThreadLimit limit(1 + int(i % 3));
                pictures[i] = pictureOf(scene, cameras[i % cameras.size()]);
            });
        }
        for (std::thread& thread : threads) thread.join();
        for (std::size_t i = 0; i < pictures.size(); ++i)
            EXPECT_EQ(pictures[i].rgba, pictureOf(scene, cameras[i % cameras.size()]).rgba);
    }
}

// What was in the picture before makes no difference.
TEST(Prepared, picturesAreCleared) {
    const PreparedScene scene({someVolume(), someOptics(true)}, SplatOptions());
    CameraOptions options;
    options.sizePixels = {60, 50};
    const Camera camera = cameraOf(*scene.scene().volume, options);
    Image image(camera.sizePixels);
    std::fill(image.rgba.begin(), image.rgba.end(), 7.0f);
    renderComposite(scene, camera, image);
    EXPECT_EQ(image.rgba, pictureOf(scene, options).rgba);
}

std::string messageOf(const std::function<void()>& call) {
    try {
        call();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::kUsage);
        return error.what();
    }
    return "no error";
}

TEST(Prepared, refusesWhatCannotBeMeant) {
    EXPECT_EQ(messageOf([] { PreparedScene({}, SplatOptions()); }),
              "scene: got no volume; expected one");
    Optics none = someOptics(false);
    none.transferFunction.opacities.clear();
    EXPECT_EQ(messageOf([&] {
                  PreparedScene({someVolume(), none}, SplatOptions());
              }),
              "transfer function's opacities: got none; expected at least one");
    const PreparedScene scene({someVolume(), someOptics(false)}, SplatOptions());
    const Camera camera = cameraOf(*scene.scene().volume, CameraOptions());
    Image small({100, 512});
    EXPECT_EQ(
        messageOf([&] { renderComposite(scene, camera, small); }),
        "image: got 100x512 pixels, 204800 values; expected the camera's 512x512, four values "
        "each");
}

}  // namespace
}  // namespace deltasplat
