// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <random>

#include "formats/cameras/motion.h"
#include "formats/usd/usd_scene.h"
#include "unit/camera_helpers.h"

namespace deltasplat::test {
namespace {

std::string said(const std::string& text, const std::string& prim = "") {
    return complaint("shot.usda", text, prim);
}

FilmCamera at(const std::string& text, double frame, const std::string& prim = "") {
    return motionOf("shot.usda", text, prim).at(frame);
}

std::string withCamera(const std::string& inside) {
    return "#usda 1.0\ndef Camera \"cam\" {\n" + inside + "\n}\n";
}

// As programs write it: comments, metadata, arrays, a relationship, several prims.
const std::string kScene = R"(#usda 1.0
(
    "a scene"
    defaultPrim = "World"
    upAxis = "Z"
    metersPerUnit = 0.01
    customLayerData = { string tool = "x } y" }
    subLayers = [ @./other.usda@ (offset = 2) ]
)

def Xform "World" (
    kind = "assembly"
    prepend references = @./set.usda@</Set>
)
{
    double3 xformOp:translate = (100, 0, 0) # to the side
    float xformOp:rotateZ:spin.timeSamples = { 1: 0, 11: 90, }
    uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:rotateZ:spin"]
    def Mesh "box" {
        point3f[] points = [(0, 0, 0), (1, 1, 1)] ( interpolation = "vertex" )
        int[] faceVertexCounts.timeSamples = { 1: [3, 3], 2: None }
        rel material:binding = </World/mat>
        color3f[] primvars:displayColor = [(1, 0, 0)] (
            interpolation = "constant"
        )
    }
    def Camera "cam"
    {
        float2 clippingRange = (0.5, 1000)
        float focalLength.timeSamples = { 1: 50, 11: 100 }
        float horizontalAperture = 36
        float verticalAperture = 24
        float horizontalApertureOffset = 3.6
        float verticalApertureOffset = -2.4
        token projection = "perspective"
        matrix4d xformOp:transform = ( (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 10, 1) )
        uniform token[] xformOpOrder = ["xformOp:transform"]
    }
    class Camera "none" {}
    def Camera "off" ( active = false ) {}
    over "cam2" {}
}
)";

TEST(UsdCamera, ASceneIsReadAsItStands) {
    std::vector<std::string> warnings;
    Listener listener;
    listener.warning = [&](const std::string& text) {
        warnings.push_back(text.substr(text.rfind(".usda")));
    };
    const CameraMotion motion = motionOf("shot.usda", kScene, "", listener);
    EXPECT_EQ(motion.frames, (std::vector<double>{1, 11}));
    EXPECT_EQ(motion.upWorld, glm::dvec3(0, 0, 1));
    EXPECT_EQ(warnings, (std::vector<std::string>{".usda: /: subLayers are not followed",
                                                  ".usda: /World: references are not followed"}));
    // As camera36 of film_camera_test.cpp, 100 to the side.
    const FilmCamera film = motion.at(1);
    EXPECT_EQ(film.nearWorld, 0.5);
    EXPECT_EQ(film.farWorld, 1000);
    expectPixel(cameraFor(film, {360, 240}), {101, 0.5, 0}, {194, 71});
    // A quarter turn about z later, with a lens twice as long; up is -x.
    const FilmCamera later = motion.at(11);
    EXPECT_EQ(later.focalMm, 100);
    expectPixel(cameraFor(later, {360, 240}), {99.75, 0.5, 0}, {194, 71});
    EXPECT_EQ(motion.at(6).focalMm, 75);
    const Camera half = cameraFor(motion.at(6), {360, 240});
    EXPECT_NEAR(half.right.x, std::sqrt(0.5), 1e-15);
    EXPECT_NEAR(half.right.y, std::sqrt(0.5), 1e-15);
}

TEST(UsdCamera, OpsApplyFromTheLastToTheFirst) {
    const FilmCamera film = at(withCamera(R"(
        double3 xformOp:translate = (1, 2, 3)
        double3 xformOp:translate:pivot = (5, 0, 0)
        float3 xformOp:rotateXYZ = (90, 0, 90)
        float3 xformOp:scale = (2, 2, 2)
        uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:translate:pivot",
            "xformOp:rotateXYZ", "xformOp:scale", "!invert!xformOp:translate:pivot"])"),
                               0);
    // (6, 1, 0) less the pivot is (1, 1, 0), scaled (2, 2, 0), about x (2, 0, 2), about z
    // (0, 2, 2), and moved (6, 4, 5).
    const glm::dvec4 point = film.worldFromCamera * glm::dvec4(6, 1, 0, 1);
    EXPECT_LE(glm::distance(point, glm::dvec4(6, 4, 5, 1)), 1e-14);
    const glm::dmat4 orient = at(withCamera("quatf xformOp:orient = (0.5, 0.5, 0.5, 0.5)\n"
                                            "uniform token[] xformOpOrder = [\"xformOp:orient\"]"),
                                 0)
                                  .worldFromCamera;
    EXPECT_EQ(orient * glm::dvec4(1, 0, 0, 0), glm::dvec4(0, 1, 0, 0));
    const glm::dmat4 zxy = at(withCamera("float3 xformOp:rotateZXY = (90, 0, 90)\n"
                                         "uniform token[] xformOpOrder = [\"xformOp:rotateZXY\"]"),
                              0)
                               .worldFromCamera;
    // x to y (about z), then y to z (about x).
    EXPECT_EQ(zxy * glm::dvec4(1, 0, 0, 0), glm::dvec4(0, 0, 1, 0));
}

TEST(UsdCamera, AStackThatIsResetForgetsWhatItStandsIn) {
    const std::string text = R"(#usda 1.0
def Xform "a" {
    double3 xformOp:translate = (100, 0, 0)
    uniform token[] xformOpOrder = ["xformOp:translate"]
    def Camera "cam" {
        double3 xformOp:translate = (1, 0, 0)
        uniform token[] xformOpOrder = ["!resetXformStack!", "xformOp:translate"]
    }
})";
    EXPECT_EQ(at(text, 0).worldFromCamera[3], glm::dvec4(1, 0, 0, 1));
}

TEST(UsdCamera, MatricesBetweenSamplesTurnWithoutShrinking) {
    const std::string text = withCamera(R"(
        matrix4d xformOp:transform.timeSamples = {
            0: ((1,0,0,0), (0,1,0,0), (0,0,1,0), (0,0,0,1)),
            10: ((0,0,-1,0), (0,1,0,0), (1,0,0,0), (4,0,0,1)),
        }
        uniform token[] xformOpOrder = ["xformOp:transform"])");
    const glm::dmat4 expected = rotation({0, 45, 0}, "xyz");
    const glm::dmat4 half = at(text, 5).worldFromCamera;
    for (int i = 0; i < 3; ++i) EXPECT_LE(glm::distance(half[i], expected[i]), 1e-14);
    EXPECT_LE(glm::distance(half[3], glm::dvec4(2, 0, 0, 1)), 1e-15);
}

TEST(UsdCamera, AParallelOneIsAsWideAsATenthOfItsAperture) {
    const std::string text = withCamera(R"(
        token projection = "orthographic"
        float horizontalAperture = 80
        float verticalAperture = 20
        double3 xformOp:scale = (3, 3, 3)
        uniform token[] xformOpOrder = ["xformOp:scale"])");
    const Camera camera = cameraFor(at(text, 0), {400, 100});
    EXPECT_DOUBLE_EQ(camera.frameWidthWorld, 24);
    // A picture of another shape holds all of the film.
    EXPECT_DOUBLE_EQ(cameraFor(at(text, 0), {800, 100}).frameWidthWorld, 48);
    EXPECT_DOUBLE_EQ(cameraFor(at(text, 0), {100, 100}).frameWidthWorld, 24);
}

TEST(UsdCamera, WhereAFileIsSilentTheSchemaSpeaks) {
    const FilmCamera film = at(withCamera(""), 3);
    EXPECT_EQ(film.focalMm, 50);
    EXPECT_EQ(film.apertureMm, glm::dvec2(20.955, 15.2908));
    EXPECT_EQ(film.worldFromCamera, glm::dmat4(1));
    EXPECT_EQ(film.projection, Projection::kPerspective);
    // What is blocked is as if it was not written.
    EXPECT_EQ(at(withCamera("float focalLength = 20\nfloat focalLength.timeSamples = {1: None}"), 3)
                  .focalMm,
              50);
}

TEST(UsdCamera, OneOfSeveralIsNamed) {
    const std::string text =
        "#usda 1.0\ndef \"w\" { def Camera \"a\" { float focalLength = 1 }\n"
        "def Camera \"b\" { float focalLength = 2 } }\ndef Camera \"c\" {}";
    EXPECT_EQ(at(text, 0, "/w/b").focalMm, 2);
    EXPECT_EQ(said(text),
              ": got 3 prims of type Camera; expected the path of one behind a colon: /w/a, /w/b, "
              "/c");
    EXPECT_EQ(said(text, "/w"), ": got 2 prims of type Camera; expected one of /w/a, /w/b, /c");
    EXPECT_EQ(said(text, "/d"),
              ": got no prim of type Camera at /d; expected one of /w/a, /w/b, /c");
    EXPECT_EQ(said("#usda 1.0\n"), ": got no prim of type Camera; expected at least one");
}

TEST(UsdCamera, WhatIsWrongIsSaidWithItsLine) {
    const struct {
        std::string text;
        const char* said;
    } cases[] = {
        {"", ":1: got nothing; expected #usda 1.0, USD's text"},
        {"PXR-USDC", ":1: got PXR-USDC; expected #usda 1.0, USD's text"},
        {"#usda 1.0\ndef Camera \"a\" {",
         ":2: got the end of the file; expected a type, def, over, "
         "class or }"},
        {"#usda 1.0\ndef Camera \"a {\n", ":2: got a text without an end; expected \""},
        {"#usda 1.0\nfloat x = 3", ":2: got float; expected def, over or class"},
        {"#usda 1.0\n(\n a = [1, (2]\n)", ":3: got ]; expected )"},
        {withCamera("float focalLength = (1, 2)"),
         ":3: got 2 values for focalLength; expected a finite number"},
        {withCamera("float focalLength = nan"),
         ":3: got nan for focalLength; expected a finite number"},
        {withCamera("float focalLength = -3"), ":3: got -3 for focalLength; expected a number > 0"},
        {withCamera("float focalLength = \"3\""),
         ":3: got \"3\" for focalLength; expected a finite number"},
        {withCamera("float focalLength = 3x"), ":4: got }; expected a property's name"},
        {withCamera("float focalLength.timeSamples = { x: 3 }"), ":3: got x:; expected a number"},
        {withCamera("float focalLength.timeSamples = { 1: 3, 2: 0 }"),
         ":3: got 0 for focalLength; expected a number > 0"},
        {withCamera("token projection = \"fisheye\""),
         ":3: got \"fisheye\" for projection; expected \"perspective\" or \"orthographic\""},
        {withCamera("float2 clippingRange = (5, 1)"),
         ":3: got 2 values for clippingRange; expected two ascending numbers >= 0"},
        {withCamera("uniform token[] xformOpOrder = [\"xformOp:translate\"]"),
         ":3: got xformOpOrder with xformOp:translate, which is not there; expected it in the same "
         "prim"},
        {withCamera("float xformOp:twist = 3\nuniform token[] xformOpOrder = [\"xformOp:twist\"]"),
         ":3: got xformOp:twist; expected a known xformOp"},
        {withCamera("double3 xformOp:translate = (1, inf, 2)\n"
                    "uniform token[] xformOpOrder = [\"xformOp:translate\"]"),
         ":3: got inf for xformOp:translate; expected 3 finite numbers"},
        {withCamera("double3 xformOp:scale = (1, 2, 1)\n"
                    "uniform token[] xformOpOrder = [\"xformOp:scale\"]"),
         ": /cam: got axes of the lengths 1,2,1; expected a rotation, perhaps evenly scaled, and a "
         "translation in the last row, row by row"},
        {"#usda 1.0\n( upAxis = \"X\" )\ndef Camera \"a\" {}",
         ":2: got \"X\" for upAxis; expected \"Y\" or \"Z\""},
    };
    for (const auto& one : cases) EXPECT_EQ(said(one.text), one.said) << one.text;
    std::string deep = "#usda 1.0\n";
    for (int i = 0; i < 100; ++i) deep += "def \"a\" {\n";
    EXPECT_EQ(said(deep), ":67: got more than 64 levels; expected fewer");
    EXPECT_EQ(said(withCamera("float a = " + std::string(10000, '('))),
              ":3: got more than 64 levels; expected fewer");
    EXPECT_NE(complaint("shot.usdc", "PXR-USDC").find("as usdcat -o x.usda writes it"),
              std::string::npos);
    EXPECT_NE(complaint("shot.json", "{}", "/a").find("got no .usda"), std::string::npos);
}

// Whatever stands in a file, it is read or refused.
TEST(UsdCamera, SpoiltScenesAreReadOrRefused) {
    for (std::size_t length = 0; length < kScene.size(); length += 7)
        said(kScene.substr(0, length), "/World/cam");
    std::mt19937 random(5);
    const std::string some = "(){}[]<>@\"'=:,;.#!0179-+eEnN \n\\\x80";
    for (int round = 0; round < 400; ++round) {
        std::string text = kScene;
        for (int i = 0; i < 3; ++i)
            text[10 + random() % (text.size() - 10)] = some[random() % some.size()];
        said(text);
    }
}

}  // namespace
}  // namespace deltasplat::test
