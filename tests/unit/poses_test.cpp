// SPDX-License-Identifier: Apache-2.0
// Poses of a C-arm against the closed form of where a marker's shadow falls on the detector.
#include "camera/poses.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <numbers>

#include "unit/camera_helpers.h"

namespace deltasplat::test {
namespace {

std::vector<CArmPose> posesOf(const std::string& text) {
    const TempFolder folder;
    std::ofstream(folder / "p.csv", std::ios::binary) << text;
    return readPoses(folder / "p.csv");
}

std::string said(const std::string& text) {
    try {
        posesOf(text);
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::kInput);
        const std::string what = error.what();
        return what.substr(what.find("p.csv") + 5);
    }
    return "";
}

const std::string kNames = "primary,secondary,sid,sdd,pixel\n";

// In a patient's coordinates (x to the left, y to the back, z up): the marker's shadow, in pixels
// to the right of and below the corner, from the way of the beam alone.
glm::dvec2 shadowOf(const CArmPose& pose, const glm::dvec3& marker, glm::ivec2 size) {
    const double p = pose.primaryDegrees * std::numbers::pi / 180;
    const double s = pose.secondaryDegrees * std::numbers::pi / 180;
    const glm::dvec3 beam(std::sin(p) * std::cos(s), -std::cos(p) * std::cos(s), std::sin(s));
    const glm::dvec3 right(-std::cos(p), -std::sin(p), 0);
    const glm::dvec3 up(-std::sin(p) * std::sin(s), std::cos(p) * std::sin(s), std::cos(s));
    const glm::dvec3 fromSource = marker + pose.sourceToIsocenter * beam;
    const double scale = pose.sourceToDetector / (pose.pixel * glm::dot(fromSource, beam));
    return glm::dvec2(size) / 2.0 +
           scale * glm::dvec2(glm::dot(fromSource, right), -glm::dot(fromSource, up));
}

constexpr glm::ivec2 kSize{640, 480};
const glm::dvec3 kIsocenter(30, -20, 500);

// @param space  of the world
Camera cameraAt(const CArmPose& pose, const std::string& space) {
    CameraOptions options;
    options.sizePixels = kSize;
    const glm::dvec3& c = kIsocenter;
    options.targetWorld = space == "LPS"   ? c
                          : space == "RAS" ? glm::dvec3(-c.x, -c.y, c.z)
                                           : glm::dvec3(c.x, c.z, -c.y);
    applyPose(pose, options);
    return makeCamera(options, {glm::ivec3(0), glm::ivec3(9)}, glm::dmat4(1), space);
}

TEST(Poses, AMarkersShadowFallsWhereTheFormulaSays) {
    const std::vector<CArmPose> poses = posesOf(kNames +
                                                "0,0,750,1100,0.8\n"
                                                "30,0,750,1100,0.8\n"
                                                "-45,20,700,1000,0.5\n"
                                                "90,-35,810,1205.5,0.308\n"
                                                "-120,89,750,750,0.8\n"
                                                "180,0,750,1100,0.8\n");
    ASSERT_EQ(poses.size(), 6U);
    for (const CArmPose& pose : poses) {
        for (const glm::dvec3& marker : {glm::dvec3(0), glm::dvec3(50, 0, 0), glm::dvec3(0, -70, 0),
                                         glm::dvec3(0, 0, 60), glm::dvec3(-31, 44, -17)}) {
            const glm::dvec2 expected = shadowOf(pose, marker, kSize);
            const glm::dvec3 m = kIsocenter + marker;
            expectPixel(cameraAt(pose, "LPS"), m, expected, 1e-8);
            expectPixel(cameraAt(pose, "RAS"), {-m.x, -m.y, m.z}, expected, 1e-8);
            // Of no patient's space: y up, z to the front, x to the left.
            expectPixel(cameraAt(pose, ""), {m.x, m.z, -m.y}, expected, 1e-8);
        }
    }
}

// Seen from the source behind the patient, the left side is on the left.
TEST(Poses, AnglesCountAsDicomHasThem) {
    const auto sourceOf = [](double primary, double secondary) {
        const Camera camera = cameraAt({primary, secondary, 750, 1100, 0.8}, "LPS");
        return camera.eyeWorld() - kIsocenter;
    };
    const auto expectNear = [](const glm::dvec3& got, const glm::dvec3& expected) {
        EXPECT_LE(glm::distance(got, expected), 1e-9) << got.x << ' ' << got.y << ' ' << got.z;
    };
    expectNear(sourceOf(0, 0), {0, 750, 0});    // behind
    expectNear(sourceOf(90, 0), {-750, 0, 0});  // LAO: the detector at the left, the source right
    expectNear(sourceOf(-90, 0), {750, 0, 0});  // RAO
    expectNear(sourceOf(0, 90), {0, 0, -750});  // CRA: the detector at the head
    expectNear(sourceOf(0, -90), {0, 0, 750});  // CAU
    const Camera camera = cameraAt({0, 0, 750, 1100, 0.8}, "LPS");
    EXPECT_LT(camera.pixelFromWorld(kIsocenter + glm::dvec3(10, 0, 0)).x, kSize.x / 2);
    EXPECT_LT(camera.pixelFromWorld(kIsocenter + glm::dvec3(0, 0, 10)).y, kSize.y / 2);
    // 1 mm at the isocenter is 1100 / 750 mm on the detector.
    EXPECT_NEAR(camera.pixelWorld(), 0.8 * 750 / 1100, 1e-12);
}

TEST(Poses, ColumnsStandInAnyOrder) {
    const std::vector<CArmPose> poses = posesOf(
        "\xEF\xBB\xBF# a run\r\n sdd , primary,sid,pixel,secondary\r\n\r\n"
        "1000, -1.5e1, 800, .25,5\r\n# the end");
    ASSERT_EQ(poses.size(), 1U);
    EXPECT_EQ(poses[0].primaryDegrees, -15);
    EXPECT_EQ(poses[0].secondaryDegrees, 5);
    EXPECT_EQ(poses[0].sourceToIsocenter, 800);
    EXPECT_EQ(poses[0].sourceToDetector, 1000);
    EXPECT_EQ(poses[0].pixel, 0.25);
}

TEST(Poses, WhatIsWrongIsSaidWithItsLine) {
    const std::string names = "primary,secondary,sid,sdd,pixel";
    EXPECT_EQ(said(""), ":1: got nothing; expected a line " + names);
    EXPECT_EQ(said("# no more\n"), ":1: got nothing; expected a line " + names);
    EXPECT_EQ(said(kNames + "\n\n"), ":3: got no poses; expected a line for each frame");
    EXPECT_EQ(said("primary,sid,sdd,pixel\n0,1,2,1\n"),
              ":1: got no column \"secondary\"; expected " + names);
    EXPECT_EQ(said("primary,primary\n"), ":1: got two columns \"primary\"; expected " + names);
    EXPECT_EQ(said("LAO\n"), ":1: got a column \"LAO\"; expected " + names);
    EXPECT_EQ(said(kNames + "0,0,1,2\n"), ":2: got 4 numbers; expected 5, one for each column");
    EXPECT_EQ(said(kNames + "0,0,1,2,1\n0,0,1,2,1,\n"),
              ":3: got 6 numbers; expected 5, one for each column");
    const std::string degrees = "; expected degrees, a number from -360 to 360";
    for (const std::string angle : {"", "x", "nan", "361", "1 2", "1e999", "0x10"})
        EXPECT_EQ(said(kNames + angle + ",0,1,2,1\n"),
                  ":2: got \"" + angle + "\" for primary" + degrees);
    const std::string length = "; expected mm, a number > 0";
    for (const std::string mm : {"0", "-1", "inf", "-nan", "1e10"})
        EXPECT_EQ(said(kNames + "0,0," + mm + ",2,1\n"), ":2: got \"" + mm + "\" for sid" + length);
    EXPECT_EQ(said(kNames + "0,0,2,1,1\n"), ":2: got an sdd of 1; expected at least the sid, 2");
    EXPECT_EQ(said(kNames + "\x1b[2J,0,1,2,1\n"), ":2: got \"?[2J\" for primary" + degrees);
}

}  // namespace
}  // namespace deltasplat::test
