// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/view/camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "deltasplat/error.h"

namespace deltasplat {
namespace {

const IndexBox kBox{{-3, 2, 5}, {7, 10, 11}};
const glm::dmat4 kUnit(1);

void expectNear(const glm::dvec3& a, const glm::dvec3& b, double within = 1e-12) {
    EXPECT_LE(glm::distance(a, b), within)
        << a.x << ' ' << a.y << ' ' << a.z << " and " << b.x << ' ' << b.y << ' ' << b.z;
}

Camera cameraOf(const std::function<void(CameraOptions&)>& set, const IndexBox& box = kBox,
                const glm::dmat4& worldFromIndex = kUnit) {
    CameraOptions options;
    set(options);
    return makeCamera(options, box, worldFromIndex);
}

TEST(Camera, namedViewsLookWhereTheySay) {
    const struct {
        const char* name;
        glm::dvec3 direction, right, up;
    } views[] = {
        {"front", {0, 0, -1}, {1, 0, 0}, {0, 1, 0}}, {"back", {0, 0, 1}, {-1, 0, 0}, {0, 1, 0}},
        {"left", {1, 0, 0}, {0, 0, 1}, {0, 1, 0}},   {"right", {-1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
        {"top", {0, -1, 0}, {1, 0, 0}, {0, 0, -1}},  {"bottom", {0, 1, 0}, {1, 0, 0}, {0, 0, 1}},
    };
    for (const auto& view : views) {
        SCOPED_TRACE(view.name);
        const Camera camera = cameraOf([&](CameraOptions& o) { o.view = view.name; });
        EXPECT_EQ(camera.direction, view.direction);
        EXPECT_EQ(camera.right, view.right);
        EXPECT_EQ(camera.up, view.up);
    }
    const Camera iso = cameraOf([](CameraOptions& o) { o.view = "iso"; });
    expectNear(iso.direction, glm::dvec3(-1) / std::sqrt(3.0));
    expectNear(iso.right, glm::dvec3(1, 0, -1) / std::sqrt(2.0));
    expectNear(iso.up, glm::dvec3(-1, 2, -1) / std::sqrt(6.0));
}

TEST(Camera, quarterTurnsLeadExactlyToTheNamedViews) {
    const struct {
        double azimuth, elevation, roll;
        const char* same;
    } turns[] = {{90, 0, 0, "right"},  {180, 0, 0, "back"},  {-90, 0, 0, "left"},
                 {270, 0, 0, "left"},  {360, 0, 0, "front"}, {0, 90, 0, "top"},
                 {0, -90, 0, "bottom"}};
    for (const auto& turn : turns) {
        SCOPED_TRACE(turn.same);
        const Camera turned = cameraOf([&](CameraOptions& o) {
            o.azimuthDegrees = turn.azimuth;
            o.elevationDegrees = turn.elevation;
        });
        const Camera named = cameraOf([&](CameraOptions& o) { o.view = turn.same; });
        EXPECT_EQ(turned.direction, named.direction);
        EXPECT_EQ(turned.right, named.right);
        EXPECT_EQ(turned.up, named.up);
    }
}

TEST(Camera, anglesTurnTheCameraAsVtkDoes) {
    const double rest = std::sqrt(0.75);
    const Camera azimuth = cameraOf([](CameraOptions& o) { o.azimuthDegrees = 30; });
    expectNear(-azimuth.direction, {0.5, 0, rest});  // the camera moved to its right
    expectNear(azimuth.up, {0, 1, 0});
    const Camera elevation = cameraOf([](CameraOptions& o) { o.elevationDegrees = 30; });
    expectNear(-elevation.direction, {0, 0.5, rest});  // the camera rose
    expectNear(elevation.up, {0, rest, -0.5});
    const Camera roll = cameraOf([](CameraOptions& o) { o.rollDegrees = 30; });
    expectNear(roll.direction, {0, 0, -1});
    expectNear(roll.up, {0.5, rest, 0});  // its head went to the right
    expectNear(roll.right, {rest, -0.5, 0});
}

TEST(Camera, azimuthTurnsAboutTheUpThatWasGiven) {
    const Camera camera = cameraOf([](CameraOptions& o) {
        o.direction = glm::dvec3(0, -1, -1);
        o.azimuthDegrees = 90;
    });
    expectNear(camera.direction, glm::dvec3(-1, -1, 0) / std::sqrt(2.0));
    expectNear(camera.right, {0, 0, -1});
}

TEST(Camera, axesAreARightHandedOrthonormalBasis) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> number(-1, 1);
    for (int i = 0; i < 200; ++i) {
        const Camera camera = cameraOf([&](CameraOptions& o) {
            o.direction = glm::dvec3(number(random), number(random), number(random)) * 1e200;
            o.up = glm::dvec3(number(random), number(random), number(random)) * 1e-200;
            o.azimuthDegrees = 400 * number(random);
            o.elevationDegrees = 400 * number(random);
            o.rollDegrees = 400 * number(random);
        });
        expectNear(glm::cross(camera.right, camera.up), -camera.direction, 1e-9);
        EXPECT_NEAR(glm::length(camera.right), 1, 1e-9);
        EXPECT_NEAR(glm::length(camera.up), 1, 1e-9);
        EXPECT_NEAR(glm::dot(camera.right, camera.up), 0, 1e-9);
    }
}

TEST(Camera, pixelsStartTopLeftAndTheTargetIsInTheMiddle) {
    const Camera camera = cameraOf([](CameraOptions& o) {
        o.targetWorld = glm::dvec3(10, 20, 30);
        o.frameWidthWorld = 8;
        o.sizePixels = {4, 2};
    });
    expectNear(camera.worldFromPixel({2, 1}), {10, 20, 30});
    expectNear(camera.worldFromPixel({0, 0}), {6, 22, 30});
    expectNear(camera.worldFromPixel({4, 2}), {14, 18, 30});
    EXPECT_EQ(camera.pixelFromWorld({14, 18, -7}), glm::dvec2(4, 2));
}

TEST(Camera, pixelAndWorldAreEachOthersInverse) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> number(-1, 1);
    for (int i = 0; i < 200; ++i) {
        const Camera camera = cameraOf([&](CameraOptions& o) {
            o.direction = glm::dvec3(number(random), number(random), number(random));
            o.rollDegrees = 180 * number(random);
            o.targetWorld = 100.0 * glm::dvec3(number(random), number(random), number(random));
            o.sizePixels = {640, 480};
        });
        const glm::dvec2 pixel(640 * number(random), 480 * number(random));
        const glm::dvec3 world = camera.worldFromPixel(pixel) + 9.0 * camera.direction;
        EXPECT_LE(glm::distance(camera.pixelFromWorld(world), pixel), 1e-9);
    }
}

TEST(Camera, matricesAgreeWithPixels) {
    const Camera camera = cameraOf([](CameraOptions& o) {
        o.view = "iso";
        o.rollDegrees = 20;
        o.sizePixels = {300, 200};
    });
    const glm::dvec3 world(3, -4, 5);
    const glm::dvec4 inCamera = camera.cameraFromWorld() * glm::dvec4(world, 1);
    const glm::dvec3 offset = world - camera.targetWorld;
    expectNear(glm::dvec3(inCamera),
               {glm::dot(offset, camera.right), glm::dot(offset, camera.up),
                glm::dot(offset, camera.direction) + camera.targetDistanceWorld},
               1e-11);
    EXPECT_EQ(inCamera.w, 1);
    const glm::dvec4 inNdc = camera.ndcFromWorld() * glm::dvec4(world, 1);
    const glm::dvec2 pixel = camera.pixelFromWorld(world);
    EXPECT_NEAR(inNdc.x, pixel.x / 300, 1e-12);
    EXPECT_NEAR(inNdc.y, pixel.y / 200, 1e-12);
    EXPECT_EQ(inNdc.w, 1);
}

// What the OpenEXR project says of worldToCamera and worldToNDC.
TEST(Camera, matricesAreThoseOfOpenExr) {
    const Camera camera = cameraOf([](CameraOptions& o) {
        o.direction = glm::dvec3(-2, 1, -3);
        o.azimuthDegrees = 12;
        o.sizePixels = {300, 200};
    });
    const glm::dmat4 matrix = camera.cameraFromWorld();
    EXPECT_NEAR(glm::determinant(glm::dmat3(matrix)), -1, 1e-12);  // left-handed, same units
    const auto inCamera = [&](const glm::dvec3& world) {
        return glm::dvec3(matrix * glm::dvec4(world, 1));
    };
    const glm::dvec3 ahead =
        inCamera(camera.targetWorld + 7.0 * camera.direction) - inCamera(camera.targetWorld);
    expectNear(ahead, {0, 0, 7});
    const auto inNdc = [&](glm::dvec2 pixel) {
        return glm::dvec2(camera.ndcFromWorld() * glm::dvec4(camera.worldFromPixel(pixel), 1));
    };
    EXPECT_LE(glm::distance(inNdc({0, 0}), glm::dvec2(0, 0)), 1e-12);
    EXPECT_LE(glm::distance(inNdc({300, 200}), glm::dvec2(1, 1)), 1e-12);
    EXPECT_LE(glm::distance(inNdc({300, 0}), glm::dvec2(1, 0)), 1e-12);
}

TEST(Camera, allOfTheVolumeIsBeforeTheCamera) {
    glm::dmat4 worldFromIndex(1);
    worldFromIndex[0] = {-3, 0.5, 0, 0};
    worldFromIndex[2] = {0, 0.25, 4, 0};
    for (const glm::dvec3& target : {glm::dvec3(0), glm::dvec3(1e3, -2e3, 5e3)}) {
        const auto set = [&](CameraOptions& o) {
            o.view = "iso";
            o.targetWorld = target;
        };
        const Camera camera = cameraOf(set, kBox, worldFromIndex);
        double nearest = 1e300;
        for (int corner = 0; corner < 8; ++corner) {
            // Corners of voxels, half an index beyond their centres.
            const glm::dvec4 index(corner & 1 ? kBox.max.x + 0.5 : kBox.min.x - 0.5,
                                   corner & 2 ? kBox.max.y + 0.5 : kBox.min.y - 0.5,
                                   corner & 4 ? kBox.max.z + 0.5 : kBox.min.z - 0.5, 1);
            nearest = std::min(nearest, (camera.cameraFromWorld() * (worldFromIndex * index)).z);
        }
        EXPECT_GT(nearest, 0);
        EXPECT_LT(nearest, 10);  // no farther off than the voxels are large
    }
}

// Written down from what the letters mean: in RAS x grows to the patient's right, y to the front
// and z to the head, in LPS x to the left and y to the back.
TEST(Camera, viewsOfAPatientAreThePatients) {
    const glm::dvec3 right(1, 0, 0), front(0, 1, 0), head(0, 0, 1);
    const struct {
        const char* name;
        glm::dvec3 direction, pictureRight, pictureUp;
    } views[] = {
        {"front", -front, -right, head}, {"back", front, right, head},
        {"left", right, -front, head},   {"right", -right, front, head},
        {"top", -head, -right, -front},  {"bottom", head, -right, front},
    };
    const glm::dvec3 lpsFromRas(-1, -1, 1);
    for (const auto& view : views) {
        SCOPED_TRACE(view.name);
        CameraOptions options;
        options.view = view.name;
        const Camera ras = makeCamera(options, kBox, kUnit, "RAS");
        EXPECT_EQ(ras.direction, view.direction);
        EXPECT_EQ(ras.right, view.pictureRight);
        EXPECT_EQ(ras.up, view.pictureUp);
        const Camera lps = makeCamera(options, kBox, kUnit, "LPS");
        EXPECT_EQ(lps.direction, view.direction * lpsFromRas);
        EXPECT_EQ(lps.right, view.pictureRight * lpsFromRas);
        EXPECT_EQ(lps.up, view.pictureUp * lpsFromRas);
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_FALSE(std::signbit(ras.direction[axis]) && ras.direction[axis] == 0);
        const Camera elsewhere = makeCamera(options, kBox, kUnit, "scanner-xyz");
        EXPECT_EQ(elsewhere.direction, makeCamera(options, kBox, kUnit).direction);
    }
    CameraOptions iso;
    iso.view = "iso";
    // From the patient's front, left and above.
    expectNear(makeCamera(iso, kBox, kUnit, "RAS").direction,
               glm::normalize(-(front - right + head)));
    expectNear(makeCamera(iso, kBox, kUnit, "LPS").direction,
               glm::normalize(-(front - right + head) * lpsFromRas));
}

TEST(Camera, aPatientIsTurnedAboutTheHeadsDirection) {
    CameraOptions options;
    options.azimuthDegrees = 90;  // to the right of who faces the patient
    const Camera turned = makeCamera(options, kBox, kUnit, "LPS");
    options.azimuthDegrees = 0;
    options.view = "left";
    const Camera left = makeCamera(options, kBox, kUnit, "LPS");
    EXPECT_EQ(turned.direction, left.direction);
    EXPECT_EQ(turned.up, left.up);
    options.view = "front";
    options.elevationDegrees = 90;
    const Camera raised = makeCamera(options, kBox, kUnit, "LPS");
    options.elevationDegrees = 0;
    options.view = "top";
    const Camera top = makeCamera(options, kBox, kUnit, "LPS");
    EXPECT_EQ(raised.direction, top.direction);
    EXPECT_EQ(raised.up, top.up);
}

TEST(Camera, directionsStayTheWorldsForAPatient) {
    CameraOptions options;
    options.direction = glm::dvec3(0, 1, 0);
    const Camera camera = makeCamera(options, kBox, kUnit, "LPS");
    EXPECT_EQ(camera.direction, glm::dvec3(0, 1, 0));
    EXPECT_EQ(camera.up, glm::dvec3(0, 0, 1));
    options.up = glm::dvec3(1, 0, 0);
    EXPECT_EQ(makeCamera(options, kBox, kUnit, "LPS").up, glm::dvec3(1, 0, 0));
    options.direction = glm::dvec3(0, 0, -1);
    options.up.reset();
    CameraOptions top;
    top.view = "top";
    EXPECT_EQ(makeCamera(options, kBox, kUnit, "RAS").up, makeCamera(top, kBox, kUnit, "RAS").up);
}

// As in Blender, whose front view looks along +y.
TEST(Camera, viewsStandOnWhatIsUp) {
    const struct {
        const char* name;
        glm::dvec3 direction, up;
    } views[] = {
        {"front", {0, 1, 0}, {0, 0, 1}}, {"back", {0, -1, 0}, {0, 0, 1}},
        {"left", {1, 0, 0}, {0, 0, 1}},  {"right", {-1, 0, 0}, {0, 0, 1}},
        {"top", {0, 0, -1}, {0, 1, 0}},  {"bottom", {0, 0, 1}, {0, -1, 0}},
    };
    CameraOptions options;
    for (const auto& view : views) {
        options.view = view.name;
        options.up = glm::dvec3(0, 0, 5);
        const Camera camera = makeCamera(options, kBox, kUnit);
        EXPECT_EQ(camera.direction, view.direction) << view.name;
        EXPECT_EQ(camera.up, view.up) << view.name;
        options.up = glm::dvec3(0, 1, 0);  // what is up anyway
        const Camera stated = makeCamera(options, kBox, kUnit);
        options.up.reset();
        const Camera plain = makeCamera(options, kBox, kUnit);
        EXPECT_EQ(stated.direction, plain.direction) << view.name;
        EXPECT_EQ(stated.up, plain.up) << view.name;
        options.up = glm::dvec3(0, -1, 0);  // the front on its head
        expectNear(makeCamera(options, kBox, kUnit).up, plain.up * glm::dvec3(-1, -1, 1));
        for (const double off : {1e-12, 1.2e-8, 1e-7, 1e-4, 0.01}) {
            const glm::dvec3 up = glm::normalize(glm::dvec3(off, -1, 2 * off));
            options.up = up;
            const Camera turned = makeCamera(options, kBox, kUnit);
            const glm::dmat3 axes(turned.right, turned.up, -turned.direction);
            EXPECT_NEAR(glm::determinant(axes), 1, 1e-12) << view.name << ' ' << off;
            if (std::string(view.name) == "front") expectNear(turned.up, up, 1e-12);
        }
    }
    options.view = "iso";
    options.up = glm::dvec3(0, 0, 1);
    expectNear(makeCamera(options, kBox, kUnit).direction, glm::dvec3(-1, 1, -1) / std::sqrt(3.0));
    options.view = "front";
    options.up = glm::dvec3(3, 4, 0);  // across the line of sight: it does not turn
    EXPECT_EQ(makeCamera(options, kBox, kUnit).direction, glm::dvec3(0, 0, -1));
    expectNear(makeCamera(options, kBox, kUnit).up, {0.6, 0.8, 0});
    options.up = glm::dvec3(0, 0, 1);  // the head's direction as it is
    const Camera patient = makeCamera(options, kBox, kUnit, "RAS");
    options.up.reset();
    EXPECT_EQ(patient.direction, makeCamera(options, kBox, kUnit, "RAS").direction);
}

// Straight down and up as the views top and bottom.
TEST(Camera, whoLooksStraightDownNeedNotSayWhatIsUp) {
    for (const double y : {9.0, -9.0}) {
        CameraOptions options;
        options.direction = glm::dvec3(0, -y, 0);
        CameraOptions view;
        view.view = y > 0 ? "top" : "bottom";
        const Camera expected = makeCamera(view, kBox, kUnit);
        EXPECT_EQ(makeCamera(options, kBox, kUnit).up, expected.up);
        options = {};
        options.projection = Projection::kPerspective;
        options.eyeWorld = glm::dvec3(1, y, 2);
        options.targetWorld = glm::dvec3(1, 0, 2);
        EXPECT_EQ(makeCamera(options, kBox, kUnit).up, expected.up);
        EXPECT_EQ(makeCamera(options, kBox, kUnit).right, expected.right);
    }
}

// A panorama need not look at anything.
TEST(Camera, anEyeThatSeesAllSidesMayBeTheTarget) {
    CameraOptions options;
    options.projection = Projection::kLatlong;
    options.sizePixels = {64, 32};
    options.view = "left";
    options.targetWorld = glm::dvec3(1, 2, 3);
    const Camera expected = makeCamera(options, kBox, kUnit);
    options.eyeWorld = options.targetWorld;
    const Camera camera = makeCamera(options, kBox, kUnit);
    EXPECT_EQ(camera.direction, glm::dvec3(1, 0, 0));
    EXPECT_EQ(camera.targetWorld, expected.targetWorld);
    EXPECT_EQ(camera.frameWidthWorld, expected.frameWidthWorld);
}

// How far the projected box reaches from the picture's edges: 0 = touches, negative = sticks out.
glm::dvec2 marginOf(const Camera& camera, const IndexBox& box, const glm::dmat4& worldFromIndex) {
    glm::dvec2 low(1e300), high(-1e300);
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec4 index(corner & 1 ? box.max.x : box.min.x,
                               corner & 2 ? box.max.y : box.min.y,
                               corner & 4 ? box.max.z : box.min.z, 1);
        const glm::dvec2 pixel = camera.pixelFromWorld(glm::dvec3(worldFromIndex * index));
        low = glm::min(low, pixel);
        high = glm::max(high, pixel);
    }
    EXPECT_LE(glm::distance(low + high, glm::dvec2(camera.sizePixels)), 1e-6);
    return low;
}

TEST(Camera, theDefaultFrameJustHoldsTheBox) {
    glm::dmat4 sheared(1);
    sheared[0] = {2, 0.5, 0, 0};
    sheared[1] = {-0.25, 0.5, 1, 0};
    sheared[2] = {0.5, 0.5, -3, 0};
    sheared[3] = {100, -200, 300, 1};
    for (const glm::ivec2 size :
         {glm::ivec2(512, 512), glm::ivec2(640, 100), glm::ivec2(90, 400)}) {
        for (const char* view : {"front", "left", "top", "iso"}) {
            for (const glm::dmat4& worldFromIndex : {kUnit, sheared}) {
                const auto set = [&](CameraOptions& o) {
                    o.view = view;
                    o.azimuthDegrees = 10;
                    o.sizePixels = size;
                };
                const Camera camera = cameraOf(set, kBox, worldFromIndex);
                const glm::dvec2 margin = marginOf(camera, kBox, worldFromIndex);
                EXPECT_NEAR(std::min(margin.x, margin.y), 0, 1e-9) << view << ' ' << size.x;
            }
        }
    }
}

TEST(Camera, theFrameOfASquarePictureIsTheLargerExtent) {
    EXPECT_EQ(cameraOf([](CameraOptions&) {}).frameWidthWorld, 10);
    EXPECT_EQ(cameraOf([](CameraOptions& o) { o.view = "left"; }).frameWidthWorld, 8);
    EXPECT_EQ(cameraOf([](CameraOptions&) {}).targetWorld, glm::dvec3(2, 6, 8));
}

TEST(Camera, aTargetMovesThePictureAndKeepsItsFrame) {
    const Camera camera = cameraOf([](CameraOptions& o) { o.targetWorld = glm::dvec3(1, 2, 3); });
    EXPECT_EQ(camera.targetWorld, glm::dvec3(1, 2, 3));
    EXPECT_EQ(camera.frameWidthWorld, 10);
}

TEST(Camera, onePointIsFramedAsOneVoxel) {
    glm::dmat4 worldFromIndex(1);
    worldFromIndex[0][0] = 3;
    worldFromIndex[1][1] = 0.5;
    worldFromIndex[3] = {7, 8, 9, 1};
    const auto front = [](CameraOptions&) {};
    const Camera point = cameraOf(front, {{2, 2, 2}, {2, 2, 2}}, worldFromIndex);
    EXPECT_EQ(point.frameWidthWorld, 0.5);
    EXPECT_EQ(point.targetWorld, glm::dvec3(13, 9, 11));
    EXPECT_EQ(cameraOf(front, {{2, 2, 2}, {2, 2, 9}}, worldFromIndex).frameWidthWorld, 0.5);
    const Camera empty = cameraOf(front, IndexBox(), worldFromIndex);
    EXPECT_EQ(empty.frameWidthWorld, 0.5);
    EXPECT_EQ(empty.targetWorld, glm::dvec3(7, 8, 9));
}

TEST(Camera, holdsTheLargestSizesAndBoxes) {
    const int most = std::numeric_limits<int>::max();
    const int least = std::numeric_limits<int>::min();
    const Camera camera = cameraOf([&](CameraOptions& o) { o.sizePixels = glm::ivec2(most); },
                                   {glm::ivec3(least), glm::ivec3(most)});
    EXPECT_EQ(camera.frameWidthWorld, 4294967295.0);
    EXPECT_EQ(camera.targetWorld, glm::dvec3(-0.5));
    EXPECT_EQ(camera.pixelFromWorld(camera.targetWorld), glm::dvec2(most / 2.0));
}

std::string messageOf(const std::function<void(CameraOptions&)>& set,
                      ErrorCode code = ErrorCode::kUsage,
                      const glm::dmat4& worldFromIndex = kUnit) {
    try {
        cameraOf(set, kBox, worldFromIndex);
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), code);
        return error.what();
    }
    return "no error";
}

TEST(Camera, anEyeLooksAtTheTarget) {
    const Camera camera = cameraOf([](CameraOptions& o) {
        o.projection = Projection::kPerspective;
        o.eyeWorld = glm::dvec3(3, 4, 20);
        o.targetWorld = glm::dvec3(3, 4, 8);
        o.fovDegrees = 90;
        o.sizePixels = {200, 100};
    });
    expectNear(camera.direction, {0, 0, -1});
    expectNear(camera.eyeWorld(), {3, 4, 20});
    EXPECT_NEAR(camera.targetDistanceWorld, 12, 1e-12);
    EXPECT_NEAR(camera.fovDegrees(), 90, 1e-9);
    // The picture is as high as the eye is away, twice.
    EXPECT_NEAR(camera.frameWidthWorld, 48, 1e-12);
    expectNear(camera.worldFromPixel({0, 0}), {-21, 16, 8});
    expectNear(camera.rayThrough({200, 100}) / 12.0, {2, -1, -1});
    const glm::dvec2 pixel = camera.pixelFromWorld({3, 10, 14});
    EXPECT_NEAR(pixel.x, 100, 1e-9);
    EXPECT_NEAR(pixel.y, 0, 1e-9);
}

TEST(Camera, turningAnEyeTurnsItsLineOfSight) {
    const Camera camera = cameraOf([](CameraOptions& o) {
        o.projection = Projection::kPerspective;
        o.eyeWorld = glm::dvec3(3, 4, 20);
        o.targetWorld = glm::dvec3(3, 4, 8);
        o.azimuthDegrees = 90;
    });
    expectNear(camera.direction, {-1, 0, 0});
    expectNear(camera.eyeWorld(), {3, 4, 20}, 1e-9);
    // Without an eye the camera goes round the target.
    const Camera around = cameraOf([](CameraOptions& o) {
        o.projection = Projection::kPerspective;
        o.distanceWorld = 12;
        o.targetWorld = glm::dvec3(3, 4, 8);
        o.azimuthDegrees = 90;
    });
    expectNear(around.eyeWorld(), {15, 4, 8}, 1e-9);
}

TEST(Camera, focalLengthAndApertureAreAnAngle) {
    const Camera camera = cameraOf([](CameraOptions& o) {
        o.projection = Projection::kPerspective;
        o.focalMm = 35;
        o.apertureMm = 24;
        o.sizePixels = {300, 100};
    });
    EXPECT_NEAR(camera.frameWidthWorld / camera.targetDistanceWorld, 24.0 / 35, 1e-12);
    EXPECT_NEAR(std::tan(camera.fovDegrees() * std::acos(-1.0) / 360), 4.0 / 35, 1e-12);
}

TEST(Camera, perspectiveFitsTheBox) {
    for (const char* view : {"front", "left", "iso"}) {
        const Camera camera = cameraOf([&](CameraOptions& o) {
            o.projection = Projection::kPerspective;
            o.view = view;
            o.fovDegrees = 50;
            o.sizePixels = {300, 200};
        });
        double nearest = 1e9;
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 world(corner & 1 ? kBox.max.x : kBox.min.x,
                                   corner & 2 ? kBox.max.y : kBox.min.y,
                                   corner & 4 ? kBox.max.z : kBox.min.z);
            EXPECT_GT(glm::dot(world - camera.eyeWorld(), camera.direction), 0);
            const glm::dvec2 pixel = camera.pixelFromWorld(world);
            nearest = std::min({nearest, pixel.x, pixel.y, 300 - pixel.x, 200 - pixel.y});
        }
        EXPECT_NEAR(nearest, 0, 1e-9) << view;
    }
}

TEST(Camera, panoramasShowAllSides) {
    const Camera camera = cameraOf([](CameraOptions& o) {
        o.projection = Projection::kLatlong;
        o.eyeWorld = glm::dvec3(1, 2, 3);
        o.direction = glm::dvec3(0, 0, -1);
        o.sizePixels = {400, 200};
    });
    expectNear(camera.eyeWorld(), {1, 2, 3}, 1e-12);
    expectNear(camera.rayThrough({200, 100}), {0, 0, -1});
    expectNear(camera.rayThrough({300, 100}), {1, 0, 0});
    expectNear(camera.rayThrough({0, 100}), {0, 0, 1});
    expectNear(camera.rayThrough({200, 0}), {0, 1, 0});
    for (const glm::dvec2 pixel :
         {glm::dvec2(20, 30), glm::dvec2(250.5, 170), glm::dvec2(390, 5)}) {
        const glm::dvec3 world = camera.eyeWorld() + 7.0 * camera.rayThrough(pixel);
        EXPECT_LE(glm::distance(camera.pixelFromWorld(world), pixel), 1e-9);
        expectNear(camera.worldFromPixel(pixel),
                   camera.eyeWorld() + camera.targetDistanceWorld * camera.rayThrough(pixel));
    }
}

TEST(Camera, perspectiveMatricesAgreeWithPixels) {
    const Camera camera = cameraOf([](CameraOptions& o) {
        o.projection = Projection::kPerspective;
        o.view = "iso";
        o.fovDegrees = 65;
        o.sizePixels = {300, 200};
    });
    const glm::dvec3 world(3, -4, 5);
    const glm::dvec4 inCamera = camera.cameraFromWorld() * glm::dvec4(world, 1);
    EXPECT_NEAR(inCamera.z, glm::dot(world - camera.eyeWorld(), camera.direction), 1e-11);
    const glm::dvec4 inNdc = camera.ndcFromWorld() * glm::dvec4(world, 1);
    const glm::dvec2 pixel = camera.pixelFromWorld(world);
    EXPECT_NEAR(inNdc.x / inNdc.w, pixel.x / 300, 1e-12);
    EXPECT_NEAR(inNdc.y / inNdc.w, pixel.y / 200, 1e-12);
}

CameraOptions cArm() {
    CameraOptions options;
    options.projection = Projection::kPerspective;
    options.sourceToIsocenterWorld = 1000;
    options.sourceToDetectorWorld = 1500;
    options.detectorWorld = glm::dvec2(300, 450);
    options.sizePixels = {200, 300};
    return options;
}

// A place on the detector is seen where it lies there.
TEST(Camera, aCArmSeesItsDetector) {
    const Camera camera = cameraOf([](CameraOptions& o) {
        o = cArm();
        o.targetWorld = glm::dvec3(3, 4, 8);
    });
    expectNear(camera.eyeWorld(), {3, 4, 1008});
    EXPECT_NEAR(camera.targetDistanceWorld, 1000, 1e-12);
    // The isocenter is magnified by 1500 / 1000.
    EXPECT_NEAR(camera.frameWidthWorld, 200, 1e-12);
    const glm::dvec2 corner = camera.pixelFromWorld({3 - 150, 4 + 225, 1008 - 1500});
    EXPECT_NEAR(corner.x, 0, 1e-9);
    EXPECT_NEAR(corner.y, 0, 1e-9);
}

TEST(Camera, refusesCArmsThatCannotBe) {
    const auto refused = [](const std::function<void(CameraOptions&)>& set) {
        return messageOf([&](CameraOptions& o) {
            o = cArm();
            set(o);
        });
    };
    EXPECT_EQ(refused([](CameraOptions&) {}), "no error");
    EXPECT_EQ(refused([](CameraOptions& o) { o.sourceToDetectorWorld = 999; }),
              "`sourceToDetectorWorld`: got 999; expected at least `sourceToIsocenterWorld` 1000");
    EXPECT_EQ(refused([](CameraOptions& o) { o.sourceToIsocenterWorld = 0; }),
              "`sourceToIsocenterWorld`: got 0; expected a finite number > 0");
    EXPECT_EQ(refused([](CameraOptions& o) { o.detectorWorld.reset(); }),
              "`detectorWorld`: got none; expected `sourceToIsocenterWorld`, "
              "`sourceToDetectorWorld` and `detectorWorld`");
    EXPECT_EQ(refused([](CameraOptions& o) { o.detectorWorld->x = 0; }),
              "`detectorWorld`: got 0x450; expected WxH, two finite numbers > 0");
    EXPECT_EQ(refused([](CameraOptions& o) { o.detectorWorld->x = NAN; }),
              "`detectorWorld`: got nanx450; expected WxH, two finite numbers > 0");
    EXPECT_EQ(refused([](CameraOptions& o) { o.sizePixels.x = 300; }),
              "`detectorWorld`: got 300x450 of 300x300 pixels; expected square pixels, as 300x300");
    EXPECT_EQ(refused([](CameraOptions& o) { o.fovDegrees = 20; }),
              "`fovDegrees`: got it and `sourceToIsocenterWorld`; expected the camera one way or "
              "the other");
    EXPECT_EQ(refused([](CameraOptions& o) { o.projection = Projection::kOrtho; }),
              "`sourceToIsocenterWorld`: got `projection` ortho; expected `projection` "
              "perspective");
}

TEST(Camera, refusesEyesThatCannotBe) {
    const auto perspective = [](const std::function<void(CameraOptions&)>& set) {
        return messageOf([&](CameraOptions& o) {
            o.projection = Projection::kPerspective;
            set(o);
        });
    };
    for (const double fov : {0.0, -10.0, 180.0, 200.0, double(NAN)}) {
        EXPECT_EQ(perspective([&](CameraOptions& o) { o.fovDegrees = fov; }).find("`fovDegrees`: "),
                  0)
            << fov;
    }
    EXPECT_EQ(
        perspective([](CameraOptions& o) { o.eyeWorld = o.targetWorld = glm::dvec3(1, 2, 3); }),
        "`eyeWorld`: got 1,2,3; expected another place than the target 1,2,3, or a `direction` to "
        "look in");
    EXPECT_EQ(perspective([](CameraOptions& o) { o.eyeWorld = glm::dvec3(0, INFINITY, 0); }),
              "`eyeWorld`: got 0,inf,0; expected three finite numbers");
    EXPECT_EQ(perspective([](CameraOptions& o) { o.nearWorld = -1; }),
              "`nearWorld`: got -1; expected a finite number of at least 0");
    EXPECT_EQ(perspective([](CameraOptions& o) { o.distanceWorld = 0; }),
              "`distanceWorld`: got 0; expected a finite number > 0");
    EXPECT_EQ(perspective([](CameraOptions& o) { o.focalMm = NAN; }),
              "`focalMm`: got nan; expected a finite number > 0");
    EXPECT_EQ(
        perspective([](CameraOptions& o) { o.frameWidthWorld = 5; }),
        "`frameWidthWorld`: got `projection` perspective; expected `projection` ortho, of which it "
        "is an option");
    EXPECT_EQ(messageOf([](CameraOptions& o) { o.eyeWorld = glm::dvec3(1); }),
              "`eyeWorld`: got `projection` ortho; expected `projection` perspective or latlong");
    EXPECT_EQ(messageOf([](CameraOptions& o) { o.projection = Projection::kLatlong; }),
              "`sizePixels`: got 512x512; expected twice as wide as high for `projection` latlong");
}

// Depths begin where it is said; nothing that is seen moves.
TEST(Camera, aParallelCameraMayStandAnywhere) {
    const IndexBox box{{0, 0, 0}, {9, 9, 9}};
    CameraOptions options;
    options.view = "iso";
    const Camera before = makeCamera(options, box, glm::dmat4(1));
    for (const double distance : {40.0, 3.0, 0.0, -7.5}) {
        options.distanceWorld = distance;
        const Camera camera = makeCamera(options, box, glm::dmat4(1));
        EXPECT_EQ(camera.targetDistanceWorld, distance);
        EXPECT_NEAR((camera.cameraFromWorld() * glm::dvec4(camera.targetWorld, 1)).z, distance,
                    1e-12);
        EXPECT_EQ(camera.frameWidthWorld, before.frameWidthWorld);
        EXPECT_EQ(camera.pixelFromWorld({1, 2, 3}), before.pixelFromWorld({1, 2, 3}));
    }
    EXPECT_EQ(messageOf([](CameraOptions& o) { o.distanceWorld = NAN; }),
              "`distanceWorld`: got nan; expected a finite number");
    EXPECT_EQ(messageOf([](CameraOptions& o) {
                  o.projection = Projection::kLatlong;
                  o.distanceWorld = 3;
              }),
              "`distanceWorld`: got `projection` latlong; expected `projection` ortho or "
              "perspective");
}

TEST(Camera, refusesWhatCannotBeMeant) {
    EXPECT_EQ(
        messageOf([](CameraOptions& o) { o.view = "frnt"; }),
        "`view`: got frnt; expected one of front, back, left, right, top, bottom, iso. Did you "
        "mean 'front'?");
    EXPECT_EQ(messageOf([](CameraOptions& o) { o.direction = glm::dvec3(0); }),
              "`direction`: got 0,0,0; expected three finite numbers, not all of them 0");
    EXPECT_EQ(messageOf([](CameraOptions& o) { o.direction = glm::dvec3(1, NAN, 0); }),
              "`direction`: got 1,nan,0; expected three finite numbers, not all of them 0");
    EXPECT_EQ(messageOf([](CameraOptions& o) { o.up = glm::dvec3(0); }),
              "`up`: got 0,0,0; expected three finite numbers, not all of them 0");
    EXPECT_EQ(messageOf([](CameraOptions& o) {
                  o.direction = glm::dvec3(0, 0, -3);
                  o.up = glm::dvec3(0, 0, 2);
              }),
              "`up`: got 0,0,2, parallel to the line of sight 0,0,-1; expected a direction that "
              "differs from it");
    EXPECT_EQ(messageOf([](CameraOptions& o) { o.frameWidthWorld = 0; }),
              "`frameWidthWorld`: got 0; expected a number > 0");
    EXPECT_EQ(messageOf([](CameraOptions& o) {
                  o.sizePixels = {512, 0};
              }),
              "`sizePixels`: got 512x0; expected WxH, each at least 1");
    EXPECT_EQ(messageOf([](CameraOptions& o) { o.azimuthDegrees = INFINITY; }),
              "`azimuthDegrees`: got inf; expected a finite number");
    EXPECT_EQ(messageOf([](CameraOptions& o) { o.targetWorld = glm::dvec3(0, INFINITY, 0); }),
              "`targetWorld`: got 0,inf,0; expected three finite numbers");
}

TEST(Camera, refusesAFlatWorld) {
    glm::dmat4 flat(1);
    flat[2] = {1, 1, 0, 0};
    EXPECT_EQ(messageOf([](CameraOptions&) {}, ErrorCode::kInput, flat),
              "worldFromIndex: got voxels of volume 0; expected a finite transform that can be "
              "inverted");
    // Of a volume like any other's, but flat beside their edges.
    flat[2] = {1e100, 0, 1, 0};
    EXPECT_EQ(messageOf([](CameraOptions&) {}, ErrorCode::kInput, flat),
              "worldFromIndex: got voxels of volume 1 and edges of 1,1,1e+100; expected a finite "
              "transform that can be inverted");
}

}  // namespace
}  // namespace deltasplat
