// SPDX-License-Identifier: Apache-2.0
// Slabs rendered one by one, here or elsewhere, make the picture that is rendered at once.
#include "deltasplat/slabs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <thread>

#include "deltasplat/error.h"
#include "deltasplat/threads.h"
#include "support/error_of.h"
#include "support/small_joined.h"
#include "support/some_scene.h"

namespace deltasplat {
namespace {

using test::cameraOf;
using test::Colors;
using test::errorOf;
using test::someCameras;
using test::someOptics;
using test::someVolume;

PreparedScene sceneOf(Colors colors, double tolerance = 0) {
    SplatOptions options;
    options.tolerance.relative = tolerance;
    return PreparedScene({someVolume(), someOptics(colors)}, options);
}

std::vector<SlabLayer> layersOf(const SlabPicture& picture) {
    std::vector<SlabLayer> layers;
    for (int slab = 0; slab < picture.slabs(); ++slab) layers.push_back(picture.render(slab));
    return layers;
}

Image imageOf(Picture picture) {
    const glm::ivec2 size = picture.camera().sizePixels;
    Image image(size);
    std::fill(image.rgba.begin(), image.rgba.end(), 5.0f);
    picture.show({{0, 0}, size}, image);
    return image;
}

TEST(SlabPicture, givesThePixelsOfThePictureAtOnce) {
    const test::SmallJoined joined;
    for (const Colors colors : {Colors::kOne, Colors::kSeveral, Colors::kOwn, Colors::kLit,
                                Colors::kFog, Colors::kFire}) {
        for (const double tolerance : {0.0, 0.1}) {
            const PreparedScene scene = sceneOf(colors, tolerance);
            // As another process would.
            const PreparedScene elsewhere = sceneOf(colors, tolerance);
            for (const CameraOptions& options : test::smallCamerasToo()) {
                const Camera camera = cameraOf(*scene.scene().volume, options);
                const SlabPicture here(scene, camera);
                const SlabPicture there(elsewhere, camera);
                ASSERT_EQ(here.slabs(), there.slabs());
                // Of joined slices there may be too few for two.
                EXPECT_GT(here.slabs(), camera.sizePixels.y > 20 ? 1 : 0);
                std::vector<SlabLayer> layers;
                for (int slab = 0; slab < here.slabs(); ++slab) {
                    const ThreadLimit limit(1 + slab % 3);
                    layers.push_back((slab % 2 == 0 ? here : there).render(slab));
                }
                std::shuffle(layers.begin(), layers.end(), std::mt19937(3));
                EXPECT_EQ(imageOf(here.fold(layers)).rgba, test::pictureOf(scene, options).rgba);
            }
        }
    }
}

TEST(SlabPicture, anyNumberOfThreadsMayRenderSlabs) {
    const PreparedScene scene = sceneOf(Colors::kSeveral);
    const CameraOptions options = someCameras()[5];
    const SlabPicture picture(scene, cameraOf(*scene.scene().volume, options));
    std::vector<SlabLayer> layers(std::size_t(picture.slabs()));
    std::vector<std::thread> threads;
    for (int slab = 0; slab < picture.slabs(); ++slab)
        threads.emplace_back([&, slab] { layers[std::size_t(slab)] = picture.render(slab); });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(imageOf(picture.fold(layers)).rgba, test::pictureOf(scene, options).rgba);
}

TEST(SlabPicture, ofAnEmptyVolumeIsTransparent) {
    const auto nothing = std::make_shared<const Volume>(
        test::makeVolume({}, [](int, int, int) { return test::kInactive; }));
    const PreparedScene scene({nothing, someOptics(Colors::kOne)}, SplatOptions());
    CameraOptions options;
    options.sizePixels = {10, 10};
    const SlabPicture picture(scene, cameraOf(*nothing, options));
    EXPECT_EQ(picture.slabs(), 0);
    EXPECT_EQ(imageOf(picture.fold({})).rgba, Image(options.sizePixels).rgba);
}

TEST(SlabPicture, refusesLayersThatAreNotItsOwn) {
    const PreparedScene scene = sceneOf(Colors::kSeveral);
    const CameraOptions options = someCameras()[1];
    const SlabPicture picture(scene, cameraOf(*scene.scene().volume, options));
    const std::vector<SlabLayer> layers = layersOf(picture);
    const std::string slabs = std::to_string(layers.size());
    const auto messageFor = [&](const std::function<void(std::vector<SlabLayer>&)>& change) {
        std::vector<SlabLayer> changed = layers;
        change(changed);
        return errorOf([&] { picture.fold(changed); });
    };
    EXPECT_EQ(messageFor([](auto&) {}), "no error");
    EXPECT_EQ(messageFor([](auto& all) { all.pop_back(); }),
              "usage: layers of a picture: got none for slab " + std::to_string(layers.size() - 1) +
                  "; expected one for each of " + slabs + " slabs");
    EXPECT_EQ(messageFor([](auto& all) { all[1].slab = 0; }),
              "usage: layers of a picture: got slab 0 twice; expected each once");
    EXPECT_EQ(
        messageFor([](auto& all) { all[0].slab = -1; }),
        "usage: layers of a picture: got slab -1; expected one of " + slabs + ", counted from 0");
    EXPECT_NE(messageFor([](auto& all) { ++all[0].max.x; }).find("for slab 0"), std::string::npos);
    EXPECT_NE(messageFor([](auto& all) {
                  all[0].min.x = std::numeric_limits<int>::min();
                  all[0].max.x = std::numeric_limits<int>::max();
              }).find("4294967295x"),
              std::string::npos);
    EXPECT_NE(messageFor([](auto& all) { all[0].values.pop_back(); }).find("another size"),
              std::string::npos);
    EXPECT_NE(messageFor([](auto& all) {
                  all[0].spans[3] = {-5, 4};
              }).find("another size"),
              std::string::npos);
    EXPECT_EQ(errorOf([&] { picture.render(int(layers.size())); }),
              "usage: layers of a picture: got slab " + slabs + "; expected one of " + slabs +
                  ", counted from 0");
    SplatOptions many;
    many.mostJoined = 4;
    EXPECT_EQ(errorOf([&] {
                  SlabPicture({scene.scene(), many}, cameraOf(*scene.scene().volume, options));
              }),
              "usage: `mostJoined`: got 4 for slabs; expected 1 or 2");
}

}  // namespace
}  // namespace deltasplat
