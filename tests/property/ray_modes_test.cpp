// SPDX-License-Identifier: Apache-2.0
// Smallest values, means, radiographs and depth shading, in parallel and from an eye, against
// closed forms and a plain loop; and the same pixels on every machine.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/matrix.hpp>
#include <optional>
#include <string>

#include "deltasplat/error.h"
#include "deltasplat/simd.h"
#include "deltasplat/threads.h"
#include "property/ray_scene.h"
#include "property/value_volume.h"
#include "support/changed_volume.h"
#include "support/simd_levels.h"

namespace deltasplat::test {
namespace {

constexpr Mode kModes[] = {Mode::kXray, Mode::kMip, Mode::kMin, Mode::kAverage, Mode::kDrr};

CameraOptions eyeCamera(const Volume& volume, const glm::dvec3& direction, double fov = 40) {
    const TestView view = viewOf(volume, direction);
    CameraOptions camera;
    camera.projection = Projection::kPerspective;
    camera.direction = view.direction;
    camera.up = view.up;
    camera.fovDegrees = fov;
    camera.sizePixels = {48, 40};
    return camera;
}

RenderOptions eyeOptions(Mode mode, const CameraOptions& camera) {
    RenderOptions options;
    options.mode = mode;
    options.camera = camera;
    return options;
}

// A matrix of any kind: turned, mirrored and sheared.
glm::dmat4 crooked() {
    glm::dmat4 matrix(1);
    matrix[0] = glm::dvec4(-0.9, 0.2, 0.1, 0);
    matrix[1] = glm::dvec4(0.3, 1.2, -0.2, 0);
    matrix[2] = glm::dvec4(0, 0.3, 0.8, 0);
    matrix[3] = glm::dvec4(13, -4, 7, 1);
    return matrix;
}

// What a pixel's line of sight from an eye meets, by a plain loop.
class PlainEye {
  public:
    PlainEye(const Volume& volume, const Camera& camera)
        : camera_(camera), plain_(plainVolume(volume)) {
        toIndex_ = glm::inverse(glm::dmat3(volume.worldFromIndex()));
        eye_ = toIndex_ * (camera.targetWorld - camera.targetDistanceWorld * camera.direction -
                           glm::dvec3(volume.worldFromIndex()[3]));
    }

    reference::Seen see(int x, int y) const {
        const glm::dvec3 world = rayOf(x + 0.5, y + 0.5);
        const double depth = camera_.projection == Projection::kLatlong
                                 ? glm::length(world)
                                 : glm::dot(world, camera_.direction);
        return followLine(plain_, vectorOf(eye_), vectorOf(toIndex_ * world),
                          camera_.nearWorld / depth);
    }

  private:
    static reference::Vector vectorOf(const glm::dvec3& v) { return {v.x, v.y, v.z}; }
    glm::dvec3 rayOf(double x, double y) const {
        const glm::dvec2 size(camera_.sizePixels);
        if (camera_.projection == Projection::kLatlong) {
            const double pi = std::acos(-1.0);
            const double east = (2 * x / size.x - 1) * pi;
            const double north = (0.5 - y / size.y) * pi;
            return std::cos(north) *
                       (std::sin(east) * camera_.right + std::cos(east) * camera_.direction) +
                   std::sin(north) * camera_.up;
        }
        const double pixel = camera_.frameWidthWorld / size.x / camera_.targetDistanceWorld;
        return camera_.direction +
               pixel * ((x - 0.5 * size.x) * camera_.right - (y - 0.5 * size.y) * camera_.up);
    }

    const Camera& camera_;
    reference::ValueVolume plain_;
    glm::dmat3 toIndex_{1.0};
    glm::dvec3 eye_{0.0};
};

std::vector<CameraOptions> eyeCameras(const Volume& volume) {
    std::vector<CameraOptions> cameras;
    for (const glm::dvec3& direction : kDirections) cameras.push_back(eyeCamera(volume, direction));
    CameraOptions inside = eyeCamera(volume, {0.4, -0.5, 1}, 100);
    inside.distanceWorld = 1.3;
    cameras.push_back(inside);
    inside.nearWorld = 2.6;
    cameras.push_back(inside);
    CameraOptions panorama = inside;
    panorama.projection = Projection::kLatlong;
    panorama.fovDegrees = {};
    panorama.distanceWorld = {};
    panorama.sizePixels = {80, 40};
    cameras.push_back(panorama);
    return cameras;
}

TEST(RayModes, PicturesFromAnEyeAgreeWithAPlainLoop) {
    for (const double emptyShare : {0.0, 0.85}) {
        for (const bool isCrooked : {false, true}) {
            Volume volume = randomVolume({{-5, 3, -9}, {12, 20, 6}}, 5, emptyShare, {1, 1.25, 0.9});
            test::changed(volume)->codeBook = CodeBook::integer(-100);
            if (isCrooked) test::changed(volume)->worldFromIndex = crooked();
            int met = 0;
            int cameraNumber = 0;
            for (const CameraOptions& options : eyeCameras(volume)) {
                SCOPED_TRACE(cameraNumber++);
                const Camera camera = makeCamera(options, volume.box(), volume.worldFromIndex());
                const PlainEye plain(volume, camera);
                Image images[4];
                const Mode modes[] = {Mode::kXray, Mode::kMip, Mode::kMin, Mode::kAverage};
                for (int m = 0; m < 4; ++m)
                    images[m] = render(volume, eyeOptions(modes[m], options)).image;
                int apart = 0;
                double missed = 0;
                for (int y = 0; y < camera.sizePixels.y; ++y) {
                    for (int x = 0; x < camera.sizePixels.x; ++x) {
                        const reference::Seen seen = plain.see(x, y);
                        met += seen.met;
                        const float* pixels[4];
                        for (int m = 0; m < 4; ++m) pixels[m] = images[m].pixel(x, y);
                        // Where a ray touches a voxel's corner rounding decides whether it is met.
                        bool isApart = false;
                        for (int m = 1; m < 4; ++m) isApart |= pixels[m][3] != float(seen.met);
                        apart += isApart;
                        ASSERT_NEAR(pixels[0][0], seen.integral, 0.02) << x << ' ' << y;
                        if (isApart || !seen.met) continue;
                        ASSERT_NEAR(pixels[3][0], seen.mean, 0.1) << x << ' ' << y;
                        // Places an eighth of a slice apart miss some of a peak.
                        ASSERT_LE(pixels[1][0], seen.highest + 0.5) << x << ' ' << y;
                        ASSERT_GE(pixels[2][0], seen.lowest - 15) << x << ' ' << y;
                        missed += std::abs(seen.highest - pixels[1][0]) +
                                  std::abs(pixels[2][0] - seen.lowest);
                    }
                }
                EXPECT_LE(apart, 80);
                EXPECT_LE(missed, 4.0 * camera.sizePixels.x * camera.sizePixels.y);
            }
            EXPECT_GT(met, 5000);
        }
    }
}

// A slab that is wide enough: each ray's way through it is known, whatever the spacing.
// A pixel of any size has the mean over its square: what voxels hold is lost nowhere, wherever they
// lie in it.
TEST(RayModes, SumsOfLargePixelsKeepWhatVoxelsHold) {
    const Volume one = makeVolume({{3, -7, 2}, {3, -7, 2}}, [](int, int, int) { return 1000; });
    const Volume few = makeVolume({{-15, -12, -9}, {14, 12, 10}}, [](int x, int y, int z) {
        return (x * 31 + y * 17 + z * 7 + 10000) % 97 == 0 ? 200 : kInactive;
    });
    for (const Volume* volume : {&one, &few}) {
        const double held = volume == &one ? 1000 : 200.0 * double(few.activeCount());
        // Lines are a voxel apart: of one alone they hit more or less of its middle.
        const double bound = volume == &one ? 0.08 : 0.02;
        for (const int voxels : {5, 40, 64, 625, 9000}) {
            for (const glm::dvec3& aside : {glm::dvec3(0), glm::dvec3(0.4, -0.3, 0.2)}) {
                RenderOptions options;
                options.mode = Mode::kXray;
                options.camera.view = "iso";
                options.camera.targetWorld = glm::dvec3(3, -7, 2) + double(voxels) * aside;
                options.camera.sizePixels = {20, 16};
                options.camera.frameWidthWorld = 20.0 * voxels;
                const Image image = render(*volume, options).image;
                double sum = 0;
                for (std::size_t i = 0; i < image.rgba.size(); i += 4) sum += image.rgba[i];
                EXPECT_NEAR(sum * voxels * voxels / held, 1, bound) << voxels;
            }
        }
    }
}

// Of voxels of any shape, seen from any side.
TEST(RayModes, SumsOfLargePixelsAreMeansOfSmallOnes) {
    Volume volume = makeVolume({{0, 0, 0}, {63, 63, 15}}, [](int x, int y, int z) {
        return (x / 3 * 7 + y / 3 * 5 + z * 3) % 11 < 4 ? 200 : 0;
    });
    for (const glm::dvec3& spacing : {glm::dvec3(0.5, 0.5, 5), glm::dvec3(1, 20, 1)}) {
        for (int axis = 0; axis < 3; ++axis)
            test::changed(volume)->worldFromIndex[axis][axis] = spacing[axis];
        for (const char* view : {"front", "left", "top", "iso"}) {
            RenderOptions options;
            options.mode = Mode::kXray;
            options.camera.view = view;
            options.camera.sizePixels = {256, 256};
            const Image fine = render(volume, options).image;
            options.camera.sizePixels = {16, 16};
            const Image coarse = render(volume, options).image;
            double most = 0, worst = 0;
            for (int y = 0; y < 16; ++y) {
                for (int x = 0; x < 16; ++x) {
                    double mean = 0;
                    for (int i = 0; i < 256; ++i)
                        mean += fine.pixel(16 * x + i % 16, 16 * y + i / 16)[0] / 256;
                    most = std::max(most, mean);
                    worst = std::max(worst, std::abs(mean - double(coarse.pixel(x, y)[0])));
                }
            }
            EXPECT_LT(worst, 0.05 * most) << view << ' ' << spacing.z;
        }
    }
}

TEST(RayModes, RadiographOfASlabIsTheExponential) {
    for (const glm::dvec3& spacing : {glm::dvec3(1), glm::dvec3(1, 1, 50), glm::dvec3(3, 2, 0.5)}) {
        const int thickness = 12;
        // 500 HU, and voxels of -2000, which let everything through, in a quarter of the slices.
        Volume volume = makeVolume(
            {{0, 0, 0}, {159, 159, thickness - 1}},
            [](int, int, int z) { return z % 4 == 1 ? 0 : 2500; }, spacing);
        test::changed(volume)->codeBook = CodeBook::integer(-2000);
        test::changed(volume)->valueMin = -2000;
        test::changed(volume)->valueMax = 500;
        const double mu = 0.004 / spacing.z;
        for (const double slope : {0.0, 0.3}) {
            const glm::dvec3 direction(slope * spacing.x, -0.2 * spacing.y, -spacing.z);
            RenderOptions options = eyeOptions(Mode::kDrr, eyeCamera(volume, direction, 1));
            options.camera.distanceWorld = 40 * glm::length(direction);
            options.camera.sizePixels = {16, 12};
            options.drr.muWater = mu;
            options.drr.photons = 1000;
            for (const bool parallel : {false, true}) {
                if (parallel) {
                    options.camera.projection = Projection::kOrtho;
                    options.camera.fovDegrees = {};
                    options.camera.distanceWorld = {};
                    options.camera.frameWidthWorld = 4 * spacing.x;
                }
                const RenderResult result = render(volume, options);
                for (int y = 0; y < 12; ++y) {
                    for (int x = 0; x < 16; ++x) {
                        const glm::dvec3 ray = result.camera.rayThrough({x + 0.5, y + 0.5});
                        const double length =
                            0.75 * thickness * spacing.z * glm::length(ray) / std::abs(ray.z);
                        const float* rgba = result.image.pixel(x, y);
                        const double expected = 1000 * std::exp(-1.5 * mu * length);
                        ASSERT_NEAR(rgba[0], expected, 1e-4 * expected) << parallel;
                        ASSERT_EQ(rgba[1], rgba[0]);
                        ASSERT_EQ(rgba[3], 1);
                    }
                }
            }
        }
    }
}

TEST(RayModes, RadiographOfABallIsTheExponentialOfItsChords) {
    const double radius = 20;
    const Volume ball = makeVolume({{-21, -21, -21}, {21, 21, 21}}, [&](int x, int y, int z) {
        return x * x + y * y + z * z <= radius * radius ? 1000 : kInactive;
    });
    RenderOptions options = eyeOptions(Mode::kDrr, eyeCamera(ball, {0.7, -0.4, 0.6}, 45));
    const RenderResult result = render(ball, options);
    double error = 0;
    int pixels = 0;
    for (int y = 0; y < 40; ++y) {
        for (int x = 0; x < 48; ++x) {
            const glm::dvec3 ray = glm::normalize(result.camera.rayThrough({x + 0.5, y + 0.5}));
            const glm::dvec3 away = -result.camera.eyeWorld();
            const double off = glm::length(away - glm::dot(away, ray) * ray);
            const double share = result.image.pixel(x, y)[0];
            if (off > radius + 2) {
                EXPECT_EQ(share, 1);
            }
            if (off > radius - 2) continue;
            const double chord = 2 * std::sqrt(radius * radius - off * off);
            const double seen = -std::log(share) / (2 * 0.022);
            EXPECT_NEAR(seen, chord, 3);
            error += seen - chord;
            ++pixels;
        }
    }
    EXPECT_GT(pixels, 200);
    // Reading between voxels flattens what is convex a little.
    EXPECT_NEAR(error / pixels, -0.1, 0.15);
}

TEST(RayModes, NothingLetsAllThrough) {
    const Volume nothing =
        makeVolume({{0, 0, 0}, {7, 7, 7}}, [](int, int, int) { return kInactive; });
    for (const float value :
         render(nothing, optionsOf(Mode::kDrr, viewOf(nothing, {0, 0, -1}))).image.rgba)
        ASSERT_EQ(value, 1);
}

TEST(RayModes, MeanAndSmallestOfAConstantAreIt) {
    Volume volume = makeVolume({{0, 0, 0}, {19, 19, 19}}, [](int x, int y, int z) {
        return (x + 2 * y + 3 * z) % 5 == 0 ? kInactive : 7;
    });
    test::changed(volume)->codeBook = CodeBook::ofTable({0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7});
    for (const Mode mode : {Mode::kAverage, Mode::kMin}) {
        for (const glm::dvec3& direction : kDirections) {
            for (const bool parallel : {true, false}) {
                const RenderOptions options = parallel
                                                  ? optionsOf(mode, viewOf(volume, direction))
                                                  : eyeOptions(mode, eyeCamera(volume, direction));
                const Image image = render(volume, options).image;
                int met = 0;
                for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
                    if (image.rgba[i + 3] == 0) continue;
                    ++met;
                    // What is not active does not count (0 would be less than the smallest).
                    ASSERT_NEAR(image.rgba[i], 0.7f, 1e-7) << modeName(mode);
                }
                EXPECT_GT(met, 500);
            }
        }
    }
}

TEST(RayModes, MeanCountsActiveVoxelsAlone) {
    const Volume volume = makeVolume({{0, 0, 0}, {15, 15, 15}}, [](int, int, int z) {
        return z < 4 ? kInactive : z < 8 ? 0 : z;
    });
    TestView view = viewOf(volume, {0, 0, -1});
    view.size = {4, 4};
    const Image image = render(volume, optionsOf(Mode::kAverage, view)).image;
    EXPECT_NEAR(image.pixel(2, 2)[0], (8 + 15) * 4 / 12.0, 1e-5);
}

// What lies around a volume has no part in its smallest values, however it is looked at.
TEST(RayModes, SmallestValuesAreNotMadeAtTheRim) {
    const Volume volume = makeVolume({{0, 0, 0}, {31, 31, 31}}, [](int x, int y, int z) {
        return x == 16 && y == 16 && z == 16 ? 200 : 1;
    });
    for (const glm::dvec3& direction : kDirections) {
        for (const bool parallel : {true, false}) {
            const Image image =
                render(volume, parallel ? optionsOf(Mode::kMin, viewOf(volume, direction))
                                        : eyeOptions(Mode::kMin, eyeCamera(volume, direction)))
                    .image;
            int met = 0;
            for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
                ASSERT_EQ(image.rgba[i], image.rgba[i + 3]) << i;
                met += image.rgba[i + 3] > 0;
            }
            EXPECT_GT(met, 500);
        }
    }
}

// Nothing never outshines something, nor is anything darker than the darkest voxel.
TEST(RayModes, LargestValuesStayBetweenThoseOfTheVolume) {
    for (const int offset : {-1000, 0}) {
        Volume volume = makeVolume({{0, 0, 0}, {31, 31, 31}},
                                   [](int x, int, int) { return x < 16 ? 30 : 100; });
        test::changed(volume)->codeBook = CodeBook::integer(offset);
        test::changed(volume)->valueMin = offset + 30;
        test::changed(volume)->valueMax = offset + 100;
        for (const glm::dvec3& direction : kDirections) {
            for (const bool parallel : {true, false}) {
                const Image image =
                    render(volume, parallel ? optionsOf(Mode::kMip, viewOf(volume, direction))
                                            : eyeOptions(Mode::kMip, eyeCamera(volume, direction)))
                        .image;
                for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
                    if (image.rgba[i + 3] == 0) continue;
                    ASSERT_GE(image.rgba[i], offset + 30);
                    ASSERT_LE(image.rgba[i], offset + 100);
                }
            }
        }
    }
}

// A peak in one slice is as dark as the slice is deep; of equal slices the nearest is seen.
TEST(RayModes, DepthShadeIsLinear) {
    const int last = 15;
    for (const int peak : {0, 4, 15, -1}) {
        const Volume volume = makeVolume({{0, 0, 0}, {15, 15, last}}, [&](int, int, int z) {
            return z == peak || peak < 0 ? 200 : 10;
        });
        for (const int sign : {1, -1}) {
            const glm::dvec3 direction(0, 0, sign);
            const int slices = peak < 0 ? 0 : sign > 0 ? peak : last - peak;
            const double expected = 200 * (1 - 0.6 * slices / last);
            TestView view = viewOf(volume, direction);
            view.size = {5, 5};
            RenderOptions options = optionsOf(Mode::kMip, view);
            options.depthShade = 0.6;
            EXPECT_NEAR(render(volume, options).image.pixel(2, 2)[0], expected, 1e-3);
            options = eyeOptions(Mode::kMip, eyeCamera(volume, direction, 20));
            options.depthShade = 0.6;
            EXPECT_NEAR(render(volume, options).image.pixel(24, 20)[0], expected, 1e-3);
        }
    }
}

// Seen obliquely, a voxel alone is as dark as it is deep in the box.
TEST(RayModes, DepthShadeOfOneVoxel) {
    const glm::ivec3 at(5, 2, 9);
    const Volume volume = makeVolume(
        {{0, 0, 0}, {11, 11, 11}},
        [&](int x, int y, int z) { return glm::ivec3(x, y, z) == at ? 100 : 0; }, {1, 2, 0.7});
    for (const glm::dvec3& direction : kDirections) {
        TestView view = viewOf(volume, direction);
        view.target = glm::dvec3(volume.worldFromIndex() * glm::dvec4(at, 1));
        view.size = {9, 9};
        view.pixelWorld = 0.05;
        RenderOptions options = optionsOf(Mode::kMip, view);
        options.depthShade = 1;
        const glm::dvec3 unit = glm::normalize(direction);
        double nearest = 0, farthest = 0;
        const double depth = glm::dot(view.target, unit);
        for (int axis = 0; axis < 3; ++axis) {
            const double way = 11 * volume.worldFromIndex()[axis][axis] * unit[axis];
            nearest += std::min(way, 0.0);
            farthest += std::max(way, 0.0);
        }
        options.camera.targetWorld = view.target;
        const double expected = 1 - (depth - nearest) / (farthest - nearest);
        const Image full = render(volume, optionsOf(Mode::kMip, view)).image;
        const Image shaded = render(volume, options).image;
        ASSERT_GT(full.pixel(4, 4)[0], 20);
        EXPECT_NEAR(shaded.pixel(4, 4)[0] / full.pixel(4, 4)[0], expected, 0.06);
    }
}

TEST(RayModes, ThreadsAndSimdLevelsGiveTheSamePixels) {
    const Volume volume = randomVolume({{-19, 5, -40}, {40, 70, 32}}, 17, 0.5, {1, 1.5, 0.8});
    for (const Mode mode : kModes) {
        for (const bool parallel : {true, false}) {
            const glm::dvec3 direction(0.4, 1, 0.6);
            RenderOptions options = parallel ? optionsOf(mode, viewOf(volume, direction))
                                             : eyeOptions(mode, eyeCamera(volume, direction));
            options.depthShade = 0.5;
            options.drr.muWater = 0.001;
            const Image expected = render(volume, options).image;
            for (const float value : expected.rgba) ASSERT_EQ(value, value) << "no NaN";
            for (const int threads : {1, 3}) {
                const ThreadLimit limit(threads);
                EXPECT_EQ(render(volume, options).image.rgba, expected.rgba) << threads;
            }
            for (const std::string& level : test::testedSimdLevels()) {
                setSimdLevel(level);
                EXPECT_EQ(render(volume, options).image.rgba, expected.rgba) << level;
            }
            setSimdLevel("auto");
        }
    }
}

// From far away lines of sight are parallel.
TEST(RayModes, FarEyeSeesTheParallelPicture) {
    const Volume volume = makeVolume({{0, 0, 0}, {31, 31, 31}}, [](int x, int y, int z) {
        return int(100 + 50 * std::sin(0.2 * x) + 40 * std::cos(0.3 * y + 0.1 * z));
    });
    for (const Mode mode : kModes) {
        TestView view = viewOf(volume, {0.5, -0.45, 1});
        view.size = {12, 12};
        RenderOptions options = optionsOf(mode, view);
        options.drr.muWater = 0.001;
        const Image parallel = render(volume, options).image;
        options.camera.projection = Projection::kPerspective;
        options.camera.frameWidthWorld = {};
        options.camera.distanceWorld = 1e5;
        options.camera.focalMm = 1e5;
        options.camera.apertureMm = 12 * view.pixelWorld;
        const Image far = render(volume, options).image;
        for (std::size_t i = 0; i < far.rgba.size(); ++i)
            ASSERT_NEAR(far.rgba[i], parallel.rgba[i], 0.001 * std::abs(parallel.rgba[i]))
                << modeName(mode);
    }
}

// Where voxels are smaller than pixels none is passed over.
TEST(RayModes, CoarsePicturesFromAnEyeKeepTheMass) {
    const Volume volume = makeVolume({{0, 0, 0}, {63, 63, 63}}, [](int x, int y, int z) {
        return (x % 8 == 3 && y % 8 == 5 && z % 8 == 2) ? 250 : kInactive;
    });
    const auto sumOf = [&](int size) {
        CameraOptions camera = eyeCamera(volume, {0.1, 0.2, 1}, 30);
        camera.distanceWorld = 140;
        camera.sizePixels = {size, size};
        double sum = 0;
        const Image image = render(volume, eyeOptions(Mode::kXray, camera)).image;
        for (std::size_t i = 0; i < image.rgba.size(); i += 4) sum += image.rgba[i];
        return sum / size / size;
    };
    EXPECT_NEAR(sumOf(20) / sumOf(240), 1, 0.03);
}

std::string refusal(const RenderOptions& options) {
    const Volume volume = makeVolume({{0, 0, 0}, {7, 7, 7}}, [](int, int, int) { return 5; });
    try {
        render(volume, options);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST(RayModes, NumbersOutOfRangeAreRefused) {
    RenderOptions options;
    options.mode = Mode::kDrr;
    EXPECT_EQ(refusal(options), "");
    for (const double bad : {0.0, -1.0, double(NAN), double(INFINITY)}) {
        RenderOptions water = options, photons = options, shade = options;
        water.drr.muWater = bad;
        EXPECT_EQ(refusal(water).find("`drr.muWater`: got "), 0);
        photons.drr.photons = bad;
        EXPECT_EQ(refusal(photons).find("`drr.photons`: got "), 0);
        shade.depthShade = bad == 0 ? 1.5 : bad;
        EXPECT_EQ(refusal(shade).find("`depthShade`: got "), 0);
    }
}

TEST(RayModes, RadiographsOfOtherUnitsAreWarnedOf) {
    const auto warningsOf = [](const Volume& volume, Mode mode = Mode::kDrr) {
        std::string lines;
        Listener listener;
        listener.warning = [&](const std::string& line) { lines += line; };
        render(volume, optionsOf(mode, viewOf(volume, {0, 0, -1})), listener);
        return lines;
    };
    Volume volume =
        makeVolume({{0, 0, 0}, {15, 15, 15}}, [](int x, int, int) { return x < 8 ? 0 : 1030; });
    EXPECT_NE(warningsOf(volume).find("names no patient's space"), std::string::npos);
    test::changed(volume)->space = "RAS";
    EXPECT_NE(warningsOf(volume).find("hardly any air"), std::string::npos);
    EXPECT_EQ(warningsOf(volume, Mode::kXray), "");
    test::changed(volume)->codeBook = CodeBook::integer(-1000);
    test::changed(volume)->valueMin = -1000;
    test::changed(volume)->valueMax = 30;
    EXPECT_EQ(warningsOf(volume), "");
    // Sums of Hounsfield units are of no use, the other way round.
    const std::string xray = warningsOf(volume, Mode::kXray);
    EXPECT_EQ(xray.find("`mode` xray: adds up Hounsfield units"), 0) << xray;
    EXPECT_NE(xray.find("`mode` drr makes radiographs"), std::string::npos);
    EXPECT_EQ(warningsOf(volume, Mode::kMip), "");
}

// One voxel fills no pixel by half: values are not shown of so little, and that is said.
TEST(RayModes, APictureOfNothingIsSaidToBeEmpty) {
    const Volume volume = makeVolume({glm::ivec3(0), glm::ivec3(63)}, [](int x, int y, int z) {
        return x == 30 && y == 31 && z == 32 ? 100 : kInactive;
    });
    const auto warningsOf = [&](Mode mode, int size) {
        RenderOptions options;
        options.mode = mode;
        options.camera.sizePixels = {size, size};
        std::string lines;
        Listener listener;
        listener.warning = [&](const std::string& line) { lines += line; };
        render(volume, options, listener);
        return lines;
    };
    for (const Mode mode : {Mode::kMip, Mode::kMin, Mode::kAverage}) {
        EXPECT_NE(warningsOf(mode, 8).find("picture: empty"), std::string::npos);
        EXPECT_EQ(warningsOf(mode, 128), "");
    }
    EXPECT_EQ(warningsOf(Mode::kXray, 8), "");
}

}  // namespace
}  // namespace deltasplat::test
