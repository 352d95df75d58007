// SPDX-License-Identifier: Apache-2.0
// A scene prepared once and rendered from anywhere, by any number of threads, gives the pixels that
// `render` gives.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "base/kept_memory.h"
#include "deltasplat/error.h"
#include "deltasplat/prepared_scene.h"
#include "deltasplat/render.h"
#include "deltasplat/threads.h"
#include "picture/render_views.h"
#include "support/error_of.h"
#include "support/make_volume.h"
#include "support/small_joined.h"
#include "support/some_scene.h"

namespace deltasplat {
namespace {

using test::cameraOf;
using test::Colors;
using test::errorOf;
using test::pictureOf;
using test::smallCamerasToo;
using test::someCameras;
using test::someOptics;
using test::someVolume;

TEST(Prepared, givesThePixelsOfRender) {
    const test::SmallJoined joined;
    for (const Colors colors : {Colors::kOne, Colors::kSeveral, Colors::kOwn, Colors::kLit,
                                Colors::kFog, Colors::kFire}) {
        for (const double tolerance : {0.0, 0.1}) {
            RenderOptions options;
            options.optics = someOptics(colors);
            options.splat.tolerance.relative = tolerance;
            const PreparedScene scene({someVolume(), options.optics}, options.splat);
            for (int round = 0; round < 2; ++round) {
                for (const CameraOptions& camera : smallCamerasToo()) {
                    options.camera = camera;
                    EXPECT_EQ(pictureOf(scene, camera).rgba,
                              render(*scene.scene().volume, options).image.rgba)
                        << int(colors) << ' ' << tolerance << ' ' << camera.azimuthDegrees;
                }
            }
        }
    }
}

// From an eye, of a scene for one picture only what its regions see is packed.
TEST(Prepared, picturesOfWhatIsSeenAreThoseOfAll) {
    const auto volume = std::make_shared<const Volume>(
        test::randomVolume({{-70, 3, -40}, {80, 90, 60}}, 17, 0.03, {1, 1.2, 0.8}));
    std::uint64_t seen = 0;
    std::uint64_t all = 0;
    for (int i = 0; i < 48; ++i) {
        RenderOptions options;
        options.optics = someOptics(i % 3 == 0 ? Colors::kOne : Colors::kSeveral);
        if (i % 8 == 7) options.optics = someOptics(i % 16 == 7 ? Colors::kOwn : Colors::kLit);
        if (i % 8 == 3) options.optics = someOptics(i % 16 == 3 ? Colors::kFog : Colors::kFire);
        CameraOptions& camera = options.camera;
        camera.projection = i % 12 == 11 ? Projection::kLatlong : Projection::kPerspective;
        camera.sizePixels = i % 12 == 11 ? glm::ivec2(96, 48) : glm::ivec2(60, 44);
        camera.azimuthDegrees = 31 * i;
        camera.elevationDegrees = 23 * i % 80;
        if (i % 12 != 11) camera.fovDegrees = i % 4 == 0 ? 3 : 15.0 * (i % 4) + i;
        // Inside, beside, and in front of the near plane.
        if (i % 3 == 1) camera.eyeWorld = {7.0 * (i % 5), 50 + i, 3.0 * (i % 7)};
        if (i % 5 == 2) camera.nearWorld = 20;
        if (i % 6 == 1) options.splat.resolution = 1;
        if (i % 6 == 2) options.splat.resolution = 2;
        if (i % 6 == 3 && i % 8 != 3) options.splat.between = 1;
        if (i % 6 == 4) options.splat.sigma = 1.5;
        if (i % 6 == 5) options.splat.footprintWidth = 9;
        const PreparedScene scene({volume, options.optics}, options.splat);
        const RenderResult one = render(*volume, options);
        Image image(one.camera.sizePixels);
        const RenderStats stats = scene.render(one.camera, image);
        EXPECT_EQ(image.rgba, one.image.rgba) << i;
        EXPECT_LE(one.stats.visible, stats.visible);
        seen += one.stats.visible;
        all += stats.visible;
    }
    EXPECT_LT(double(seen), 0.7 * double(all));
}

// Where words would take much memory, slabs get theirs a few at a time.
TEST(Prepared, picturesInPartsAreThoseOfAllAtOnce) {
    const test::SmallJoined joined;
    for (const Colors colors : {Colors::kOne, Colors::kSeveral}) {
        for (const double least : {0.0, 1e-6}) {
            RenderOptions options;
            options.optics = someOptics(colors);
            options.optics.transferFunction.opacities[0].opacity = least;
            for (const Method method :
                 {Method::kAuto, Method::kDelta, Method::kSparse, Method::kTraditional}) {
                options.splat.method = method;
                for (std::size_t i = 0; i < smallCamerasToo().size(); ++i) {
                    options.camera = smallCamerasToo()[i];
                    options.splat.mostJoined = i / 2 % 2 == 0 ? 2 : kMostJoined;
                    const ThreadLimit limit(1 + int(i % 3));
                    const RenderResult whole = render(*someVolume(), options);
                    PreparedScene::Impl scene({someVolume(), options.optics}, options.splat, true);
                    scene.wordBytes = i % 2 == 0 ? 0 : 4e5;
                    KeptMemory memory;
                    Image image(whole.camera.sizePixels);
                    const RenderStats stats = renderImage(scene, whole.camera, memory, image, {});
                    EXPECT_EQ(image.rgba, whole.image.rgba) << int(colors) << ' ' << i;
                    EXPECT_EQ(stats.visible, whole.stats.visible);
                    EXPECT_EQ(stats.deltas, whole.stats.deltas);
                    EXPECT_EQ(stats.stamps, whole.stats.stamps);
                }
            }
        }
    }
}

// What a view along an axis is rendered from.
// @param away  which way it looks: -1 or 1
std::shared_ptr<const PreparedAxis> axisOf(const PreparedScene& scene, int axis,
                                           const Listener& listener = {}, int away = -1) {
    const Volume& volume = *scene.scene().volume;
    CameraOptions options;
    options.sizePixels = {24, 20};
    options.direction = glm::dvec3(0);
    (*options.direction)[axis] = away;
    const Camera camera = cameraOf(volume, options);
    const DrawPlan plan = planPicture(scene.impl(), camera, DrawnFor::kSlabs, listener);
    AxisPlan all = plan.views.front().axis;
    all.seen.reset();
    EXPECT_EQ(all.key.sliceAxis, axis);
    return scene.impl().axis(all, listener);
}

// A camera that turns needs each axis once, whatever the angle.
TEST(Prepared, preparesEachAxisOnce) {
    const PreparedScene scene({someVolume(), someOptics(Colors::kSeveral)}, SplatOptions());
    std::vector<std::shared_ptr<const PreparedAxis>> axes;
    for (int axis = 0; axis < 3; ++axis) axes.push_back(axisOf(scene, axis));
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
        EXPECT_EQ(axisOf(scene, axis, listener), axes[std::size_t(axis)]);
        EXPECT_EQ(told, 0);
    }
}

// Other optics of a scene: its opacities and colours changed so that the same codes are seen, codes
// that are seen changed, and looks of other kinds.
std::vector<Optics> otherOptics() {
    std::vector<Optics> all;
    for (const Colors colors :
         {Colors::kOne, Colors::kSeveral, Colors::kOwn, Colors::kLit, Colors::kFog}) {
        all.push_back(someOptics(colors));
        all.push_back(all.back());
        all.back().extinctionScale = 0.3;
        all.push_back(all[all.size() - 2]);
        all.back().transferFunction.opacities = {{90, 0, 0.5, 0}, {180, 0.6, 0.5, 0}};
    }
    return all;
}

TEST(Prepared, otherOpticsGiveThePixelsOfRender) {
    for (const double tolerance : {0.0, 0.1}) {
        RenderOptions options;
        options.splat.tolerance.relative = tolerance;
        PreparedScene scene({someVolume(), someOptics(Colors::kSeveral)}, options.splat);
        for (const CameraOptions& camera : {smallCamerasToo()[1], smallCamerasToo()[6]}) {
            options.camera = camera;
            for (const Optics& optics : otherOptics()) {
                scene = scene.withOptics(optics);
                options.optics = optics;
                EXPECT_EQ(pictureOf(scene, camera).rgba, render(*someVolume(), options).image.rgba)
                    << tolerance;
            }
        }
    }
}

// What is told apart is what words are made of.
TEST(Prepared, wordsAreSharedWhereTheSameIsToldApart) {
    const PreparedScene scene({someVolume(), someOptics(Colors::kSeveral)}, SplatOptions());
    const auto wordsOf = [](const PreparedScene& one) { return axisOf(one, 1)->words; };
    const auto words = wordsOf(scene);
    Optics optics = scene.scene().optics;
    optics.transferFunction.colors = {{0, {1, 1, 0}}, {255, {0.3, 0.1, 0}}};
    optics.extinctionScale = 2.5;
    const PreparedScene recolored = scene.withOptics(optics);
    EXPECT_EQ(wordsOf(recolored), words);
    // Also where no picture of the scene between was made.
    optics.extinctionScale = 1.5;
    EXPECT_EQ(wordsOf(recolored.withOptics(optics).withOptics(scene.scene().optics)), words);
    optics.transferFunction.opacities = {{90, 0, 0.5, 0}, {180, 0.6, 0.5, 0}};
    EXPECT_NE(wordsOf(scene.withOptics(optics)), words);
    SplatOptions held;
    held.tolerance.relative = 0.1;
    const PreparedScene holding({someVolume(), scene.scene().optics}, held);
    optics = scene.scene().optics;
    optics.extinctionScale = 2.5;
    EXPECT_NE(wordsOf(holding.withOptics(optics)), wordsOf(holding));
}

// Whole slices are the same from both ends of an axis; changes are told from the slice in front.
TEST(Prepared, whatIsWholeIsSharedByViewsFromBothEnds) {
    SplatOptions options;
    for (const Method method : {Method::kAuto, Method::kSparse, Method::kDelta}) {
        options.method = method;
        const PreparedScene scene({someVolume(), someOptics(Colors::kSeveral)}, options);
        const auto front = axisOf(scene, 1);
        const auto back = axisOf(scene, 1, {}, 1);
        EXPECT_EQ(front == back, front->deltas().areWhole());
        EXPECT_EQ(front->deltas().areWhole(), method != Method::kDelta);
        EXPECT_EQ(axisOf(scene, 1), front);
        EXPECT_EQ(axisOf(scene, 1, {}, 1), back);
        Optics optics = scene.scene().optics;
        optics.extinctionScale = 2.5;
        const PreparedScene other = scene.withOptics(optics);
        EXPECT_EQ(axisOf(other, 1, {}, 1)->words, back->words);
    }
    // Also where other optics saw the one end alone.
    const PreparedScene scene({someVolume(), someOptics(Colors::kSeveral)}, SplatOptions());
    const auto front = axisOf(scene, 1);
    Optics optics = scene.scene().optics;
    optics.extinctionScale = 2.5;
    EXPECT_EQ(axisOf(scene.withOptics(optics), 1, {}, 1)->words, front->words);
}

// What voxels are divided into depends on how opaque they are, though the same are told apart.
TEST(Prepared, dividedVoxelsAreThoseOfTheirOptics) {
    const auto volume = std::make_shared<const Volume>(test::makeVolume(
        {glm::ivec3(0), glm::ivec3(14)}, [](int, int y, int) { return y == 7 ? 100 : 2; }));
    const auto opticsOf = [](double haze) {
        Optics optics;
        optics.transferFunction.normalized = false;
        optics.transferFunction.colors = {{0, glm::dvec3(1)}};
        optics.transferFunction.opacities = {{0, haze}, {80, haze}, {81, 0.999}};
        return optics;
    };
    RenderOptions options;
    options.splat.between = 1;
    options.camera.sizePixels = {45, 45};
    options.optics = opticsOf(0.6);
    PreparedScene scene({volume, options.optics}, options.splat);
    pictureOf(scene, options.camera);
    for (const double haze : {0.01, 0.55, 1e-6}) {
        options.optics = opticsOf(haze);
        scene = scene.withOptics(options.optics);
        EXPECT_EQ(pictureOf(scene, options.camera).rgba, render(*volume, options).image.rgba)
            << haze;
    }
}

// A painter may clear all that classes show, and then leaves no words, nor looks.
TEST(Prepared, wordsThatWerePaintedAreNotShared) {
    RenderOptions options;
    options.optics = someOptics(Colors::kSeveral);
    options.camera = smallCamerasToo()[1];
    Optics faded = options.optics;
    faded.gradientOpacity = {{0, 0}};
    const PreparedScene scene({someVolume(), faded}, options.splat);
    const Image clear = pictureOf(scene, options.camera);
    const Image seen = pictureOf(scene.withOptics(options.optics), options.camera);
    EXPECT_NE(seen.rgba, clear.rgba);
    EXPECT_EQ(seen.rgba, render(*someVolume(), options).image.rgba);
}

// Also while none of the axes is there yet.
TEST(Prepared, anyNumberOfThreadsMayRenderOneScene) {
    const test::SmallJoined joined;
    for (const Colors colors :
         {Colors::kOne, Colors::kOwn, Colors::kLit, Colors::kFog, Colors::kFire}) {
        const PreparedScene scene({someVolume(), someOptics(colors)}, SplatOptions());
        const std::vector<CameraOptions> cameras = smallCamerasToo();
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

// Nor is anything seen in the longer steps of an oblique view that cannot be seen straight on.
TEST(Prepared, showsAsMuchAsRenderOfWhatIsHardlyThere) {
    constexpr int kFaint = 24;
    Optics optics = someOptics(Colors::kOne);
    optics.transferFunction.opacities = {{0, 1, 0.5, 0}};
    for (int i = 1; i <= kFaint; ++i)
        optics.transferFunction.opacities.push_back({double(i), std::exp2(-54 + 0.25 * i), 0.5, 0});
    // Stripes beside something opaque.
    const auto volume = std::make_shared<const Volume>(test::makeVolume(
        {{0, 0, 0}, {23, 8 * kFaint + 7, 0}}, [](int, int y, int) { return y / 8; }));
    const PreparedScene scene({volume, optics}, SplatOptions());
    RenderOptions options;
    options.optics = optics;
    options.camera.azimuthDegrees = 40;
    options.camera.sizePixels = {100, 200};
    EXPECT_EQ(pictureOf(scene, options.camera).rgba, render(*volume, options).image.rgba);
}

// Nor does what memory held before, and who else uses it.
TEST(Prepared, scenesKeepMemoryAndNothingElse) {
    const test::SmallJoined joined;
    for (const Colors colors : {Colors::kSeveral, Colors::kOwn, Colors::kFog, Colors::kFire,
                                Colors::kLit, Colors::kOne}) {
        const PreparedScene scene({someVolume(), someOptics(colors)}, SplatOptions());
        for (int round = 0; round < 2; ++round) {
            const std::vector<CameraOptions> cameras = smallCamerasToo();
            std::vector<Image> pictures(cameras.size());
            std::vector<std::thread> threads;
            for (std::size_t i = 0; i < cameras.size(); ++i) {
                threads.emplace_back([&, i] {
                    const Camera camera = cameraOf(*scene.scene().volume, cameras[i]);
                    pictures[i] = Image(camera.sizePixels);
                    scene.render(camera, pictures[i]);
                });
            }
            for (std::thread& thread : threads) thread.join();
            for (std::size_t i = 0; i < cameras.size(); ++i)
                EXPECT_EQ(pictures[i].rgba,
                          pictureOf(PreparedScene(scene.scene(), {}), cameras[i]).rgba)
                    << i;
        }
    }
}

// What was in the picture before makes no difference.
TEST(Prepared, picturesAreCleared) {
    const auto nothing = std::make_shared<const Volume>(
        test::makeVolume({{0, 0, 0}, {7, 7, 7}}, [](int, int, int) { return test::kInactive; }));
    const Optics optics = someOptics(Colors::kSeveral);
    Optics clear = optics;
    clear.transferFunction.opacities = {{0, 0, 0.5, 0}};
    for (const Scene& seen :
         {Scene{someVolume(), optics}, Scene{nothing, optics}, Scene{someVolume(), clear}}) {
        const PreparedScene scene(seen, SplatOptions());
        std::vector<CameraOptions> cameras = smallCamerasToo();
        CameraOptions beside;
        beside.targetWorld = glm::dvec3(500, 500, 500);
        beside.sizePixels = {60, 50};
        cameras.push_back(beside);
        for (const CameraOptions& options : cameras) {
            const Camera camera = cameraOf(*seen.volume, options);
            Image image(camera.sizePixels);
            std::fill(image.rgba.begin(), image.rgba.end(), 7.0f);
            scene.render(camera, image);
            EXPECT_EQ(image.rgba, pictureOf(scene, options).rgba);
        }
    }
}

TEST(Prepared, refusesWhatCannotBeMeant) {
    EXPECT_EQ(errorOf([] { PreparedScene({}, SplatOptions()); }),
              "usage: scene: got no volume; expected one");
    Optics none = someOptics(Colors::kOne);
    none.transferFunction.opacities.clear();
    EXPECT_EQ(errorOf([&] {
                  PreparedScene({someVolume(), none}, SplatOptions());
              }),
              "usage: transfer function's opacities: got none; expected at least one");
    const PreparedScene scene({someVolume(), someOptics(Colors::kOne)}, SplatOptions());
    const Camera camera = cameraOf(*scene.scene().volume, CameraOptions());
    Image small({100, 512});
    EXPECT_EQ(errorOf([&] { scene.render(camera, small); }),
              "usage: image: got 100x512 pixels, 204800 values; expected the camera's 512x512, "
              "four values "
              "each");
}

}  // namespace
}  // namespace deltasplat
