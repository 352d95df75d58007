// SPDX-License-Identifier: Apache-2.0
// Samples of deep pictures: put over each other they are the flat picture, they lie where the
// volume does, and those of two parts make the whole.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <string>
#include <vector>

#include "deltasplat/cut/cut_volume.h"
#include "deltasplat/memory_limit.h"
#include "deltasplat/render_deep.h"
#include "support/changed_volume.h"
#include "support/error_of.h"
#include "support/same_picture.h"
#include "support/some_scene.h"

namespace deltasplat {
namespace {

using test::cameraOf;
using test::Colors;
using test::errorOf;
using test::someCameras;
using test::someOptics;
using test::someVolume;

struct Deep {
    Camera camera;
    DeepImage image;
    Image flat;
};

Deep deepOf(const PreparedScene& scene, const Camera& camera, int slicesPerSample) {
    Deep deep{camera, {}, Image(camera.sizePixels)};
    renderDeep(scene, camera, {slicesPerSample}, deep.image, deep.flat);
    return deep;
}

// Puts samples over each other, from the front on.
glm::dvec4 flattened(const std::vector<DeepSample>& samples) {
    glm::dvec4 sum(0);
    for (const DeepSample& sample : samples) sum += (1 - sum.a) * glm::dvec4(sample.rgba);
    return sum;
}

std::vector<DeepSample> samplesAt(const DeepImage& image, int x, int y) {
    const auto samples = image.pixel(x, y);
    return {samples.begin(), samples.end()};
}

void expectTidy(const std::vector<DeepSample>& samples) {
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const DeepSample& sample = samples[i];
        EXPECT_GE(sample.z, i == 0 ? 0 : samples[i - 1].zBack);
        EXPECT_GE(sample.zBack, sample.z);
        EXPECT_LE(sample.rgba.a, 1);
        for (int c = 0; c < 4; ++c) EXPECT_GE(sample.rgba[c], 0);
        EXPECT_GT(sample.rgba.r + sample.rgba.g + sample.rgba.b + sample.rgba.a, 0);
    }
}

TEST(Deep, samplesOverEachOtherAreTheFlatPicture) {
    for (const Colors colors :
         {Colors::kOne, Colors::kSeveral, Colors::kOwn, Colors::kLit, Colors::kFog}) {
        const PreparedScene scene({someVolume(), someOptics(colors)}, {});
        for (const CameraOptions& options : someCameras()) {
            const Camera camera = cameraOf(*scene.scene().volume, options);
            const Image picture = test::pictureOf(scene, options);
            const double brightest = *std::max_element(picture.rgba.begin(), picture.rgba.end());
            ASSERT_GT(brightest, 0.1);
            std::size_t before = 0;
            for (const int slices : {1000, 8, 1}) {
                const Deep deep = deepOf(scene, camera, slices);
                ASSERT_EQ(deep.image.size, camera.sizePixels);
                double largest = 0;
                double ofFlat = 0;
                for (int y = 0; y < picture.size.y; ++y) {
                    for (int x = 0; x < picture.size.x; ++x) {
                        const auto samples = samplesAt(deep.image, x, y);
                        expectTidy(samples);
                        const glm::dvec4 sum = flattened(samples);
                        for (int c = 0; c < 4; ++c) {
                            const double wanted = picture.pixel(x, y)[c];
                            largest = std::max(largest, std::abs(sum[c] - wanted));
                            ofFlat = std::max(ofFlat, std::abs(deep.flat.pixel(x, y)[c] - wanted));
                        }
                    }
                }
                EXPECT_LE(largest, 5e-6 * std::max(1.0, brightest)) << slices;
                EXPECT_LE(ofFlat, 5e-6 * std::max(1.0, brightest)) << slices;
                EXPECT_GT(deep.image.samples(), before) << slices;
                before = deep.image.samples();
            }
        }
    }
}

TEST(Deep, hasTheSameSamplesForEveryMethodThreadAndSimdLevel) {
    const CameraOptions options = someCameras()[6];
    test::expectTheSameHoweverMade([&](Method method) {
        SplatOptions splat;
        splat.method = method;
        const PreparedScene scene({someVolume(), someOptics(Colors::kSeveral)}, splat);
        const Deep deep = deepOf(scene, cameraOf(*scene.scene().volume, options), 3);
        std::string bytes;
        for (const DeepRow& row : deep.image.rows) {
            bytes.append(reinterpret_cast<const char*>(row.begins.data()),
                         row.begins.size() * sizeof(std::size_t));
            bytes.append(reinterpret_cast<const char*>(row.samples.data()),
                         row.samples.size() * sizeof(DeepSample));
        }
        return bytes;
    });
}

// A single slice of voxels, in a volume of others that are clear.
std::shared_ptr<const Volume> plateAcross(int axis, int slice) {
    const IndexBox box{{-4, 3, 0}, {20, 27, 24}};
    Volume volume = test::makeVolume(
        box, [&](int x, int y, int z) { return glm::ivec3(x, y, z)[axis] == slice ? 255 : 0; },
        {1, 1.5, 0.7});
    test::changed(volume)->worldFromIndex[3] = {-20, 7, 3, 1};
    return std::make_shared<const Volume>(std::move(volume));
}

// What a pixel's middle sees, by formulas of its own.
struct Sight {
    glm::dvec3 from;
    glm::dvec3 towards;
    double depthOfOne;  // depth that one length of `towards` goes

    Sight(const Camera& camera, int x, int y) {
        const glm::dvec2 size(camera.sizePixels);
        const glm::dvec2 offset = glm::dvec2(x + 0.5, y + 0.5) - 0.5 * size;
        const double pixel = camera.frameWidthWorld / size.x;
        const glm::dvec3 across = pixel * (offset.x * camera.right - offset.y * camera.up);
        from = camera.targetWorld - camera.targetDistanceWorld * camera.direction;
        towards = camera.targetDistanceWorld * camera.direction + across;
        depthOfOne = camera.targetDistanceWorld;
        if (camera.projection == Projection::kOrtho) {
            from += across;
            towards = camera.direction;
            depthOfOne = 1;
        } else if (camera.projection == Projection::kLatlong) {
            const double east = 2 * std::acos(-1.0) * offset.x / size.x;
            const double north = -std::acos(-1.0) * offset.y / size.y;
            towards = std::cos(north) *
                          (std::sin(east) * camera.right + std::cos(east) * camera.direction) +
                      std::sin(north) * camera.up;
            depthOfOne = 1;
        }
    }
    // How deep a plane across an axis is crossed.
    double depthAt(const Volume& volume, int axis, double index) const {
        const double place =
            volume.worldFromIndex()[3][axis] + volume.worldFromIndex()[axis][axis] * index;
        return (place - from[axis]) / towards[axis] * depthOfOne;
    }
    bool isMostAlong(const Volume& volume, int axis) const {
        const auto steps = [&](int i) {
            return std::abs(towards[i]) / volume.worldFromIndex()[i][i];
        };
        return steps(axis) > steps((axis + 1) % 3) && steps(axis) > steps((axis + 2) % 3);
    }
};

std::vector<CameraOptions> camerasAlong(int axis) {
    std::vector<CameraOptions> cameras;
    for (const bool backwards : {false, true}) {
        for (const Projection projection :
             {Projection::kOrtho, Projection::kPerspective, Projection::kLatlong}) {
            for (const double tilt : {0.0, 0.3}) {
                CameraOptions camera;
                camera.projection = projection;
                camera.sizePixels = {80, 40};
                glm::dvec3 direction(tilt, 0.4 * tilt, 0.7 * tilt);
                direction[axis] = backwards ? -1 : 1;
                camera.direction = direction;
                if (axis == 1) camera.up = glm::dvec3(0, 0, 1);
                if (projection == Projection::kLatlong)
                    camera.eyeWorld = glm::dvec3(-11, 30, 11) - 9.0 * direction;
                if (projection == Projection::kPerspective) camera.fovDegrees = 35;
                cameras.push_back(camera);
            }
        }
    }
    return cameras;
}

TEST(Deep, samplesLieWhereTheirVoxelsAre) {
    const int slices[] = {7, 16, 10};
    for (int axis = 0; axis < 3; ++axis) {
        const auto volume = plateAcross(axis, slices[axis]);
        Optics optics;
        optics.transferFunction.colors = {{0, {1, 0.5, 0.2}}};
        optics.transferFunction.opacities = {{0, 0, 0.5, 0}, {255, 0.5, 0.5, 0}};
        for (const int between : {0, 2}) {
            SplatOptions splat;
            splat.between = between;
            const PreparedScene scene({volume, optics}, splat);
            for (const CameraOptions& options : camerasAlong(axis)) {
                const Camera camera = cameraOf(*volume, options);
                const Deep deep = deepOf(scene, camera, 1);
                int seen = 0;
                for (int y = 0; y < 40; ++y) {
                    for (int x = 0; x < 80; ++x) {
                        const Sight sight(camera, x, y);
                        if (!sight.isMostAlong(*volume, axis)) continue;
                        double depths[2];
                        for (int i = 0; i < 2; ++i)
                            depths[i] = sight.depthAt(*volume, axis, slices[axis] - 0.5 + i);
                        std::sort(depths, depths + 2);
                        for (const DeepSample& sample : samplesAt(deep.image, x, y)) {
                            // What is mixed of others is seen beside the plate, if faintly.
                            if (sample.zBack <= depths[0] + 1e-4 || sample.z >= depths[1] - 1e-4) {
                                EXPECT_GT(between, 0);
                                continue;
                            }
                            EXPECT_NEAR(sample.z, std::max(depths[0], 0.0), 1e-4 * depths[1]);
                            EXPECT_NEAR(sample.zBack, depths[1], 1e-4 * depths[1]);
                            ++seen;
                        }
                    }
                }
                EXPECT_GT(seen, 50) << axis << " " << projectionName(camera.projection);
            }
        }
    }
}

TEST(Deep, nothingIsNearerThanTheNearPlane) {
    const PreparedScene scene({someVolume(), someOptics(Colors::kSeveral)}, {});
    for (const Projection projection : {Projection::kPerspective, Projection::kLatlong}) {
        CameraOptions options;
        options.projection = projection;
        options.sizePixels = {80, 40};
        options.eyeWorld = glm::dvec3(16, 15, 11);
        options.direction = glm::dvec3(0.2, -0.1, 1);
        options.nearWorld = 2.6;
        const Deep deep = deepOf(scene, cameraOf(*scene.scene().volume, options), 4);
        float nearest = 1e9f;
        for (const DeepRow& row : deep.image.rows)
            for (const DeepSample& sample : row.samples) nearest = std::min(nearest, sample.z);
        EXPECT_EQ(nearest, 2.6f) << projectionName(projection);
    }
}

// A soft ball of fog, of two colours, of which nothing is cut off by the volume's box.
std::shared_ptr<const Volume> softBall() {
    const IndexBox box{{0, 0, 0}, {47, 47, 47}};
    return std::make_shared<const Volume>(test::makeVolume(box, [](int x, int y, int z) {
        const double away = glm::distance(glm::dvec3(x, y, z), glm::dvec3(23.5)) / 22;
        if (away >= 1) return test::kInactive;
        const double share = 1 - away * away;
        return 1 + int(250 * share * share * (0.8 + 0.2 * std::sin(0.3 * x + 0.2 * z)));
    }));
}

std::shared_ptr<const Volume> partOf(const Volume& volume, int axis, glm::ivec2 slices) {
    Cut cut;
    cut.slices[std::size_t(axis)] = slices;
    return std::make_shared<const Volume>(cutVolume(volume, cut));
}

// Samples of both parts of a volume, cut across the axis that is looked along, one after the other.
TEST(Deep, samplesOfTwoHalvesAreTheWhole) {
    const auto whole = softBall();
    Optics optics;
    optics.transferFunction.colors = {{0, {1, 0.2, 0.1}}, {255, {0.1, 0.5, 1}}};
    optics.transferFunction.opacities = {{0, 0, 0.5, 0}, {255, 0.12, 0.5, 0}};
    optics.range = glm::dvec2(0, 255);
    const PreparedScene scene({whole, optics}, {});
    const PreparedScene low({partOf(*whole, 2, {0, 19}), optics}, {});
    const PreparedScene high({partOf(*whole, 2, {20, 47}), optics}, {});
    for (const Projection projection : {Projection::kOrtho, Projection::kPerspective}) {
        for (const double tilt : {0.0, 0.5}) {
            CameraOptions options;
            options.projection = projection;
            options.sizePixels = {120, 100};
            options.direction = glm::dvec3(tilt, -0.5 * tilt, -1);
            const Camera camera = cameraOf(*whole, options);
            const Image picture = test::pictureOf(scene, options);
            const Deep all = deepOf(scene, camera, 5);
            // What is looked at from above: the front half is the one of larger indices.
            const Deep front = deepOf(high, camera, 5);
            const Deep back = deepOf(low, camera, 5);
            double largest = 0;
            std::size_t both = 0;
            for (int y = 0; y < 100; ++y) {
                for (int x = 0; x < 120; ++x) {
                    std::vector<DeepSample> samples = samplesAt(front.image, x, y);
                    const std::vector<DeepSample> behind = samplesAt(back.image, x, y);
                    both += !samples.empty() && !behind.empty();
                    samples.insert(samples.end(), behind.begin(), behind.end());
                    expectTidy(samples);
                    const glm::dvec4 sum = flattened(samples);
                    for (int c = 0; c < 4; ++c)
                        largest = std::max(largest, std::abs(sum[c] - picture.pixel(x, y)[c]));
                    // Cut at the same depths.
                    for (const DeepSample& of : samplesAt(all.image, x, y)) {
                        // Filters are not of one mind about next to nothing.
                        if (of.rgba.a < 1e-3) continue;
                        EXPECT_TRUE(std::any_of(
                            samples.begin(), samples.end(), [&](const DeepSample& sample) {
                                return sample.z == of.z && sample.zBack == of.zBack;
                            }));
                    }
                }
            }
            EXPECT_LE(largest, 2e-3) << projectionName(projection) << " " << tilt;
            EXPECT_GT(both, 1000u);
        }
    }
}

TEST(Deep, ofAnEmptyVolumeHasNoSamples) {
    const Volume nothing = test::makeVolume({}, [](int, int, int) { return test::kInactive; });
    RenderOptions options;
    options.optics = someOptics(Colors::kOne);
    options.camera.sizePixels = {10, 6};
    DeepImage deep;
    const RenderResult result = renderDeep(nothing, options, {}, deep);
    EXPECT_EQ(deep.size, glm::ivec2(10, 6));
    ASSERT_EQ(deep.rows.size(), 6u);
    EXPECT_EQ(deep.samples(), 0u);
    EXPECT_TRUE(deep.pixel(9, 5).empty());
    EXPECT_EQ(result.image.rgba, Image({10, 6}).rgba);
}

TEST(Deep, isThePictureThatRenderMakes) {
    RenderOptions options;
    options.optics = someOptics(Colors::kSeveral);
    options.camera = someCameras()[3];
    DeepImage deep;
    const RenderResult result = renderDeep(*someVolume(), options, {}, deep);
    const RenderResult flat = render(*someVolume(), options);
    EXPECT_EQ(result.stats.stamps, flat.stats.stamps);
    EXPECT_EQ(result.stats.slices, flat.stats.slices);
    EXPECT_EQ(result.stats.slabs, flat.stats.slabs);
    EXPECT_EQ(result.camera.targetWorld, flat.camera.targetWorld);
    for (std::size_t i = 0; i < flat.image.rgba.size(); ++i)
        ASSERT_NEAR(result.image.rgba[i], flat.image.rgba[i], 5e-6);
    EXPECT_GT(deep.samples(), 1000u);
}

TEST(Deep, refusesWhatCannotBeMeant) {
    const auto message = [](const auto& change) {
        RenderOptions options;
        options.optics = someOptics(Colors::kOne);
        options.camera.sizePixels = {20, 20};
        DeepOptions deepOptions;
        change(options, deepOptions);
        DeepImage deep;
        return errorOf([&] { renderDeep(*someVolume(), options, deepOptions, deep); });
    };
    EXPECT_EQ(message([](auto&, auto&) {}), "no error");
    for (const int slices : {0, -1, kMostSlicesPerSample + 1}) {
        EXPECT_EQ(message([&](auto&, DeepOptions& deep) { deep.slicesPerSample = slices; }),
                  "usage: `slicesPerSample`: got " + std::to_string(slices) +
                      "; expected a whole number within 1..1048576");
    }
    EXPECT_EQ(message([](RenderOptions& options, auto&) { options.mode = Mode::kMip; }),
              "usage: `mode`: got mip; expected composite for a deep picture");
    // The volume reaches 11.2 from its middle, and 0.4 farther with the rest of its voxels.
    EXPECT_EQ(message([](RenderOptions& options, auto&) { options.camera.distanceWorld = 11.2; }),
              "usage: `distanceWorld`: got 11.2; expected at least 11.6 for a deep "
              "picture, all of whose depths are beyond the camera");
    EXPECT_EQ(message([](RenderOptions& options, auto&) { options.camera.distanceWorld = 11.6; }),
              "no error");
    const PreparedScene scene({someVolume(), someOptics(Colors::kOne)}, {});
    const Camera camera = cameraOf(*scene.scene().volume, someCameras()[0]);
    Image wrong({3, 3});
    DeepImage deep;
    EXPECT_NE(errorOf([&] { renderDeep(scene, camera, {}, deep, wrong); }).find("image: got 3x3"),
              std::string::npos);
}

TEST(Deep, saysHowMuchMemoryIsMissing) {
    RenderOptions options;
    options.camera.sizePixels = {30000, 30000};
    DeepImage deep;
    setMemoryLimit(std::uint64_t{1} << 30);
    const std::string error = errorOf([&] { renderDeep(*someVolume(), options, {}, deep); });
    setMemoryLimit(0);
    EXPECT_EQ(error.find("failed: `sizePixels` 30000x30000: needs 26.8 GiB of memory"), 0u)
        << error;
}

}  // namespace
}  // namespace deltasplat
