// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "formats/cameras/motion.h"
#include "unit/camera_helpers.h"

namespace deltasplat::test {
namespace {

std::string said(const std::string& text) {
    return complaint("shot.json", text);
}

FilmCamera still(const std::string& text) {
    const CameraMotion motion = motionOf("shot.json", text);
    EXPECT_TRUE(motion.frames.empty());
    return motion.at(7);
}

TEST(JsonCamera, EveryFieldCounts) {
    const FilmCamera film = still(R"({
        "projection": "perspective", "focal": 50, "aperture": [36, 24], "offset": [3.6, -2.4],
        "fit": "stretch", "pixel_aspect": 2, "near": 0.5, "far": 100, "size": [360, 240],
        "matrix": [[0, 0, -1, 0], [0, 1, 0, 0], [1, 0, 0, 0], [10, 0, 0, 1]]})");
    EXPECT_EQ(film.sizePixels, glm::ivec2(360, 240));
    EXPECT_EQ(film.nearWorld, 0.5);
    EXPECT_EQ(film.farWorld, 100);
    EXPECT_EQ(film.fit, FilmFit::kStretch);
    EXPECT_EQ(film.pixelAspect, 2);
    // From (10, 0, 0) along -x, the right is -z.
    const Camera camera = cameraFor(film, {360, 240});
    EXPECT_EQ(camera.direction, glm::dvec3(-1, 0, 0));
    expectPixel(camera, {0, 0.5, -1}, {194, 71});
}

TEST(JsonCamera, PlacesMayBeSaidInThreeWays) {
    const glm::dmat4 matrix =
        still(R"({"matrix": [0,0,-1,0, 0,1,0,0, 1,0,0,0, 10,2,3,1]})").worldFromCamera;
    for (const char* text : {R"({"eye": [10, 2, 3], "target": [0, 2, 3]})",
                             R"({"eye": [10, 2, 3], "direction": [-2, 0, 0], "up": [0, 5, 0]})",
                             R"({"translate": [10, 2, 3], "rotate": [0, 90, 0]})"}) {
        SCOPED_TRACE(text);
        const glm::dmat4 other = still(text).worldFromCamera;
        for (int i = 0; i < 4; ++i) EXPECT_LE(glm::distance(other[i], matrix[i]), 1e-15);
    }
}

TEST(JsonCamera, RotationsGoInTheOrderThatIsNamed) {
    // About x and then about y takes y to z and to x; the other way around y stays, then goes to z.
    const glm::dvec4 y(0, 1, 0, 0);
    const auto turned = [&](const std::string& order) {
        return still(R"({"translate": [0,0,0], "rotate": [90, 90, 0], "rotate_order": ")" + order +
                     "\"}")
                   .worldFromCamera *
               y;
    };
    EXPECT_EQ(turned("xyz"), glm::dvec4(1, 0, 0, 0));
    EXPECT_EQ(turned("zyx"), glm::dvec4(0, 0, 1, 0));
}

TEST(JsonCamera, KeysAreMixed) {
    const CameraMotion motion = motionOf("shot.json", R"({"aperture": 36, "keys": [
        {"frame": 10, "focal": 20, "translate": [0, 0, 0], "rotate": [0, 0, 0]},
        {"frame": 20, "focal": 40, "translate": [10, 0, 0], "rotate": [0, 80, 0]},
        {"frame": 21, "focal": 41, "translate": [10, 0, 1], "rotate": [0, 80, 0]}]})");
    EXPECT_EQ(motion.frames, (std::vector<double>{10, 20, 21}));
    const FilmCamera film = motion.at(12.5);
    EXPECT_EQ(film.focalMm, 25);
    EXPECT_EQ(film.apertureMm, glm::dvec2(36, 0));
    const glm::dmat4 expected = rotation({0, 20, 0}, "xyz");
    for (int i = 0; i < 3; ++i)
        EXPECT_LE(glm::distance(film.worldFromCamera[i], expected[i]), 1e-14);
    EXPECT_LE(glm::distance(film.worldFromCamera[3], glm::dvec4(2.5, 0, 0, 1)), 1e-15);
    // Before the first and behind the last they hold still; at keys they are those.
    EXPECT_EQ(motion.at(-5).focalMm, 20);
    EXPECT_EQ(motion.at(99).focalMm, 41);
    EXPECT_EQ(motion.at(20).worldFromCamera, motion.at(20 + 0.0).worldFromCamera);
    EXPECT_EQ(motion.at(21).worldFromCamera[3], glm::dvec4(10, 0, 1, 1));
}

TEST(JsonCamera, RotationsTakeTheShorterWay) {
    const glm::dmat4 a = rotation({0, 170, 0}, "xyz");
    const glm::dmat4 b = rotation({0, -170, 0}, "xyz");
    const glm::dmat4 half = mixed(a, b, 0.5);
    const glm::dmat4 expected = rotation({0, 180, 0}, "xyz");
    for (int i = 0; i < 3; ++i) EXPECT_LE(glm::distance(half[i], expected[i]), 1e-14);
    // All around, whichever number of the quaternion is the largest.
    for (int axis = 0; axis < 3; ++axis) {
        for (int degrees = -180; degrees <= 180; degrees += 15) {
            glm::dvec3 turn(0);
            turn[axis] = degrees;
            const glm::dmat4 first = rotation(turn, "xyz");
            turn[axis] = degrees + 30;
            const glm::dmat4 mid = mixed(first, rotation(turn, "xyz"), 0.5);
            turn[axis] = degrees + 15;
            for (int i = 0; i < 3; ++i)
                EXPECT_LE(glm::distance(mid[i], rotation(turn, "xyz")[i]), 1e-14);
        }
    }
}

TEST(JsonCamera, WhatIsWrongIsSaidWithItsLine) {
    const struct {
        const char* text;
        const char* said;
    } cases[] = {
        {"[1]", ":1: got an array; expected an object"},
        {"{", ":1: got the end of the file; expected valid JSON"},
        {"{}", ":1: got no place of the camera; expected \"matrix\", \"eye\" or \"translate\""},
        {"{\"focal\": 5,\n\"focall\": 5}", ":2: got \"focall\"; expected a field of a camera"},
        {"{\"focal\": \"5\"}", ":1: got \"5\" for \"focal\"; expected a number > 0"},
        {"{\"focal\": NaN}", ":1: got \"focal\": N; expected valid JSON"},
        {"{\"focal\": 1e999}", ":1: got 1e999; expected a finite number"},
        {"{\"focal\": 0}", ":1: got 0 for \"focal\"; expected a number > 0"},
        {"{\"focal\": 5, \"focal\": 6}", ":1: got \"focal\" twice; expected it once"},
        {"{\"aperture\": [36]}",
         ":1: got an array for \"aperture\"; expected a width, or a width and a height > 0"},
        {"{\"aperture\": [36, 0]}",
         ":1: got 36,0 for \"aperture\"; expected a width, or a width and a height > 0"},
        {"{\"size\": [10, 0.5]}",
         ":1: got 0.5 for \"size\"; expected two whole numbers from 1 to 2147483647"},
        {"{\"fit\": \"wide\"}",
         ":1: got \"wide\" for \"fit\"; expected one of horizontal, vertical, fill, overscan, "
         "stretch"},
        {"{\"projection\": 3}",
         ":1: got 3 for \"projection\"; expected one of ortho, perspective, latlong"},
        {"{\"matrix\": [1, 2]}",
         ":1: got an array for \"matrix\"; expected 16 numbers, or four rows of four"},
        {"{\"eye\": [0,0,0]}",
         ":1: got an eye that looks nowhere; expected one of \"target\" and \"direction\""},
        {"{\"target\": [0,0,0]}", ":1: got \"target\" without \"eye\"; expected \"eye\" besides"},
        {"{\"eye\": [0,0,0], \"direction\": [0,2,0]}",
         ":1: got a line of sight 0,2,0 along up 0,1,0; expected an up that differs from it"},
        {"{\"eye\": [0,0,0], \"matrix\": []}",
         ":1: got it and \"matrix\"; expected one place of the camera"},
        {"{\"keys\": []}", ":1: got no keys; expected a list of keys"},
        {"{\"keys\": [3]}", ":1: got 3; expected a key, an object"},
        {"{\"keys\": [{\"translate\": [0,0,0]}]}",
         ":1: got a key without \"frame\"; expected its number"},
        {"{\"keys\": [{\"frame\": 1}]}",
         ":1: got no place of the camera; expected \"matrix\", \"eye\" or \"translate\""},
        {"{\"keys\": [{\"frame\": 1, \"size\": 3}]}",
         ":1: got \"size\"; expected a field of a camera's key"},
        {"{\"translate\": [0,0,0], \"keys\": [{\"frame\": 2, \"focal\": 3},\n{\"frame\": 2, "
         "\"focal\": 3}]}",
         ":2: got 2 behind 2; expected frames that ascend"},
        {"{\"translate\": [0,0,0], \"keys\": [{\"frame\": 1, \"focal\": 3},\n{\"frame\": 2}]}",
         ":2: got a key without \"focal\"; expected it, as in the first key"},
        {"{\"translate\": [0,0,0], \"keys\": [{\"frame\": 1},\n{\"frame\": 2, \"focal\": 3}]}",
         ":2: got a key with \"focal\"; expected none, as in the first key"},
        {"{\"matrix\": [1,0,0,4, 0,1,0,5, 0,0,1,6, 0,0,0,1]}",
         ":1: matrix: got the translation in the last column; expected a rotation, perhaps evenly "
         "scaled, and a translation in the last row, row by row"},
        {"{\"matrix\": [-1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]}",
         ":1: matrix: got a mirrored one; expected a rotation, perhaps evenly scaled, and a "
         "translation in the last row, row by row"},
        {"{\"translate\": [0,0,0], \"near\": 100,\n\"far\": 100}",
         ":2: got 100 for \"far\"; expected more than \"near\", 100"},
    };
    for (const auto& one : cases) EXPECT_EQ(said(one.text), one.said) << one.text;
    const std::string more("{\"translate\": [0,0,0]}\n\0{", 25);
    EXPECT_EQ(said(more), ":2: got a byte that is 0; expected valid JSON");
}

}  // namespace
}  // namespace deltasplat::test
