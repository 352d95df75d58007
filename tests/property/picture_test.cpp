// SPDX-License-Identifier: Apache-2.0
// Pictures shown part by part, and beyond their frame.
#include "deltasplat/picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "deltasplat/error.h"
#include "deltasplat/optics/transfer_function.h"
#include "deltasplat/render.h"
#include "support/error_of.h"
#include "support/same_picture.h"
#include "support/some_scene.h"

namespace deltasplat {
namespace {

using test::Colors;
using test::errorOf;

// Puts a picture together of parts.
Image joined(Picture& picture, const std::vector<PixelBox>& parts) {
    Image whole(picture.camera().sizePixels);
    for (const PixelBox& part : parts) {
        Image image(part.size());
        picture.show(part, image);
        for (int y = 0; y < image.size.y; ++y) {
            const float* row = image.pixel(0, y);
            std::copy(row, row + 4 * image.size.x, whole.pixel(part.min.x, part.min.y + y));
        }
    }
    return whole;
}

// Cuts a box in two, and the halves in turn, anywhere.
void cut(const PixelBox& box, int depth, std::mt19937& random, std::vector<PixelBox>& parts) {
    const int axis = int(random() % 2);
    if (depth == 0 || box.size()[axis] < 2) {
        parts.push_back(box);
        return;
    }
    PixelBox low = box, high = box;
    const int place = box.min[axis] + 1 + int(random() % unsigned(box.size()[axis] - 1));
    low.max[axis] = high.min[axis] = place;
    cut(low, depth - 1, random, parts);
    cut(high, depth - 1, random, parts);
}

TEST(Picture, hasTheBitsOfTheWhole) {
    std::mt19937 random(4);
    for (const auto& [colors, filter] : {std::pair(Colors::kOne, PictureFilter::kBox),
                                         std::pair(Colors::kSeveral, PictureFilter::kCatmullRom),
                                         std::pair(Colors::kLit, PictureFilter::kMitchell),
                                         std::pair(Colors::kFog, PictureFilter::kGauss)}) {
        SplatOptions splatting;
        splatting.filter = filter;
        const PreparedScene scene({test::someVolume(), test::someOptics(colors)}, splatting);
        for (const CameraOptions& options : test::someCameras()) {
            const Image whole = test::pictureOf(scene, options);
            const Camera camera = test::cameraOf(*scene.scene().volume, options);
            Picture picture(scene, camera);
            std::vector<PixelBox> parts;
            cut({{0, 0}, camera.sizePixels}, 5, random, parts);
            EXPECT_GT(parts.size(), 8u);
            EXPECT_EQ(joined(picture, parts).rgba, whole.rgba);
        }
    }
}

// Far away, and from near: filters are wide, or all is within a few voxels.
TEST(Picture, hasTheBitsOfTheWholeAtAnySize) {
    std::mt19937 random(9);
    const PreparedScene scene({test::someVolume(), test::someOptics(Colors::kSeveral)}, {});
    for (const double width : {3.0, 900.0}) {
        CameraOptions options = test::someCameras()[3];
        options.frameWidthWorld = width;
        const Image whole = test::pictureOf(scene, options);
        Picture picture(scene, test::cameraOf(*scene.scene().volume, options));
        std::vector<PixelBox> parts;
        cut({{0, 0}, options.sizePixels}, 6, random, parts);
        EXPECT_EQ(joined(picture, parts).rgba, whole.rgba);
    }
}

TEST(Picture, isTheSameHoweverItIsMade) {
    for (const int number : {1, 6, 8}) {
        const CameraOptions options = test::someCameras()[std::size_t(number)];
        test::expectTheSameHoweverMade([&](Method method) {
            SplatOptions splat;
            splat.method = method;
            const PreparedScene scene({test::someVolume(), test::someOptics(Colors::kSeveral)},
                                      splat);
            Picture picture(scene, test::cameraOf(*scene.scene().volume, options));
            Image part({41, 23});
            picture.show({{29, 17}, {70, 40}}, part);
            return part.rgba;
        });
    }
}

TEST(Picture, knowsHowFarItMayBeOff) {
    SplatOptions splat;
    splat.tolerance.relative = 0.05;
    const PreparedScene scene({test::someVolume(), test::someOptics(Colors::kSeveral)}, splat);
    for (const int number : {2, 5}) {
        const Camera camera =
            test::cameraOf(*scene.scene().volume, test::someCameras()[std::size_t(number)]);
        Image whole(camera.sizePixels);
        const RenderStats stats = scene.render(camera, whole);
        Picture picture(scene, camera);
        EXPECT_EQ(picture.stats().errorBoundColor, 0);
        picture.show({{0, 0}, camera.sizePixels}, whole);
        EXPECT_GT(stats.errorBoundColor, 0);
        EXPECT_EQ(picture.stats().errorBoundColor, stats.errorBoundColor);
        EXPECT_EQ(picture.stats().errorBoundAlpha, stats.errorBoundAlpha);
        EXPECT_EQ(picture.stats().stamps, stats.stamps);
    }
}

TEST(Picture, refusesWhatIsNoPart) {
    const PreparedScene scene({test::someVolume(), test::someOptics(Colors::kOne)}, {});
    Picture picture(scene, test::cameraOf(*scene.scene().volume, test::someCameras()[0]));
    Image image({10, 10});
    EXPECT_EQ(
        errorOf([&] {
            picture.show({{85, 0}, {95, 10}}, image);
        }),
        "usage: part of a picture: got 10x10 pixels from 85,0 on; expected some of its 90x70");
    EXPECT_EQ(errorOf([&] {
                  picture.show({{0, 0}, {10, 11}}, image);
              }),
              "usage: image: got 10x10 pixels; expected 10x11, those of the part");
}

// What lies within the frame is the picture without overscan, but for rounding.
TEST(Overscan, goesOnBeyondTheFrame) {
    const PreparedScene scene({test::someVolume(), test::someOptics(Colors::kSeveral)}, {});
    for (int number = 0; number < 8; ++number) {
        CameraOptions options = test::someCameras()[std::size_t(number)];
        options.frameWidthWorld.reset();
        if (number < 4) options.frameWidthWorld = 20;
        const Image plain = test::pictureOf(scene, options);
        const Camera frame = test::cameraOf(*scene.scene().volume, options);
        options.overscanPixels = {13, 8};
        const Camera camera = test::cameraOf(*scene.scene().volume, options);
        EXPECT_EQ(camera.sizePixels, glm::ivec2(90 + 26, 70 + 16));
        EXPECT_EQ(camera.withoutOverscan().sizePixels, frame.sizePixels);
        EXPECT_NEAR(camera.withoutOverscan().frameWidthWorld, frame.frameWidthWorld, 1e-12);
        const Image wide = test::pictureOf(scene, options);
        double squares = 0;
        double largest = 0;
        double beyond = 0;
        for (int y = 0; y < wide.size.y; ++y) {
            for (int x = 0; x < wide.size.x; ++x) {
                const glm::ivec2 place = glm::ivec2(x, y) - options.overscanPixels;
                const bool isWithin = place.x >= 0 && place.y >= 0 && place.x < 90 && place.y < 70;
                if (!isWithin) beyond += wide.pixel(x, y)[3];
                for (int c = 0; isWithin && c < 4; ++c) {
                    const double error =
                        double(wide.pixel(x, y)[c]) - plain.pixel(place.x, place.y)[c];
                    squares += error * error;
                    largest = std::max(largest, std::abs(error));
                }
            }
        }
        EXPECT_LT(std::sqrt(squares / double(plain.rgba.size())), 1e-5) << number;
        EXPECT_LT(largest, 1e-3) << number;
        if (number < 4) {
            EXPECT_GT(beyond, 10) << number;
        }
        // A world point is where it is in the frame.
        const glm::dvec4 world(12, 15, 10, 1);
        const glm::dvec4 a = frame.ndcFromWorld() * world;
        const glm::dvec4 b = camera.ndcFromWorld() * world;
        for (int c = 0; c < 4; ++c) EXPECT_NEAR(a[c], b[c], 1e-12 * std::max(1.0, std::abs(a[c])));
        const glm::dvec2 pixel = camera.pixelFromWorld(glm::dvec3(world));
        EXPECT_NEAR(pixel.x - 13, 90 * b.x / b.w, 1e-9);
        EXPECT_NEAR(pixel.y - 8, 70 * b.y / b.w, 1e-9);
    }
}

TEST(Overscan, isRefusedWhereThereIsNone) {
    CameraOptions options = test::someCameras()[8];
    options.overscanPixels = {1, 0};
    const auto volume = test::someVolume();
    EXPECT_EQ(errorOf([&] { test::cameraOf(*volume, options); }),
              "usage: `overscanPixels`: got `projection` latlong; expected `projection` ortho or "
              "perspective");
    options = test::someCameras()[0];
    options.overscanPixels = {0, -1};
    EXPECT_EQ(errorOf([&] { test::cameraOf(*volume, options); }),
              "usage: `overscanPixels`: got 0,-1; expected two numbers within 0..1000000");
}

// What the program makes of a volume if nothing is asked for.
TEST(Picture, nobodyHasToSayHow) {
    const std::shared_ptr<const Volume> some = test::someVolume();
    const Volume& volume = *some;
    RenderOptions options;
    options.optics.transferFunction = defaultRamp(volume);
    options.splat.mostJoined = kMostJoined;
    EXPECT_EQ(render(volume).image.rgba, render(volume, options).image.rgba);
    EXPECT_EQ(render(volume).camera.sizePixels, glm::ivec2(512));
}

}  // namespace
}  // namespace deltasplat
