// SPDX-License-Identifier: Apache-2.0
// Pixels, reckoned by hand: so many mm on the film are so many pixels.
#include "deltasplat/view/film_camera.h"

#include <cmath>
#include <functional>
#include <limits>

#include "unit/camera_helpers.h"

namespace deltasplat::test {
namespace {

const double kNan = std::numeric_limits<double>::quiet_NaN();

// At (0, 0, 10), looking along -z; 1 mm is 10 pixels of a picture of 360x240.
FilmCamera camera36() {
    FilmCamera film;
    film.worldFromCamera[3] = {0, 0, 10, 1};
    film.focalMm = 50;
    film.apertureMm = {36, 24};
    return film;
}

TEST(FilmCamera, ALengthAcrossIsSoManyMillimetresOnTheFilm) {
    const Camera camera = cameraFor(camera36(), {360, 240});
    // 1 of 10 units aside is 5 of 50 mm, 50 pixels.
    expectPixel(camera, {1, 0.5, 0}, {230, 95});
    expectPixel(camera, {0, 0, -90}, {180, 120});
    expectPixel(camera, {1, 0, 5}, {280, 120});
    EXPECT_EQ(camera.eyeWorld(), glm::dvec3(0, 0, 10));
}

TEST(FilmCamera, AShiftedFilmSeesMoreOfWhereItIsShifted) {
    FilmCamera film = camera36();
    film.offsetMm = {3.6, -2.4};
    // The middle lies 36 pixels to the right of and 24 below where the line of sight goes.
    const Camera camera = cameraFor(film, {360, 240});
    expectPixel(camera, {0, 0, 0}, {144, 96});
    expectPixel(camera, {1, 0.5, 0}, {194, 71});
    const glm::dvec2 offset = camera.frameOffset();
    EXPECT_NEAR(offset.x, 0.1, 1e-15);
    EXPECT_NEAR(offset.y, -0.1, 1e-15);
}

TEST(FilmCamera, AParallelPictureWithWidePixels) {
    FilmCamera film;
    film.projection = Projection::kOrtho;
    film.worldFromCamera[3] = {0, 0, 10, 1};
    film.frameWidthWorld = 8;
    film.pixelAspect = 2;
    film.offsetMm = {-9, 0};  // of 36, a quarter
    // Pixels are 0.02 wide and 0.01 high.
    const Camera camera = cameraFor(film, {400, 100});
    expectPixel(camera, {1, 0.25, -7}, {200 + 100 + 50, 50 - 25});
    EXPECT_EQ(camera.eyeWorld(), glm::dvec3(0, 0, 10));
    EXPECT_DOUBLE_EQ(camera.frameHeightWorld(), 1);
}

TEST(FilmCamera, FilmsOfOtherShapesFitAsTheyAreToldTo) {
    // A square picture of a film back of 36 x 24.
    const struct {
        FilmFit fit;
        double widthMm, heightMm;
    } fits[] = {{FilmFit::kHorizontal, 36, 36},
                {FilmFit::kVertical, 24, 24},
                {FilmFit::kFill, 24, 24},
                {FilmFit::kOverscan, 36, 36},
                {FilmFit::kStretch, 36, 24}};
    for (const auto& one : fits) {
        SCOPED_TRACE(filmFitName(one.fit));
        FilmCamera film = camera36();
        film.fit = one.fit;
        film.offsetMm = {1, 2};
        const Camera camera = cameraFor(film, {240, 240});
        const glm::dvec2 pixels(240 / one.widthMm, 240 / one.heightMm);
        expectPixel(camera, {1, 0.5, 0}, {120 + (5 - 1) * pixels.x, 120 - (2.5 - 2) * pixels.y});
    }
    // One as high as wide, of a picture that is wider.
    FilmCamera high = camera36();
    high.apertureMm = {30, 30};
    high.fit = FilmFit::kFill;
    expectPixel(cameraFor(high, {300, 100}), {1, 0, 0}, {150 + 50, 50});
    high.fit = FilmFit::kOverscan;
    expectPixel(cameraFor(high, {300, 100}), {1, 0, 0}, {150 + 5 * 100 / 30.0, 50});
    // A parallel one is fitted as well.
    high.projection = Projection::kOrtho;
    high.frameWidthWorld = 6;
    expectPixel(cameraFor(high, {300, 100}), {1, 0, 0}, {150 + 100 / 6.0, 50});
}

TEST(FilmCamera, MatricesTurnMoveAndScale) {
    // Looks along +x, with z up, from (5, 0, 0), in a space twice as large.
    FilmCamera film = camera36();
    film.worldFromCamera = {{0, -2, 0, 0}, {0, 0, 2, 0}, {-2, 0, 0, 0}, {5, 0, 0, 1}};
    film.nearWorld = 3;
    const Camera camera = cameraFor(film, {360, 240});
    EXPECT_EQ(camera.direction, glm::dvec3(1, 0, 0));
    EXPECT_EQ(camera.up, glm::dvec3(0, 0, 1));
    EXPECT_EQ(camera.right, glm::dvec3(0, -1, 0));
    EXPECT_EQ(camera.nearWorld, 6);
    expectPixel(camera, {15, -1, 0.5}, {230, 95});
    film.projection = Projection::kOrtho;
    film.frameWidthWorld = 8;
    EXPECT_EQ(cameraFor(film, {360, 240}).frameWidthWorld, 16);
}

TEST(FilmCamera, WhatIsStoredInPicturesSaysTheSame) {
    FilmCamera film = camera36();
    film.offsetMm = {3, 5};
    film.pixelAspect = 1.5;
    for (const Projection projection : {Projection::kOrtho, Projection::kPerspective}) {
        film.projection = projection;
        const Camera camera = cameraFor(film, {90, 70});
        const glm::dvec3 world(0.7, -0.3, 2);
        const glm::dvec4 ndc = camera.ndcFromWorld() * glm::dvec4(world, 1);
        expectPixel(camera, world, glm::dvec2(ndc) / ndc.w * glm::dvec2(90, 70));
        const glm::dvec2 pixel = camera.pixelFromWorld(world);
        expectPixel(camera, camera.worldFromPixel(pixel), pixel);
        const bool isFlat = projection == Projection::kPerspective;
        expectPixel(camera,
                    (isFlat ? camera.eyeWorld() : camera.worldFromPixel(pixel)) +
                        3.0 * camera.rayThrough(pixel),
                    pixel);
    }
}

TEST(FilmCamera, MatricesThatAreNoCamerasAreRefused) {
    const struct {
        const char* said;
        std::function<void(glm::dmat4&)> spoil;
    } cases[] = {
        {"not finite", [](glm::dmat4& m) { m[1][2] = kNan; }},
        {"a projection", [](glm::dmat4& m) { m[2][3] = 1; }},
        {"the translation in the last column",
         [](glm::dmat4& m) {
             m[3] = {0, 0, 0, 1};
             m[1][3] = 4;
         }},
        {"axes of the lengths 1,0,1",
         [](glm::dmat4& m) {
             m[1] = {0, 0, 0, 0};
         }},
        {"singular", [](glm::dmat4& m) { m[1] = m[0]; }},
        {"a singular matrix", [](glm::dmat4& m) { m = glm::dmat4(0); }},
        {"mirrored", [](glm::dmat4& m) { m[0] = -m[0]; }},
        {"right angles", [](glm::dmat4& m) { m[0][1] = 0.01; }},
        {"axes of the lengths 1,1,1.01", [](glm::dmat4& m) { m[2] *= 1.01; }},
    };
    for (const auto& one : cases) {
        SCOPED_TRACE(one.said);
        FilmCamera film = camera36();
        one.spoil(film.worldFromCamera);
        try {
            cameraFor(film, {8, 8});
            ADD_FAILURE();
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::kUsage);
            EXPECT_NE(std::string(error.what()).find(one.said), std::string::npos) << error.what();
        }
    }
    // What three digits leave is mended.
    FilmCamera film = camera36();
    film.worldFromCamera[0] = {0.707, 0, -0.707, 0};
    film.worldFromCamera[2] = {0.707, 0, 0.7075, 0};
    const Camera camera = cameraFor(film, {8, 8});
    EXPECT_NEAR(glm::length(camera.right), 1, 1e-15);
    EXPECT_NEAR(glm::dot(camera.right, camera.direction), 0, 1e-15);
}

TEST(FilmCamera, NumbersOutOfRangeAreRefused) {
    const std::function<void(FilmCamera&)> spoils[] = {
        [](FilmCamera& film) { film.focalMm = 0; },
        [](FilmCamera& film) { film.focalMm = kNan; },
        [](FilmCamera& film) { film.apertureMm.x = -1; },
        [](FilmCamera& film) { film.apertureMm.y = kNan; },
        [](FilmCamera& film) { film.offsetMm.y = kNan; },
        [](FilmCamera& film) { film.offsetMm.x = 1e6; },
        [](FilmCamera& film) { film.pixelAspect = 0; },
        [](FilmCamera& film) { film.pixelAspect = 1e3; },
        [](FilmCamera& film) { film.frameWidthWorld = 0; },
        [](FilmCamera& film) { film.nearWorld = -1; },
    };
    for (const auto& spoil : spoils) {
        FilmCamera film = camera36();
        spoil(film);
        EXPECT_THROW(cameraFor(film, {8, 8}), Error);
    }
    CameraOptions options;
    options.worldFromCamera = glm::dmat4(1);
    options.targetWorld = glm::dvec3(0);
    EXPECT_THROW(makeCamera(options, {}, glm::dmat4(1)), Error);
    CameraOptions panorama;
    panorama.projection = Projection::kLatlong;
    panorama.sizePixels = {16, 8};
    EXPECT_NO_THROW(makeCamera(panorama, {}, glm::dmat4(1)));
    panorama.pixelAspect = 2;
    EXPECT_THROW(makeCamera(panorama, {}, glm::dmat4(1)), Error);
}

}  // namespace
}  // namespace deltasplat::test
