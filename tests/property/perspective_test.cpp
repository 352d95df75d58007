// SPDX-License-Identifier: Apache-2.0
// Pictures that are seen from an eye: right against closed forms and an independent ray marcher,
// without seams, jumps or aliasing, and the same bits whoever makes them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>

#include "deltasplat/error.h"
#include "deltasplat/render.h"
#include "deltasplat/simd.h"
#include "deltasplat/threads.h"
#include "property/test_scene.h"
#include "reference/ray_marcher.h"
#include "support/make_volume.h"
#include "support/simd_levels.h"

namespace deltasplat::test {
namespace {

const double kPi = std::acos(-1.0);

// What a camera sees through a pixel, by formulas of its own.
struct Sight {
    glm::dvec3 eye, ahead, right, up;
    double tangent;  // half the height of a flat picture at distance 1; 0: a panorama
    glm::dvec2 size;
    double nearest;
    bool parallel;
    double pixel;

    explicit Sight(const Camera& camera)
        : eye(camera.targetWorld - camera.targetDistanceWorld * camera.direction),
          ahead(camera.direction),
          right(camera.right),
          up(camera.up),
          tangent(camera.projection == Projection::kLatlong
                      ? 0
                      : 0.5 * camera.frameWidthWorld * camera.sizePixels.y / camera.sizePixels.x /
                            camera.targetDistanceWorld),
          size(camera.sizePixels),
          nearest(camera.nearWorld),
          parallel(camera.projection == Projection::kOrtho),
          pixel(camera.frameWidthWorld / camera.sizePixels.x) {}

    // Where the line of sight begins: on the near plane, or so far away.
    glm::dvec3 from(double x, double y) const {
        if (parallel) return eye + pixel * ((x - 0.5 * size.x) * right - (y - 0.5 * size.y) * up);
        const glm::dvec3 ray = towards(x, y);
        const double depth = tangent > 0 ? glm::dot(ray, ahead) : glm::length(ray);
        return eye + nearest / depth * ray;
    }

    glm::dvec3 towards(double x, double y) const {
        if (parallel) return ahead;
        if (tangent > 0) {
            return ahead +
                   tangent * ((2 * x - size.x) / size.y * right - (2 * y - size.y) / size.y * up);
        }
        const double east = (2 * x / size.x - 1) * kPi;
        const double north = (0.5 - y / size.y) * kPi;
        return std::cos(north) * (std::sin(east) * right + std::cos(east) * ahead) +
               std::sin(north) * up;
    }
};

reference::Vector vectorOf(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

// The picture that the marcher makes of a volume as the transfer function of the tests shows it.
reference::Picture marched(const TestVolume& volume, const Camera& camera, double opacity,
                           double step, int samples = 1) {
    const TransferFunction function = testTransferFunction(opacity);
    reference::Medium medium;
    medium.first = {volume.first.x, volume.first.y, volume.first.z};
    const glm::ivec3 last = volume.first + volume.dims - 1;
    medium.last = {last.x, last.y, last.z};
    medium.valueAt = [&volume, last](int x, int y, int z) {
        const glm::ivec3 at(x, y, z);
        if (glm::any(glm::lessThan(at, volume.first)) || glm::any(glm::greaterThan(at, last)))
            return 0.0;
        return double(const_cast<TestVolume&>(volume).at(at));
    };
    for (int i = 0; i < 3; ++i)
        medium.axes[std::size_t(i)] = vectorOf(glm::dvec3(volume.worldFromIndex[i]));
    medium.origin = vectorOf(glm::dvec3(volume.worldFromIndex[3]));
    medium.look = [opacity](double value) {
        const double share = value / 255;
        return reference::Rgba{share, 1 - share, 0.25, opacity * share};
    };
    const Sight sight(camera);
    reference::Eye eye;
    eye.from = [&](double x, double y) { return vectorOf(sight.from(x, y)); };
    eye.towards = [&](double x, double y) { return vectorOf(sight.towards(x, y)); };
    eye.width = camera.sizePixels.x;
    eye.height = camera.sizePixels.y;
    eye.samples = samples;
    return reference::march(medium, eye, step);
}

// Soft blobs that end before the box does.
TestVolume makeSmooth(const glm::ivec3& dims, const glm::dvec3& spacing) {
    TestVolume volume({-7, 3, 11}, dims);
    volume.worldFromIndex = spaced(spacing, {5, -3, 2});
    const struct {
        glm::dvec3 middle;
        double radius, height;
    } blobs[] = {
        {{0.4, 0.5, 0.55}, 0.34, 200}, {{0.65, 0.35, 0.4}, 0.22, 120}, {{0.3, 0.7, 0.3}, 0.2, 90}};
    for (int z = 0; z < dims.z; ++z) {
        for (int y = 0; y < dims.y; ++y) {
            for (int x = 0; x < dims.x; ++x) {
                const glm::dvec3 place = (glm::dvec3(x, y, z) + 0.5) / glm::dvec3(dims);
                double value = 0;
                for (const auto& blob : blobs) {
                    const double away = glm::distance(place, blob.middle) / blob.radius;
                    if (away < 1)
                        value += blob.height * std::pow(0.5 + 0.5 * std::cos(kPi * away), 1);
                }
                volume.at(volume.first + glm::ivec3(x, y, z)) = float(std::min(value, 255.0));
            }
        }
    }
    return volume;
}

RenderOptions optionsOf(double opacity, Projection projection, glm::ivec2 size) {
    RenderOptions options;
    options.optics.transferFunction = testTransferFunction(opacity);
    options.optics.unitDistance = 1;
    options.camera.projection = projection;
    options.camera.sizePixels = size;
    return options;
}

double marchedDb(const TestVolume& volume, const RenderResult& result, double opacity) {
    return psnr(result.image, marched(volume, result.camera, opacity, 0.2));
}

TEST(Perspective, agreesWithARayMarcherOnSmoothVolumes) {
    const TestVolume smooth = makeSmooth({72, 64, 80}, {1, 1.2, 0.9});
    const Volume volume = throughVdb(smooth);
    const auto worldAt = [&](double x, double y, double z) {
        return smooth.world(glm::dvec3(smooth.first) + glm::dvec3(x, y, z));
    };
    const struct {
        const char* name;
        std::function<void(CameraOptions&)> set;
    } views[] = {
        {"front", [](CameraOptions&) {}},
        {"iso", [](CameraOptions& o) { o.view = "iso"; }},
        {"wide",
         [](CameraOptions& o) {
             o.direction = glm::dvec3(-1, 0.5, -0.6);
             o.fovDegrees = 80;
         }},
        {"inside",
         [&](CameraOptions& o) {
             o.eyeWorld = worldAt(30.3, 30.1, 41.7);
             o.direction = glm::dvec3(0.7, 0.2, -0.9);
             o.fovDegrees = 90;
         }},
        {"170 degrees",
         [&](CameraOptions& o) {
             o.eyeWorld = worldAt(36, 32, 90);
             o.fovDegrees = 170;
         }},
        {"cut by the near plane",
         [&](CameraOptions& o) {
             o.eyeWorld = worldAt(30.3, 30.1, 110);
             o.fovDegrees = 60;
             o.nearWorld = 50;
         }},
        {"from afar",
         [](CameraOptions& o) {
             o.fovDegrees = 1;
             o.rollDegrees = 30;
         }},
    };
    for (const double opacity : {0.05, 0.6}) {
        for (const auto& view : views) {
            RenderOptions options = optionsOf(opacity, Projection::kPerspective, {120, 90});
            view.set(options.camera);
            const double db = marchedDb(smooth, render(volume, options), opacity);
            RecordProperty(view.name, std::to_string(db));
            EXPECT_GE(db, 40) << view.name << ", opacity " << opacity;
        }
    }
}

TEST(Perspective, panoramasAgreeWithARayMarcher) {
    const TestVolume smooth = makeSmooth({72, 64, 80}, {1, 1.2, 0.9});
    const Volume volume = throughVdb(smooth);
    for (const double opacity : {0.05, 0.6}) {
        for (const glm::dvec3 eye : {glm::dvec3(36, 32, 40), glm::dvec3(10.5, 60, 20.25)}) {
            for (const double nearest : {0.0, 6.0}) {
                RenderOptions options = optionsOf(opacity, Projection::kLatlong, {256, 128});
                options.camera.eyeWorld = smooth.world(glm::dvec3(smooth.first) + eye);
                options.camera.direction = glm::dvec3(-1, 0.2, -0.6);
                options.camera.nearWorld = nearest;
                const double db = marchedDb(smooth, render(volume, options), opacity);
                RecordProperty("panorama", std::to_string(db));
                EXPECT_GE(db, 40) << eye.x << ", opacity " << opacity;
            }
        }
    }
}

// The same marcher, the same volume, parallel lines of sight.
TEST(Perspective, parallelViewsAgreeWithTheSameMarcher) {
    const TestVolume smooth = makeSmooth({72, 64, 80}, {1, 1.2, 0.9});
    const Volume volume = throughVdb(smooth);
    for (const double opacity : {0.05, 0.6}) {
        for (const char* view : {"front", "iso"}) {
            RenderOptions options = optionsOf(opacity, Projection::kOrtho, {120, 90});
            options.camera.view = view;
            EXPECT_GE(marchedDb(smooth, render(volume, options), opacity), 40) << view;
        }
    }
}

// Far from the eye, a perspective picture is a parallel one.
TEST(Perspective, fromAfarIsParallel) {
    const TestVolume smooth = makeSmooth({40, 44, 36}, {1, 1, 1});
    const Volume volume = throughVdb(smooth);
    RenderOptions options = optionsOf(0.4, Projection::kPerspective, {90, 90});
    options.camera.direction = glm::dvec3(-1, 0.3, -0.7);
    options.camera.fovDegrees = 0.01;
    const RenderResult far = render(volume, options);
    RenderOptions parallel = optionsOf(0.4, Projection::kOrtho, {90, 90});
    parallel.camera.direction = options.camera.direction;
    parallel.camera.frameWidthWorld = far.camera.frameWidthWorld;
    const Image image = render(volume, parallel).image;
    double squares = 0;
    for (std::size_t i = 0; i < image.rgba.size(); ++i)
        squares += std::pow(image.rgba[i] - far.image.rgba[i], 2);
    EXPECT_GE(-10 * std::log10(squares / double(image.rgba.size())), 50);
}

// A voxel's share of a ball, by its distance from the surface.
TestVolume makeBall(int radius) {
    const int side = 2 * radius + 5;
    TestVolume ball({0, 0, 0}, glm::ivec3(side));
    for (int z = 0; z < side; ++z) {
        for (int y = 0; y < side; ++y) {
            for (int x = 0; x < side; ++x) {
                const double away = glm::distance(glm::dvec3(x, y, z), glm::dvec3(radius + 2));
                ball.at({x, y, z}) = float(255 * std::clamp(radius - away + 0.5, 0.0, 1.0));
            }
        }
    }
    return ball;
}

// Extinction in proportion to values, so that what is full by half takes half as much light.
void setExtinction(RenderOptions& options, double extinction) {
    TransferFunction& function = options.optics.transferFunction;
    function.colors = {{0, {1, 1, 1}}};
    function.opacities.clear();
    for (int value = 0; value <= 255; ++value)
        function.opacities.push_back({double(value), 1 - std::exp(-value / 255.0), 0.5, 0});
    options.optics.unitDistance = 1;
    options.optics.extinctionScale = extinction;
}

// How far alpha is from 1 - exp(-S L), at worst.
double worstAlpha(
    const RenderResult& result, double extinction,
    const std::function<double(const glm::dvec3& from, const glm::dvec3& unit)>& length) {
    const Sight sight(result.camera);
    double worst = 0;
    const glm::ivec2 size = result.image.size;
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            const glm::dvec3 unit = glm::normalize(sight.towards(x + 0.5, y + 0.5));
            const double exact =
                1 - std::exp(-extinction * length(sight.from(x + 0.5, y + 0.5), unit));
            worst = std::max(worst, std::abs(result.image.pixel(x, y)[3] - exact));
        }
    }
    return worst;
}

// Pictures of what has one colour are of opacity alone, and those of several colours are not.
void setColors(RenderOptions& options, bool several) {
    if (several) options.optics.transferFunction.colors.push_back({255, {1, 0.5, 0.2}});
}

constexpr int kRadius = 80;
const glm::dvec3 kMiddle(kRadius + 2);

TEST(Perspective, stepsAreAsLongAsTheyAreInABall) {
    const Volume volume = throughRaw(makeBall(kRadius), glm::dvec3(1));
    const auto lengthIn = [&](const glm::dvec3& from, const glm::dvec3& unit) {
        const double ahead = glm::dot(kMiddle - from, unit);
        const double beside = glm::length(kMiddle - from - ahead * unit);
        return ahead + std::sqrt(kRadius * kRadius - beside * beside);
    };
    for (const glm::dvec3& eye : {kMiddle, kMiddle + glm::dvec3(20.3, -11, 31.5)}) {
        for (const bool several : {false, true}) {
            RenderOptions options = optionsOf(1, Projection::kPerspective, {160, 160});
            const double extinction = 0.8 / kRadius;
            setExtinction(options, extinction);
            setColors(options, several);
            options.camera.eyeWorld = eye;
            options.camera.direction = glm::dvec3(-0.6, -0.2, -1);
            options.camera.fovDegrees = 90;
            EXPECT_LE(worstAlpha(render(volume, options), extinction, lengthIn), 2e-3)
                << eye.x << ' ' << several;
            options.camera.fovDegrees = {};
            options.camera.projection = Projection::kLatlong;
            options.camera.sizePixels = {200, 100};
            EXPECT_LE(worstAlpha(render(volume, options), extinction, lengthIn), 2e-3)
                << eye.x << ' ' << several;
        }
    }
}

// Seen from outside, a ball that ends softly: voxels cannot tell where on them an edge is.
TEST(Perspective, stepsAreAsLongAsTheyAreInASoftBall) {
    const int side = 2 * kRadius + 5;
    TestVolume ball({0, 0, 0}, glm::ivec3(side));
    for (int z = 0; z < side; ++z) {
        for (int y = 0; y < side; ++y) {
            for (int x = 0; x < side; ++x) {
                const double away = glm::distance(glm::dvec3(x, y, z), kMiddle) / kRadius;
                ball.at({x, y, z}) = float(255 * std::pow(std::max(0.0, 1 - away * away), 2));
            }
        }
    }
    const Volume volume = throughVdb(ball);
    const auto lengthIn = [&](const glm::dvec3& from, const glm::dvec3& unit) {
        const double ahead = glm::dot(kMiddle - from, unit);
        const double beside = glm::length(kMiddle - from - ahead * unit);
        // The integral of (1 - r^2)^2 over a chord.
        const double half = std::sqrt(std::max(0.0, kRadius * kRadius - beside * beside));
        return 16.0 / 15 * std::pow(half, 5) / std::pow(kRadius, 4);
    };
    for (const glm::dvec3& away : {glm::dvec3(0, 10, 130), glm::dvec3(90, 80, -70)}) {
        for (const bool several : {false, true}) {
            RenderOptions options = optionsOf(1, Projection::kPerspective, {160, 160});
            const double extinction = 1.2 / kRadius;
            setExtinction(options, extinction);
            setColors(options, several);
            options.camera.eyeWorld = kMiddle + away;
            options.camera.fovDegrees = 90;
            EXPECT_LE(worstAlpha(render(volume, options), extinction, lengthIn), 2e-3)
                << away.x << ' ' << several;
        }
    }
}

TEST(Perspective, stepsAreAsLongAsTheyAreInASlab) {
    for (const glm::dvec3 spacing : {glm::dvec3(1), glm::dvec3(1, 1, 3), glm::dvec3(2, 1, 0.5)}) {
        // So wide that its sides stay out of sight.
        const double thick = 24 * spacing.z;
        const glm::ivec2 wide(glm::dvec2(4 * thick + 40) / glm::dvec2(spacing));
        TestVolume slab({0, 0, 0}, {wide, 24});
        std::fill(slab.values.begin(), slab.values.end(), 255.0f);
        slab.worldFromIndex = spaced(spacing);
        const Volume volume = throughRaw(slab, spacing);
        const auto lengthIn = [&](const glm::dvec3& from, const glm::dvec3& unit) {
            const double a = (-0.5 * spacing.z - from.z) / unit.z;
            const double b = (23.5 * spacing.z - from.z) / unit.z;
            return std::max(0.0, std::max(a, b)) - std::max(0.0, std::min(a, b));
        };
        const glm::dvec3 middle = 0.5 * glm::dvec3(slab.dims - 1) * spacing;
        for (const double above : {0.9, 0.2, 0.0}) {
            for (const bool several : {false, true}) {
                RenderOptions options = optionsOf(1, Projection::kPerspective, {160, 160});
                const double extinction = 0.5 / thick;
                setExtinction(options, extinction);
                setColors(options, several);
                options.camera.eyeWorld = middle + glm::dvec3(0.1, 0.3, above * thick);
                options.camera.direction = glm::dvec3(0, 0, -1);
                options.camera.fovDegrees = 90;
                const double worst = worstAlpha(render(volume, options), extinction, lengthIn);
                EXPECT_LE(worst, 2e-3) << spacing.z << ' ' << above << ' ' << several;
            }
        }
    }
}

// Cameras outside of a volume, within it, on its slices, cut by the near plane, and to all sides.
std::vector<CameraOptions> identityCameras() {
    CameraOptions camera;
    camera.projection = Projection::kPerspective;
    camera.sizePixels = {110, 90};
    camera.fovDegrees = 70;
    std::vector<CameraOptions> cameras(4, camera);
    cameras[0].direction = glm::dvec3(-0.7, 0.3, -0.6);
    cameras[1].eyeWorld = glm::dvec3(10, 12, 9);
    cameras[1].direction = glm::dvec3(1, 0.3, -0.2);
    cameras[2].eyeWorld = glm::dvec3(10.5, 12.3, 40);
    cameras[2].fovDegrees = 20;
    cameras[2].nearWorld = 20.7;
    cameras[3].projection = Projection::kLatlong;
    cameras[3].fovDegrees = {};
    cameras[3].eyeWorld = glm::dvec3(12.2, 9.9, 14);
    cameras[3].direction = glm::dvec3(0.2, -0.3, 1);
    cameras[3].sizePixels = {128, 64};
    return cameras;
}

TEST(Perspective, methodsThreadsAndSimdLevelsGiveTheSamePixels) {
    const Volume volume = randomVolume({{0, 0, 0}, {33, 26, 28}}, 5, 0.5, {1, 1.2, 0.8});
    int number = 0;
    for (const CameraOptions& camera : identityCameras()) {
        for (const bool several : {false, true}) {
            SCOPED_TRACE("camera " + std::to_string(number++) + (several ? ", colours" : ""));
            RenderOptions options;
            options.camera = camera;
            TransferFunction& function = options.optics.transferFunction;
            function.colors = {{0, {1, 0, 0.5}}};
            if (several) function.colors.push_back({255, {0.2, 1, 0}});
            // Some of it so thin that colours have low digits.
            function.opacities = {
                {40, 0, 0.5, 0}, {60, 1e-6, 0.5, 0}, {200, 0.1, 0.5, 0}, {255, 1, 0.5, 0}};
            for (const int between : {0, 1}) {
                options.splat.between = between;
                options.splat.method = Method::kAuto;
                const Image expected = render(volume, options).image;
                double sum = 0;
                for (const float value : expected.rgba) sum += value;
                EXPECT_GT(sum / double(expected.rgba.size()), 0.02);
                for (const Method method :
                     {Method::kDelta, Method::kSparse, Method::kTraditional, Method::kAuto}) {
                    options.splat.method = method;
                    for (const int threads : {1, 3, 8}) {
                        const ThreadLimit limit(threads);
                        EXPECT_EQ(render(volume, options).image.rgba, expected.rgba)
                            << methodName(method) << ", " << threads << " threads";
                    }
                }
                for (const std::string& level : test::testedSimdLevels()) {
                    setSimdLevel(level);
                    EXPECT_EQ(render(volume, options).image.rgba, expected.rgba) << level;
                }
                setSimdLevel("auto");
            }
        }
    }
}

// Where sheet pixels lie as far apart as those of the base plane and fall on them, but for
// rounding.
TEST(Perspective, simdLevelsAgreeWherePixelsFallOnEachOther) {
    const Volume volume = makeVolume({{0, 0, 0}, {19, 9, 39}}, [](int, int, int) { return 200; });
    RenderOptions options;
    TransferFunction& function = options.optics.transferFunction;
    function.colors = {{0, glm::dvec3(0)}, {100, glm::dvec3(1)}};
    function.opacities = {{0, 0, 0.5, 0}, {100, 0.1, 0.5, 0}};
    options.optics.extinctionScale = 100;
    CameraOptions wide;
    wide.projection = Projection::kPerspective;
    wide.view = "iso";
    wide.fovDegrees = 120;
    wide.sizePixels = {240, 150};
    CameraOptions near = wide;
    near.eyeWorld = glm::dvec3(-5.5, -8.5, 29.5);
    near.targetWorld = glm::dvec3(9.5, 4.5, 19.5);
    near.fovDegrees = 90;
    near.sizePixels = {256, 256};
    for (const CameraOptions& camera : {wide, near}) {
        options.camera = camera;
        const Image expected = render(volume, options).image;
        for (const std::string& level : test::testedSimdLevels()) {
            setSimdLevel(level);
            EXPECT_EQ(render(volume, options).image.rgba, expected.rgba) << level;
        }
        setSimdLevel("auto");
    }
}

// Where a volume lies in index space, and where in the world, makes no difference.
TEST(Perspective, picturesDoNotDependOnThePlaceInIndexSpace) {
    const IndexBox box{{0, 0, 0}, {20, 25, 22}};
    const Volume here = randomVolume(box, 3, 0.4);
    const glm::ivec3 moved(8 * 100000, -8 * 70000, 8 * 3);
    Volume there = makeVolume({box.min + moved, box.max + moved}, [&](int x, int y, int z) {
        const auto& tree = here.codes()->tree();
        const openvdb::Coord at(x - moved.x, y - moved.y, z - moved.z);
        return tree.isValueOn(at) ? int(tree.getValue(at)) : kInactive;
    });
    test::changed(there)->worldFromIndex[3] = glm::dvec4(-glm::dvec3(moved), 1);
    RenderOptions options = optionsOf(0.5, Projection::kPerspective, {80, 80});
    options.camera.eyeWorld = glm::dvec3(11, 12, 60);
    options.camera.targetWorld = glm::dvec3(10, 12, 11);
    const Image a = render(here, options).image;
    const Image b = render(there, options).image;
    for (std::size_t i = 0; i < a.rgba.size(); ++i) ASSERT_NEAR(a.rgba[i], b.rgba[i], 1e-6);
}

TEST(Perspective, whatToleranceCostsIsBounded) {
    const Volume volume = randomVolume({{0, 0, 0}, {40, 30, 35}}, 8, 0.3, {1, 1, 1.5});
    for (const CameraOptions& camera : identityCameras()) {
        RenderOptions options = optionsOf(0.3, camera.projection, camera.sizePixels);
        options.camera = camera;
        const Image exact = render(volume, options).image;
        for (const double tolerance : {0.02, 0.2}) {
            options.splat.tolerance.relative = tolerance;
            const RenderResult held = render(volume, options);
            double color = 0, alpha = 0;
            for (std::size_t i = 0; i < exact.rgba.size(); ++i) {
                const double off = std::abs(double(held.image.rgba[i]) - exact.rgba[i]);
                (i % 4 == 3 ? alpha : color) = std::max(i % 4 == 3 ? alpha : color, off);
            }
            EXPECT_GT(alpha, 0);
            EXPECT_LE(color, held.stats.errorBoundColor + 1e-5);
            EXPECT_LE(alpha, held.stats.errorBoundAlpha + 1e-5);
            EXPECT_LT(held.stats.errorBoundAlpha, 5 * tolerance);
        }
    }
}

TEST(Perspective, whatCannotBeSeenIsAnEmptyPicture) {
    const Volume volume = randomVolume({{0, 0, 0}, {20, 20, 20}}, 4);
    RenderOptions options = optionsOf(0.5, Projection::kPerspective, {40, 40});
    options.camera.eyeWorld = glm::dvec3(10, 10, 60);
    const auto isEmpty = [&](const Volume& seen) {
        const Image image = render(seen, options).image;
        return std::all_of(image.rgba.begin(), image.rgba.end(), [](float f) { return f == 0; });
    };
    EXPECT_FALSE(isEmpty(volume));
    // Behind the eye, nearer than the near plane, beyond what numbers tell apart, or nothing.
    options.camera.direction = glm::dvec3(0.1, 0.2, 1);
    EXPECT_TRUE(isEmpty(volume));
    options.camera.direction = glm::dvec3(0, 0, -1);
    options.camera.nearWorld = 80;
    EXPECT_TRUE(isEmpty(volume));
    options.camera.nearWorld = 0;
    EXPECT_TRUE(isEmpty(Volume()));
    options.camera.eyeWorld = glm::dvec3(10, 10, 1e12);
    EXPECT_TRUE(isEmpty(volume));
}

// Where slices are thick, a region is as narrow as a pixel, and filters as wide as it.
TEST(Perspective, nothingIsSeenThroughFogAroundTheEye) {
    TestVolume fog({0, 0, 0}, {32, 32, 32});
    std::fill(fog.values.begin(), fog.values.end(), 200.0f);
    for (const double thickness : {1.0, 10.0, 50.0}) {
        fog.worldFromIndex = spaced({1, 1, thickness});
        const Volume volume = throughRaw(fog, {1, 1, thickness});
        for (const Projection projection : {Projection::kPerspective, Projection::kLatlong}) {
            for (const double fov : {60.0, 90.0, 179.0}) {
                for (const int side : {32, 64, 128}) {
                    RenderOptions options = optionsOf(0.97, projection, {side, side / 2});
                    if (projection == Projection::kPerspective) options.camera.fovDegrees = fov;
                    options.camera.eyeWorld = glm::dvec3(15.2, 14.3, 14.1 * thickness);
                    options.camera.direction = glm::dvec3(0.05, 0.03, -1);
                    const Image image = render(volume, options).image;
                    float least = 1;
                    for (std::size_t i = 3; i < image.rgba.size(); i += 4)
                        least = std::min(least, image.rgba[i]);
                    EXPECT_GE(least, 0.999f) << thickness << ", " << fov << ", " << side;
                }
            }
        }
    }
}

// A floor of checkered voxels from five pixels a voxel to a fifth of one, against the mean of
// sixteen pixels for each.
TEST(Perspective, farSlicesDoNotAlias) {
    TestVolume floor({0, 0, 0}, {300, 4, 800});
    for (int z = 0; z < floor.dims.z; ++z) {
        for (int y = 0; y < floor.dims.y; ++y) {
            for (int x = 0; x < floor.dims.x; ++x)
                floor.at({x, y, z}) = (x + z) % 2 == 0 ? 255.0f : 60.0f;
        }
    }
    const Volume volume = throughRaw(floor, glm::dvec3(1));
    RenderOptions options = optionsOf(0.9, Projection::kPerspective, {160, 120});
    options.camera.fovDegrees = 40;
    options.camera.eyeWorld = glm::dvec3(150, 25, -30);
    options.camera.targetWorld = glm::dvec3(150, 0, 50);
    // Both pictures of the same sheets.
    options.splat.between = 0;
    for (const int resolution : {1, 2}) {
        options.splat.resolution = resolution;
        options.camera.sizePixels = {160, 120};
        const Image once = render(volume, options).image;
        options.camera.sizePixels = {640, 480};
        const Image often = render(volume, options).image;
        double squares = 0;
        for (int y = 0; y < 120; ++y) {
            for (int x = 0; x < 160; ++x) {
                for (int c = 0; c < 4; ++c) {
                    double sum = 0;
                    for (int i = 0; i < 16; ++i)
                        sum += often.pixel(4 * x + i % 4, 4 * y + i / 4)[c];
                    squares += std::pow(once.pixel(x, y)[c] - sum / 16, 2);
                }
            }
        }
        const double db = -10 * std::log10(squares / (4 * 160 * 120));
        RecordProperty("floor", std::to_string(db));
        EXPECT_GE(db, 38) << resolution;
    }
}

}  // namespace
}  // namespace deltasplat::test
